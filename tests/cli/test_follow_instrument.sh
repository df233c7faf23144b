#!/bin/bash
# A followed run under an instrument: its times, limits and reach, the positions of its axes; repeats that never come; and
# what may be wrong with the plan, the dark level or decimal signs.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

"$FUZZ_SEEDS" "$root/seeds" || exit 1
cp "$root/seeds/basis/0.gonio" b.gonio
gonio plan b.gonio --instrument two-arms -n 12 -q -o plan.csv || exit 1
gonio measure plan.csv atlas:sapphire-metallic --instrument two-arms -q -o run.csv || exit 1
lines() { grep -v '^#' "$1"; }
# follows ARGUMENTS: the file robot.csv, without a basis, from the beginning
follows() {
    rm -f out.csv out.csv.journal
    checks=$((checks + 1))
    timeout 60 "$GONIO" measure --follow robot.csv plan.csv --instrument two-arms --no-basis --idle 0.2s -o out.csv "$@" \
        >"$root/work/stdout" 2>"$root/work/stderr" || failed "follow $*" "$(cat "$root/work/stderr")"
}
said() { expect_true "'$1' is said" grep -q -- "$1" "$root/work/stderr"; }
not_said() { expect_true "'$1' is not said" eval '! grep -q -- "$1" "$root/work/stderr"'; }
# edited ROW COLUMNS: run.csv with values of one reading, of those of the sample, replaced
edited() {
    awk -F, -v OFS=, -v row="$1" -v values="$2" \
        '/^[0-9]/ && $6 == "" && ++n == row { split(values, v, " "); $7 = v[1]; $8 = v[2]; $9 = v[3] } { print }' run.csv
}

# ---- time by the kinematics ----

: >robot.csv
follows --json
duration=$(sed -n 's/^# duration_s: //p' plan.csv)
expect_true 'the time left is that of the plan' jq -e --argjson s "$duration" \
    '.ended == "nothing more came" and .directions_left == 12 and (.seconds_left - $s | fabs) < 1' "$root/work/stdout"
lines run.csv | head -9 >robot.csv
follows --remaining rest.csv
expect_also 'two-arm scatterometer: 12 directions to read; about' '6 read, 6 left; about' 'nothing more came: 6 readings, 6'
rest=$(sed -n 's/^# duration_s: //p' rest.csv)
last=$(tail -1 robot.csv | cut -d, -f5)
expect_true 'the rest takes as long as in the plan' awk -v a="$rest" -v b="$duration" -v c="$last" \
    'BEGIN { exit !(a - (b - c) < 1 && (b - c) - a < 1) }'
expect_same <(lines plan.csv | cut -d, -f1-4,7-10 | tail -6) <(lines rest.csv | cut -d, -f1-4,6-9 | tail -6)

# ---- its limits ----

edited 3 '3141.593 10 10' >robot.csv
follows --remaining rest.csv
expect_also 'saturated' '12 read, 1 left' 'nothing more came: 12 readings, 1 direction left' 'their first readings count'
said 'only repeats are left: 1; waiting for them'
expect_true 'the rest is of the basis of the plan' test "$(grep '^# basis' plan.csv)" = "$(grep '^# basis' rest.csv)"
expect_true 'the saturated reading is the rest' test "$(lines rest.csv | wc -l)" -eq 2
edited 4 '0.0014 0.0013 0.0015' >robot.csv
follows
expect_also '12 directions' 'all read' '; 1 at the dark level'
said 'is at the dark level of the instrument'
awk -F, -v OFS=, '/^[0-9]/ && $6 == "" && ++n > 4 { $7 = $8 = $9 = 0.0014 } { print }' run.csv >robot.csv
follows
said '5 readings in a row are at the dark level: is the lamp on?'
sed 's/"floor_per_sr": 1e-3, "dark_per_sr": 5e-4/"floor_per_sr": 1e-5, "dark_per_sr": 5e-4/; s/"\$schema.*//' \
    "$(dirname "$here")/../data/instruments/two-arms.json" >quiet.json
