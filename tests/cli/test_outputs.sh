#!/bin/bash
# Outputs appear whole or not at all, and inputs stay as they are: places that cannot be written,
# full disks, outputs that are inputs, interrupts.
. "$(dirname "$0")/lib.sh"

materials='atlas:oak-sawn atlas:gold-polished atlas:plaster-cast'
# shellcheck disable=SC2086
expect_ok learn --grid bivariate $materials -o b.gonio
expect_ok plan b.gonio -n 4 -o p.csv
expect_ok measure p.csv atlas:white-linen -o r.csv
expect_ok convert atlas:white-linen m.binary
expect_ok plan b.gonio -n 100 --restarts 1 -o long.csv

# every_writer CODE PART OUTPUT: what each command says of an output.
every_writer() {
    # shellcheck disable=SC2086
    expect_fail "$1" "$2" learn --grid bivariate $materials -o "$3"
    expect_fail "$1" "$2" plan b.gonio -n 4 -o "$3"
    expect_fail "$1" "$2" plan b.gonio -n 4 --history "$3" -o x.csv
    expect_fail "$1" "$2" measure p.csv m.binary -o "$3"
    expect_fail "$1" "$2" reconstruct b.gonio r.csv -o "$3"
    expect_fail "$1" "$2" convert m.binary "$3"
}

# ---- places that cannot be written ----

mkdir folder closed
: >closed/old
: >protected
chmod 555 closed
chmod 444 protected
every_writer 1 'nowhere/x: cannot write: No such file or directory' nowhere/x
every_writer 1 'm.binary/x: cannot write: Not a directory' m.binary/x
# A reconstruction goes into the folder, under its readings' name; the others want a file.
mkdir folder/r.binary
expect_fail 1 'folder/r.binary: cannot write: Is a directory' reconstruct b.gonio r.csv -o folder
rmdir folder/r.binary
expect_ok reconstruct b.gonio r.csv -o folder
rm folder/r.binary
mkdir folder/r.binary
every_writer 1 ': cannot write: Is a directory' folder
rmdir folder/r.binary
every_writer 1 '/dev/full: cannot write: No space left on device' /dev/full
if permissions_apply; then
    runner=as_other_user
    chmod a+rwx .
    every_writer 1 'closed/x: cannot write: Permission denied' closed/x
    every_writer 1 'closed/old: cannot write: Permission denied' closed/old
    every_writer 1 'protected: cannot write: Permission denied' protected
    runner=gonio
else
    skip 'read-only files and folders: no other user to run as'
fi

# ---- a full disk, for which a limit on the size of files stands in ----

limited() (ulimit -f "$kilobytes" && exec "$GONIO" "$@")
runner=limited
kilobytes=1000
expect_fail 1 'x.binary: cannot write: File too large' convert m.binary x.binary
expect_fail 1 'm-old.binary: cannot write: File too large' \
    convert atlas:red-cotton m-old.binary --threads 4
expect_fail 1 'x.binary: cannot write: File too large' reconstruct b.gonio r.csv -o x.binary
kilobytes=350 # room for what learn keeps in its scratch files, but not for the basis
# shellcheck disable=SC2086
expect_fail 1 'x.gonio: cannot write: File too large' learn --grid bivariate $materials -o x.gonio
kilobytes=200 # the scratch files of three materials reach to 290
# shellcheck disable=SC2086
expect_fail 1 'cannot write the scratch file: File too large; set TMPDIR' \
    learn --grid bivariate $materials -o x.gonio
kilobytes=1
expect_fail 1 'x.csv: cannot write: File too large' plan b.gonio -n 100 --restarts 1 -o x.csv
expect_fail 1 'x.csv: cannot write: File too large' measure long.csv m.binary -o x.csv
runner=gonio
no_scratch() (export TMPDIR=$root/nowhere && exec "$GONIO" "$@")
# shellcheck disable=SC2086
runner=no_scratch expect_fail 1 'nowhere: cannot make a scratch file' learn --grid bivariate $materials -o x.gonio

# An old output survives a failure.
cp r.csv old.csv
runner=limited expect_fail 1 'old.csv: cannot write: File too large' \
    measure long.csv m.binary -o old.csv
expect_same r.csv old.csv

# ---- standard output ----

to_full() { "$GONIO" "$@" >/dev/full; }
to_closed() { "$GONIO" "$@" >&-; }
runner=to_full expect_fail 1 'cannot write to standard output: No space left' info m.binary
runner=to_full expect_fail 1 'cannot write to standard output: No space left' info atlas: --json
runner=to_full expect_fail 1 'cannot write to standard output: No space left' \
    compare m.binary m.binary
runner=to_full expect_fail 1 'cannot write to standard output: No space left' learn -h
runner=to_closed expect_fail 1 'cannot write to standard output: Bad file' info p.csv
"$GONIO" plan b.gonio -n 4 -qo /dev/stdout 2>&1 | grep -v '^# command' >piped.csv
expect_same piped.csv <(grep -v '^# command' p.csv)
expect_ok measure p.csv m.binary -o /dev/null

# ---- outputs that are inputs ----

ln -s m.binary soft.binary
ln m.binary hard.binary
ln -s p.csv soft.csv
ln r.csv hard.csv
ln -s b.gonio soft.gonio
for name in m.binary ./m.binary "$PWD/m.binary" soft.binary hard.binary; do
    expect_fail 2 "$name is an input: give another name" convert m.binary "$name"
    expect_fail 2 "$name is an input" measure p.csv m.binary -o "$name"
    expect_fail 2 "$name is an input" learn --grid bivariate atlas:oak-sawn m.binary -o "$name"
