# Hostile cases and tissues: exit 2 (1 where only the solver can know), one line; nothing is written.
. "$SOURCE/tests/cli/lib.sh"

cat >t.yaml <<'Y'
tissue: t
density: 1000 kg/m3
elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 300 kPa}
Y
cat >good.yaml <<'Y'
case: c
mesh: {block: {size: [10 mm, 10 mm, 10 mm], cells: [2, 2, 2]}}
tissue: t.yaml
supports: [{on: bottom, fix: xyz}]
loads: [{on: top, displacement: [0 mm, 0 mm, 1 mm], time: {ramp: 1 s}}]
time: {until: 0.02 s, output_every: 0.01 s}
Y
"$SINEW" run good.yaml --engine springs --quiet
"$SINEW" run good.yaml --engine continuum --quiet

# bad NAME "sed script" "fragment": a case with one thing wrong
bad() {
    sed -e "$2" good.yaml >"$1.yaml"
    for engine in springs continuum; do
        fails 2 "$1.yaml" "$SINEW" run "$1.yaml" --engine $engine --out out
        grep -qF -- "$3" stderr || die "expected \"$3\" in: $(cat stderr)"
    done
}
bad typo 's/supports/suports/' 'did you mean "supports"'
bad unit 's/1 mm\]/1 kPa]/' 'kPa'
bad nounit 's/1 mm\]/1]/' 'unit'
bad surface 's/on: top/on: topp/' 'did you mean "top"'
bad tissue 's/t.yaml/nope.yaml/' 'nope.yaml'
bad cells 's/\[2, 2, 2\]/[0, 2, 2]/' 'cells'
bad grade 's/cells: \[2, 2, 2\]/cells: [2, 2, 2], grade: {towards: [0 mm, 0 mm, 0 mm], ratio: 0.5}/' '1 to 100'
bad gradeless 's/cells: \[2, 2, 2\]/cells: [2, 2, 2], grade: {ratio: 2}/' 'towards'
bad outside 's/cells: \[2, 2, 2\]/cells: [2, 2, 2], grade: {towards: [0 mm, 11 mm, 0 mm], ratio: 2}/' 'a point of the block'
bad huge 's/\[2, 2, 2\]/[200000, 200000, 200000]/' 'cells'
bad size 's/10 mm, 10 mm, 10 mm/-10 mm, 10 mm, 10 mm/' 'size'
bad fix 's/fix: xyz/fix: xyw/' 'fix'
bad until 's/until: 0.02 s/until: 0 s/' 'until'
bad missing '/^time/d' 'time'
bad broken 's/^mesh: {/mesh: [/' ':'
bad alias 's/^case: c/case: \&a c/' 'anchor'
bad duplicate 's/^case: c/case: c\ncase: d/' 'case'
fails 2 'no.yaml' "$SINEW" run no.yaml --engine springs

sed '/^supports/d' good.yaml >free.yaml
fails 2 'rigid motion' "$SINEW" run free.yaml --engine continuum

# tissue NAME "sed script" "fragment"
tissue() {
    sed -e "$2" t.yaml >"$1.yaml"
    fails 2 "$1.yaml" "$SINEW" test "$1.yaml" --protocol tensile --stretch 1.1
    grep -qF -- "$3" stderr || die "expected \"$3\" in: $(cat stderr)"
}
tissue law 's/neo-hookean/neo-hokean/' 'did you mean "neo-hookean"'
tissue key 's/shear_modulus/shear_modulos/' 'did you mean "shear_modulus"'
tissue range 's/3 kPa/-3 kPa/' 'shear_modulus'
tissue dimension 's/3 kPa/3 mm/' 'mm'
tissue nomodulus 's/, bulk_modulus: 300 kPa//' 'bulk_modulus'
tissue notanumber 's/3 kPa/nan kPa/' 'nan'
tissue density 's/1000 kg/-1000 kg/' 'density'

# no engine carries what it cannot: it says so
sed 's/300 kPa/incompressible/' t.yaml >incompressible.yaml
sed 's/t.yaml/incompressible.yaml/' good.yaml >noway.yaml
fails 2 'bulk_modulus' "$SINEW" run noway.yaml --engine springs
[ ! -e out ] || die "something was written"
