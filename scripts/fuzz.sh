#!/bin/sh
# Fuzzes every reader: fuzz.sh [SECONDS each, default 100]. Needs clang with libFuzzer
# (scripts/install-packages.sh fuzz). What breaks a reader is left in build/fuzz/found; minimise it, put it into
# tests/fuzz/corpus and mend the reader: from then on ctest replays it.
set -eu
seconds=${1:-100}
cd "$(dirname "$0")/.."
cmake --preset fuzz >build/fuzz-configure.log || { cat build/fuzz-configure.log; exit 1; }
cmake --build --preset fuzz
found=$PWD/build/fuzz/found
mkdir -p "$found"
bad=0
for corpus in tests/fuzz/corpus/*; do
    name=$(basename "$corpus")
    mkdir -p build/fuzz/corpus/$name
    printf '== %s, %s s\n' "$name" "$seconds"
    dictionary=tests/fuzz/$name.dict
    # inputs of interest gather in build/; the corpus of the repository is read only
    UBSAN_OPTIONS=print_stacktrace=1 LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0 \
        nice build/fuzz/tests/fuzz_$name build/fuzz/corpus/$name "$corpus" -max_total_time="$seconds" \
        -max_len=4096 -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 -verbosity=0 \
        $([ -f $dictionary ] && echo -dict=$dictionary) -artifact_prefix="$found/$name-" \
        >build/fuzz/$name.log 2>&1 || { bad=1; tail -n 40 build/fuzz/$name.log; }
    grep -E 'number_of_executed_units|average_exec_per_sec|peak_rss_mb' build/fuzz/$name.log || true
done
[ $bad = 0 ] && echo "clean"
exit $bad
