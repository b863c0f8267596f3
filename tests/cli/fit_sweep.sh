# Frequency sweeps through fit: alone, with a pull, held out, refused.
. "$SOURCE/tests/cli/lib.sh"

cat >tissue.yaml <<'Y'
tissue: t
elastic: {law: exponential, B: 10, C: 20 kPa}
memory: {law: fung-spectrum, c: 0.2, tau1: 50 ms, tau2: 20 s}
Y
for stretch in 1 1.1; do
    "$SINEW" test tissue.yaml --protocol dynamic --stretch $stretch --from "1 mHz" --to "100 Hz" \
        --points 25 --out sweep-$stretch.csv --quiet
done
grep -qF '# mean_stretch: 1.1' sweep-1.1.csv || die "the curve does not say its stretch"
"$SINEW" test tissue.yaml --protocol relaxation --stretch 1.15 --ramp "2 s" --hold "100 s" \
    --points 60 --out pull.csv --quiet

# as many frequencies as make the search start on a part of them
"$SINEW" test tissue.yaml --protocol dynamic --stretch 1.1 --from "1 mHz" --to "100 Hz" --points 400 \
    --out long.csv --quiet
"$SINEW" fit long.csv --elastic linear --memory fung-spectrum --json >long.json
holds "($(awk '/"tau1"/ { getline; print $2 + 0; exit }' long.json) / 0.05 - 1)^2 < 1e-10"
[ "$(number points <long.json | tail -n 1)" = 800 ] || die "expected two residuals a frequency"

# about stretch 1 the slope is C
"$SINEW" fit sweep-1.csv --elastic linear --memory fung-spectrum --out one --json >one.json
holds "($(awk '/"modulus"/ { getline; print $2 + 0; exit }' one.json) / 20e3 - 1)^2 < 1e-10"
grep -q '"kind": "dynamic"' one.json || die "expected a dynamic curve"
grep -q '"modulus": "\(storage\|loss\)"' one.json || die "expected which modulus is worst"
grep -q '"memory_as_exponentials"' one.json || die "expected the memory over the span of the sweep"
for text in "moduli about stretch 1" "sweep-1.csv, loss" "Reduced relaxation function"; do
    grep -qF -- "$text" one/report.html || die "the page does not show \"$text\""
done

"$SINEW" fit sweep-1.csv sweep-1.1.csv pull.csv --elastic exponential --memory fung-spectrum \
    --weights peak --hold-out --out all --json >all.json
grep -q '"identifiable": false' all.json && die "expected every constant to be determined"
[ "$(grep -c '"rmse_over_peak"' all.json)" = 6 ] || die "expected three curves and their predictions"
grep -qF 'sweep-1.1.csv, moduli about stretch 1.1, predicted from the others' all/report.html ||
    die "the page does not predict the sweep"
grep -q 'Stress over time' all/report.html || die "the page does not show the pull"

sed 's/1.1$/-1/' sweep-1.1.csv >bad.csv
fails 2 'mean_stretch' "$SINEW" fit bad.csv --elastic linear
fails 2 'a dynamic curve: a tensile test needs a uniaxial one' "$SINEW" analyze sweep-1.csv --test tensile
fails 2 'a dynamic curve: --replay needs a uniaxial one' "$SINEW" test tissue.yaml --replay sweep-1.csv
