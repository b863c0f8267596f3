#!/bin/sh
# Published benchmarks of the continuum: verify-benchmarks.sh SINEW OUT. Prints what was published,
# ours on three meshes and what they extrapolate to; exits 1 where that is more than 0.5 % (the
# spread of the codes of Land et al. at their finest) outside of what was published.
set -eu
sinew=$(realpath "$1")
mkdir -p "$2"
out=$(realpath "$2")
cd "$(dirname "$0")/../examples/benchmarks"
cp ./*.yaml "$out"
bad=0
printf '%-6s %-42s %-20s %10s %10s %10s %13s\n' "" "mm" published coarse medium fine extrapolated

# last CASE COLUMN: runs a case and prints the last value of a column of its history
last() {
    "$sinew" run "$out/$1.yaml" --engine continuum --out "$out/$1" --quiet
    awk -F, -v name="$2 [m]" '
        NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) at = k }
        END { printf "%.9g", $at }' "$out/$1/history.csv"
}

# line WHAT LOW HIGH A B C: three values in mm on meshes that are halved twice. What is left of a
# geometric series is added to the last; where they do not form one, nothing is.
line() {
    awk -v what="$1" -v low="$2" -v high="$3" -v a="$4" -v b="$5" -v c="$6" 'BEGIN {
        ratio = b == a ? 0 : (c - b) / (b - a)
        limit = ratio > 0 && ratio < 0.7 ? c + (c - b) * ratio / (1 - ratio) : c
        converging = (c - b) ^ 2 < (b - a) ^ 2
        spread = 0.005 * (limit < 0 ? -limit : limit)
        ok = converging && limit >= low - spread && limit <= high + spread
        printf "%-6s %-42s %8.6g .. %-8.6g %10.4f %10.4f %10.4f %13.4f\n",
               ok ? "ok" : "SHORT", what, low, high, a, b, c, limit
        exit !ok }' || bad=1
}

# cook CASE COLUMN FACTOR WHAT LOW HIGH
cook() {
    set -- "$@" $(for n in 8 16 32; do
        awk -v n=$n -f cook.awk >"$out/cook.msh"
        last "$1" "$2" | awk -v by="$3" '{ print 1e3 * by * $1 }'
    done)
    line "$4" "$5" "$6" "$7" "$8" "$9"
}

# land CASE COLUMN REST WHAT LOW HIGH CELLS CELLS CELLS: a deformed z
land() {
    name=$1 column=$2 rest=$3 what=$4 low=$5 high=$6
    shift 6
    values=$(for cells in "$@"; do
        sed "s/cells: \[.*\]}}/cells: [$cells]}}/" $name.yaml >"$out/$name.yaml"
        last $name $column | awk -v rest="$rest" '{ print rest + 1e3 * $1 }'
    done)
    # shellcheck disable=SC2086
    line "$what" "$low" "$high" $values
}

cook cook-plane-stress middle_uy 1e5 "Cook, plane stress, middle" 23.96 23.97
cook cook-linear corner_uy 1e5 "Cook, plane strain, nu = 1/3, corner" 32.20 32.28
cook cook-incompressible middle_uy 1e5 "Cook, nearly incompressible, middle" 16.432584 16.432584
cook cook-neo-hookean corner_uy 1 "Cook, neo-Hookean, corner" 6.9083 6.9083
land land-1 end_uz 1 "Land 1, beam, z of the end" 4.0 4.2 "10, 1, 1" "20, 2, 2" "40, 4, 4"
land land-2 middle_uz -18.5 "Land 2, ellipsoid, z of the apex, mid-wall" -27.324 -27.045 \
    "1, 8, 6" "2, 16, 12" "4, 32, 24"
exit $bad
