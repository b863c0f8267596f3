# Fibres by a rule and from a file through the command, on both engines.
. "$SOURCE/tests/cli/lib.sh"

cat >artery.yaml <<'E'
tissue: artery
density: 1100 kg/m3
elastic: {law: hgo, mu: 9 kPa, k1: 12 kPa, k2: 1.1, kappa: 0.1, angle: 30 deg, bulk_modulus: 200 kPa}
E
# case_of NAME FIBRES: a block of 48 tetrahedra, pulled
case_of() {
    cat >"$1.yaml" <<E
case: pulled
mesh: {block: {size: [10 mm, 10 mm, 10 mm], cells: [2, 2, 2]}}
tissue: artery.yaml
fibres: $2
supports: [{on: left, fix: xyz}]
loads: [{on: right, displacement: [1 mm, 0.5 mm, 0 mm], time: {ramp: 1 s}}]
probes: [{name: pull, reaction: right}, {name: tip, point: [10 mm, 5 mm, 5 mm]}]
time: {until: 1 s, output_every: 0.5 s}
springs: {model: coupled, volume: false, integrator: quasi-static}
continuum: {element: P1, steps: 2}
E
}

# rows that are all the same are that direction, to the last bit
{ echo "fx,fy,fz,sx,sy,sz"; for n in $(seq 48); do echo "0,3,4,1,1,0"; done; } >alike.csv
case_of direction "{direction: [0, 3, 4], sheet: [1, 1, 0]}"
case_of file "{file: alike.csv}"
# a fibre has no sign
{ echo "fx,fy,fz,sx,sy,sz"; for n in $(seq 24); do echo "0,3,4,1,1,0"; echo "0,-3,-4,1,1,0"; done; } >signs.csv
case_of signs "{file: signs.csv}"
for e in continuum springs; do
    for c in direction file signs; do
        "$SINEW" run $c.yaml --engine $e --out $e.$c --quiet
        grep -q 'Name="fibre"' $e.$c/fields_0002.vtu || die "no fibres in the fields of $e"
    done
    cmp $e.direction/history.csv $e.file/history.csv || die "$e: equal rows are not one direction"
    for k in pull_fx pull_fy; do
        f=$(number $k <$e.direction/summary.json) g=$(number $k <$e.signs/summary.json)
        holds "($f - $g)^2 <= (1e-7 * $f)^2"
    done
done
holds "($(number pull_fx <springs.signs/summary.json) / $(number pull_fx <continuum.signs/summary.json) - 1)^2 < 1e-14"

# a rule that turns is another body than one direction
case_of around "{circumferential: x, angle: 40 deg, through: [0 mm, 5.3 mm, 4.6 mm]}"
"$SINEW" run around.yaml --engine springs --out around --quiet
holds "($(number pull_fx <around/summary.json) / $(number pull_fx <springs.direction/summary.json) - 1)^2 > 0.01^2"

# what is wrong is named with its place
sed '5s/.*/0,0,0,1,1,0/' alike.csv >bad.csv
case_of bad "{file: bad.csv}"
fails 2 "bad.csv:5: the fibre has no length" "$SINEW" run bad.yaml --engine springs
case_of bad "{circumferential: z, angel: 30 deg}"
fails 2 'did you mean "angle"?' "$SINEW" run bad.yaml --engine springs
case_of bad "{circumferential: z, angle: [60 deg, -60 deg], walls: [left, rigth]}"
fails 2 'did you mean "right"?' "$SINEW" run bad.yaml --engine continuum
