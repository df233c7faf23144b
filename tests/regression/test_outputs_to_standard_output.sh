#!/bin/bash
# The summary line was written into a table that went to standard output, and tables could not go to pipes.
. "$(dirname "$0")/../cli/lib.sh"

expect_ok learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o b.gonio
expect_ok plan b.gonio -n 4 -o p.csv
expect_ok measure p.csv atlas:red-cotton -o r.csv
expect_ok reconstruct b.gonio r.csv -o good.binary

# to_standard_output FILE ARGUMENTS...: FILE has what the command wrote, its result is on standard error.
to_standard_output() {
    local file=$1
    shift
    checks=$((checks + 1))
    "$GONIO" "$@" >"$file" 2>"$root/work/stderr" || failed "gonio $*" "$(cat "$root/work/stderr")"
}

for name in /dev/stdout /dev/fd/1 -; do
    to_standard_output to-file.binary reconstruct b.gonio r.csv -o "$name"
    expect_same to-file.binary good.binary
    expect_true 'the summary is on standard error' grep -q "^$name: " "$root/work/stderr"
done
expect_true 'no file is called -' test ! -e ./-
"$GONIO" reconstruct b.gonio r.csv -qo /dev/stdout | cat >piped.binary
expect_same piped.binary good.binary
printf 'before' >appended
"$GONIO" reconstruct b.gonio r.csv -qo - >>appended
expect_same <(tail -c +7 appended) good.binary
mkfifo named
cat named >from-named.binary &
expect_ok reconstruct b.gonio r.csv -o named
wait
expect_same from-named.binary good.binary

# Other writers, and results as JSON.
expect_ok convert good.binary good.h5
expect_ok convert good.binary good.xml
for format in h5 xml; do
    writer=$([ $format = h5 ] && echo table || echo klems)
    "$GONIO" convert --format $writer good.binary - | cat >"piped.$format"
    expect_same "piped.$format" "good.$format"
done
to_standard_output plan.csv plan b.gonio -n 4 -o -
expect_same <(grep -v '^# command' plan.csv) <(grep -v '^# command' p.csv)
to_standard_output readings.csv measure p.csv atlas:red-cotton -o - --json
expect_same <(grep -v '^# command' readings.csv) <(grep -v '^# command' r.csv)
expect_true 'JSON is on standard error' grep -q '"readings": 4' "$root/work/stderr"

to_full() { "$GONIO" "$@" >/dev/full; }
runner=to_full expect_fail 1 'cannot write: No space left' reconstruct b.gonio r.csv -o /dev/stdout
to_nobody() { "$GONIO" "$@" | true; return "${PIPESTATUS[0]}"; }
runner=to_nobody expect_fail 1 'cannot write: Broken pipe' reconstruct b.gonio r.csv -o /dev/stdout

finish
