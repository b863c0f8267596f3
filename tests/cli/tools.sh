# Tools and forces of all kinds in both engines: what they push comes out at the support.
. "$SOURCE/tests/cli/lib.sh"

cat >soft.yaml <<'END'
tissue: soft
density: 1000 kg/m3
elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 15 kPa}
END

# a closed box of 4 x 4 x 4 mm about the origin, in millimetres
awk 'BEGIN {
    print "solid box"
    for (d = 0; d < 3; d++) for (s = 0; s < 2; s++) {
        e = (d + 1) % 3; f = (d + 2) % 3
        for (k = 0; k < 4; k++) { x[k, d] = s ? 2 : -2; x[k, e] = k == 1 || k == 2 ? 2 : -2; x[k, f] = k >= 2 ? 2 : -2 }
        split(s ? "0 1 2 0 2 3" : "0 2 1 0 3 2", w, " ")
        for (n = 1; n <= 6; n++) print "vertex", x[w[n], 0], x[w[n], 1], x[w[n], 2]
    }
    print "endsolid box" }' >box.stl

# case_of NAME "tools: …"
case_of() {
    cat >"$1.yaml" <<END
case: $1
mesh: {block: {size: [12 mm, 12 mm, 6 mm], cells: [6, 6, 3]}}
tissue: soft.yaml
supports: [{on: bottom, fix: xyz}]
$2
probes: [{name: foot, reaction: bottom}, {name: tip, point: [6 mm, 6 mm, 6 mm]}]
time: {until: 0.4 s, output_every: 0.1 s}
springs: {model: coupled, volume: false, integrator: quasi-static, precision: double}
continuum: {element: P1, steps: 4}
END
}
# last COLUMN FILE: the last value of a column whose header begins with it
last() { awk -F, -v want="$1" 'NR == 1 { for (k = 1; k <= NF; k++) if (index($k, want) == 1) at = k } END { print $at }' "$2"; }

push="path: [[0 s, 0 mm, 0 mm, 0 mm], [0.4 s, 0 mm, 0 mm, -1 mm]]"
case_of sphere "tools: [{name: t, sphere: 4 mm, at: [6 mm, 6 mm, 10.01 mm], $push}]"
case_of capsule "tools: [{name: t, capsule: {radius: 2 mm, axis: [0 mm, 9 mm, 0 mm]}, at: [6 mm, 1 mm, 8.01 mm], friction: 0.2, $push}]"
case_of plane "tools: [{name: t, plane: [0, 0, -1], at: [0 mm, 0 mm, 6.01 mm], $push}]"
case_of mesh "tools: [{name: t, mesh: {file: box.stl, unit: mm}, at: [6 mm, 6 mm, 8.01 mm], $push, turn: [[0 s, 0 deg, 0 deg, 0 deg], [0.4 s, 0 deg, 0 deg, 40 deg]]}]"
for tool in sphere capsule plane mesh; do
    for engine in springs continuum; do
        "$SINEW" run $tool.yaml --engine $engine --out $tool-$engine --quiet
        # equilibrium: the tool is pushed by as much as the support holds; Newton stops at 1e-8,
        # the springs' relaxation at 1e-6 of the forces
        holds "$(last t_fz $tool-$engine/history.csv) > 1e-3"
        holds "($(last t_fz $tool-$engine/history.csv) - $(last foot_fz $tool-$engine/history.csv))^2 < (1e-4 * $(last t_fz $tool-$engine/history.csv))^2"
    done
    # without a volume term coupled springs are linear elements, with the same contact; friction
    # depends on the path, of which each engine takes steps of its own
    limit=1e-4
    [ $tool != capsule ] || limit=1e-2
    holds "($(last t_fz $tool-springs/history.csv) / $(last t_fz $tool-continuum/history.csv) - 1)^2 < $limit^2"
done

# a force at a point, and the same in all over a surface
case_of point "loads: [{point: [6 mm, 6 mm, 6 mm], force: [0 mN, 2 mN, -5 mN], time: {ramp: 0.4 s}}]"
case_of spread "loads: [{on: top, force: [0 mN, 2 mN, -50 mN], time: {ramp: 0.4 s}}]"
for engine in springs continuum; do
    for load in point spread; do
        "$SINEW" run $load.yaml --engine $engine --out $load-$engine --quiet
        holds "($(last foot_fy $load-$engine/history.csv) + 2e-3)^2 < 1e-7^2"
    done
    holds "($(last foot_fz point-$engine/history.csv) - 5e-3)^2 < 1e-7^2"
    holds "($(last foot_fz spread-$engine/history.csv) - 50e-3)^2 < 1e-6^2"
done
holds "($(last tip_uz point-springs/history.csv) / $(last tip_uz point-continuum/history.csv) - 1)^2 < 1e-5^2"

# second-order elements share a point force by their own shape functions
sed 's/element: P1/element: P2/; s/point: \[6 mm, 6 mm, 6 mm\], force/point: [5.3 mm, 6.1 mm, 4.4 mm], force/' point.yaml >inside.yaml
"$SINEW" run inside.yaml --engine continuum --out inside --quiet
holds "($(last foot_fz inside/history.csv) - 5e-3)^2 < 1e-7^2"

# grasping: springs with motion alone
case_of held "tools: [{name: t, sphere: 4 mm, at: [6 mm, 6 mm, 10.01 mm], path: [[0 s, 0 mm, 0 mm, 0 mm], [0.1 s, 0 mm, 0 mm, -0.5 mm], [0.3 s, 0 mm, 0 mm, 1 mm]], grasp: [0.1 s, 0.35 s]}]"
fails 2 "continuum: tool \"t\": grasp is not supported" "$SINEW" run held.yaml --engine continuum
fails 2 "grasp needs integrator explicit" "$SINEW" run held.yaml --engine springs
sed 's/quasi-static, precision/explicit, damping: 100 1\/s, precision/' held.yaml >moved.yaml
"$SINEW" run moved.yaml --engine springs --out moved --quiet
# pushed at 0.1 s, pulled at 0.3 s (to rest within 1 %), let go at 0.4 s
awk -F, 'NR == 3 && !($10 > 0) || NR == 5 && !($10 < -1e-3) || NR == 6 && $10 != 0 { print; bad = 1 } END { exit bad }' \
    "moved/history.csv" || die "the tool's force: $(cat moved/history.csv)"
sed 's/grasp: .*s\]/grasp: [2 s, 1 s]/' held.yaml >back.yaml
fails 2 "two rising times" "$SINEW" run back.yaml --engine springs
