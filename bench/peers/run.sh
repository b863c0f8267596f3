#!/bin/sh
# The cube of `sinew bench continuum` in other programs: run.sh SINEW [CELLS an edge, default 14].
# Runs CalculiX (ccx) and dolfinx where they are installed (Debian: calculix-ccx, python3-dolfinx),
# one thread each, and prints seconds of the processor and their ratio to ours.
set -eu
sinew=$(realpath "$1")
cells=${2:-14}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 CCX_NPROC_EQUATION_SOLVER=1
cd "$work"
awk -v n="$cells" -f "$here/block.awk"

# seconds NAME COMMAND…: of the processor; nothing where it failed
seconds() {
    name=$1
    shift
    ("$@" >"$name.log" 2>&1 && times) | awk 'END {
        if (split($0, part, "[ms ]+") < 4) exit
        print 60 * (part[1] + part[3]) + part[2] + part[4] }'
}

line() { # line NAME SECONDS
    awk -v name="$1" -v s="$2" -v ours="$ours" 'BEGIN {
        if (s == "") printf "%-28s failed\n", name
        else printf "%-28s %9.2f s %7.1f times ours\n", name, s, s / ours }'
}

ours=$(seconds sinew "$sinew" run block.yaml --engine continuum --out out --quiet)
[ -n "$ours" ] || { tail -n 2 sinew.log; exit 1; }
printf 'cube of %d^3 cells, 30 %% in 10 steps\n' "$cells"
line "sinew, P1" "$ours"
if command -v ccx >/dev/null; then
    line "CalculiX, C3D4" "$(seconds ccx ccx block)"
    grep -q '\*ERROR' ccx.log && echo "  (CalculiX reports an error: it did not finish the load)"
else
    echo "CalculiX is not installed (calculix-ccx)"
fi
if /usr/bin/python3 -c 'import dolfinx' 2>/dev/null; then
    line "dolfinx, P1, MUMPS" "$(seconds dolfinx /usr/bin/python3 "$here/block.py" "$cells")"
else
    echo "dolfinx is not installed (python3-dolfinx)"
fi
