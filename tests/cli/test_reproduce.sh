#!/bin/bash
# gonio reproduce: what it leaves, that a stopped run or a group of processes leaves the same, and
# input that it cannot use.
. "$(dirname "$0")/lib.sh"

materials='atlas:gold-polished atlas:oak-sawn atlas:red-cotton atlas:plaster-cast atlas:white-linen'

# ---- what it leaves ----

# shellcheck disable=SC2086
expect_output 'out: see report.md' reproduce $materials --quick -o out
for section in 'Fig. 2(a)' 'Fig. 2(b)' 'Fig. 3(a)' 'Fig. 3(b)' 'Fig. 4' 'Fig. 5' 'Fig. 6' 'Fig. 7'; do
    expect_true "report.md has a section $section" grep -q "^## $section" out/report.md
done
for name in fig2a fig2b fig3a fig3a-curves fig3b fig4 fig5; do
    expect_true "figure $name has its data and script" test -s out/figures/$name.csv -a -s out/figures/$name.gp
    if command -v gnuplot >/dev/null; then
        expect_true "figure $name is drawn" test -s out/figures/$name.png
    fi
done
for name in fig6 fig7; do
    expect_true "figure $name is rendered" test -s out/figures/$name.png
done
for name in splits bivariate fig2a fig2b fig3a fig3a-means fig3b fig4 fig5 fig6 fig7; do
    expect_true "table $name" test "$(wc -l <out/tables/$name.csv)" -gt 4
done
expect_true 'all three errors are in the tables' \
    grep -q '^material,reconstructed_from.*e6_percent,cube_root_percent,log_relative$' out/tables/fig5.csv
expect_true 'results.json holds the claims' grep -q '"verdict": "agrees"' out/results.json
expect_true 'what these few materials cannot show is said' grep -q 'not tested' out/report.md

# ---- the same bytes, however it was run ----

# same WHAT FOLDER: the folder holds what the first run left.
same() {
    checks=$((checks + 1))
    diff -r out "$2" >"$root/work/diff" 2>&1 || failed "$1 leaves other files" "$(head -5 "$root/work/diff")"
}

cp -r out again
rm again/pieces/fig3b-random* again/report.md again/figures/fig3a.*
if full; then
    rm again/pieces/fig3b* again/pieces/fig5-w* again/pieces/fig7*
fi
# shellcheck disable=SC2086
expect_output 'again: see' reproduce $materials --quick -o again
expect_true 'going on is told' grep -q 'note: reproducing: resuming' "$root/work/stderr"
same 'going on' again

# One experiment after the other.
few='--quick --only fig2a,fig3b'
# shellcheck disable=SC2086
expect_ok reproduce $materials $few -o few
expect_true 'only what was asked for' test ! -e few/figures/fig5.csv -a -e few/figures/fig3b.csv
if full; then
    cp -r few rest
    cp out/pieces/*.json rest/pieces
    # shellcheck disable=SC2086
    expect_ok reproduce $materials --quick -o rest
    same 'doing the rest later' rest
fi

# same_few WHAT FOLDER: the same for those.
same_few() {
    checks=$((checks + 1))
    diff -r few "$2" >"$root/work/diff" 2>&1 || failed "$1 leaves other files" "$(head -5 "$root/work/diff")"
}

if full; then
    # shellcheck disable=SC2086
    expect_ok reproduce $materials $few --threads 1 -o one
    same_few 'one thread' one
fi

# shellcheck disable=SC2086
"$GONIO" reproduce $materials $few --threads 1 -o stopped 2>"$root/work/stopped" &
for _ in $(seq 300); do
    [ -n "$(find stopped/pieces -name '*.json' 2>/dev/null)" ] && break
    sleep 0.02
done
kill -9 $! 2>/dev/null
wait $! 2>/dev/null
# shellcheck disable=SC2086
expect_ok reproduce $materials $few -o stopped
same_few 'a run that was killed' stopped

# Containers build as root, and have fewer processors than the test has processes. MPI itself leaks.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 ASAN_OPTIONS=detect_leaks=0
if command -v mpirun >/dev/null && mpirun -n 1 "$GONIO" reproduce atlas:oak-sawn -o none 2>&1 | grep -q 'too few'; then
    for size in $(full && echo 1 2 3 || echo 2); do
        checks=$((checks + 1))
        # shellcheck disable=SC2086
        timeout 300 mpirun --oversubscribe -n $size "$GONIO" reproduce $materials $few --threads 1 \
            -o group-$size >"$root/work/stdout" 2>&1 ||
            failed "mpirun -n $size" "$(cat "$root/work/stdout")"
        expect_true "one of $size processes speaks" test "$(grep -c 'see report.md' "$root/work/stdout")" -eq 1
        same_few "a group of $size" group-$size
    done
else
    skip 'groups: no mpirun, or built without MPI'
fi

# ---- pieces that somebody has written, with right checksums ----

# forged PIECE FROM TO COMPLAINT: the run does not believe the piece, and says which.
forged() {
    rm -rf forged
    cp -r out forged
    "$FORGE_PIECE" "forged/pieces/$1.json" "$2" "$3" || failed "forging $1"
    # shellcheck disable=SC2086
    expect_fail 1 "forged/pieces/$1.json: $4" \
        reproduce $materials --quick --only "${1%%-*}" -o forged
}
channel=$(sed 's/.*"entries":\[\(\[[0-9]*,[0-2],\).*/\1/' out/pieces/fig4-samples-80.json)
rendering=$(cd out/pieces && echo fig6-*)
forged fig4-samples-80 "$channel" "${channel%?,}100000000," "'entries' is not a list of [cell, channel 0 to 2, "
forged fig5-white-linen '"errors":[[' '"errors":[null,[' "'errors' is not a list of errors"
if full; then
    forged fig4-samples-80 "$channel" "${channel}null,0,0,0],[0,0," "'entries' is not a list of ["
    forged fig2a '"splits":[' '"splits":[[1.0],' "'splits' is not a list of variances for each split"
    forged "${rendering%%.json*}" '"image":"0' '"image":"x' "'image' is not an image"
