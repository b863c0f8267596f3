# The printed tables: every equation has its proof, every JSON key its row, the manual is up to date.
. "$SOURCE/tests/cli/lib.sh"

"$SOURCE/scripts/manual.sh" "$SINEW" --check || die "the manual's tables: make manual"

#---- equations: 1 to 50, each proof a function that a test runs ------------------------------------

"$SINEW" list equations --json >equations.json
"$SINEW" list equations | sed -n 's/^| `(\([0-9]*\))` .*/\1/p' >numbers
seq 1 50 | diff - numbers || die "expected the equations 1 to 50"
exists() { # exists FOLDER.FILE:FUNCTION
    file=$SOURCE/tests/$(echo "$1" | sed 's/\..*//')/test_$(echo "$1" | sed 's/^[^.]*\.//; s/:.*//').c
    [ -f "$file" ] || return 1
    [ "$(grep -cw -- "${1#*:}" "$file")" -ge 2 ] && grep -q "static void ${1#*:}(void \*\*state)" "$file"
}
sed -n 's/^ *"proof": "\(.*\)"$/\1/p' equations.json | tr ';' '\n' | tr -d ' ' | sed '/^$/d' | sort -u >proofs
[ "$(wc -l <proofs)" -gt 30 ] || die "too few proofs"
while read -r proof; do exists "$proof" || die "no test $proof"; done <proofs
exists law.battery:test_nothing && die "a proof that does not exist was found"
sed -n 's/^ *"code": "\(.*\)",$/\1/p' equations.json | tr ',' '\n' | tr -d ' ' | sed '/^$/d' | sort -u >code
while read -r file; do [ -f "$SOURCE/src/$file" ] || die "no file src/$file"; done <code
# what has no proof says that it is not implemented, and the other way round
"$SINEW" list equations | awk -F'|' '/^\| `\(/ {
    none = $4 ~ /^ not implemented/; empty = $6 ~ /^ *$/
    if (none != empty || ($4 !~ /^ (proven|partly: .*|not implemented: .*) $/)) { print; bad = 1 } }
    END { exit bad }' || die "a state and its proof do not agree"

#---- keys: all commands print keys of the tables, and all keys of the tables ----------------------

cat >t.yaml <<'Y'
tissue: t
density: 1000 kg/m3
elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 300 kPa}
memory: {law: prony, g: [0.3], tau: [0.1 s]}
Y
cat >u.yaml <<'Y'
tissue: u
elastic: {law: exponential, B: 10, C: 5 kPa}
memory: {law: prony, g: [0.3, 0.2], tau: [50 ms, 5 s]}
Y
cat >b.yaml <<'Y'
tissue: b
elastic: {law: hgo, mu: 3 kPa, k1: 2 kPa, k2: 1, kappa: 0.1, angle: 30 deg, bulk_modulus: 30 kPa}
memory:
  branch:
    deviatoric: {law: prony, g: [0.3], tau: [0.1 s]}
    volumetric: {law: prony, g: [0.2], tau: [0.3 s]}
    fibre: {law: prony, g: [0.1], tau: [2 s]}
Y
cat >c.yaml <<'Y'
case: c
mesh: {block: {size: [10 mm, 10 mm, 10 mm], cells: [2, 2, 2]}}
tissue: t.yaml
supports: [{on: bottom, fix: xyz}]
loads: [{on: top, displacement: [0 mm, 0 mm, 1 mm], time: {ramp: 1 s}}]
probes: [{name: pull, reaction: top}]
time: {until: 0.02 s, output_every: 0.01 s}
Y
machine() { "$SINEW" test u.yaml --stretch 1.2 --json "$@"; }
machine --protocol tensile --ramp "1 s" --out tensile.csv >test-1.json
machine --protocol relaxation --ramp "1 s" --hold "60 s" --out relaxation.csv >test-2.json
machine --protocol cyclic --ramp "1 s" --cycles 2 --out cyclic.csv >test-3.json
machine --protocol hysteresis --points 3 >test-4.json
machine --protocol dynamic --points 3 >test-5.json
"$SINEW" test u.yaml --protocol creep --stress "3 kPa" --hold "60 s" --json --out creep.csv >test-6.json
"$SINEW" test t.yaml --protocol tensile --stretch 1.1 --json --out soft.csv >test-7.json
"$SINEW" test u.yaml --replay relaxation.csv --json >test-8.json
"$SINEW" test b.yaml --protocol tensile --stretch 1.1 --json --report b.html >test-11.json
[ "$(grep -c 'Reduced relaxation function' b.html)" -ge 3 ] || die "a memory for each part has its plot"
machine --protocol dynamic --out dynamic.csv >test-9.json
"$SINEW" test t.yaml --protocol biaxial --stretch-1 1.2 --stretch-2 1.1 --json --out biaxial.csv >test-10.json
awk 'BEGIN { print "time [s],stretch [1],stress [Pa]"
    for (i = 0; i <= 200; i++) {
        w = 6.283185307 * i / 20
        printf "%g,%.9f,%.6f\n", i / 20, 1.05 + 0.01 * sin(w), 50 + 100 * sin(w + 0.1) + sin(2 * w)
    } }' >sine.csv
