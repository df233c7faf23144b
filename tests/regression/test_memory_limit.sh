#!/bin/bash
# Too little address space is an error; it was an endless loop in the matrix library.
. "$(dirname "$0")/../cli/lib.sh"

if [ "${GONIO_TESTS:-}" = small ]; then
    skip 'limits of address space: the sanitizers need more than any'
    finish
fi
expect_ok learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o b.gonio
# limited KILOBYTES: a command that multiplies matrices; 0 and 1 are ends, others are not.
limited() {
    (
        ulimit -v "$1"
        timeout -k 2 60 "$GONIO" plan b.gonio -n 4 --threads 2 -o p.csv
    ) >/dev/null 2>"$root/work/stderr"
    local code=$?
    checks=$((checks + 1))
    [ $code -le 1 ] || failed "ulimit -v $1" "exit code $code" "$(cat "$root/work/stderr")"
}

for kilobytes in 250000 350000 450000 550000; do
    limited $kilobytes
done
(
    ulimit -v 300000
    "$GONIO" plan b.gonio -n 4 --threads 2 -o p.csv
) >/dev/null 2>"$root/work/stderr"
expect_true 'the reason is told' grep -q 'the address space is limited (ulimit -v)' "$root/work/stderr"
finish
