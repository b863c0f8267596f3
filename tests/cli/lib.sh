# What the tests of the command share. SINEW is the command, SOURCE the project's folder; each test
# runs in an empty folder of its own.
set -eu

fails() { # fails CODE "fragment" command…: the exit code, one line on standard error, a fragment of it
    wanted=$1
    fragment=$2
    shift 2
    code=0
    "$@" >stdout 2>stderr || code=$?
    [ "$code" = "$wanted" ] || die "exit $code, expected $wanted: $*: $(cat stderr)"
    [ "$(wc -l <stderr)" = 1 ] || die "expected one line on standard error: $*: $(cat stderr)"
    grep -qF -- "$fragment" stderr || die "expected \"$fragment\" in: $(cat stderr)"
}

die() {
    echo "FAILED: $*" >&2
    exit 1
}

# number KEY: the first number of that name in the JSON on standard input
number() { sed -n 's/^ *"'"$1"'": \(-\{0,1\}[0-9.eE+-]*\),\{0,1\}$/\1/p' | head -n 1; }

# holds "expression": arithmetic truth, in awk
holds() { awk "BEGIN { exit !($1) }" || die "does not hold: $1"; }
