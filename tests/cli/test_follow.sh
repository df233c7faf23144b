#!/bin/bash
# Runs on a real instrument: a file that a robot appends to, standard input, a command; everything that goes wrong on
# the way; and kill -9 and signals at random moments, KILLS of them, after which nothing is lost.
. "$(dirname "$0")/lib.sh"
kills=${KILLS:-15}
signals=(KILL TERM HUP)
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
gonio() { timeout 60 "$GONIO" "$@"; }

"$FUZZ_SEEDS" "$root/seeds" || exit 1
cp "$root/seeds/basis/0.gonio" b.gonio
names=theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg
{
    echo $names
    for k in $(seq 0 29); do
        echo "$((10 + k % 6 * 12)),0,$((5 + k / 6 * 15)),$((180 - k % 4 * 30))"
    done
} >plan.csv
gonio measure plan.csv atlas:white-emulsion-paint -o known.csv || exit 1
grep -v '^#' known.csv >rows.csv
header=$(head -1 rows.csv)
count=30

rows_of() { grep -v -e '^#' -e '^theta' "$1" | sort; }
expect_all() { # FILE: it has every row of the instrument once
    checks=$((checks + 1))
    diff <(rows_of rows.csv) <(rows_of "$1") >"$root/work/diff" || failed "$1 has not every reading" "$(cat "$root/work/diff")"
}
follow() { # ARGUMENTS: the file robot.csv, without a basis
    gonio measure --follow robot.csv plan.csv --no-basis -o out.csv "$@"
}

# ---- a file that is whole, with progress and an expected error ----

cp rows.csv robot.csv
expect_output '30 read, ' measure --follow robot.csv plan.csv --basis b.gonio --budget 1s --remaining rest.csv -o out.csv
expect_also 'left; expected error (E6) '
expect_all out.csv
rm -f out.csv* rest.csv

# ---- it grows by halves of lines, and gonio is killed again and again ----

slowly() { # writes robot.csv, each line in two pieces
    : >robot.csv
    while IFS= read -r line; do
        printf '%s' "${line:0:25}" >>robot.csv
        sleep 0.0"$((RANDOM % 3))"
        printf '%s\n' "${line:25}" >>robot.csv
    done <rows.csv
}
RANDOM=7
slowly &
robot=$!
for k in $(seq "$kills"); do
    "$GONIO" measure --follow robot.csv plan.csv --no-basis -o out.csv >/dev/null 2>&1 &
    process=$!
    sleep "0.$(printf %02d $((RANDOM % 15)))"
    kill -s "${signals[k % 3]}" $process 2>/dev/null
    wait $process 2>/dev/null
done
wait $robot
expect_true 'after all kills the run ends' eval 'follow >"$root/work/stdout" 2>"$root/work/stderr"'
expect_all out.csv
expect_true 'the journal has each line once' test "$(grep -c ' line ' out.csv.journal)" -eq $((count + 1))
cp out.csv interrupted.csv
rm -f out.csv*
follow >/dev/null
expect_same <(grep -v '^# command' out.csv) <(grep -v '^# command' interrupted.csv)

# A journal that is cut in the middle of a line goes on.
truncate -s -20 out.csv.journal
expect_true 'a cut journal goes on' eval 'follow >"$root/work/stdout" 2>"$root/work/stderr"'
expect_true 'a cut line is noted' grep -q 'unfinished line cut off' "$root/work/stderr"
expect_all out.csv
rm -f out.csv*

# ---- a command is killed together with gonio ----

cat >instrument.sh <<'END'
#!/bin/sh
echo "$1 $3" >>visits
awk -F, -v i="$1" -v o="$3" -v p="$4" '!/^#/ && NR > 1 && $1 == i + 0 && $3 == o + 0 && $4 == p + 0 { print $5, $6, $7 }' rows.csv
END
chmod +x instrument.sh
command_run() { gonio measure --exec ./instrument.sh plan.csv --no-basis -o out.csv "$@"; }
for k in $(seq $((kills / 3 + 1))); do
    "$GONIO" measure --exec ./instrument.sh plan.csv --no-basis -o out.csv >/dev/null 2>&1 &
    process=$!
    sleep "0.$(printf %02d $((RANDOM % 20)))"
    kill -s "${signals[k % 3]}" $process 2>/dev/null
    wait $process 2>/dev/null
done
sleep 0.1
expect_true 'a run by a command ends' eval 'command_run >"$root/work/stdout" 2>"$root/work/stderr"'
expect_true 'every direction was read' grep -q 'all read: 30 readings, 0 directions left' "$root/work/stdout"
expect_true 'a kill repeats one reading at most' test "$(wc -l <visits)" -le $((count + kills / 3 + 1))
rm -f out.csv* visits

# ---- standard input, a decimal comma, the end of input ----

sed -e 's/,/;/g' -e 's/\./,/g' rows.csv | head -12 >german.csv
printf '30;0;5;180;0,1' >>german.csv
checks=$((checks + 1))
gonio measure --follow - plan.csv --no-basis -o out.csv <german.csv >"$root/work/stdout" 2>"$root/work/stderr" ||
    failed 'standard input' "$(cat "$root/work/stderr")"
