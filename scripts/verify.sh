#!/bin/sh
# Long verification: verify.sh SINEW. Prints a table; exits 1 if a line does not hold.
set -eu
sinew=$(realpath "$1")
cd "$(dirname "$0")/.."
out=build/verify
rm -rf $out
mkdir -p $out
bad=0
line() { # line "what" VALUE LIMIT
    if awk "BEGIN { exit !($2 <= $3) }"; then word=ok; else word=SHORT bad=1; fi
    printf '%-6s %-66s %-10s limit %s\n' $word "$1" "$2" "$3"
}
# field FILE MODEL KEY: a number of one model in compare.json
field() {
    awk -v model="\"$2\"" -v key="\"$3\":" '
        $1 == "\"name\":" { found = index($0, model) }
        found && $1 == key { sub(",", "", $2); print $2; exit }' "$1"
}

# the strip at every measured speed: coupled springs follow the mixed elements
for ramp in 0.1 1 10 100; do
    "$sinew" compare examples/muscle/strip-${ramp}s.yaml --out $out/strip-$ramp --quiet
    for model in coupled smoothed; do
        line "strip, ramp of $ramp s: $model+volume, force over the reference's" \
            "$(field $out/strip-$ramp/compare.json $model+volume reaction_rms)" 0.01
    done
done

# the indentation: linear elements and coupled springs differ from the reference mostly by the mesh
"$sinew" compare examples/muscle/indentation.yaml --out $out/indentation --quiet
for model in coupled smoothed; do
    line "indentation: $model+volume, displacement" \
        "$(field $out/indentation/compare.json $model+volume displacement_rms)" 0.05
done
line "indentation: the reference's own error, displacement" \
    "$(field $out/indentation/compare.json 'P2P1 reference' displacement_rms)" 0.01

# the same bits on every instruction set
differing=0
for isa in scalar sse2 avx2 avx512; do
    SINEW_ISA=$isa "$sinew" run examples/muscle/strip-0.1s.yaml --engine springs --out $out/$isa --quiet
    cmp -s $out/scalar/history.csv $out/$isa/history.csv || differing=$((differing + 1))
done
line "instruction sets whose history differs from scalar's in any bit" $differing 0

# published benchmarks of the finite elements
scripts/verify-benchmarks.sh "$sinew" $out/benchmarks || bad=1

# the finite elements against closed forms, with the error that they state themselves
scripts/verify-closed.sh "$sinew" $out/closed || bad=1

# hard cases from default settings
scripts/verify-robust.sh "$sinew" $out/robust || bad=1

# the parallel solver's iterations stay bounded
scripts/verify-multigrid.sh "$sinew" $out/multigrid || bad=1

# 95 % intervals of fits of random tissues hold the truth as often as they say
cmake --preset check >/dev/null
cmake --build --preset check --target verification_coverage >/dev/null
build/check/tests/verification_coverage 200 2 || bad=1
exit $bad
