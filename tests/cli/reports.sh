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
page creep "held stress" "compliance, start of the hold" "creep rate, smallest" "time to rupture"
"$SINEW" analyze cyclic.csv --test cyclic --out cyclic --quiet
[ -s cyclic/report.html ] || die "cyclic/report.html is missing"
