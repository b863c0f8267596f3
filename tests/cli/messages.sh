# What the command says when it is used wrongly.
. "$SOURCE/tests/cli/lib.sh"

fails 2 'did you mean "analyze"' "$SINEW" analyse x.csv
fails 2 'unknown command "frobnicate"' "$SINEW" frobnicate
fails 2 '--test is missing' "$SINEW" analyze x.csv
fails 2 'did you mean "tensile"' "$SINEW" analyze x.csv --test tensil
fails 2 'did you mean "--elastic"' "$SINEW" fit x.csv --elastc demiray
fails 2 'no curve given' "$SINEW" fit
fails 2 'x.csv' "$SINEW" analyze x.csv --test tensile
fails 2 'did you mean "demiray"' "$SINEW" fit x.csv --elastic demirai
fails 2 'did you mean "fung-spectrum"' "$SINEW" fit x.csv --elastic demiray --memory fung-spectrm
fails 2 'expected NAME=VALUE' "$SINEW" fit x.csv --elastic demiray --fix c
fails 2 'expected a whole number' "$SINEW" fit x.csv --elastic demiray --terms two
fails 2 'did you mean "springs"' "$SINEW" run x.yaml --engine spring
fails 2 '--engine is missing' "$SINEW" run x.yaml
fails 2 'either --protocol or --replay' "$SINEW" test x.yaml
fails 2 '--ramp' "$SINEW" test x.yaml --protocol tensile --ramp "3 kPa"
fails 2 'x.yaml' "$SINEW" compare x.yaml
fails 2 'unknown benchmark' "$SINEW" bench strings
"$SINEW" --help | grep -q 'sinew compare' || die "help lists the commands"
for command in analyze fit test run calibrate compare bench convert list; do
    "$SINEW" $command --help | grep -q 'Example' || die "$command --help has an example"
done
