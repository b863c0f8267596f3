#!/bin/sh
# Hard cases from default settings: verify-robust.sh SINEW OUT. Every case must end by itself: with
# its answer, or with a reason that helps and the last state that converged on disk. Prints a table;
# exits 1 where one does neither, crashes, or takes longer than LIMIT seconds (default 300).
set -eu
sinew=$(realpath "$1")
mkdir -p "$2"
cd "$2"
limit=${LIMIT:-300}
bad=0

# tissue NAME LAW: a tissue file
tissue() { printf 'tissue: %s\ndensity: 1000 kg/m3\nelastic: {%s}\n' "$1" "$2" >"$1.yaml"; }
tissue soft "law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 15 kPa"
tissue stiffening "law: demiray, c: 500 Pa, b: 20, bulk_modulus: 50 kPa"
tissue stiffening-incompressible "law: demiray, c: 500 Pa, b: 20, bulk_modulus: incompressible"
tissue nearly "law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 15 MPa" # nu = 0.4999
tissue incompressible "law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: incompressible"
tissue sheet "law: neo-hookean, shear_modulus: 100 kPa, bulk_modulus: 500 kPa"

# case_of NAME ELEMENT TISSUE REST…: a case file with nothing in it but what it must have
case_of() {
    name=$1 element=$2 tissue=$3
    shift 3
    {
        printf 'case: %s\ntissue: %s.yaml\ntime: {until: 1 s, output_every: 0.25 s}\n' "$name" "$tissue"
        printf 'continuum: {element: %s}\n' "$element"
        printf '%s\n' "$@"
    } >"$name-$element.yaml"
}

# number FILE KEY
number() { sed -n 's/^ *"'"$2"'": \(-\{0,1\}[0-9.eE+-]*\),\{0,1\}$/\1/p' "$1" | head -n 1; }

# row NAME ELEMENT WANTED FRAGMENT: runs it. WANTED: answer, reason (it ran, stopped and says why) or
# refusal (an error before the run); FRAGMENT: what the last two must say
row() {
    run=$1-$2 wanted=$3 fragment=${4:-}
    rm -rf "$run"
    code=0
    timeout "$limit" "$sinew" run "$run.yaml" --engine continuum --out "$run" --quiet \
        >"$run.out" 2>"$run.err" || code=$?
    case $code in
    0) found=answer ;;
    1) found=reason ;;
    2) found=refusal ;;
    124) found="ran longer than $limit s" ;;
    *) found="exit $code" ;;
    esac
    word=ok
    case $wanted in *$found*) ;; *) word=SHORT ;; esac
    if [ -n "$fragment" ]; then grep -qF -- "$fragment" "$run.err" || word=SHORT; fi
    steps=- cuts=- newton=- seconds=-
    if [ -e "$run/summary.json" ]; then
        steps=$(number "$run/summary.json" steps)
        cuts=$(number "$run/summary.json" cutbacks)
        newton=$(number "$run/summary.json" newton_iterations)
        seconds=$(number "$run/summary.json" wall_s | cut -c1-5)
        if grep -qi nan "$run/history.csv"; then word=SHORT found="$found, with NaN"; fi
    elif [ "$found" != refusal ]; then
        word=SHORT
    fi
    # what stopped on its way leaves the state it came to: the last row is later than the start
    if [ "$found" = reason ]; then
        [ "$(wc -l <"$run/history.csv")" -ge 3 ] || word=SHORT found="$found, without its last state"
    fi
    [ $word = ok ] || bad=1
    printf '%-6s %-22s %-5s %-8s %6s %5s %7s %7s  %s\n' $word "$1" "$2" "$found" "$steps" "$cuts" \
        "$newton" "$seconds" "$(sed "s/^[^:]*: [^:]*: //" "$run.err" | cut -c1-150)"
}
# carries RUN: the wall holds the 50 N of the traction, which is 1000 times the law's modulus
carries() {
    awk -v f="$(number "$1/summary.json" wall_fx)" 'BEGIN { exit !((f / -50 - 1) ^ 2 < 1e-12) }' ||
        { bad=1; printf 'SHORT  %s: the wall does not carry 50 N\n' "$1"; }
}
printf '%-6s %-22s %-5s %-8s %6s %5s %7s %7s\n' "" case cells outcome steps cuts newton s

