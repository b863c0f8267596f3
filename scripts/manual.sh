#!/bin/sh
# Writes the printed tables of the manual: manual.sh SINEW [--check]. A page holds them between
#   <!-- printed by: sinew list options --> and <!-- end -->
# With --check nothing is written; what differs is shown and the exit code is 1.
set -eu
sinew=$(realpath "$1")
check=${2:-}
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0
for page in docs/guide/*.md; do
    grep -q '^<!-- printed by: sinew list ' "$page" || continue
    inside=""
    while IFS= read -r line || [ -n "$line" ]; do
        case "$line" in
        "<!-- end -->") inside="" ;;
        esac
        [ -n "$inside" ] || printf '%s\n' "$line"
        case "$line" in
        "<!-- printed by: sinew list "*)
            topic=${line#"<!-- printed by: sinew list "}
            printf '\n'
            "$sinew" list "${topic% -->}"
            printf '\n'
            inside=yes
            ;;
        esac
    done <"$page" >"$work/page"
    if [ "$check" = --check ]; then
        diff "$page" "$work/page" || bad=1
    else
        cmp -s "$page" "$work/page" || cp "$work/page" "$page"
    fi
done
[ $bad = 0 ] || echo "the manual's tables are not what the command prints: make manual" >&2
exit $bad
