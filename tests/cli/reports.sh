# Every method of analyze writes a page and a JSON file; what the terminal shows stands in the page.
. "$SOURCE/tests/cli/lib.sh"

# an exponential curve, a relaxation, cycles and a creep test, all from the virtual machine
cat >tissue.yaml <<'Y'
tissue: t
elastic: {law: exponential, B: 10, C: 5 kPa}
memory: {law: prony, g: [0.3, 0.2], tau: [50 ms, 5 s]}
Y
"$SINEW" test tissue.yaml --protocol tensile --stretch 1.2 --ramp "1 s" --out tensile.csv --quiet
"$SINEW" test tissue.yaml --protocol relaxation --stretch 1.2 --ramp "1 s" --hold "60 s" --out relaxation.csv --quiet
"$SINEW" test tissue.yaml --protocol cyclic --stretch 1.2 --ramp "1 s" --cycles 3 --out cyclic.csv --quiet
"$SINEW" test tissue.yaml --protocol creep --stress "3 kPa" --ramp "1 s" --hold "60 s" --out creep.csv --quiet

page() { # page METHOD "property"…
    method=$1
    shift
    "$SINEW" analyze $method.csv --test $method --out $method >$method.txt
    [ -s $method/analysis.json ] || die "$method/analysis.json is missing"
    for property; do
        grep -qF -- "$property" $method.txt || die "$method: the terminal does not show \"$property\""
        sed "s/&#39;/'/g" $method/report.html | grep -qF -- "$property" ||
            die "$method: the page does not show \"$property\""
    done
}
page tensile "Young's modulus" "toe modulus" "largest slope" "yield stress, 0.2 % offset" \
    "ultimate tensile strength" "strain at ultimate" "work to failure" "slope against stress (13)"
page relaxation "peak stress" "final stress" "relaxed fraction" "relaxation per decade of time"
"$SINEW" test tissue.yaml --protocol dynamic --out dynamic.csv --quiet
page dynamic "power law of the storage modulus" "plateau at low frequency" "peak of tan δ"
page creep "held stress" "compliance, start of the hold" "creep rate, smallest" "time to rupture"
"$SINEW" analyze cyclic.csv --test cyclic --out cyclic --quiet
[ -s cyclic/report.html ] || die "cyclic/report.html is missing"
for key in preconditioned_after_cycle definition discarded remarks; do
    grep -q "\"$key\":" cyclic/analysis.json || die "cyclic: no $key"
done
grep -rl 'gnuplot drew nothing' --include=report.html . && die "a plot is missing"

# a steady sine in time: storage and loss modulus of a spring with a dashpot, 30 kPa and 5 kPa
awk 'BEGIN { print "# area: 4 mm2\ntime [s],stretch [1],force [mN]"
    for (i = 0; i < 600; i++) { p = 6.283185307179586 * i / 60
        printf "%.9g,%.9g,%.9g\n", i / 120, 1.1 + 0.02 * sin(p), 4e-3 * (4000 + 600 * sin(p) + 100 * cos(p)) } }' >sine.csv
"$SINEW" analyze sine.csv --test dynamic --json --out sine >sine.json
holds "($(number frequency_Hz <sine.json) - 2) ^ 2 < 1e-12"
holds "($(number storage_modulus_Pa <sine.json) - 30000) ^ 2 < 1e-2"
holds "($(number loss_modulus_Pa <sine.json) - 5000) ^ 2 < 1e-2"
grep -q "Loops" sine/report.html || die "the page shows no loops"
grep -q '"peak_tan_delta": null' sine.json || die "one frequency has no peak"

# a tensile test with options; late rows are put back and said
awk 'BEGIN { print "# area: 4 mm2\ntime [s],stretch [1],stress [kPa]"
    for (i = 0; i < 400; i++) { k = i == 200 ? 201 : i == 201 ? 200 : i
        x = k < 300 ? k / 300 : 1; y = 0.4 * (exp(25 * 0.2 * x) - 1)
        printf "%.9g,%.9g,%.9g\n", k / 10, 1 + 0.2 * x, k < 300 ? y : y * (1 - (k - 300) / 400) } }' >pull.csv
"$SINEW" analyze pull.csv --test tensile --preload "2 mN" --window 0.05,0.1 --json >pull.json
holds "($(number preload_Pa <pull.json) - 500) ^ 2 < 1e-6"
# 0.4 kPa (exp(25 e) - 1) = 0.5 kPa at e = 0.0324
holds "($(number stretch_at_zero_strain <pull.json) - 1.0324372) ^ 2 < 1e-10"
grep -q '"yield_stress_Pa": null' pull.json || die "the fall in the hold is no yield"
grep -q 'out of the order of time put back' pull.json || die "the late row is not said"
holds "$(number discarded <pull.json) > 100"
fails 2 'needs a remark "# area' "$SINEW" analyze tensile.csv --test tensile --preload "2 mN"
fails 2 '--window: found "0.1"' "$SINEW" analyze pull.csv --test tensile --window 0.1
fails 2 '0 rows between strain 0.5 and 0.6' "$SINEW" analyze pull.csv --test tensile --window 0.5,0.6
fails 2 'loading ramp 2 asked for' "$SINEW" analyze pull.csv --test tensile --ramp 2
fails 2 '--preload belongs to --test tensile' "$SINEW" analyze pull.csv --test creep --preload "1 kPa"
awk -F, 'NR < 3 || NR < 203 { print } NR > 2 { line[NR] = $0 } END { for (i = 3; i < 100; i++) print line[i] }' pull.csv >twice.csv
fails 2 'twice.csv: row 201: time goes back' "$SINEW" analyze twice.csv --test tensile
