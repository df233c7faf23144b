#!/bin/bash
# Any text that began with a comment was taken for an OBJ mesh without faces: a plan, for one.
. "$(dirname "$0")/../cli/lib.sh"

if ! gonio render atlas:oak-sawn --size 8 --samples 1 -o probe.png >"$root/work/stdout" 2>&1; then
    printf 'SKIPPED: built without the renderer\n'
    exit 0
fi
expect_ok learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o b.gonio
expect_ok plan b.gonio -n 4 -o p.csv
expect_fail 1 'p.csv: readings (CSV), not a mesh' render atlas:oak-sawn -m p.csv -o x.png
printf '# v 0 0 0\njust some text\n' >words.obj
expect_fail 1 'words.obj: not a mesh that gonio reads (OBJ, PLY), judged by its content' \
    render atlas:oak-sawn -m words.obj -o x.png
printf '# a triangle\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n' >triangle
expect_output 'triangle: mesh, OBJ' info triangle
expect_ok render atlas:oak-sawn -m triangle --size 8 --samples 1 -o x.png

finish
