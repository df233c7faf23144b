#!/usr/bin/env bash
# A group of 1, 2 and 3 processes leaves the same bytes as one alone, and one that fails ends all:
# test_process_group.sh PROGRAM WITH_MPI
set -euo pipefail
program=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() {
    echo "$*" >&2
    exit 1
}

[ "$("$program" "$scratch/alone")" = "sum 145.000 by 1" ] || fail "alone: another sum"

if [ "$2" != TRUE ]; then
    if OMPI_COMM_WORLD_SIZE=2 "$program" "$scratch/no" 2>"$scratch/message"; then
        fail "a program without MPI must not run under mpirun"
    fi
    grep -q "built without MPI" "$scratch/message" || fail "no word about MPI: $(cat "$scratch/message")"
    echo "SKIPPED: groups by mpirun, as gonio is built without MPI"
    exit 0
fi
command -v mpirun >/dev/null || { echo "SKIPPED: there is no mpirun"; exit 0; }

# Containers build as root, and have fewer processors than the test has processes. MPI itself leaks.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 ASAN_OPTIONS=detect_leaks=0
run() {
    local size=$1
    shift
    timeout 60 mpirun --oversubscribe -n "$size" "$program" "$@"
}

for size in 1 2 3; do
    [ "$(run $size "$scratch/group-$size")" = "sum 145.000 by $size" ] || fail "$size: another sum"
    diff -r "$scratch/alone" "$scratch/group-$size" || fail "$size processes leave other files than one"
done

# The others wait at the barrier, and must not do so forever.
code=0
run 3 "$scratch/failing" 1 >"$scratch/output" 2>"$scratch/message" || code=$?
[ $code = 1 ] || fail "exit code $code instead of 1: $(cat "$scratch/message")"
grep -q "^rank 1: piece-[0-9]*: made to fail" "$scratch/message" || fail "not told: $(cat "$scratch/message")"

# What the others finished stays, and whoever comes next goes on.
[ "$(run 2 "$scratch/failing")" = "sum 145.000 by 2" ] || fail "going on: another sum"
diff -r "$scratch/alone" "$scratch/failing" || fail "going on leaves other files"