block='mesh: {block: {size: [20 mm, 20 mm, 20 mm], cells: [4, 4, 4]}}'
bar='mesh: {block: {size: [40 mm, 10 mm, 10 mm], cells: [8, 2, 2]}}'
sheet='mesh: {block: {size: [100 mm, 20 mm, 1 mm], cells: [20, 4, 1]}}'
left='supports: [{on: left, fix: xyz}]'
ramp='time: {ramp: 1 s}'

for e in P1 P2 P2P1; do
    case_of stretch-100 $e soft "$block" "$left" \
        "loads: [{on: right, displacement: [20 mm, 0 mm, 0 mm], $ramp}]" \
        "probes: [{name: pull, reaction: right}]"
    row stretch-100 $e answer
    case_of compress-50 $e soft "$block" "$left" \
        "loads: [{on: right, displacement: [-10 mm, 0 mm, 0 mm], $ramp}]" \
        "probes: [{name: pull, reaction: right}]"
    row compress-50 $e answer
    case_of nu-0.4999 $e nearly "$bar" "$left" \
        "loads: [{on: right, traction: [0 Pa, 0 Pa, 60 Pa], $ramp}]" \
        "probes: [{name: wall, reaction: left}]"
    row nu-0.4999 $e answer
    tissue=stiffening
    [ $e != P2P1 ] || tissue=stiffening-incompressible
    case_of steep-ramp $e $tissue "$bar" "$left" \
        "loads: [{on: right, traction: [500 kPa, 0 Pa, 0 Pa], $ramp}]" \
        "probes: [{name: wall, reaction: left}]"
    row steep-ramp $e answer
    carries steep-ramp-$e
    case_of steep-at-once $e $tissue "$bar" "$left" \
        "loads: [{on: right, traction: [500 kPa, 0 Pa, 0 Pa]}]" "probes: [{name: wall, reaction: left}]"
    row steep-at-once $e answer
    carries steep-at-once-$e
    case_of sheet-bent $e sheet "$sheet" "$left" "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]" \
        "probes: [{name: wall, reaction: left}, {name: tip, point: [100 mm, 10 mm, 0.5 mm]}]"
    row sheet-bent $e answer
    case_of sheet-drawn $e sheet "$sheet" "$left" \
        "loads: [{on: right, displacement: [50 mm, 0 mm, 0 mm], $ramp}]" \
        "probes: [{name: wall, reaction: left}]"
    row sheet-drawn $e answer
    # beyond what a clamped block can follow
    case_of crush $e soft "$block" "$left" \
        "loads: [{on: right, displacement: [-19.9 mm, 0 mm, 0 mm], $ramp}]" \
        "probes: [{name: pull, reaction: right}]"
    row crush $e "answer or reason"
    # a slender column pushed straight down, and one pushed beyond its buckling load a little askew
    case_of column $e soft 'mesh: {block: {size: [60 mm, 6 mm, 6 mm], cells: [10, 1, 1]}}' "$left" \
        "loads: [{on: right, traction: [-200 Pa, 0 Pa, 2 Pa], $ramp}]" \
        "probes: [{name: wall, reaction: left}]"
    row column $e answer
    case_of slides $e soft "$block" 'supports: [{on: left, fix: x}]' \
        "loads: [{on: right, traction: [0 Pa, 0 Pa, 100 Pa], $ramp}]"
    row slides $e refusal "rigid motion free"
    case_of unsupported $e soft "$block" "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]"
    row unsupported $e refusal "rigid motion free"
    # a ball pressed far into the block
    case_of ball $e soft "$block" 'supports: [{on: bottom, fix: xyz}]' \
        'tools: [{name: ball, sphere: 8 mm, at: [10 mm, 10 mm, 28.1 mm], path: [[0 s, 0 mm, 0 mm, 0 mm], [1 s, 0 mm, 0 mm, -9 mm]], friction: 0.3}]'
    row ball $e answer
    # a tube that cannot hold the pressure (its limit is near 700 Pa), in a thick and in a thin wall
    tissue=soft
    [ $e != P2P1 ] || tissue=incompressible
    for wall in 12 10.2; do
        case_of tube-$wall $e $tissue \
            "mesh: {tube: {inner_radius: 10 mm, outer_radius: $wall mm, length: 4 mm, cells: [1, 24, 1]}}" \
            'supports: [{on: bottom, fix: z}, {on: top, fix: z}]' \
            "loads: [{on: inner, pressure: 5 kPa, $ramp}]" \
            "probes: [{name: wall, point: [10 mm, 0 mm, 2 mm]}]"
        row tube-$wall $e reason "more than the body can carry"
    done
