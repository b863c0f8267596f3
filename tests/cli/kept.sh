# sinew compare: what a kept result depends on. A change of any of it is run anew, and nothing else is.
. "$SOURCE/tests/cli/lib.sh"

cat >t.yaml <<'Y'
tissue: t
density: 1000 kg/m3
elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 30 kPa}
Y
sed 's/shear_modulus: 3/shear_modulus: 4/' t.yaml >t2.yaml
sed 's/density: 1000/density: 1100/' t.yaml >t3.yaml
{ cat t.yaml; echo 'memory: {law: prony, g: [0.3], tau: [0.1 s]}'; } >t4.yaml
{ cat t.yaml; echo 'memory: {law: prony, g: [0.3], tau: [0.2 s]}'; } >t5.yaml
# a closed wedge above the body, in millimetres
awk 'BEGIN {
    split("0 0 0  4 0 0  0 4 0  0 0 4", x, " "); print "solid wedge"
    split("1 3 2  1 2 4  1 4 3  2 3 4", w, " ")
    for (n = 1; n <= 12; n++) print "vertex", x[3 * w[n] - 2], x[3 * w[n] - 1], x[3 * w[n]]
    print "endsolid wedge" }' >jaw.stl
sed 's/vertex 4 0 0/vertex 5 0 0/' jaw.stl >jaw2.stl
for n in $(seq 48); do echo "0,3,$n"; done | sed '1i fx,fy,fz' >f.csv
sed '9s/.*/0,3,1/' f.csv >f2.csv
cat >a.yaml <<'Y'
case: one
mesh: {block: {size: [20 mm, 10 mm, 10 mm], cells: [2, 2, 2]}}
tissue: t.yaml
fibres: [1, 0, 0]
gravity: [0 m/s2, 0 m/s2, -1 m/s2]
supports: [{on: left, fix: xyz}]
loads: [{on: right, traction: [100 Pa, 0 Pa, 0 Pa], time: {ramp: 1 s}}]
tools: [{name: jaw, sphere: 4 mm, at: [10 mm, 5 mm, 14.1 mm], friction: 0.1, path: [[0 s, 0 mm, 0 mm, 0 mm], [1 s, 0 mm, 0 mm, -0.2 mm]]}]
probes: [{name: tip, point: [20 mm, 5 mm, 5 mm]}, {name: hold, reaction: left}]
time: {until: 1 s, output_every: 1 s}
springs: {integrator: quasi-static, step: 1 s}
continuum: {steps: 1}
Y
# the springs that a case may give
sed '/^tools/d' a.yaml >free.yaml
"$SINEW" calibrate free.yaml --out given --quiet
cp given/springs.csv s.csv
awk -F, -v OFS=, '/^[0-9]/ && !done { $5 *= 1.01; done = 1 } { print }' s.csv >s2.csv
cmp -s s.csv s2.csv && die "no spring was changed"
# a body of one cell, whose surfaces have names
cat >body.msh <<'M'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "foot"
2 2 "face"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 20 0 0
3 0 20 0
4 0 0 20
$EndNodes
$Elements
3
1 2 2 1 1 1 3 2
2 2 2 2 2 2 3 4
3 4 2 0 1 1 2 3 4
$EndElements
M
sed 's/"face"/"side"/' body.msh >body2.msh
sed -e '/^tools/d; /^fibres/d; /^probes/d; s/left/foot/; s/right/face/' \
    -e 's/^mesh: .*/mesh: {file: body.msh, unit: mm}/' a.yaml >m.yaml
sed -e 's/body.msh/body2.msh/; s/on: face/on: side/' m.yaml >m2.yaml
# and one that moves, with few steps
sed -e '/^tools/d; s/until: 1 s, output_every: 1 s/until: 10 ms, output_every: 10 ms/; s/ramp: 1 s/ramp: 10 ms/' \
    -e 's/^continuum: .*/continuum: {element: P1, analysis: dynamic, step: auto, step_tolerance: 0.1}/' a.yaml >d.yaml