fi

# ---- input that it cannot use ----

# shellcheck disable=SC2086
{
    expect_fail 1 'out holds another run: identity.seed is 0 there and 7 here' \
        reproduce $materials --quick --only fig2a --seed 7 -o out
    expect_fail 1 'out holds another run: identity.' reproduce $materials --only fig2a -o out
    expect_fail 2 "no experiment is called 'fig9'" reproduce $materials --only fig5,fig9 -o no
    expect_fail 2 "--seed: -1 is too small" reproduce $materials --seed -1 -o no
    expect_fail 2 'no output: give -o FOLDER' reproduce $materials
}
# Pieces of another build are not mixed with this one's.
cp -r out older
sed -i 's/"build": "[0-9a-f]*"/"build": "0123456789abcdef"/' older/run.json
# shellcheck disable=SC2086
expect_fail 1 'older holds another run: identity.build is "0123456789abcdef" there and ' \
    reproduce $materials --quick -o older
mkdir full
: >full/something
# shellcheck disable=SC2086
expect_fail 2 "holds 'something' but no run of gonio" reproduce $materials --quick -o full
expect_fail 2 '3 materials are too few' reproduce atlas:oak-sawn atlas:red-cotton atlas:jade-carved -o no
expect_fail 1 'nowhere' reproduce nowhere -o no

mkdir db twins
expect_ok convert atlas:oak-sawn db/oak.binary
for name in red-cotton jade-carved plaster-cast; do
    expect_ok convert atlas:$name db/$name.binary
done
head -c 1000 db/oak.binary >db/broken.binary
cp db/oak.binary db/tree.binary
cp db/red-cotton.binary twins/red-cotton.binary
expect_fail 1 '3 of 7 materials cannot be used (--skip-bad leaves them out); db/broken.binary: ' \
    reproduce db twins -o no
expect_true 'what is there twice is named' grep -qF \
    'db/tree.binary: has the same values as db/oak.binary; twins/red-cotton.binary: there is another' "$root/work/stderr"
run reproduce db twins --skip-bad --quick --only fig2a -o skipped || failed '--skip-bad' "$(cat "$root/work/stderr")"
expect_true 'what is left out is named' test "$(grep -c 'warning: left out: ' "$root/work/stderr")" -eq 3
rm db/broken.binary db/tree.binary
expect_ok reproduce db --quick --only fig2a -o clean
checks=$((checks + 1))
diff -r skipped clean >/dev/null || failed 'leaving out bad materials differs from not having them'

# ---- the materials that the paper quotes ----

# Under the sanitizers unit/held_out runs those methods.
if full; then
    mkdir quoted
    cp db/*.binary quoted
    expect_ok convert atlas:gold-polished quoted/gold-paint.binary
    run reproduce quoted --only fig5 -o whole || failed 'the whole Fig. 5' "$(cat "$root/work/stderr")"
    expect_true 'the quoted method is run and kept' test -s whole/pieces/fig5-matusik-800-gold-paint.json
    expect_true 'for the quoted materials alone' test "$(find whole/pieces -name 'fig5-matusik*' | wc -l)" -eq 1
    expect_true 'and is in the table' grep -q '^"\?gold-paint"\?,matusik-800,4,' whole/tables/fig5.csv
    expect_true 'and beside what the paper quotes' grep -q '^| gold-paint | 2.9 | .* | 3.2 | [0-9.]* |$' whole/report.md
    cp -r whole gone_on
    rm gone_on/pieces/fig5-matusik* gone_on/report.md gone_on/tables/fig5.csv
    expect_ok reproduce quoted --only fig5 -o gone_on
    checks=$((checks + 1))
    diff -r whole gone_on >/dev/null || failed 'going on with the quoted method leaves other files'
fi

# splits FILE TEXT
splits() { printf '{"splits": [{"basis": [%s], "test": [%s]}]}\n' "$2" "$3" >"$1"; }
splits good.json '"oak", "red-cotton", "jade-carved"' '"plaster-cast"'
splits unknown.json '"oak", "red-cotton", "chalk"' '"plaster-cast"'
splits twice.json '"oak", "red-cotton", "jade-carved"' '"oak"'
splits few.json '"oak", "red-cotton"' '"plaster-cast"'
splits numbers.json '"oak", "red-cotton", 3' '"plaster-cast"'
echo '{"splits": []}' >none.json
echo '{"splits": [' >torn.json
expect_ok reproduce db --quick --only fig2a --splits good.json -o given
expect_true 'the splits given are used' grep -q '^1,test,"plaster-cast"$' given/tables/splits.csv
expect_fail 1 "unknown.json: split 1: no material is called 'chalk'" reproduce db --splits unknown.json -o no
expect_fail 1 "numbers.json: split 1: a material's name must be a string" reproduce db --splits numbers.json -o no
if full; then
    expect_fail 1 "twice.json: split 1: 'oak' is named twice" reproduce db --splits twice.json -o no
    expect_fail 1 'few.json: split 1 has 2 materials to learn from' reproduce db --splits few.json -o no
    expect_fail 1 "none.json: holds no array 'splits'" reproduce db --splits none.json -o no
fi
expect_fail 1 'torn.json:2: not JSON' reproduce db --splits torn.json -o no
expect_fail 1 'missing.json: ' reproduce db --splits missing.json -o no

finish
