# Tissues to FEBio and Abaqus and back, from the command line.
. "$SOURCE/tests/cli/lib.sh"

cp "$SOURCE/examples/muscle/muscle.yaml" .
cat >t.yaml <<'Y'
tissue: t
density: 1060 kg/m3
elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 300 kPa}
memory: {law: prony, g: [0.25], tau: [0.5 s]}
Y
units="--stress-unit kPa --time-unit s --length-unit mm"
for kind in feb inp; do
    "$SINEW" convert t.yaml t.$kind $units --quiet
    "$SINEW" convert t.$kind back-$kind.yaml $units --json >$kind.json
    grep -qx '  shear_modulus: 3 kPa' back-$kind.yaml || die "$kind: $(cat back-$kind.yaml)"
    grep -q '"elastic": "neo-hookean"' $kind.json || die "$kind.json"
done
grep -q '<c1>1.125</c1>' t.feb || die "FEBio holds the long-term law: c1 = 3/2 0.75 kPa"
grep -q '^1.5, 0.006666666666666667$' t.inp || die "Abaqus holds C10 = 1.5 kPa, D1 = 2/300 1/kPa"
xmllint --noout t.feb 2>/dev/null || [ $? = 127 ] || die "t.feb is no XML"
"$SINEW" convert t.feb t2.inp $units --quiet
"$SINEW" convert muscle.yaml muscle.feb --stress-unit kPa --time-unit s >text
grep -q 'exponentials, error at most' text || die "the price of six exponentials is not said: $(cat text)"
"$SINEW" convert muscle.feb again.yaml --stress-unit kPa --time-unit s --quiet
"$SINEW" test again.yaml --protocol tensile --stretch 1.1 --quiet

fails 2 'carry no units' "$SINEW" convert t.yaml x.feb
fails 2 '--time-unit' "$SINEW" convert t.yaml x.feb --stress-unit kPa
fails 2 '--stress-unit' "$SINEW" convert t.yaml x.feb --stress-unit mm --time-unit s
fails 2 'meshes are not converted' "$SINEW" convert a.msh x.feb $units
fails 2 'unknown kind' "$SINEW" convert t.yaml x.txt $units
fails 2 'nothing to convert' "$SINEW" convert t.yaml x.yaml $units
fails 2 'a file to read and one to write' "$SINEW" convert t.yaml $units
fails 2 'no counterpart' "$SINEW" convert muscle.yaml x.inp $units
fails 2 'none.yaml' "$SINEW" convert none.yaml x.feb $units
fails 2 'none.feb' "$SINEW" convert none.feb x.yaml $units
fails 2 't.yaml' "$SINEW" convert t.yaml nowhere/x.feb $units
fails 2 'material "b"' "$SINEW" convert t.feb x.yaml $units --material b
for file in x.feb x.inp x.yaml; do [ ! -e $file ] || die "$file was written"; done
