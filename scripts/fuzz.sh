#!/usr/bin/env bash
# Fuzzes one target after the other: fuzz.sh BUILD SECONDS [TARGET...], with a build of the preset "fuzz". Inputs are
# kept in BUILD/corpus/TARGET, and the next run begins with them; what crashes, hangs for 10 s ($TIMEOUT) or asks for
# more than 1 GiB is left in BUILD/found. Exit code 1 if there is anything.
set -u
build=$1
seconds=$2
shift 2
cd "$(dirname "$0")/.." || exit 1
[ $# -gt 0 ] || set -- $(sed -n 's/^\(PLAIN\|MUTATED\)(\(.*\))$/\2/p' tests/fuzz/targets.h)

"$build/tests/fuzz/fuzz-seeds" "$build/seeds" || exit 1
mkdir -p "$build/found"
code=0
for target in "$@"; do
    corpus=$build/corpus/$target
    mkdir -p "$corpus"
    more=()
    [ ! -f "tests/fuzz/dictionaries/$target" ] || more+=("-dict=tests/fuzz/dictionaries/$target")
    [ ! -d "tests/regression/fuzz/$target" ] || more+=("tests/regression/fuzz/$target")
    if nice "$build/tests/fuzz/fuzz-$target" -max_total_time="$seconds" -timeout="${TIMEOUT:-10}" -rss_limit_mb=2500 \
        -malloc_limit_mb=1024 -max_len=65536 -artifact_prefix="$build/found/$target-" \
        "$corpus" "$build/seeds/$target" "${more[@]}" \
        >"$build/found/$target.log" 2>&1; then
        echo "$target: nothing found; $(grep -ao '^#[0-9]*.*DONE' "$build/found/$target.log" | grep -ao '^#[0-9]*' | tr -d '#') runs"
    else
        code=1
        echo "$target: see $build/found/$target.log"
    fi
done
exit $code
