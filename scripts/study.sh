#!/bin/sh
# The study of docs/theory/study.md, whose tables and figures it rewrites: study.sh SINEW [FOLDER]. Goes on where it
# was interrupted; delete the folder to begin anew. Cases come from examples/study: every line of study.txt without
# and with memory.
set -eu
cd "$(dirname "$0")/.."
sinew=$(realpath "$1")
folder=${2:-build/study}
cases=$folder/cases
mkdir -p "$cases"
cp examples/study/*.yaml examples/study/*.msh "$cases"
rm -f "$cases"/*-[0-9]*-*.yaml
# variant NAME TEXT FILE TISSUE FACTOR WAY: a case of another tissue, and load or motion
variant() {
    sed -e "s/^case: .*/case: $2/" -e "s/linear\(-memory\)\{0,1\}.yaml/$4.yaml/" -e "s/\[1 s, 1\]/[1 s, $5]/" \
        -e "/displacement/s/1 mm/$6 mm/" "examples/study/$3.yaml" >"$cases/$1.yaml"
}
elastic='' memory='' gmsh=''
while read -r file strain tissue factor way; do
    case $file in '' | '#'*) continue ;; esac
    load=${file%-deep}
    name=$load-$strain-$tissue
    text="$load to $strain % of a tissue of law $tissue"
    variant "$name" "$text" "$file" "$tissue" "$factor" -
    elastic="$elastic $cases/$name.yaml"
    if [ "$way" = none ]; then
        : # without memory only
    elif [ -e "examples/study/$file-held.yaml" ]; then
        variant "$name-memory" "$text with memory" "$file-held" "$tissue-memory" 1 "$way"
        # stress that bends over a step of a quarter of a second makes 1 % at large strain
        [ "$strain" -le 5 ] || sed -i 's/step: 0.25 s/step: 0.125 s/' "$cases/$name-memory.yaml"
    else # the load stays, and the tissue creeps for two seconds
        variant "$name-memory" "$text with memory" "$file" "$tissue-memory" "$factor" -
        sed -i -e 's/until: 1 s/until: 3 s/' -e 's/steps: 4/steps: 12/' -e 's/\[2, 20, 3\]/[1, 10, 2]/' \
            "$cases/$name-memory.yaml"
    fi
    [ "$way" = none ] || memory="$memory $cases/$name-memory.yaml"
    # the same block as gmsh cuts it
    case $name in
    inflation* | indentation* | *-30-* | *-fung) ;;
    *)
        # in two steps: its references are the dearest of all
        sed -e 's/^mesh: .*/mesh: {file: block.msh, unit: mm}/' -e 's/0.25 s/0.5 s/g' -e 's/steps: 4/steps: 2/' \
            "$cases/$name.yaml" >"$cases/$name-gmsh.yaml"
        gmsh="$gmsh $cases/$name-gmsh.yaml"
        ;;
    esac
done <examples/study/study.txt
# the figures of a page as files of their own: FOLDER/NAME-1.svg …
figures() { # figures PAGE FOLDER/NAME
    awk -v name="$2" '
        /<svg role="img"/ { file = name "-" ++n ".svg"; keep = 1; sub(/.*<svg role/, "<svg role") }
        keep { print >file }
        keep && /<\/svg>/ { keep = 0; close(file) }' "$1"
}
# puts a table between the lines "<!-- NAME -->" and "<!-- end -->" of the page
page=docs/theory/study.md
insert() { # insert NAME
    awk -v name="$1" -v table="$folder/$1.txt" '
        $0 == "<!-- end -->" { skip = 0 }
        !skip
        $0 == "<!-- " name " -->" {
            print "```"
            while ((getline line <table) > 0) if (line !~ /results in/) { sub(/ +$/, "", line); print line }
            print "```"
            skip = 1
        }' "$page" >"$folder/page.md"
    cp "$folder/page.md" "$page"
}
models= # all, unless they are named
run() { # run NAME MESHES REFERENCE CASES…: on both cores
    name=$1 meshes=$2 reference=$3
    shift 3
    # shellcheck disable=SC2086 # a list of words
    "$sinew" compare "$@" --meshes "$meshes" --reference "$reference" $models --jobs 2 --out "$folder/$name" \
        >"$folder/$name.txt"
    figures "$folder/$name/report.html" "$folder/$name"
    insert "$name"
    echo "$folder/$name.txt, $folder/$name/report.html"
}
# shellcheck disable=SC2086 # the names hold no blanks
run elastic 1,2,3 2 $elastic
# shellcheck disable=SC2086
run gmsh 1,2 2 $gmsh
# constants of published rules remember as all others do
models='--models central+volume,coupled+volume,smoothed+volume,P1,calibrated+volume'
# shellcheck disable=SC2086
run memory 1,2,4 4 $memory
cp "$folder/elastic-1.svg" docs/theory/figures/study-cost.svg
cp "$folder/elastic-2.svg" docs/theory/figures/study-mesh.svg
