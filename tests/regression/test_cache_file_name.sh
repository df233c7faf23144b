#!/bin/bash
# Man pages named files in the cache that were never made. The bases stay in $BUILTIN_BASES for other tests.
source=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/../cli/lib.sh"

announced() { expect_true "$1 is announced" grep -q '^gonio plan: note: no BASIS given: learning' "$root/work/stderr"; }
if full; then
    expect_ok plan -n 2 -o default.csv
    announced 'the default basis'
fi
expect_ok plan --method condition --components 3 -n 5 --restarts 1 -o paper.csv
announced "the paper's basis"
version=$(gonio --version | cut -d ' ' -f 2)
expect_true 'each basis is kept' \
    test "$(find "$XDG_CACHE_HOME/gonio" -type f -size +0 | wc -l)" -eq "$(full && echo 2 || echo 1)"
pages=0
for page in "$source"/docs/man/*.1; do
    for name in $(grep -o 'atlas-VERSION[-A-Za-z]*\.gonio' "$page"); do
        full || [[ $name == *-bivariate.gonio ]] || continue
        pattern=$(sed "s/VERSION/$version/; s/RECIPE/[0-9]/" <<<"$name")
        expect_true "$(basename "$page"): $name is made" \
            test "$(find "$XDG_CACHE_HOME/gonio" -name "$pattern" | wc -l)" -eq 1
        pages=$((pages + 1))
    done
done
expect_true 'the pages of plan, next, reconstruct and gonio name them' test $pages -ge "$(full && echo 7 || echo 1)"

# A damaged one is made again, and one that cannot be kept is used.
paper=$(find "$XDG_CACHE_HOME/gonio" -name '*-bivariate.gonio')
cp "$paper" "$root/work/whole.gonio"
head -c 5000 "$root/work/whole.gonio" >"$paper"
run plan --method condition --components 3 -n 5 --restarts 1 -o again.csv
expect_true 'a damaged cache is warned of' grep -q 'warning: .*-bivariate.gonio: .*; it is made again$' "$root/work/stderr"
expect_true 'and why' grep -qF "$paper: damaged: " "$root/work/stderr"
expect_same "$paper" "$root/work/whole.gonio"
expect_same <(grep -v '^# command' again.csv) <(grep -v '^# command' paper.csv)

if [ -n "${BUILTIN_BASES:-}" ]; then
    rm -rf "$BUILTIN_BASES"
    cp -r "$XDG_CACHE_HOME/gonio" "$BUILTIN_BASES"
fi

finish
