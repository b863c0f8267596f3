# sinew compare: several cases and meshes, what is kept, what is refused.
. "$SOURCE/tests/cli/lib.sh"

cat >t.yaml <<'Y'
tissue: t
density: 1000 kg/m3
elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 30 kPa}
Y
case_file() { # case_file NAME FORCE
    cat <<Y
case: $1
mesh: {block: {size: [20 mm, 10 mm, 10 mm], cells: [2, 2, 2]}}
tissue: t.yaml
supports: [{on: left, fix: xyz}]
loads: [{on: right, traction: [$2 Pa, 0 Pa, 0 Pa], time: {ramp: 1 s}}]
time: {until: 1 s, output_every: 0.5 s}
springs: {integrator: quasi-static, step: 0.5 s}
continuum: {steps: 2}
Y
}
case_file one 100 >a.yaml
case_file two 200 >b.yaml

# one case: its table, its words, its files
"$SINEW" compare a.yaml --meshes 1,2 --out one >one.txt
grep -q 'For an error up to' one.txt || grep -q 'No spring model' one.txt || die "words are missing"
grep -q "Not run: central: springs alone have Poisson's ratio 1/4" one.txt || die "what is left out is not said"
[ "$(grep -c '^  smoothed+volume' one.txt)" = 2 ] || die "a row for every mesh"
for word in 'Which model to use' 'Error against cost' 'Error against mesh size' '1 kHz' 'Energy ledger' \
    'right_force over right_displacement' 'right_displacement over time' '<canvas'; do
    grep -q "$word" one/report.html || die "report.html lacks \"$word\""
done
grep -qE 'https?://[^w]' one/report.html && die "report.html reaches out to the network"

# several: kept results are used again, whoever made them; the first case's are those of before
"$SINEW" compare a.yaml b.yaml --meshes 1,2 --out all --jobs 2 >all-1.txt 2>/dev/null
kept=$(ls all/kept | wc -l)
[ "$kept" = 30 ] || die "2 references and 28 runs expected, found $kept"
[ -f all/a/report.html ] && [ -f all/b/compare.json ] && [ -f all/study.json ] || die "files are missing"
touch all/mark
"$SINEW" compare a.yaml b.yaml --meshes 1,2 --out all >all-2.txt
cmp all-1.txt all-2.txt || die "kept results print another table"
[ -z "$(find all/kept -newer all/mark)" ] || die "something was run again"
jq_like() { sed -n 's/^ *"displacement_rms": \([0-9.e-]*\),/\1/p' "$1"; }
jq_like one/compare.json >x
jq_like all/a/compare.json >y
cmp x y || die "a case has other errors beside another case"

# a kept file that was cut off or damaged is made again, with the same numbers
first=all/kept/$(ls all/kept | head -n 1)
size=$(wc -c <"$first")
head -c $((size / 2)) "$first" >cut && cp cut "$first"
second=all/kept/$(ls all/kept | tail -n 1)
echo rubbish >"$second"
"$SINEW" compare a.yaml b.yaml --meshes 1,2 --out all --quiet
[ "$(wc -c <"$first")" = "$size" ] || die "a cut file was not made again"
jq_like all/a/compare.json >y
cmp x y || die "what was made again differs"

# killed in the middle, it goes on: what is there is not run again
rm -rf killed
"$SINEW" compare a.yaml b.yaml --meshes 1,2,3 --out killed --quiet &
pid=$!
while [ "$(ls killed/kept 2>/dev/null | grep -vc tmp)" -lt 5 ] && kill -0 $pid 2>/dev/null; do sleep 0.05; done
kill -9 $pid 2>/dev/null || true
wait $pid 2>/dev/null || true
touch killed/mark
before=$(ls killed/kept | grep -vc tmp)
[ "$before" -ge 5 ] || die "nothing was kept before the kill"
"$SINEW" compare a.yaml b.yaml --meshes 1,2,3 --out killed --quiet
again=$(find killed/kept -newer killed/mark -type f | wc -l)
[ "$again" -le $((44 - before)) ] || die "$again runs after $before of 44 were kept"

# a changed case is another case
case_file two 250 >b.yaml
"$SINEW" compare a.yaml b.yaml --meshes 1,2 --out all --quiet
[ "$(ls all/kept | wc -l)" = $((kept + 15)) ] || die "the changed case was not run anew"

# --models
"$SINEW" compare a.yaml --models coupled,P1 --json >models.json
[ "$(grep -c '"springs":' models.json)" = 3 ] || die "two models and the reference expected"

fails 2 'expected a case file' "$SINEW" compare
fails 2 'did you mean "coupled"' "$SINEW" compare a.yaml --models cuopled
fails 2 'stands twice' "$SINEW" compare a.yaml --models P1,P1
fails 2 'expected factors' "$SINEW" compare a.yaml --meshes 1,two
fails 2 'rising' "$SINEW" compare a.yaml --meshes 2,1
fails 2 'needs --out' "$SINEW" compare a.yaml b.yaml --jobs 2
fails 2 'no.yaml' "$SINEW" compare a.yaml no.yaml
