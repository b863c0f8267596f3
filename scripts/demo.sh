#!/bin/sh
# The main job on real measurements: demo.sh SINEW OUT. Prints what it does and where the reports are.
set -eu
sinew=$(realpath "$1")
out=$2
cd "$(dirname "$0")/.."
mkdir -p "$out/cases"
data=data/cardiac-muscle
ramps="$data/ramp-0.1s.csv $data/ramp-1s.csv $data/ramp-10s.csv $data/ramp-100s.csv"
step() { printf '\n== %s\n' "$*"; }

step "1. What was measured: relaxation after a ramp of 0.1 s"
"$sinew" analyze $data/ramp-0.1s.csv --test relaxation --out "$out/analyze"

step "2. One exponential law x one continuous spectrum for all four speeds; each predicted from the others"
"$sinew" fit $ramps --elastic exponential --memory fung-spectrum --hold-out \
    --name "passive cardiac muscle, one dimension" --out "$out/fit"

step "3. The same data as a three-dimensional tissue, which springs and continuum carry below"
"$sinew" fit $ramps --elastic demiray --memory fung-spectrum --hold-out \
    --name "passive cardiac muscle" --density "1060 kg/m3" --bulk-ratio 1000 --out "$out/muscle"

step "4. That tissue in the virtual testing machine: the four ramps replayed, and a test nobody made"
for ramp in 0.1 1 10 100; do
    "$sinew" test "$out/muscle/tissue.yaml" --replay $data/ramp-${ramp}s.csv --out "$out/replay-${ramp}s.csv"
done
"$sinew" test "$out/muscle/tissue.yaml" --protocol cyclic --stretch 1.2 --ramp "0.5 s" --cycles 5 \
    --out "$out/cyclic.csv"
"$sinew" analyze "$out/cyclic.csv" --test cyclic --out "$out/cyclic"

# the cases of examples/muscle with the tissue fitted just now
cp examples/muscle/*.yaml "$out/cases"
cp "$out/muscle/tissue.yaml" "$out/cases/muscle.yaml"

step "5. A strip of it, through both engines"
"$sinew" run "$out/cases/strip-1s.yaml" --engine springs --out "$out/strip-springs"
"$sinew" run "$out/cases/strip-1s.yaml" --engine continuum --out "$out/strip-continuum"

step "6. What the springs cost in accuracy"
for ramp in 0.1 1 10 100; do
    "$sinew" compare "$out/cases/strip-${ramp}s.yaml" --out "$out/compare-strip-${ramp}s"
done
"$sinew" compare "$out/cases/indentation.yaml" --out "$out/compare-indentation"

step "Reports"
for page in analyze fit muscle cyclic strip-springs strip-continuum compare-strip-0.1s \
    compare-strip-1s compare-strip-10s compare-strip-100s compare-indentation; do
    echo "  $(realpath "$out")/$page/report.html"
done
