# A run that is killed goes on where it was, and ends with the same bytes.
. "$SOURCE/tests/cli/lib.sh"

cat >soft.yaml <<'YAML'
tissue: soft
density: 1000 kg/m3
elastic: {law: demiray, c: 2 kPa, b: 4, bulk_modulus: 40 kPa}
memory: {law: prony, g: [0.3, 0.2], tau: [10 ms, 200 ms]}
YAML
cat >poke.yaml <<'YAML'
case: poke
mesh: {block: {size: [40 mm, 40 mm, 20 mm], cells: [8, 8, 4]}}
tissue: soft.yaml
gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]
supports: [{on: bottom, fix: xyz}]
tools: [{name: probe, sphere: 10 mm, at: [20 mm, 20 mm, 30.1 mm], friction: 0.3, path: [[0 s, 0 mm, 0 mm, 0 mm], [0.3 s, 0 mm, 0 mm, -4 mm]]}]
probes: [{name: foot, reaction: bottom}]
time: {until: 0.5 s, output_every: 5 ms}
springs: {model: central, precision: single}
YAML

# what must come out the same: all but wall times
same() { # same DIR
    for file in whole/history.csv whole/energy.csv whole/fields*; do
        cmp "$file" "$1/${file#whole/}" || die "$1/${file#whole/} differs"
    done
    for folder in whole "$1"; do
        grep -v '"wall_s"\|"real_time_factor"\|"step_wall_' $folder/summary.json >summary
        mv summary summary-$folder
    done
    cmp summary-whole "summary-$1" || die "$1/summary.json differs"
}

"$SINEW" run poke.yaml --engine springs --out whole --quiet
[ ! -e whole/state.bin ] || die "the state of a run that is done was kept"

# killed again and again, each time a while after it saved something new: a slow machine waits
# longer, and what is tried stays the same
tries=0
killed=0
while :; do
    [ -e part/state.bin ] && into=--resume || into=--out
    touch before
    "$SINEW" run poke.yaml --engine springs $into part --quiet &
    pid=$!
    while [ $tries != 12 ] && kill -0 $pid 2>/dev/null &&
        [ -z "$(find part -name state.bin -newer before 2>/dev/null)" ]; do
        sleep 0.01
    done
    [ $tries = 12 ] || sleep "0.$(awk "BEGIN { srand($tries); printf \"%03d\", 60 * rand() }")"
    [ $tries = 12 ] || kill -9 $pid 2>/dev/null || :
    code=0
    wait $pid || code=$?
    [ $code != 0 ] || break
    [ $code = 137 ] || die "exit $code, expected to be killed or done"
    killed=$((killed + 1))
    [ ! -e part/state.bin ] || cp part/state.bin kept.bin
    tries=$((tries + 1))
done
[ $killed -gt 1 ] || die "was killed $killed times: nothing was tried"
same part

[ -s kept.bin ] || die "no state was saved"
fails 2 "no unfinished run" "$SINEW" run poke.yaml --engine springs --resume part

head -c 100 kept.bin >part/state.bin
fails 2 "damaged" "$SINEW" run poke.yaml --engine springs --resume part
cp kept.bin part/state.bin
fails 2 "not in --out" "$SINEW" run poke.yaml --engine springs --resume part --out other
fails 2 "resume: the state" "$SINEW" run poke.yaml --engine continuum --resume part
sed 's/c: 2 kPa/c: 2.1 kPa/' soft.yaml >stiff && mv stiff soft.yaml
fails 2 "another net" "$SINEW" run poke.yaml --engine springs --resume part
