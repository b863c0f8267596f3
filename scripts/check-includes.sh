#!/bin/sh
# Holds every #include of src/ and include/ against the table of docs/design/house.md: includes go
# down, rooms on one step are blind to each other, and compare, io and cli see only the public
# headers (sinew/NAME.h) of other folders.
set -eu
cd "$(dirname "$0")/.."
find src include -name '*.[ch]' | sort | xargs awk '
BEGIN {
    # what a folder may include, itself apart
    may["base"] = ""
    may["law"] = "base"
    may["relax"] = "base"
    may["tissue"] = "base law relax"
    may["lab"] = "base law relax tissue"
    may["model"] = "base law relax tissue"
    may["springs"] = may["continuum"] = "base law relax tissue model"
    may["compare"] = "base law relax tissue model springs continuum"
    may["io"] = "base law relax tissue lab model springs continuum compare"
    may["cli"] = "base law relax tissue lab model springs continuum compare io"
    may["sinew"] = may["cli"]
    public_only["compare"] = public_only["io"] = public_only["cli"] = 1
    any["sinew"] = 1
}
function complain(text) {
    printf "%s:%d: %s\n", FILENAME, FNR, text
    bad = 1
}
/^[ \t]*#[ \t]*include[ \t]*"/ {
    split(FILENAME, path, "/")
    folder = path[2]
    if (path[1] == "include") { folder = path[3]; sub(/\.h$/, "", folder) }
    if (!(folder in may)) { complain("folder \"" folder "\" is not in the table"); next }
    split($0, quoted, "\"")
    count = split(quoted[2], part, "/")
    if (count < 2) { complain("write the folder: \"" folder "/" quoted[2] "\""); next }
    is_public = part[1] == "sinew"
    target = part[1]
    if (is_public) { target = part[2]; sub(/\.h$/, "", target) }
    if (target == folder || (is_public && target == "sinew" && folder == "cli")) next
    if (index(" " may[folder] " ", " " target " ") == 0)
        complain(folder " may not include " quoted[2])
    else if (!is_public && (path[1] == "include" || folder in public_only))
        complain(folder " sees only public headers, not " quoted[2])
}
END { exit bad }'
