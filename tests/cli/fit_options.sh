# Weights, window, bootstrap and the choice of terms: what was asked is in fit.json and on the page.
. "$SOURCE/tests/cli/lib.sh"

cat >tissue.yaml <<'Y'
tissue: t
elastic: {law: exponential, B: 10, C: 5 kPa}
memory: {law: prony, g: [0.3, 0.2], tau: [0.5 s, 20 s]}
Y
# a machine that rounds to 20 Pa: noise of 6 Pa
for ramp in 0.2 10; do
    "$SINEW" test tissue.yaml --protocol relaxation --stretch 1.2 --ramp "$ramp s" --hold "100 s" \
        --points 80 --out exact.csv --quiet
    awk -F, -v OFS=, '/^#/ || /time/ { print; next } { $3 = 20 * int($3 / 20 + 0.5); print }' \
        exact.csv >ramp-$ramp.csv
done
"$SINEW" fit ramp-0.2.csv ramp-10.csv --elastic exponential --memory prony --terms auto:3 \
    --weights peak --weight ramp-10.csv=2 --to "80 s" --bootstrap 60 --seed 7 --out out --json >fit.json
[ "$(number chosen <fit.json)" = 2 ] || die "expected two terms: $(grep -A3 '"terms"' fit.json)"
for key in '"weights": "peak"' '"ci95_bootstrap"' '"refits": 60' '"seed": 7' '"runner_up"' \
    '"durbin_watson"' '"determined_combination"' '"constants": 8'; do
    grep -qF -- "$key" fit.json || die "fit.json does not hold $key"
done
[ "$(grep -c '"weight": ' fit.json)" = 2 ] || die "expected two weights"
holds "$(grep '"weight": ' fit.json | sed -n '2s/[^0-9.]//gp') > 2"
for text in "Number of terms" "Percentiles of" "Correlation of the constants" "Durbin-Watson" \
    "Slope against stress" "Weights of the exponentials"; do
    sed "s/&#39;/'/g" out/report.html | grep -qF -- "$text" || die "the page does not show \"$text\""
done
# the same seed gives the same bits
"$SINEW" fit ramp-0.2.csv ramp-10.csv --elastic exponential --memory prony --terms auto:3 \
    --weights peak --weight ramp-10.csv=2 --to "80 s" --bootstrap 60 --seed 7 --json >again.json
cmp fit.json again.json

f="$SINEW fit ramp-0.2.csv --elastic exponential --memory prony"
fails 2 'expected a whole number of at least 1, auto or auto:N' $f --terms auto:x
fails 2 'give one of the two' $f --terms auto --law-terms auto
fails 2 'law exponential has no terms' $f --law-terms auto
fails 2 'expected plain, peak or noise' $f --weights heavy
fails 2 'no curve of that name' $f --weight other.csv=2
fails 2 'expected FILE=W' $f --weight 2
fails 2 'expected a number above 0' $f --weight ramp-0.2.csv=-2
fails 2 'is not before' $f --from "9 s" --to "3 s"
fails 2 'no row from' $f --from "900 s"
fails 2 'expected 0 or at least 40' $f --bootstrap 3
