# Cuts in case files: what they take out, what the results show, what is refused.
. "$SOURCE/tests/cli/lib.sh"

cat >t.yaml <<'Y'
tissue: t
density: 1000 kg/m3
elastic: {law: neo-hookean, shear_modulus: 10 kPa, bulk_modulus: 50 kPa}
Y
cat >good.yaml <<'Y'
case: c
mesh: {block: {size: [30 mm, 10 mm, 10 mm], cells: [6, 2, 2]}}
tissue: t.yaml
gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]
supports: [{on: left, fix: xyz}]
probes: [{name: tip, point: [30 mm, 5 mm, 5 mm]}]
cuts:
  - {at: 25 ms, box: {from: [10 mm, -1 mm, -1 mm], to: [15 mm, 11 mm, 11 mm]}}
  - {at: 30 ms, sphere: {centre: [27 mm, 5 mm, 10 mm], radius: 3 mm}}
  - {at: 0 s, cells: [143, 142]}
time: {until: 0.06 s, output_every: 0.02 s}
springs: {model: coupled, volume: true, integrator: explicit, precision: double}
Y
"$SINEW" run good.yaml --engine springs --out out >stdout
grep -q 'cut: [0-9]* cells removed' stdout || die "the summary does not tell of the cuts"
value() { sed -n "s/^ *\"$1\": \(.*[^,]\),*$/\1/p" out/summary.json; }
[ "$(value cells_removed)" -gt 26 ] || die "too few cells: $(value cells_removed)"
awk "BEGIN { exit !($(value released_J) > 0 && $(value dissipated_J) >= $(value released_J)) }" ||
    die "nothing was released"
# frames: whole, then without two, then without the slice
cells() { sed -n 's/.*NumberOfCells="\([0-9]*\)".*/\1/p' "out/fields_$1.vtu"; }
[ "$(cells 0000)" = 144 ] || die "cells at the start: $(cells 0000)"
[ "$(cells 0001)" = 142 ] || die "cells at 20 ms: $(cells 0001)"
[ "$(cells 0003)" = $((144 - $(value cells_removed))) ] || die "cells at the end: $(cells 0003)"
grep -q 'Name="cell"' out/fields_0003.vtu || die "frames must say which cells are there"
grep -q 'Name="removed"' out/fields_0003.vtu && die "removed cells are not there to be marked"
grep -q 'The body at the last output time' out/report.html || die "no picture in the report"

fails 2 "continuum: cuts are not supported" "$SINEW" run good.yaml --engine continuum
fails 1 "continuum: cuts are not supported" "$SINEW" compare good.yaml
# everything removed: no body to show, no crash
sed 's/from: .*\]}}/from: [-1 m, -1 m, -1 m], to: [1 m, 1 m, 1 m]}}/' good.yaml >dust.yaml
"$SINEW" run dust.yaml --engine springs --out dust --quiet
grep -q '"cells_removed": 144' dust/summary.json || die "dust"
sed 's/integrator: explicit/integrator: quasi-static/' good.yaml >still.yaml
fails 1 'leaves a piece that no support' "$SINEW" run still.yaml --engine springs

# bad NAME "sed script" "fragment"
bad() {
    sed -e "$2" good.yaml >"$1.yaml"
    fails 2 "$1.yaml" "$SINEW" run "$1.yaml" --engine springs --out none
    grep -qF -- "$3" stderr || die "expected \"$3\" in: $(cat stderr)"
    [ ! -e none ] || die "$1: something was written"
}
bad key 's/^cuts:/cut:/' 'did you mean "cuts"'
bad region 's/sphere: {/spheer: {/' 'did you mean "sphere"'
bad none 's/, cells: \[143, 142\]//' 'no region of the cut, expected one of sphere, box, cells'
bad both 's/cells: \[143/sphere: {}, cells: [143/' 'expected one region of a cut'
bad unit 's/at: 25 ms/at: 25 mm/' 'mm'
bad nounit 's/radius: 3 mm/radius: 3/' 'unit'
bad late 's/at: 25 ms/at: 1 s/' '0 s to the end of the run, 0.06 s'
bad early 's/at: 25 ms/at: -1 s/' '0 s to the end of the run'
bad radius 's/radius: 3 mm/radius: 0 mm/' 'a radius of more than 0'
bad box 's/to: \[15 mm/to: [10 mm/' 'more than the same number of "from"'
bad cell 's/143, 142/144/' '143'
bad empty 's/\[143, 142\]/[]/' 'expected cells'
bad miss 's/centre: \[27 mm/centre: [60 mm/' 'cut 2 hits no cell'
bad inside 's/radius: 3 mm/radious: 3 mm/' 'did you mean "radius"'
