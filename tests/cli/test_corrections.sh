#!/bin/bash
# Blank runs, references, the reflectance at given incidences, and what rests on the database.
. "$(dirname "$0")/lib.sh"
"$FUZZ_SEEDS" "$root/seeds" || exit 1
cp "$root/seeds/basis/0.gonio" b.gonio
names=theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value_per_sr

printf '%s\n30,0,40,180,0.31\n30,0,60,180,0.21\n50,0,20,90,0.26\n' $names >r.csv
printf '%s\n30,0,40,180,0.01\n30,0,60,180,0.011\n30,0,60,180,0.009\n' $names >dark.csv
printf 'theta_r_deg,brf\n0,1.0\n90,0.5\n' >tile.csv
values() { grep -v '^[#t]' "$1" | cut -d, -f5 | xargs; }

# ---- blank ----

expect_ok convert r.csv left.csv --blank dark.csv
expect_true 'the blank is subtracted' test "$(values left.csv)" = '0.3 0.2 0.25'
expect_true 'its uncertainty is written' grep -q 'value_deviation_per_sr' left.csv
expect_true 'it is noted' grep -q '# note: a blank run of 3 readings is subtracted: at 2 ' left.csv
expect_ok convert dark.csv left.csv --blank r.csv
expect_true 'a blank brighter than the sample is noted' grep -q 'the blank is brighter than the sample in ' left.csv
expect_ok reconstruct b.gonio r.csv --blank dark.csv -o out.binary
expect_ok next b.gonio r.csv --blank dark.csv -n 2 -o more.csv
sed 's/value_per_sr/500nm_per_sr/' dark.csv >other.csv
expect_fail 1 'the blank has other channels' convert -q r.csv bad.csv --blank other.csv

# ---- references ----

printf 'a,b\n1,2\n' >words.csv
expect_ok convert r.csv left.csv --reference-brf 2
expect_true 'relative to a number' test "$(values left.csv | cut -c1-6)" = 0.1973
expect_ok convert r.csv left.csv --reference-brf tile.csv
expect_true 'relative to a table' test "$(values left.csv | cut -c1-6)" = 0.0767
expect_ok convert r.csv left.csv --reference-brf 2 --as values=brdf
expect_true 'in another unit' test "$(values left.csv)" = '0.62 0.42 0.52'
expect_fail 2 'no reflectance factor above 0' convert -q r.csv bad.csv --reference-brf=-1
expect_fail 1 'theta_r_deg and brf' convert -q r.csv bad.csv --reference-brf words.csv

# ---- energy ----

expect_output 'reflectance  30 deg' info atlas:white-emulsion-paint --albedo-at 0,30
expect_output '"reflectance": [' info atlas:white-emulsion-paint --albedo-at 45 --json
expect_output '+-' reconstruct b.gonio r.csv --albedo-at 10 -o out.binary
expect_output '"deviation": [' reconstruct b.gonio r.csv --albedo-at 10 --json -o out.binary
expect_also '"database_share"'
expect_output 'rests on the database alone' reconstruct b.gonio r.csv -o out.binary
expect_fail 2 'below 90 degrees' info atlas:gold-leaf --albedo-at 90
expect_fail 2 'below 90 degrees' reconstruct b.gonio r.csv --albedo-at 1,x -o out.binary
finish
