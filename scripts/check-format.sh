#!/bin/sh
# clang-format 14 over everything in C; prints what differs.
set -eu
cd "$(dirname "$0")/.."
formatter=$(command -v clang-format-14 || command -v clang-format)
find src include tests examples -name '*.[ch]' | sort |
    xargs "$formatter" --dry-run --Werror --style=file