done
expect_fail 2 'm.binary is an input' convert soft.binary m.binary
expect_fail 2 'm.binary is an input' learn . atlas:oak-sawn -o m.binary
expect_fail 2 'soft.csv is an input' measure p.csv m.binary -o soft.csv
expect_fail 2 'soft.gonio is an input' plan b.gonio -n 4 -o soft.gonio
expect_fail 2 'soft.gonio is an input' plan b.gonio -n 4 --history soft.gonio -o x.csv
expect_fail 2 'hard.csv is an input' reconstruct b.gonio r.csv -o hard.csv
expect_fail 2 'b.gonio is an input' reconstruct b.gonio r.csv -o b.gonio

cp p.csv candidates.csv
for name in candidates.csv ./candidates.csv; do
    expect_fail 2 "$name is an input" plan b.gonio -n 2 --method random --candidates candidates.csv --history "$name" -o x.csv
    expect_fail 2 "$name is an input" \
        reconstruct b.gonio r.csv --predict-at candidates.csv --deviation "$name" -o x.csv
done

# ---- two outputs ----

expect_fail 2 '--history and -o name the same file' plan b.gonio -n 4 --history ./x.csv -o x.csv
expect_fail 2 '--history and -o name the same file' plan b.gonio -n 4 --history "$PWD/x.csv" -o x.csv
expect_fail 2 '--deviation and -o name the same file' reconstruct b.gonio r.csv --deviation ./x.csv -o x.csv
printf 'old' >both.csv
ln both.csv both-hard.csv
expect_fail 2 '--history and -o name the same file' plan b.gonio -n 4 --history both.csv -o both-hard.csv
# What was there stays where one of them cannot be written.
expect_fail 1 'nowhere/x.csv: cannot write' plan b.gonio -n 4 --history both.csv -o nowhere/x.csv
expect_fail 1 'nowhere/x.csv: cannot write' plan b.gonio -n 4 --history new.csv -o nowhere/x.csv
expect_ok plan b.gonio -n 4 --history both.csv -o both-plan.csv
expect_true 'both are written' test -s both-plan.csv -a "$(head -c 3 both.csv)" != old
rm both*

# ---- outputs that exist ----

printf 'old' >target.csv
ln -s target.csv link.csv
expect_ok measure p.csv m.binary -o link.csv
expect_true 'a link stays a link' test -L link.csv
expect_true 'what it points to is written' grep -q '^theta_i_deg' target.csv

# ---- the folder for the built-in basis ----

no_cache() (
    unset XDG_CACHE_HOME
    export HOME=$root/files/m.binary
    exec "$GONIO" "$@"
)
runner=no_cache run plan --method condition -K 5 -n 5 -o x.csv || failed 'a plan without a cache' "$(cat "$root/work/stderr")"
expect_true 'no cache is warned of' \
    grep -q 'warning: no cache folder for the built-in basis, .*: set XDG_CACHE_HOME' "$root/work/stderr"
expect_true 'and does not end the work' test -s x.csv
rm x.csv
expect_fail 1 'm.binary: cannot use this folder' demo -o m.binary
expect_fail 1 'nowhere/demo: cannot use this folder' demo -o nowhere/demo

# ---- interrupts ----

# interrupted SIGNAL ARGUMENTS...: stops the program a moment after its start.
interrupted() {
    local signal=$1
    shift
    "$GONIO" "$@" >"$root/work/stdout" 2>"$root/work/stderr" &
    local job=$!
    sleep 0.4
    kill -s "$signal" $job
    wait $job
}
set -m # so that background jobs take SIGINT
for signal in INT TERM HUP; do
    before=$(snapshot)
    interrupted $signal plan b.gonio -n 400 --restarts 1000000 -o x.csv
    code=$?
    expect_true "an interrupted plan ends by SIG$signal" test "$(kill -l $code)" = $signal
    expect_true "an interrupted plan leaves nothing" test "$(snapshot)" = "$before"
done

# Who waits for a pipe's writer, or for what it writes.
mkfifo silent
for command in 'info silent' 'measure silent atlas:oak-sawn -o x.csv'; do
    # shellcheck disable=SC2086
    "$GONIO" $command 2>"$root/work/stderr" &
    job=$!
    sleep 0.5
    kill -s INT $job
    wait $job
    code=$?
    expect_true "$command is interrupted" test "$(kill -l $code)" = INT
done
rm silent

# Many reconstructions: stopped when the first is there, long before the last.
mkdir several results
for k in {10..49}; do ln r.csv several/$k.csv; done
for signal in INT TERM; do
    "$GONIO" reconstruct b.gonio several/*.csv -o results >"$root/work/stdout" \
        2>"$root/work/stderr" &
    job=$!
    while [ ! -e results/10.binary ] && kill -0 $job 2>/dev/null; do :; done
    kill -s "$signal" $job
    wait $job
    code=$?
    count=$(find results -name '*.binary' | wc -l)
    whole=$(find results -name '*.binary' -size 34992012c | wc -l)
    expect_true "interrupted reconstructions end by SIG$signal" test "$(kill -l $code)" = $signal
    expect_true "an interrupt takes effect before the last of many" test "$count" -lt 40
    expect_true "interrupted reconstructions are whole or not there" test "$whole" -eq "$count"
    expect_true "and nothing else is left" test "$(ls results | wc -l)" -eq "$count"
    expect_true "those reported are there" test "$(wc -l <"$root/work/stdout")" -eq "$count"
    rm results/*
done

finish