for method in tensile cyclic relaxation creep sine biaxial; do
    sed '$p' $method.csv >repeated.csv # a row twice is a remark
    "$SINEW" analyze repeated.csv --test $(echo $method | sed s/sine/dynamic/) --json >analyze-$method-1.json
done
"$SINEW" test u.yaml --protocol creep --stress "3 kPa" --hold "60 s" --recovery "0 s" --quiet --out held.csv
"$SINEW" analyze held.csv --test creep --json >analyze-creep-2.json
"$SINEW" analyze soft.csv --test tensile --json >analyze-tensile-2.json
mv analyze-sine-1.json analyze-dynamic-2.json
"$SINEW" analyze dynamic.csv --test dynamic --json >analyze-dynamic-1.json
"$SINEW" fit relaxation.csv tensile.csv --elastic exponential --memory prony --terms auto:2 --hold-out --bootstrap 40 --json >fit-1.json
# one direction does not determine two constants
"$SINEW" fit tensile.csv --elastic mooney-rivlin --json >fit-2.json
"$SINEW" fit biaxial.csv --elastic neo-hookean --json >fit-3.json
"$SINEW" fit dynamic.csv --elastic linear --json >fit-4.json
"$SINEW" run c.yaml --engine springs --json >run-1.json
"$SINEW" run c.yaml --engine continuum --json >run-2.json
"$SINEW" run c.yaml --engine continuum --refine 2 --json >run-3.json
"$SINEW" calibrate c.yaml --json >calibrate-1.json
"$SINEW" compare c.yaml --json >compare-1.json
"$SINEW" compare c.yaml c.yaml --models P1 --json >study-1.json
"$SINEW" compare c.yaml c.yaml --json >study-2.json
"$SINEW" convert t.yaml t.feb --stress-unit kPa --time-unit s --json >convert-1.json
for topic in equations options keys laws memories protocols; do
    "$SINEW" list $topic --json >list-$topic.json
done
paths() { sed -n 's/^ *"key": "\(.*\)",$/\1/p' | sort -u; }
# bench measures this machine for seconds; its keys are checked against the source that prints them
"$SINEW" list keys --json | sed -n 's/^ *"name": "\(.*\)",$/\1/p' | sort -u | grep -v '^bench-' >commands
[ "$(wc -l <commands)" -ge 9 ] || die "commands are missing in list keys"
while read -r command; do
    "$SINEW" list keys "$command" "$command"-*.json --json >seen.json
    paths <seen.json >seen
    "$SINEW" list keys "$command" --json | paths >all
    diff all seen || die "keys of $command that no command printed"
done <commands
for bench in bench-springs:bench bench-haptic:bench_haptic bench-fit:bench_fit bench-continuum:bench_continuum; do
    "$SINEW" list keys ${bench%:*} --json | paths | sed 's/.*[].]//' | sort -u >all
    sed -n 's/.*cli_put[a-z_]*([a-z]*, "\([a-zA-Z_0-9]*\)".*/\1/p' "$SOURCE/src/cli/${bench#*:}.c" \
        "$SOURCE/src/cli/bench_end.c" | sort -u >seen
    diff all seen || die "keys of ${bench%:*} are not those of its source"
done
# a key that is in no table is refused, and so is what is no result
sed 's/"peak_stress_Pa"/"peek_stress_Pa"/' analyze-relaxation-1.json >wrong.json
fails 2 'unknown key "peek_stress_Pa"' "$SINEW" list keys analyze-relaxation wrong.json
fails 2 'no JSON' "$SINEW" list keys fit t.yaml
fails 2 'none.json' "$SINEW" list keys fit none.json

#---- options: help and list say the same -----------------------------------------------------------

for command in $("$SINEW" list options --json | sed -n 's/^ *"name": "\(.*\)",$/\1/p'); do
    "$SINEW" $command --help | sed -n 's/^  \(--[a-z0-9-]*\).*/\1/p' |
        grep -vxE -- '--(json|quiet|help)' | sort >help || true
    "$SINEW" list options $command --json | sed -n 's/^ *"option": "\(--[a-z0-9-]*\).*/\1/p' | sort >listed
    diff help listed || die "options of $command"
done
fails 2 'did you mean "keys"' "$SINEW" list key
fails 2 'list: what?' "$SINEW" list
fails 2 'did you mean "demiray"' "$SINEW" list laws demirai
fails 2 'unknown memory' "$SINEW" list memories nothing
fails 2 'one name at most' "$SINEW" list laws demiray ogden
fails 2 'unknown command' "$SINEW" list options nothing
fails 2 'nothing may follow' "$SINEW" list equations 7
