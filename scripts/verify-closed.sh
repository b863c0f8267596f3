#!/bin/sh
# The continuum against closed forms: verify-closed.sh SINEW OUT. Prints the closed form, ours on
# three meshes, what they extrapolate to, and the error that --refine 3 states for the coarse one
# over the true one; exits 1 where the fine mesh is more than LIMIT off, or a stated error does not
# hold the true one or is more than five times as large.
set -eu
sinew=$(realpath "$1")
mkdir -p "$2"
cd "$2"
bad=0
printf '%-6s %-44s %12s %12s %12s %12s %13s %7s\n' "" "" "closed form" coarse medium fine extrapolated stated

# row WHAT EXACT A B C LIMIT [EXTRAPOLATED ERROR]
row() {
    awk -v what="$1" -v exact="$2" -v a="$3" -v b="$4" -v c="$5" -v limit="$6" -v x="${7:-}" -v e="${8:-}" '
    BEGIN {
        if (x == "") { ratio = (c - b) / (b - a); x = ratio > 0 && ratio < 0.7 ? c + (c - b) * ratio / (1 - ratio) : c }
        off = c / exact - 1; if (off < 0) off = -off
        is = a - exact; if (is < 0) is = -is
        stated = e == "" || is <= 1e-6 * exact ? "" : e / is # nothing to state where any mesh is right
        ok = off <= limit && (stated == "" || (stated >= 1 && stated <= 5))
        printf "%-6s %-44s %12.6g %12.6g %12.6g %12.6g %13.6g %7s\n", ok ? "ok" : "SHORT", what, exact, a, b, c, x,
               stated == "" ? "-" : sprintf("%.2f", stated)
        exit !ok }' || bad=1
}

# refined CASE QUANTITY: values, extrapolated, error of the coarse mesh
refined() {
    awk -v name="\"$2\":" '
        $1 == name && $2 == "{" { found = 1 }
        !found { next }
        $1 == "\"values\":" { list = 1; next }
        $1 == "\"errors\":" { list = 2; next }
        list && $1 ~ /^\]/ { if (list == 2) exit; list = 0; next }
        list { sub(",", "", $1); if (list == 1) value = value " " $1; else if (error == "") error = $1 }
        $1 == "\"extrapolated\":" { sub(",", "", $2); x = $2 }
        END { print value, x, error }' "$1/summary.json"
}

# closed WHAT CASE QUANTITY EXACT LIMIT SCALE SHIFT: runs a case with --refine 3; a quantity times
# SCALE plus SHIFT is compared
closed() {
    [ -e "$2/summary.json" ] || "$sinew" run "$2.yaml" --engine continuum --refine 3 --out "$2" --quiet
    # shellcheck disable=SC2046
    set -- "$1" "$4" "$5" $(refined "$2" "$3" | awk -v by="$6" -v shift="$7" \
        '{ for (k = 1; k <= 5; k++) printf "%.12g ", $k * by + (k < 5 ? shift : 0) }')
    row "$1" "$2" "$4" "$5" "$6" "$3" "$7" "$8"
}

tissue() { printf 'tissue: %s\ndensity: 1000 kg/m3\nelastic: {%s}\n' "$1" "$2" >"$1.yaml"; }
tissue rubber "law: neo-hookean, shear_modulus: 17 kPa, bulk_modulus: incompressible"
tissue rivlin "law: mooney-rivlin, c1: 850 Pa, c2: 210 Pa, bulk_modulus: incompressible"
tissue fibreless "law: demiray, c: 9 kPa, b: 1.6, bulk_modulus: incompressible"
tissue stiff "law: neo-hookean, shear_modulus: 50 MPa, bulk_modulus: 33.333333333333333 MPa" # nu = 0
tissue bar "law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 20 kPa"
rollers='supports: [{on: left, fix: x}, {on: front, fix: y}, {on: bottom, fix: z}]'