done
for e in P1 P2; do
    case_of incompressible $e incompressible "$bar" "$left" \
        "loads: [{on: right, traction: [0 Pa, 0 Pa, 60 Pa], $ramp}]"
    row incompressible $e refusal "P2P1"
done
case_of incompressible P2P1 incompressible "$bar" "$left" \
    "loads: [{on: right, traction: [0 Pa, 0 Pa, 60 Pa], $ramp}]" "probes: [{name: wall, reaction: left}]"
row incompressible P2P1 answer
for e in P2P1; do
    case_of stretch-incompressible $e incompressible "$block" "$left" \
        "loads: [{on: right, displacement: [20 mm, 0 mm, 0 mm], $ramp}]" \
        "probes: [{name: pull, reaction: right}]"
    row stretch-incompressible $e answer
    case_of compress-incompressible $e incompressible "$block" "$left" \
        "loads: [{on: right, displacement: [-10 mm, 0 mm, 0 mm], $ramp}]" \
        "probes: [{name: pull, reaction: right}]"
    row compress-incompressible $e answer
done

# mesh NAME NODES CELLS: tetrahedra; "low" is the triangle 1 2 3
mesh() {
    {
        printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 "low"\n3 2 "meat"\n$EndPhysicalNames\n'
        printf '$Nodes\n%s\n' "$(echo "$2" | tr ';' '\n' | wc -l)"
        echo "$2" | tr ';' '\n' | awk '{ print NR, $0 }'
        printf '$EndNodes\n$Elements\n%s\n1 2 2 1 1 1 2 3\n' "$(($(echo "$3" | tr ';' '\n' | wc -l) + 1))"
        echo "$3" | tr ';' '\n' | awk '{ print NR + 1, "4 2 2 1", $0 }'
        printf '$EndElements\n'
    } >"$1.msh"
}
hold='supports: [{on: low, fix: xyz}]'
weight='gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]'
five='0 0 0;10 0 0;0 10 0;0 0 10;10 10 10'
mesh inverted "$five" '1 2 3 4;2 4 3 5' # the second is listed inside out
mesh flat "$five;5 5 0" '1 2 3 4;2 3 4 5;1 2 3 6'
mesh isolated "$five;40 0 0;50 0 0;40 10 0;40 0 10" '1 2 3 4;2 3 4 5;6 7 8 9'
mesh corner "$five;20 10 10;10 20 10;10 10 20" '1 2 3 4;2 3 4 5;5 6 7 8' # joined in one node
mesh edge "$five;20 5 5;20 15 0" '1 2 3 4;2 3 4 5;2 5 6 7'               # joined along one edge
for e in P1 P2P1; do
    for m in inverted flat isolated corner edge; do
        case_of mesh-$m $e soft "mesh: {file: $m.msh, unit: mm}" "$hold" "$weight" \
            "probes: [{name: low, reaction: low}]"
    done
    row mesh-inverted $e answer
    row mesh-flat $e refusal "flat"
    row mesh-isolated $e refusal "hangs on nothing"
    row mesh-corner $e refusal "hinge"
    row mesh-edge $e refusal "hinge"
done
exit $bad