edited 5 '0 0 0' >robot.csv
rm -f out.csv*
expect_output 'below the dark level of the instrument' measure --follow robot.csv plan.csv --instrument quiet.json --no-basis \
    --idle 0.2s -o out.csv

# ---- a command is given the axes, and the rest is planned within reach ----

cat >robot.sh <<'END'
#!/bin/sh
[ $# -eq 8 ] || exit 3
echo "$5 $6 $7 $8" >>visits
echo 0.3
END
chmod +x robot.sh
rm -f out.csv*
expect_output 'all read: 12 readings' measure --exec ./robot.sh plan.csv --instrument two-arms --no-basis -o out.csv
expect_same <(lines plan.csv | tail -n +2 | awk -F, '{ printf "%.3f %.3f %.3f %.3f\n", $7, $8, $9, $10 }') \
    <(awk '{ printf "%.3f %.3f %.3f %.3f\n", $1, $2, $3, $4 }' visits)
rm -f out.csv*
{ grep '^# values' run.csv; lines run.csv | head -8; } >robot.csv
expect_ok measure --follow robot.csv plan.csv --instrument two-arms --basis b.gonio --adapt --idle 0.2s --remaining rest.csv \
    -o out.csv
expect_true 'it is adapted' grep -q ' adapt ' out.csv.journal
expect_output 'readings of white-emulsion-paint' measure rest.csv atlas:white-emulsion-paint --instrument two-arms -o x.csv

# ---- the plan ----

cp run.csv robot.csv
rm -f out.csv*
expect_fail 1 'the instrument in-plane cannot read theta_i' measure --follow robot.csv plan.csv --instrument in-plane \
    --no-basis -q -o out.csv
sed 's/two-arm scatter/one-arm scatter/' plan.csv >other.csv
rm -f out.csv*
gonio measure --follow robot.csv other.csv --instrument two-arms --no-basis --idle 0.2s -o out.csv >"$root/work/stdout" \
    2>"$root/work/stderr"
said 'other.csv: planned for another instrument: hemispherical one-arm'

# ---- a dark level above the sample, a second value, decimal commas ----

sed 's/\(,dark,\).*/\130,30,30/' run.csv >robot.csv
follows
said 'was the light on in a dark row?'
cp run.csv robot.csv
follows
not_said 'was the light on'
said '1 dark row subtracted'
edited 2 '7 8 9' | lines /dev/stdin | sed -n 5p >>robot.csv
follows
said 'again, with another value: both count'
awk -F, -v OFS=, '/^[0-9]/ { t = 86390 + 2 * n++; $5 = sprintf("%02d:%02d:%02d", t / 3600 % 24, t / 60 % 60, t % 60) }
    { print }' run.csv >robot.csv
follows
not_said 'the time is before'
sed 's/^# values.*/# values: percent/' run.csv >robot.csv
follows
said "taken as 'percent', but the instrument states 'factor'"
# What a file does not say is what the instrument gives.
cp run.csv robot.csv
follows
lines out.csv >stated.csv
grep -v '^# values' run.csv >robot.csv
follows
not_said 'but the instrument states'
expect_same stated.csv <(lines out.csv)
iconv -t UTF-16 run.csv >robot.csv
rm -f out.csv*
expect_true 'UTF-16 is refused' eval '! gonio measure --follow robot.csv plan.csv --no-basis -o out.csv >"$root/work/stdout" \
    2>"$root/work/stderr"'
said 'this is UTF-16'
lines run.csv | sed 's/\./,/g' | head -4 >robot.csv
follows
said 'are these decimal commas?'
lines run.csv | sed 's/,/;/g; s/\./,/g' >robot.csv
follows
expect_also 'all read: 12 readings'

# ---- refusals ----

expect_fail 2 "--idle: 'soon'" measure --follow robot.csv plan.csv --idle soon -o out2.csv
expect_fail 2 'not both' measure --follow robot.csv plan.csv --instrument two-arms --candidates run.csv -o out2.csv
finish
