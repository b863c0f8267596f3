#!/bin/sh
# Multigrid under refinement: verify-multigrid.sh SINEW OUT [NODES]. Prints the cycles that solve one
# system of a stretched block to 1e-8 on three meshes of each element; exits 1 where the finest needs
# more than 1.5 times those of the coarsest, or where a system was left to the direct solver.
set -eu
sinew=$(realpath "$1")
mkdir -p "$2"
bad=0
printf '%-6s %-10s %10s %10s %10s\n' "" "cycles" "3k nodes" "12k nodes" "51k nodes"
for element in P1 P2 P2P1; do
    "$sinew" bench continuum --solver iterative --element $element --nodes "${3:-51000}" --json \
        >"$2/multigrid-$element.json"
    tr -d ' ,' <"$2/multigrid-$element.json" | awk -F: -v element=$element '
        $1 == "\"cycles\"" { cycles[++n] = $2 }
        $1 == "\"rescues\"" { rescues += $2 }
        END {
            ok = n >= 2 && cycles[n] <= 1.5 * cycles[1] && rescues == 0
            printf "%-6s %-10s", ok ? "ok" : "SHORT", element
            for (k = 1; k <= n; k++) printf " %10d", cycles[k]
            printf "\n"
            exit !ok }' || bad=1
done
exit $bad
