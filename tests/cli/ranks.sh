# The continuum on several ranks: the same answer for every number of them, and one message where
# something is wrong.
. "$SOURCE/tests/cli/lib.sh"

command -v mpirun >/dev/null || {
    echo "skipped: no mpirun"
    exit 77
}
# in containers the tests run as root, and there may be fewer cores than ranks
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1
# ranks that give way while they wait get no time at all on a busy machine
export OMPI_MCA_mpi_yield_when_idle=0
export OMPI_MCA_btl_vader_single_copy_mechanism=none # needs a right that containers take away

# the library of MPI unloads its plugins before leaks are looked for, so that theirs have no name to
# be known by; the tests on one rank look for ours
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0"

on() { # on N ARGUMENTS…: the command on N ranks
    n=$1
    shift
    timeout 300 mpirun -n "$n" "$SINEW" "$@"
}

# near A B: the histories of two folders agree to 1e-6 of the largest value of their columns
near() {
    paste -d, "$1/history.csv" "$2/history.csv" | awk -F, '
        NR > 1 { rows++; for (k = 1; k <= NF / 2; k++) {
            a = $k; b = $(k + NF / 2)
            if (a * a > top[k]) top[k] = a * a
            if ((a - b)^2 > off[k]) off[k] = (a - b)^2 } }
        END { for (k in top) if (off[k] > 1e-12 * top[k]) bad = 1
              exit bad || rows < 3 }' || die "the histories of $1 and $2 differ"
}

cat >soft.yaml <<'EOT'
tissue: soft
density: 1000 kg/m3
elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 60 kPa}
memory: {law: fung-spectrum, c: 0.2, tau1: 10 ms, tau2: 10 s}
EOT
sed 's/3 kPa/4 kPa/; /memory/d' soft.yaml >elastic.yaml
# case_of NAME TISSUE TOOLS CONTINUUM: memory, follower pressure, gravity, a tool with friction
case_of() {
    cat >"$1.yaml" <<EOT
case: $1
mesh: {block: {size: [12 mm, 10 mm, 8 mm], cells: [4, 3, 2]}}
tissue: $2
gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]
supports: [{on: bottom, fix: xyz}, {on: front, fix: y}]
loads:
  - {on: right, pressure: 300 Pa, time: {ramp: 0.5 s}}
  - {on: left, traction: [0 Pa, 0 Pa, 50 Pa], time: {ramp: 0.5 s}}
$3
probes: [{name: wall, reaction: bottom}, {name: tip, point: [11 mm, 3 mm, 7 mm]}]
time: {until: 1 s, output_every: 0.25 s}
continuum: {$4}
EOT
}
tool='tools: [{name: ball, sphere: 4 mm, at: [6 mm, 5 mm, 12.1 mm], path: [[0 s, 0 mm, 0 mm, 0 mm], [0.5 s, 1 mm, 0 mm, -1.5 mm]], friction: 0.2}]'

# the same answer
for element in P1 P2 P2P1; do
    case_of $element soft.yaml "$tool" "element: $element, steps: 4"
    "$SINEW" run $element.yaml --engine continuum --out $element-1 --quiet
    [ "$(number ranks <$element-1/summary.json)" = 1 ] || die "ranks"
done
for n in 2 3; do
    on $n run P1.yaml --engine continuum --out P1-$n --quiet
    [ "$(number ranks <P1-$n/summary.json)" = $n ] || die "$n ranks"
    near P1-1 P1-$n
    for key in elastic_J external_work_J dissipated_J; do
        holds "($(number $key <P1-1/summary.json) / $(number $key <P1-$n/summary.json) - 1)^2 < 1e-12"
    done