# states of one strain: any mesh holds them
cat >uniaxial.yaml <<EOT
case: uniaxial tension
mesh: {block: {size: [30 mm, 20 mm, 10 mm], cells: [1, 1, 1]}}
tissue: rivlin.yaml
$rollers
loads: [{on: right, displacement: [15 mm, free, free], time: {ramp: 1 s}}]
probes: [{name: pull, reaction: right}, {name: corner, point: [30 mm, 20 mm, 10 mm]}]
time: {until: 1 s, output_every: 1 s}
continuum: {steps: 4}
EOT
closed "uniaxial, Mooney-Rivlin, stretch 1.5, N" uniaxial pull_fx \
    "$(awk 'BEGIN { l = 1.5; printf "%.12g", 2e-4 * 2 * (850 + 210 / l) * (l - 1 / l ^ 2) }')" 1e-7 1 0
cat >equibiaxial.yaml <<EOT
case: equibiaxial tension
mesh: {block: {size: [20 mm, 20 mm, 10 mm], cells: [1, 1, 1]}}
tissue: rivlin.yaml
$rollers
loads: [{on: right, displacement: [7 mm, free, free], time: {ramp: 1 s}}, {on: back, displacement: [free, 7 mm, free], time: {ramp: 1 s}}]
probes: [{name: pull, reaction: right}]
time: {until: 1 s, output_every: 1 s}
continuum: {steps: 4}
EOT
closed "equibiaxial, Mooney-Rivlin, stretch 1.35, N" equibiaxial pull_fx \
    "$(awk 'BEGIN { l = 1.35; printf "%.12g", 2e-4 * 2 * (850 + 210 * l ^ 2) * (l - 1 / l ^ 5) }')" 1e-7 1 0

# tubes between frictionless plates: the pressure that opens them to a known radius
pressure() { # pressure C B: the integral of (sigma_tt - sigma_rr)/r over the wall; B = 0 is neo-Hookean
    awk -v c="$1" -v b="$2" -v Ri=5.3 -v Ro=9.1 -v ri=6.731 'BEGIN {
        a = ri ^ 2 - Ri ^ 2; ro = sqrt(Ro ^ 2 + a); n = 20000
        for (k = 0; k < n; k++) {
            r = ri + (ro - ri) * (k + 0.5) / n; q = r ^ 2 / (r ^ 2 - a)
            sum += c * exp(b * (q + 1 / q - 2)) * (q - 1 / q) / r
        }
        printf "%.12g", sum * (ro - ri) / n }'
}
for law in rubber fibreless; do
    if [ $law = rubber ]; then p=$(pressure 17000 0); else p=$(pressure 9000 1.6); fi
    cat >tube-$law.yaml <<EOT
case: thick tube, $law
mesh: {tube: {inner_radius: 5.3 mm, outer_radius: 9.1 mm, length: 2 mm, cells: [1, 12, 1]}}
tissue: $law.yaml
supports: [{on: bottom, fix: z}, {on: top, fix: z}]
loads: [{on: inner, pressure: $p Pa, time: {ramp: 1 s}}]
probes: [{name: wall, point: [5.3 mm, 0 mm, 1 mm]}]
time: {until: 1 s, output_every: 1 s}
continuum: {steps: 5}
EOT
    closed "thick tube, $law, inner wall moves, mm" tube-$law wall_ux 1.431 0.01 1e3 0
done

cat >hanging.yaml <<EOT
case: a bar under its own weight
mesh: {block: {size: [20 mm, 20 mm, 100 mm], cells: [1, 1, 4]}}
tissue: stiff.yaml
supports: [{on: top, fix: xyz}]
gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]
probes: [{name: hook, reaction: top}]
time: {until: 1 s, output_every: 1 s}
continuum: {element: P1, steps: 1}
EOT
closed "hanging bar, linear cells, energy, nJ" hanging elastic_J \
    "$(awk 'BEGIN { printf "%.12g", 1e9 * 9810 ^ 2 * 4e-4 * 0.1 ^ 3 / (6 * 1e8) }')" 2e-3 1e9 0

