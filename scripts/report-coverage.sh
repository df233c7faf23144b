#!/bin/sh
# Lines covered, file by file: report-coverage.sh BUILD, after the tests of a coverage build.
set -eu
cd "$1"
find . -path '*gonio-objects.dir*' -name '*.gcda' | sort | while read -r data; do
    gcov -n "$data" 2>/dev/null | grep -A1 "^File '.*/src/.*\.c'" | grep -v '^--'
done | paste - - | sed "s/File '.*\/src\///; s/'//; s/Lines executed://" | sort
