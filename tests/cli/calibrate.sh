# sinew calibrate: constants that a case takes, numbers, refusals.
. "$SOURCE/tests/cli/lib.sh"

cat >t.yaml <<E
tissue: block
elastic: {law: neo-hookean, shear_modulus: 3.448 kPa, bulk_modulus: 33.33 kPa}
E
# a repeated cut is no lattice with an isotropic net
cat >c.yaml <<E
case: block
mesh: {block: {size: [40 mm, 20 mm, 20 mm], cells: [6, 3, 3], pattern: kuhn}}
tissue: t.yaml
supports: [{on: left, fix: xyz}]
loads: [{on: right, displacement: [0.4 mm, 0 mm, 0 mm], time: {ramp: 1 s}}]
probes: [{name: pull, reaction: right}]
time: {until: 1 s, output_every: 1 s}
springs: {model: central, integrator: quasi-static}
continuum: {steps: 1}
E
"$SINEW" calibrate c.yaml --out full --quiet >quiet
[ ! -s quiet ] || die "--quiet prints nothing"
"$SINEW" calibrate c.yaml --strain 0.1 --json >full.json
holds "$(number strain <full.json) == 0.1"
holds "$(number springs_beyond_edges <full.json) > 0"
grep -q '"held, shear xy"' full/calibration.json || die "virtual tests are told"
grep -q 'Most of what stays' full/report.html || die "the page says what stays"
"$SINEW" calibrate c.yaml --rule lloyd --out lloyd | grep -q 'rule lloyd' || die "the rule is told"

force() { # force CASE ENGINE
    "$SINEW" run "$1" --engine $2 --out run --quiet
    tail -n 1 run/history.csv | cut -d, -f2
}
for rule in full lloyd; do
    sed "s/model: central/model: central, constants: $rule\/springs.csv/" c.yaml >$rule.yaml
done
truth=$(force c.yaml continuum)
full=$(force full.yaml springs)
lloyd=$(force lloyd.yaml springs)
# 112 nodes: a coarse mesh of linear cells is too stiff by several per cent itself
awk "BEGIN { f = $full / $truth - 1; l = $lloyd / $truth - 1; exit !(f * f < 0.1 ^ 2 && 9 * f * f < l * l) }" ||
    die "forces: continuum $truth, full $full, lloyd $lloyd"

sed 's/6, 3, 3/6, 3, 2/' full.yaml >other.yaml
fails 2 'are of another mesh' "$SINEW" run other.yaml --engine springs
sed 's/model: central/model: coupled/' full.yaml >coupled.yaml
fails 2 'model: central' "$SINEW" run coupled.yaml --engine springs
fails 2 'did you mean "lloyd"' "$SINEW" calibrate c.yaml --rule loyd
fails 2 'strain' "$SINEW" calibrate c.yaml --strain 3
fails 2 'expected one case file' "$SINEW" calibrate
sed 's/33.33 kPa/3 kPa/' t.yaml >soft.yaml
sed 's/t.yaml/soft.yaml/' c.yaml >soft-case.yaml
fails 2 'model coupled' "$SINEW" calibrate soft-case.yaml

# fibres and matrix in one energy: constants by direction, which the net takes without a look at the law
cat >fung.yaml <<E
tissue: fung
elastic: {law: fung, c: 1 kPa, a: [9, 6, 6, 0, 0, 0, 6, 6, 6], bulk_modulus: 333 kPa}
E
sed -e 's/t.yaml/fung.yaml/' -e 's/, pattern: kuhn//' -e 's/^supports/fibres: [0, 1, 0]\n&/' c.yaml >fung-case.yaml
fails 2 'sinew calibrate' "$SINEW" run fung-case.yaml --engine springs
"$SINEW" calibrate fung-case.yaml --out fung --quiet
grep -q '^# squares of ' fung/springs.csv || die "the law of squares stands in the file"
sed 's/model: central/model: central, constants: fung\/springs.csv/' fung-case.yaml >fung-run.yaml
truth=$(force fung-case.yaml continuum)
fung=$(force fung-run.yaml springs)
# 112 nodes at Poisson's ratio 0.4955
awk "BEGIN { f = $fung / $truth - 1; exit !(f * f < 0.15 ^ 2) }" || die "fung: continuum $truth, springs $fung"
