# Hostile curves: exit 2, one line that names the file; nothing is written.
. "$SOURCE/tests/cli/lib.sh"

head='time [s],stretch [1],stress [kPa]'
rows=$(awk 'BEGIN { for (i = 0; i < 60; i++) printf "%g,%g,%g\n", i * 0.01, 1 + i * 0.001, i * 0.05 }')
: >empty.csv
echo "$head" >header.csv
printf '%s\n%s\n' 'time [s],stretch [1],stress' "$rows" >nounit.csv
printf '%s\n%s\n' 'time [s],stretch [1],stress [mm]' "$rows" >wrongunit.csv
printf '%s\n%s\n' 'time [s],stretch [1],stres [kPa]' "$rows" >misspelt.csv
printf '%s\n%s\n%s\n' "$head" "$rows" '0.7,nan,3' >nan.csv
printf '%s\n%s\n%s\n' "$head" "$rows" '0.7,inf,3' >inf.csv
printf '%s\n%s\n%s\n' "$head" "$rows" '0.7,1e999,3' >overflow.csv
printf '%s\n%s\n%s\n' "$head" "$rows" '0.7,abc,3' >text.csv
printf '%s\n%s\n%s\n' "$head" "$rows" '0.01,1.2,3' >back.csv
printf '%s\n%s\n%s\n' "$head" "$rows" '0.7,1.2' >short.csv
printf '%s\n%s\n\0\0\n%s\n' "$head" "$rows" "$rows" >nul.csv
head -c 4000 /dev/urandom >binary.csv
for name in empty header nounit wrongunit misspelt nan inf overflow text back short nul binary; do
    fails 2 "$name.csv" "$SINEW" analyze $name.csv --test tensile --out out
    fails 2 "$name.csv" "$SINEW" fit $name.csv --elastic exponential --out out
done
fails 2 'did you mean "stress' "$SINEW" analyze misspelt.csv --test tensile
fails 2 'wrongunit.csv:1' "$SINEW" analyze wrongunit.csv --test tensile
printf '%s\n0,1,0\n1,1,1\n2,1,2\n3,1,1\n4,1,2\n5,1,3\n6,1,2\n' "$head" >constant.csv
fails 2 'constant.csv' "$SINEW" fit constant.csv --elastic exponential
printf '%s\n0,1,0\n1,1.1,1\n2,1.2,2\n' "$head" >few.csv
fails 2 'few.csv' "$SINEW" fit few.csv --elastic exponential --memory fung-spectrum
printf 'stretch [1],stress [kPa]\n1,0\n1.1,1\n1.2,2\n1.3,4\n' >notime.csv
fails 2 'time' "$SINEW" fit notime.csv --elastic exponential
printf 'time [s],stretch [1]\n0,1\n1,1.1\n2,1.2\n3,1.3\n' >nostress.csv
fails 2 'nostress.csv' "$SINEW" fit nostress.csv --elastic exponential --out out
for method in tensile cyclic creep relaxation; do
    fails 2 'nostress.csv' "$SINEW" analyze nostress.csv --test $method --out out
done
printf 'time [s],force [N],extension [mm]\n0,0,0\n1,1,1\n2,2,2\n3,4,3\n' >nosize.csv
fails 2 'gauge_length' "$SINEW" analyze nosize.csv --test tensile --out out
fails 2 'nosize.csv' "$SINEW" fit nosize.csv --elastic exponential --out out
printf '# gauge_length: 20 mm\n%s\n' "$(cat nosize.csv)" >noarea.csv
fails 2 'area' "$SINEW" analyze noarea.csv --test tensile --out out
printf '# gauge_length: 20\n%s\n' "$(cat nosize.csv)" >badnote.csv
fails 2 'gauge_length' "$SINEW" analyze badnote.csv --test tensile --out out

# a law and a test that do not go together: measured is a pull along one axis
good() { printf '%s\n%s\n' "$head" "$rows"; }
good >good.csv
"$SINEW" fit good.csv --elastic exponential --quiet
for law in fung fung-general fung-skin fung-planar; do
    fails 2 "$law" "$SINEW" fit good.csv --elastic $law --out out
done
printf 'frequency [Hz],storage_modulus [kPa],loss_modulus [kPa]\n0.1,3,0.4\n1,4,0.5\n10,5,1\n' >sweep.csv
fails 2 'three directions' "$SINEW" fit sweep.csv --elastic fung --out out
fails 2 'sweep.csv' "$SINEW" analyze sweep.csv --test relaxation --out out
printf 'time [s],shear_strain [1],shear_stress [Pa]\n0,0,0\n1,0.1,3\n2,0.2,6\n3,0.3,9\n' >shear.csv
fails 2 'shear.csv' "$SINEW" analyze shear.csv --test tensile --out out
fails 2 'shear.csv' "$SINEW" fit shear.csv --elastic exponential --out out
# a monotonous pull has no cycle, and holds neither stretch nor stress
for method in cyclic relaxation creep; do
    fails 2 'good.csv' "$SINEW" analyze good.csv --test $method --out out
done
printf '%s\n0,1,0\n0,1,0\n0,1,0\n0,1,0\n' "$head" >still.csv
fails 2 'still.csv' "$SINEW" analyze still.csv --test tensile --out out
fails 2 'still.csv' "$SINEW" fit still.csv --elastic exponential --out out
[ ! -e out ] || die "something was written"
