#!/bin/sh
# Installs the Debian packages that are missing for "demo", "check" or "fuzz" (which include demo),
# and says which and why. Uses apt-get as root or through sudo.
set -eu
cd "$(dirname "$0")"
what=${1:-demo}
missing=""
while read -r package for why; do
    case "$package" in \#* | "") continue ;; esac
    [ "$for" = demo ] || [ "$for" = "$what" ] || continue
    if ! dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q "ok installed"; then
        [ -n "$missing" ] || echo "Installing with apt-get:"
        printf '  %-22s %s\n' "$package" "$why"
        missing="$missing $package"
    fi
done <packages.txt
[ -n "$missing" ] || exit 0
if [ "$(id -u)" = 0 ]; then
    as_root=""
elif command -v sudo >/dev/null; then
    as_root="sudo"
else
    echo "These packages need root: run as root, or install sudo, or run" >&2
    echo "  apt-get install --no-install-recommends$missing" >&2
    exit 1
fi
export DEBIAN_FRONTEND=noninteractive
log=$(mktemp)
# a fresh machine has no package lists yet
if ! $as_root apt-get update >"$log" 2>&1 ||
    ! $as_root apt-get install -y --no-install-recommends $missing >>"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "apt-get failed; its whole output is in $log" >&2
    exit 1
fi
rm -f "$log"
