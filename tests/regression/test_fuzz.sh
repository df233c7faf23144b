#!/bin/bash
# Every fuzz target on the files that it once failed on (fuzz/TARGET), and on seeds with a few changes.
. "$(dirname "$0")/../cli/lib.sh"
known=$(cd "$(dirname "$0")" && pwd)/fuzz

expect_true 'seeds are made' "$FUZZ_SEEDS" "$root/seeds"
changes=$(full && echo 60 || echo 30)
for folder in "$root"/seeds/*; do
    target=${folder##*/}
    paths=("$folder")
    [ ! -d "$known/$target" ] || paths+=("$known/$target")
    checks=$((checks + 1))
    timeout 120 "$FUZZ_REPLAY" -n "$changes" "$target" "${paths[@]}" >"$root/work/stdout" 2>&1 ||
        failed "fuzz-replay -n $changes $target" "$(tail -20 "$root/work/stdout")"
done
finish