done
on 2 run P2.yaml --engine continuum --out P2-2 --quiet
on 3 run P2P1.yaml --engine continuum --out P2P1-3 --json >P2P1.json
near P2-1 P2-2
near P2P1-1 P2P1-3
[ "$(grep -c '"engine"' P2P1.json)" = 1 ] || die "more than one rank speaks"
# every cell and node is in the fields, in its place: numbers of FILE's arrays, one a line
numbers() {
    sed -n 's/.*type="Float64".*format="binary">\([^<]*\).*/\1/p' "$1" | while read -r line; do
        echo "$line" | base64 -d | od -An -v -tf8 -w8 -j8
        echo end
    done
}
for element in P1 P2P1; do
    numbers $element-1/fields_0004.vtu >one
    numbers $element-3/fields_0004.vtu >three
    paste one three | awk '
        $1 == "end" { if (off > 1e-12 * top) bad = 1; off = top = 0; arrays++; next }
        { rows++; if ($1 * $1 > top) top = $1 * $1; if (($1 - $2)^2 > off) off = ($1 - $2)^2 }
        END { exit bad || arrays < 5 || rows < 60 * 3 }' || die "the fields of $element differ"
done

# multigrid, alone and shared; motion and small strain
for element in P1 P2P1; do
    case_of it soft.yaml "$tool" "element: $element, steps: 4, solver: iterative"
    "$SINEW" run it.yaml --engine continuum --out it-1 --quiet
    on 2 run it.yaml --engine continuum --out it-2 --quiet
    near $element-1 it-1
    near $element-1 it-2
done
for analysis in "analysis: dynamic, step: 50 ms" "analysis: linear" "analysis: linear, solver: iterative"; do
    case_of other elastic.yaml "" "element: P2P1, $analysis"
    "$SINEW" run other.yaml --engine continuum --out other-1 --quiet
    on 2 run other.yaml --engine continuum --out other-2 --quiet
    near other-1 other-2
done
case_of fine elastic.yaml "" "element: P1, steps: 2"
"$SINEW" run fine.yaml --engine continuum --refine 2 --out fine-1 --quiet
on 2 run fine.yaml --engine continuum --refine 2 --out fine-2 --quiet
near fine-1 fine-2
grep -q '"refinement"' fine-2/summary.json || die "no refinement"

# one of two ranks is killed: both end, and the run goes on on one rank and on three
case_of long soft.yaml "$tool" "element: P2P1, steps: 40"
sed -i 's/output_every: 0.25 s/output_every: 0.05 s/' long.yaml
"$SINEW" run long.yaml --engine continuum --out long --quiet
cat >killed.sh <<'EOT'
"$SINEW" run long.yaml --engine continuum --out killed --quiet &
running=$!
while [ "$OMPI_COMM_WORLD_RANK" = 1 ] && [ ! -e killed/fields_0003.vtu ]; do sleep 0.02; done
[ "$OMPI_COMM_WORLD_RANK" != 1 ] || kill -9 $running
wait $running
EOT
timeout 120 mpirun -n 2 sh killed.sh >stdout 2>stderr && die "a rank was killed and nobody noticed"
[ -e killed/state.bin ] || die "no state"
[ ! -e killed/history.csv ] || die "the run was too fast to be killed"
cp -r killed other
"$SINEW" run long.yaml --engine continuum --resume killed --quiet
on 3 run long.yaml --engine continuum --resume other --quiet
near long killed
near long other

#---- what is wrong is said once, and all end

says() { # says "fragment" command…: it fails, and one line of ours says why
    fragment=$1
    shift
    "$@" >stdout 2>stderr && die "it did not fail: $*"
    [ "$(grep -c "^sinew: " stderr)" = 1 ] || die "expected one line of ours: $(cat stderr)"
    grep -F -- "$fragment" stderr | grep -q "^sinew: " || die "expected \"$fragment\": $(cat stderr)"
}
sed 's/cells: \[4, 3, 2\]/cells: [1, 1, 1]/' P1.yaml >tiny.yaml
says "7 ranks for a mesh of 6 cells" on 7 run tiny.yaml --engine continuum
on 5 run tiny.yaml --engine continuum --quiet
says "springs runs in one process" on 2 run P1.yaml --engine springs
says "convert: runs in one process" on 2 convert a b
says "nothing.yaml" on 2 run nothing.yaml --engine continuum
# a file that one rank does not see
cat >lone.sh <<'EOT'
case=P1.yaml
[ "$OMPI_COMM_WORLD_RANK" != 1 ] || case=nothing.yaml
exec "$SINEW" run $case --engine continuum --quiet
EOT
says "nothing.yaml" timeout 60 mpirun -n 3 sh lone.sh
