# The analyses of the continuum through the command: motion, small strain, refinement, and a run
# that is killed and goes on.
. "$SOURCE/tests/cli/lib.sh"

cat >soft.yaml <<'EOF'
tissue: soft
density: 1000 kg/m3
elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 15 kPa}
EOF
# case_of NAME CONTINUUM: a block pulled up on one side
case_of() {
    cat >"$1.yaml" <<EOF
case: $1
mesh: {block: {size: [12 mm, 6 mm, 6 mm], cells: [3, 1, 2]}}
tissue: soft.yaml
supports: [{on: left, fix: xyz}]
loads: [{on: right, traction: [0 Pa, 0 Pa, 20 Pa], time: {ramp: 10 ms}}]
probes: [{name: wall, reaction: left}, {name: tip, point: [12 mm, 3 mm, 3 mm]}]
time: {until: 40 ms, output_every: 2 ms}
continuum: {$2}
EOF
}

# statics and small strain agree to the strain of about 0.5 %
case_of static "element: P2, steps: 2"
case_of linear "element: P2, analysis: linear"
for c in static linear; do
    "$SINEW" run $c.yaml --engine continuum --out $c --quiet
    holds "($(number "wall_fz" <$c/summary.json) + 20 * 36e-6)^2 < (1e-6 * 20 * 36e-6)^2"
done
holds "($(number tip_uz <linear/summary.json) / $(number tip_uz <static/summary.json) - 1)^2 < 0.02^2"

# motion: kinetic energy, a velocity field, and the tip swings about the static place
case_of moving "element: P2P1, analysis: dynamic, step: 0.5 ms, rho_infinity: 0.9"
"$SINEW" run moving.yaml --engine continuum --out moving --quiet
holds "$(number kinetic_J <moving/summary.json) > 0"
grep -q 'Name="velocity"' moving/fields_0020.vtu || die "no velocity"
[ ! -e moving/state.bin ] || die "a finished run leaves its state"
fails 2 "0 (most damping) to 1" sh -c 'sed "s/0.9/1.5/" moving.yaml >bad.yaml; "$0" run bad.yaml --engine continuum' "$SINEW"
sed '/density/d' soft.yaml >light.yaml
fails 2 "density" sh -c 'sed "s/soft.yaml/light.yaml/" moving.yaml >bad.yaml; "$0" run bad.yaml --engine continuum' "$SINEW"

# steps by accuracy: what a dynamic run does unless told, and says
case_of auto "element: P2P1, analysis: dynamic"
case_of chosen "element: P2P1, analysis: dynamic, step: auto, step_tolerance: 1e-4"
case_of loose "element: P2P1, analysis: dynamic, step_tolerance: 1e-3"
for c in auto chosen loose; do
    "$SINEW" run $c.yaml --engine continuum --out $c --quiet
    grep -q '"note": "steps of .* taken back for it' $c/summary.json || die "$c does not say how it went"
done
cmp auto/history.csv chosen/history.csv || die "auto is not the default"
holds "$(number steps <loose/summary.json) < 0.8 * $(number steps <auto/summary.json)"
for c in loose moving; do
    holds "($(number tip_uz <$c/summary.json) / $(number tip_uz <auto/summary.json) - 1)^2 < 0.03^2"
done
case_of wrong "step: auto"
fails 2 "analysis: dynamic only" "$SINEW" run wrong.yaml --engine continuum
case_of wrong "analysis: dynamic, step_tolerance: 2"
fails 2 "less than 1" "$SINEW" run wrong.yaml --engine continuum

# killed as soon as a state is there; the folder then goes on to the same bytes
"$SINEW" run moving.yaml --engine continuum --out killed --quiet &
running=$!
while [ ! -e killed/fields_0002.vtu ]; do sleep 0.02; done
kill -9 $running
wait $running || true
[ -e killed/state.bin ] || die "no state"
[ ! -e killed/history.csv ] || die "the run was too fast to be killed"
cp -r killed other
"$SINEW" run moving.yaml --engine continuum --resume killed --quiet
cmp moving/history.csv killed/history.csv || die "the resumed run differs"
cmp moving/fields.pvd killed/fields.pvd || die "the resumed run lists other frames"
cmp moving/fields_0020.vtu killed/fields_0020.vtu || die "the resumed run ends otherwise"
fails 2 "no unfinished run" "$SINEW" run moving.yaml --engine continuum --resume killed
fails 2 "not of this case" "$SINEW" run static.yaml --engine continuum --resume other
fails 2 "no state of the springs" "$SINEW" run moving.yaml --engine springs --resume other

# refinement: values, order and errors of every probe and of the energy
case_of coarse "element: P2, steps: 1"
sed 's/cells: \[3, 1, 2\]/cells: [2, 1, 1]/; s/output_every: 2 ms/output_every: 40 ms/' coarse.yaml >fine.yaml
"$SINEW" run fine.yaml --engine continuum --refine 3 --out refined --json --quiet >refined.json
for key in '"refinement"' '"meshes"' '"tip_uz"' '"elastic_J"' '"extrapolated"' '"errors"' '"observed"'; do
    grep -q "$key" refined/summary.json || die "no $key in summary.json"
done
grep -q "Error by refinement" refined/report.html || die "no table in the report"
sed 's/P2/P1/' fine.yaml >first.yaml
"$SINEW" run first.yaml --engine continuum --refine 3 --by order --json --quiet >order.json
[ "$(grep -c '"model": "P2P1"' order.json)" = 2 ] || die "two runs of P2P1 were to follow"
fails 2 "element: P1" "$SINEW" run fine.yaml --engine continuum --refine 2 --by order
fails 2 "cells or order" "$SINEW" run fine.yaml --engine continuum --refine 2 --by luck
fails 2 "give both" "$SINEW" run fine.yaml --engine continuum --by order
fails 2 "expected 2 or 3" "$SINEW" run fine.yaml --engine continuum --refine 4
fails 2 "engine continuum" "$SINEW" run fine.yaml --engine springs --refine 2