# bars that their own weight sets swinging: the period 4 L sqrt(rho/M)
period() { # period CASE COLUMN LEVEL: the mean by upward crossings, s
    awk -F, -v name="$2 [m]" -v level="$3" '
        NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) at = k; next }
        NR > 2 && before < level && $at >= level {
            last = t + ($1 - t) * (level - before) / ($at - before)
            if (!count++) first = last
        }
        { t = $1; before = $at }
        END { printf "%.9g ", (last - first) / (count - 1) }' "$1/history.csv"
}
bar() { # bar WHAT AXIS MODULUS FIX GRAVITY
    exact=$(awk -v M="$3" 'BEGIN { printf "%.12g", 0.4 * sqrt(1000 / M) }')
    values=$(for n in 4 8 16; do
        cat >bar-$2-$n.yaml <<EOT
case: swinging bar
mesh: {block: {size: [100 mm, 10 mm, 10 mm], cells: [$n, 1, 1]}}
tissue: bar.yaml
supports: [{on: left, fix: xyz}, {on: boundary, fix: $4}]
gravity: [$5]
probes: [{name: tip, point: [100 mm, 5 mm, 5 mm]}]
time: {until: $(awk -v T="$exact" 'BEGIN { print 5.4 * T }') s, output_every: $(awk -v T="$exact" 'BEGIN { print T / 40 }') s}
continuum: {element: P2, analysis: dynamic, step_tolerance: 1e-5}
EOT
        "$sinew" run bar-$2-$n.yaml --engine continuum --out bar-$2-$n --quiet
        period bar-$2-$n "tip_u$2" 5e-8
    done)
    # shellcheck disable=SC2086
    row "$1" "$exact" $values 1e-3
}
bar "bar along itself, period, s" x 24000 yz "0.00024 m/s2, 0 m/s2, 0 m/s2"
bar "bar in shear, period, s" y 3000 xz "0 m/s2, 0.00003 m/s2, 0 m/s2"

# a QLV block at small strain after a ramp of 0.5 s, at 20 s; steps of the schedule, halved twice
printf 'tissue: remembering\ndensity: 1000 kg/m3\nelastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 6 kPa}\nmemory: {law: prony, g: [0.3, 0.25], tau: [0.2 s, 3 s]}\n' >remembering.yaml
for load in relaxation creep; do
    values=$(for n in 10 20 40; do
        if [ $load = relaxation ]; then
            loads='displacement: [0.0001 mm, free, free]' factor=$(awk 'BEGIN { printf "%.12g", 1 / (7714.285714285714 * 1e-5 * 1e-4) }')
        else
            loads='traction: [0.07714285714285714 Pa, 0 Pa, 0 Pa]' factor=1e7
        fi
        cat >$load-$n.yaml <<EOT
case: $load
mesh: {block: {size: [10 mm, 10 mm, 10 mm], cells: [1, 1, 1]}}
tissue: remembering.yaml
$rollers
loads: [{on: right, $loads, time: {ramp: 0.5 s}}]
probes: [{name: pull, reaction: right}, {name: tip, point: [10 mm, 10 mm, 10 mm]}]
time: {until: 4 s, output_every: 4 s}
continuum: {element: P1, steps: $n, tolerance: 1e-10}
EOT
        "$sinew" run $load-$n.yaml --engine continuum --out $load-$n --quiet
        awk -F, -v name="$([ $load = relaxation ] && echo 'pull_fx [N]' || echo 'tip_ux [m]')" -v by="$factor" '
            NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) at = k }
            END { printf "%.9g ", $at * by }' $load-$n/history.csv
    done)
    # relaxation: (1/T) int_0^T G(t - s) ds; creep: its Volterra equation by 8000 equal steps
    exact=$(awk -v what=$load 'function G(t) { return 0.45 + 0.3 * exp(-t / 0.2) + 0.25 * exp(-t / 3) }
        BEGIN { T = 0.5; until = 4; n = 4000; h = until / n
            if (what == "relaxation") {
                for (k = 0; k < n; k++) sum += G(until - T * (k + 0.5) / n) / n
                printf "%.9g", sum; exit }
            for (k = 0; k < n; k++) mean[k] = (G(k * h) + 4 * G((k + 0.5) * h) + G((k + 1) * h)) / 6
            for (i = 1; i <= n; i++) {
                sum = i * h / T < 1 ? i * h / T : 1
                for (j = 1; j < i; j++) sum -= mean[i - j] * rise[j]
                rise[i] = sum / mean[0]; strain += rise[i] }
            printf "%.9g", strain }')
    # shellcheck disable=SC2086
    row "QLV $load, of the elastic value, 10/20/40 steps" "$exact" $values 1e-3
done
exit $bad