count=0
changed() { # changed FROM SED-COMMAND: FROM with a change, as case v1, v2, …
    count=$((count + 1))
    sed "$2" "$1" >v$count.yaml
    cmp -s "$1" v$count.yaml && die "nothing is changed by $2"
    return 0
}
for change in 's/20 mm, 10 mm/21 mm, 10 mm/' 's/cells: .2, 2, 2./cells: [4, 2, 2]/' 's/cells: .*\]/&, pattern: bcc/' \
    s/t.yaml/t2.yaml/ s/t.yaml/t3.yaml/ s/t.yaml/t4.yaml/ s/t.yaml/t5.yaml/ \
    's/fibres: .*/fibres: [0, 1, 0]/' 's/fibres: .*/fibres: {direction: [1, 0, 0], sheet: [0, 1, 1]}/' \
    's/fibres: .*/fibres: {circumferential: x, through: [0 mm, 5.3 mm, 4.6 mm]}/' \
    's/fibres: .*/fibres: {circumferential: x, through: [0 mm, 5.3 mm, 4.6 mm], angle: 9 deg}/' \
    's/fibres: .*/fibres: {file: f.csv}/' 's/fibres: .*/fibres: {file: f2.csv}/' \
    's/-1 m.s2/-2 m\/s2/' 's/left, fix: xyz/left, fix: xy/; s/fix: xy}/&, {on: bottom, fix: z}/' \
    's/100 Pa/101 Pa/' 's/ramp: 1 s/ramp: 0.9 s/' 's/traction: .* Pa., time/pressure: 10 Pa, time/' \
    's/sphere: 4 mm/sphere: 4.05 mm/' 's/10 mm, 5 mm, 14.1/9 mm, 5 mm, 14.1/' 's/friction: 0.1/friction: 0.2/' \
    's/-0.2 mm/-0.3 mm/' 's/path: /turn: [[0 s, 0 deg, 0 deg, 0 deg], [1 s, 0 deg, 9 deg, 0 deg]], &/' \
    's/sphere: 4 mm/capsule: {radius: 4 mm, axis: [0 mm, 1 mm, 0 mm]}/' \
    's/sphere: 4 mm/capsule: {radius: 4 mm, axis: [0 mm, 2 mm, 0 mm]}/' \
    's/sphere: 4 mm/mesh: {file: jaw.stl, unit: mm}/' 's/sphere: 4 mm/mesh: {file: jaw2.stl, unit: mm}/' \
    's/name: jaw/name: claw/' 's/name: tip/name: end/' 's/name: hold/name: pull/' \
    's/point: .20 mm/point: [19 mm/' 's/reaction: left/reaction: bottom/' \
    's/until: 1 s/until: 2 s/' 's/output_every: 1 s/output_every: 0.5 s/' \
    's/integrator: quasi-static/integrator: explicit/' 's/integrator: quasi-static/integrator: implicit/' \
    's/integrator: quasi-static/integrator: implicit, scheme: backward-euler/' 's/step: 1 s}/step: 0.5 s}/' \
    's/step: 1 s/&, precision: double/' 's/step: 1 s/&, damping: 1 1\/s/' \
    's/step: 1 s/&, damping: {stiffness: 1 ms}/' 's/step: 1 s/&, memory_tolerance: 0.01/' \
    's/step: 1 s/&, model: central, constants: s.csv/' 's/step: 1 s/&, model: central, constants: s2.csv/' \
    's/steps: 1/steps: 2/' 's/steps: 1/step: 0.6 s/' 's/steps: 1/step: 0.7 s/' 's/steps: 1/&, tolerance: 1e-7/' \
    's/steps: 1/&, memory_tolerance: 0.01/' 's/steps: 1/&, solver: iterative/'; do
    changed a.yaml "$change"
done
changed m.yaml 's/steps: 1/&, analysis: linear/'
# one cell of two patterns is the same mesh; the finer one that measures its error is not
changed a.yaml 's/cells: .2, 2, 2./cells: [1, 1, 1]/'
changed a.yaml 's/cells: .2, 2, 2./cells: [1, 1, 1], pattern: kuhn/'
changed d.yaml 's/tolerance: 0.1/tolerance: 0.2/'
changed d.yaml 's/tolerance: 0.1/&, rho_infinity: 0.5/'
kept() { ls all/kept | wc -l; }
cases=$((count + 4))
"$SINEW" compare a.yaml d.yaml m.yaml m2.yaml $(seq -f 'v%g.yaml' $count) --models P1 --out all --quiet
[ "$(kept)" = $((2 * cases)) ] || die "$(kept) files for $cases cases, expected two each"

# what no number depends on is taken from what is kept
sed 's/case: one/case: another/; s/step: 1 s/&, threads: 2/' a.yaml >same.yaml
"$SINEW" compare same.yaml --models P1 --out all --quiet
[ "$(kept)" = $((2 * cases)) ] || die "name and threads were run anew"
# another model is held against the reference that is there; with a finer mesh the reference is one
# on that mesh, and what is held against it is run anew
"$SINEW" compare a.yaml --models coupled --out all --quiet
[ "$(kept)" = $((2 * cases + 1)) ] || die "one model more, one file more"
"$SINEW" compare a.yaml --models P1 --meshes 1,2 --out all --quiet
[ "$(kept)" = $((2 * cases + 4)) ] || die "two meshes and their reference were not run"
# what no engine of the reference can do is refused still
sed 's/name: jaw/&, grasp: [0.1 s, 0.5 s]/' a.yaml >grasp.yaml
fails 1 'grasp' "$SINEW" compare grasp.yaml --models P1 --out all
sed '$acuts: [{at: 0.5 s, cells: [1]}]' a.yaml >cut.yaml
fails 1 'cut' "$SINEW" compare cut.yaml --models P1 --out all
