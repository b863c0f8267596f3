# The manual quotes the law it explains: the quotation must be the file.
. "$SOURCE/tests/cli/lib.sh"

page=$SOURCE/docs/guide/adding-a-law.md
awk '/^```/ { n++; next } n == 1' "$page" >quoted.c
diff quoted.c "$SOURCE/src/law/laws/mooney_rivlin.c" || die "adding-a-law.md quotes another file"
grep -q 'X(mooney_rivlin)' "$SOURCE/src/law/registry.c" || die "the registry line is another one"

# every relative link of the manual leads somewhere
for page in "$SOURCE"/README.md "$SOURCE"/docs/*.md "$SOURCE"/docs/*/*.md; do
    grep -oE '\]\([^)#: ]+\)' "$page" | tr -d '()]' | while read -r link; do
        [ -e "$(dirname "$page")/$link" ] || die "$page: no $link"
    done
done