expect_also 'out.csv: input ended: 11 readings, 19 directions left'
expect_true 'half a line is not taken' grep -q 'the last line has no end' "$root/work/stderr"
expect_output '11 directions, 11 measured' info out.csv
rm -f out.csv*

# ---- what goes wrong ----

{
    head -6 rows.csv
    sed -n 3p rows.csv         # a copy
    echo 'motor stalled'       # no reading
    sed -n 12p rows.csv        # before its turn
    echo "1,0,1,0,0.3,0.3,0.3" # not planned
} >robot.csv
expect_true 'troubles are survived' eval 'follow --budget 1s >"$root/work/stdout" 2>"$root/work/stderr"'
said() { expect_true "'$1' is said" grep -q -- "$1" "$root/work/stderr"; }
said 'robot.csv:7: the same as an earlier line'
said 'robot.csv:8: '
said 'robot.csv:9: the readings come in another order'
said 'robot.csv:10: no direction of the plan is within a degree'
expect_also 'out.csv: time up: 7 readings, 24 directions left; 1 line not understood'

# The plan was edited meanwhile; the file was replaced by a shorter one.
sed -i 2d plan.csv
sed -n '1p;20,22p' rows.csv >robot.csv
expect_true 'another plan is survived' eval 'follow --budget 1s >"$root/work/stdout" 2>"$root/work/stderr"'
said 'the plan is not the one that the run began with'
expect_also '10 readings'
rm -f out.csv*

# Times that run backwards, in a file without a basis.
{
    echo "$header,time"
    sed -n 3p rows.csv | sed 's/$/,12:00:05/'
    sed -n 4p rows.csv | sed 's/$/,12:00:01/'
} >robot.csv
expect_true 'time may run backwards' eval 'follow --budget 0.5s >"$root/work/stdout" 2>"$root/work/stderr"'
said 'robot.csv:3: the time is before that of the line above'
rm -f out.csv*

# A saturated reading is asked for again; the second takes its place.
{
    head -4 rows.csv
    sed -n 5p rows.csv | sed -E 's/^(([^,]*,){4}).*/\1100,100,100/'
    sed -n '6,$p' rows.csv
} >robot.csv
expect_true 'saturation is noticed' eval \
    'follow --saturation 50 --remaining rest.csv --budget 0.5s >"$root/work/stdout" 2>"$root/work/stderr"'
expect_also 'read again: ' 'saturated' '1 direction left'
expect_true 'what is left is one direction' test "$(rows_of rest.csv | wc -l)" -eq 1
sed -n 5p rows.csv >>robot.csv
expect_true 'the repeat is taken' eval 'follow --saturation 50 >"$root/work/stdout" 2>"$root/work/stderr"'
expect_also '1 reading set aside'
expect_all out.csv
rm -f out.csv* rest.csv

# ---- the rest is planned again ----

cp rows.csv robot.csv
head -8 rows.csv >robot.csv
expect_true 'a run adapts' eval 'gonio measure --follow robot.csv plan.csv --basis b.gonio --adapt --candidates rows.csv \
    --budget 1s --remaining rest.csv -o out.csv >"$root/work/stdout" 2>"$root/work/stderr"'
expect_true 'it is recorded' grep -q ' adapt ' out.csv.journal
expect_true 'as many directions are left' test "$(rows_of rest.csv | wc -l)" -ge 22
rm -f out.csv* rest.csv
expect_output '"ended": "target met"' measure --follow robot.csv plan.csv --basis b.gonio --target-error 1000% --json \
    -o out.csv
rm -f out.csv*

# ---- refusals ----

expect_fail 2 'exclude each other' measure --follow robot.csv --exec ./instrument.sh plan.csv -o out.csv
expect_fail 2 'take one PLAN' measure --follow robot.csv plan.csv atlas:gold-leaf -o out.csv
expect_fail 2 'is not a duration' measure --follow robot.csv plan.csv --budget soon -o out.csv
expect_fail 2 '--adapt needs a basis' measure --follow robot.csv plan.csv --adapt --no-basis -o out.csv
expect_fail 2 'give --journal' measure --follow robot.csv plan.csv -o -
expect_fail 2 'is an input' measure --follow robot.csv plan.csv -o robot.csv
expect_fail 1 'not the journal of a run' measure --follow robot.csv plan.csv --no-basis --journal known.csv -o out.csv
echo 'a,b' >robot.csv
checks=$((checks + 1))
follow >"$root/work/stdout" 2>"$root/work/stderr" && failed 'names of columns that mean nothing are an error'
said "no column 'theta_i_deg'"
rm -f out.csv*
checks=$((checks + 1))
gonio measure --exec false plan.csv --no-basis -o out.csv >"$root/work/stdout" 2>"$root/work/stderr" &&
    failed 'a command that fails is an error'
said 'it ended with code 1'
said 'goes on with the run'
finish
