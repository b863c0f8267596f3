#!/bin/sh
# Everything `make check` holds the tree to.
set -eu
cd "$(dirname "$0")/.."
step() { printf '\n== %s\n' "$1"; }

step "formatting (clang-format 14)"
scripts/check-format.sh
step "include table"
scripts/check-includes.sh
for preset in check asan; do
    step "build, preset $preset"
    cmake --preset $preset >/dev/null
    cmake --build --preset $preset
    step "tests, preset $preset"
    ctest --preset $preset -j 2
done
