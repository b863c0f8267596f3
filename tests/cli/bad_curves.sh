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
[ ! -e out ] || die "something was written"
