#!/bin/bash
# gonio check: instruments in words, as JSON and as a picture; the schema knows what the program knows.
source=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/lib.sh"

differ() { ! cmp -s "$1" "$2"; }

for word in in-plane two-arms four-axis; do
    expect_output "$word: " check "$word"
    expect_also 'kinematics: ' 'axes move together' 'theta_i ' 'the mirror direction'
    expect_ok check "$source/data/instruments/$word.json"
done
expect_output 'out of reach: ' check four-axis

cat >rig.json <<'END'
{"gonio_instrument": 1, "kinematics": "in-plane",
 "axes": {"incidence": {"positions_deg": [20]}, "detector": {"from_deg": -60, "to_deg": 60, "step_deg": 5}}}
END
expect_output 'single directions or a plane, theta_i 20 to 20 and theta_o 0 to 60' check rig.json
cat >ring.json <<'END'
{"gonio_instrument": 1, "kinematics": "direct", "axes": {"theta_i": {"positions_deg": [0, 30, 60]},
 "theta_o": {"positions_deg": [5, 25, 45, 65]}, "phi_o": {"from_deg": 0, "to_deg": 345, "step_deg": 15}}}
END
expect_output 'with what is between listed positions, theta_i 0 to 60 and theta_o 5 to 65' check ring.json
sed 's/"from_deg"/"form_deg"/' rig.json >wrong.json
expect_fail 1 'wrong.json: axes.detector.form_deg: unknown key; known are from_deg, to_deg' check wrong.json
sed 's/^ "axes"/ "limits": {"theta_o_deg": [70, 80]}, "axes"/' rig.json >blind.json
expect_fail 1 "blind.json: no pair of directions can be reached; most are kept out by 'theta_o'" check blind.json
expect_fail 1 'six-axis' check six-axis
expect_fail 2 'INSTRUMENT is needed' check
printf '\xef\xbb\xbf' | cat - rig.json >marked.json
expect_ok check marked.json

# ---- a table of directions in a CSV file beside the instrument ----

mkdir tables
echo '{"gonio_instrument": 1, "kinematics": "table", "directions": "rows.csv"}' >tables/rig.json
printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n10,0,30,180\n20,0,40,90\n' >tables/rows.csv
expect_output '2 directions' check tables/rig.json
printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n10,0,x,180\n' >tables/rows.csv
expect_fail 1 'tables/rows.csv:2: no number in column theta_o_deg' check tables/rig.json

# ---- plans ----

expect_ok learn --grid bivariate --mixtures 0 atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o b.gonio
plan() { expect_ok plan b.gonio --method expected-error --instrument "$@"; }
plan ring.json -n 30 -o ring.csv
expect_output 'ring.csv: 30 readings in ' check ring.json ring.csv
plan rig.json -n 5 -o plan.csv
expect_true 'the columns' grep -q 'axis_incidence_deg,axis_detector_deg,time_s' plan.csv
expect_true 'the light stands' test "$(grep -c '^20.0000.*,20.0000,' plan.csv)" = 5
expect_ok measure plan.csv atlas:oak-sawn -o read.csv
expect_output ' in the order of choice' plan b.gonio --method expected-error --instrument four-axis -n 6 -o four.csv
expect_also 'blind: ' 'without the limits' 'reached: '
expect_output 'four-axis goniometer in' plan b.gonio --method expected-error --instrument four-axis --budget 3min -n 20 -o b.csv
expect_ok next b.gonio read.csv --instrument rig.json -n 2 -o next.csv
expect_true 'next has axes' grep -q 'axis_detector_deg' next.csv
expect_fail 2 '--budget needs --instrument' plan b.gonio --budget 45min -o no.csv
expect_fail 2 "'soon' is not a time like 45min" plan b.gonio --instrument four-axis --budget soon -o no.csv
expect_fail 2 'not both' plan b.gonio --instrument four-axis --budget 1h --target-error 3 -o no.csv
expect_fail 2 'not both' plan b.gonio --instrument four-axis --candidates plan.csv -o no.csv
expect_fail 2 'no reading fits into' plan b.gonio --method expected-error --instrument four-axis --budget 5s -o no.csv
expect_fail 2 'need the method expected-error' plan b.gonio --method random -n 5 --instrument four-axis -o no.csv

# ---- a rehearsed run ----

expect_output 'a run of ' measure four.csv atlas:oak-sawn --instrument four-axis --seed 3 -o run.csv
expect_true 'reference lines' grep -q ',reference,' run.csv
expect_output 'drift corrected' info run.csv
expect_output '6 directions, 6 measured' info run.csv
expect_ok measure four.csv atlas:oak-sawn --instrument four-axis --seed 3 -o same.csv
expect_true 'the same seed, the same run' diff <(grep -v '^# command' run.csv) <(grep -v '^# command' same.csv)
expect_ok reconstruct b.gonio run.csv -o run.binary
expect_output 'E6' compare atlas:oak-sawn run.binary
expect_ok plan b.gonio --method expected-error --instrument two-arms -n 4 -o arms.csv
expect_ok measure arms.csv atlas:plaster-cast --instrument two-arms -o factors.csv
expect_true 'factors' grep -q '^# values: reflectance factor' factors.csv
expect_true 'dark lines' grep -q ',dark,' factors.csv
expect_output 'reflectance factors' info factors.csv
expect_fail 1 'cannot read this direction' measure four.csv atlas:oak-sawn --instrument in-plane -o no.csv
expect_fail 2 'its own noise' measure four.csv atlas:oak-sawn --instrument four-axis --noise 1 -o no.csv

# ---- JSON ----

if command -v jq >"$root/work/jq"; then
    holds() { jq -e "$1" "$root/work/stdout" >"$root/work/jq"; }
    expect_ok check four-axis --json
    expect_true 'the share that is reached' holds '.reach.share > 0.5 and .reach.share < 1'
    expect_ok plan b.gonio --method expected-error --instrument four-axis -n 5 -o four.csv --json
    expect_true 'the run' holds '.run.duration_s <= .run.unordered_s and .run.reached_share > 0.5'
    printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,550nm_per_sr\n20,0,40,180,\n' >one.csv
    expect_ok measure one.csv atlas:oak-sawn --instrument rig.json -o one-run.csv --json
    expect_true 'the channels that are written' holds ".channels == $(grep -c . <<<"$(grep theta_i_deg one-run.csv |
        tr ',' '\n' | grep _per_sr)")"
    expect_ok check four-axis --json
    expect_true 'the axes' holds '.axes.beta.to_deg == 75 and .sensor.saturation_per_sr == null'
else
    skip 'JSON: no jq'
fi

# ---- the picture ----

expect_ok check rig.json -o picture
expect_true 'the data of the picture' grep -q 'theta_i = 20 degrees' picture/reach.csv
if command -v gnuplot >"$root/work/gnuplot"; then
    expect_true 'the picture' test -s picture/reach.svg -a -s picture/reach.png
fi

# ---- a plan as the instrument makes it ----

expect_output 'arms.csv: 4 readings in ' check two-arms arms.csv -o picture
expect_also ' of exposures, ' ' of moves, ' ' of incidence, 2.0 min of references'
expect_true 'the data of the tour' test -s picture/tour.csv
expect_true 'an axis that stands is not drawn' eval '! grep -q stage picture/tour.csv'
expect_true 'the readings are drawn' grep -q 'readings of the plan' picture/reach.gp
sed '12s/^[^,]*/17.5/' arms.csv >edited.csv
checks=$((checks + 1))
gonio check two-arms edited.csv >"$root/work/stdout" 2>"$root/work/stderr" || failed 'check edited.csv'
expect_true 'edited angles are noticed' grep -q 'edited.csv:12: the positions of the axes do not read the angles' \
    "$root/work/stderr"
cut -d, -f1-6,11 edited.csv >plain.csv
expect_ok check two-arms plain.csv
expect_fail 1 'arms.csv:12: the instrument in-plane cannot read theta_i' check in-plane arms.csv
if command -v jq >"$root/work/jq"; then
    expect_ok check two-arms arms.csv --json
    expect_true 'the parts of the time' holds \
        '.run | (.exposures_s + .moves_s + .incidence_changes_s + .references_s - .duration_s | fabs) < 1e-6'
fi

# ---- apertures ----

expect_ok reconstruct b.gonio run.csv --method posterior --predict-at run.csv -o points.csv
expect_ok reconstruct b.gonio run.csv --method posterior --instrument four-axis --predict-at run.csv -o instrument.csv
expect_ok reconstruct b.gonio run.csv --method posterior --aperture 1.2,0.2 --predict-at run.csv -o apertures.csv
expect_true 'apertures count' differ <(grep -v '^#' points.csv) <(grep -v '^#' apertures.csv)
# `next` knows as much of the readings as a reconstruction through the same apertures.
sed 's/"detector_half_angle_deg": [0-9.]*/"detector_half_angle_deg": 9/' "$source/data/instruments/four-axis.json" >wide.json
error_of() { sed -n 's/.*expected error (E6) \(now \)\{0,1\}\([0-9.]*\) %.*/\2/p' "$root/work/stdout"; }
errors=
for rig in four-axis wide.json; do
    expect_ok reconstruct b.gonio run.csv --method posterior --instrument $rig -o known.binary
    known=$(error_of)
    expect_ok next b.gonio run.csv --instrument $rig -n 2 -o next.csv
    expect_true "next by $rig" test -n "$known" -a "$known" = "$(error_of)"
    errors="$errors $known"
done
# shellcheck disable=SC2086
expect_true 'apertures count' test "$(printf '%s\n' $errors | sort -u | wc -l)" = 2

# Numbers of which a file says nothing are what the instrument gives: two-arms reflectance factors.
printf 'theta_i,phi_i,theta_o,phi_o,R,G,B\n15,0,30,180,0.5,0.4,0.3\n30,0,30,180,0.9,0.8,0.7\n' >bare.csv
sed 's/R,G,B/R_per_sr,G_per_sr,B_per_sr/; s/theta_i/incident theta/' bare.csv >stated.csv
taken_as() { # WORDS COMMAND FILE OPTION...
    local words=$1
    expect_ok "$2" b.gonio "$3" --instrument two-arms "${@:4}"
    expect_true "$* takes them so" grep -qF "$words" "$root/work/stderr"
}
taken_as 'reflectance factors (divided by pi)' reconstruct bare.csv --method posterior -o bare.binary
taken_as 'reflectance factors (divided by pi)' next bare.csv -n 1 -o next.csv
taken_as 'values in 1/sr' reconstruct bare.csv --method posterior --as values=brdf -o bare.binary
printf '%s, "values": {"kind": "counts", "counts_of_1_per_sr": 5e5}}' \
    '{"gonio_instrument": 1, "kinematics": "direct", "axes": {"theta_i": {"from_deg": 0, "to_deg": 80},
    "theta_o": {"from_deg": -80, "to_deg": 80}}' >counter.json
printf 'theta_i,phi_i,theta_o,phi_o,counts\n15,0,0,0,50000\n30,0,60,180,50000\n' >counts.csv
expect_ok reconstruct b.gonio bare.csv --instrument counter.json --method posterior -o bare.binary
expect_true 'they are counts' grep -qF 'counts (divided by those of 1/sr and cos theta_o)' "$root/work/stderr"
expect_fail 2 'counts_of_1_per_sr of an instrument file' info -q counts.csv
expect_ok check counter.json counts.csv
sed '2,$s/[0-9]*$//' counts.csv >empty.csv
expect_output '0 measured' info empty.csv
expect_ok info counts.csv --as values=brdf
# By hand: 50,000 counts over 500,000 of 1/sr are 0.1 at theta_o 0, and 0.2 at 60 degrees.
expect_ok convert counts.csv converted.csv --instrument counter.json
expect_true 'counts are converted' awk -F, '/^15/ { a = $NF } /^30/ { b = $NF }
    END { exit !(a > 0.0999999 && a < 0.1000001 && b > 0.1999999 && b < 0.2000001) }' converted.csv
expect_ok info counts.csv --instrument counter.json
expect_true 'info has them in 1/sr' grep -q 'value *0.1 *0.2' "$root/work/stdout"
head -2 counts.csv >first.csv
expect_ok compare converted.csv counts.csv --leave-out first.csv --instrument counter.json
expect_true 'compared as the instrument gives them' grep -q '^counts.csv *0.000' "$root/work/stdout"
expect_ok measure counts.csv counts.csv --instrument counter.json -o looked-up.csv
expect_true 'looked up as the instrument gives them' cmp <(grep -v '^#' looked-up.csv) <(grep -v '^#' converted.csv)
expect_fail 2 'a basis of separate channels' check-isotropy -q b.gonio counts.csv --instrument counter.json
expect_ok report atlas:plaster-cast --readings counts.csv --instrument counter.json -o page.html
expect_fail 2 'counter.json is an input' convert counts.csv counter.json --instrument counter.json
expect_fail 1 'six-axis' info counts.csv --instrument six-axis
taken_as 'values in 1/sr' reconstruct stated.csv --method posterior -o bare.binary
expect_fail 2 '--noise cannot be negative' next b.gonio run.csv --instrument four-axis --noise -1 -o no.csv
expect_fail 2 "--aperture: 'wide' is not a half angle" reconstruct b.gonio run.csv --aperture wide -o no.binary
expect_fail 2 "--aperture: '50' is not a half angle" reconstruct b.gonio run.csv --aperture 50 -o no.binary
expect_fail 2 'apertures need a reconstruction by posterior' \
    reconstruct b.gonio read.csv --method ridge --aperture 2 -o no.binary
expect_fail 1 'six-axis' reconstruct b.gonio run.csv --instrument six-axis -o no.binary

# ---- the schema ----

if python3 -c 'import jsonschema' 2>"$root/work/python"; then
    cat >validate.py <<'END'
import json, sys
import jsonschema
schema = json.load(open(sys.argv[1]))
bad = 0
for path in sys.argv[2:]:
    bad += any(True for _ in jsonschema.Draft7Validator(schema).iter_errors(json.load(open(path))))
print(bad)
END
    expect_true 'the schema accepts the instruments' test "$(python3 validate.py "$source/data/instrument.schema.json" \
        rig.json "$source"/data/instruments/*.json)" = 0
    expect_true 'the schema refuses an unknown key' test "$(python3 validate.py "$source/data/instrument.schema.json" \
        wrong.json)" = 1
else
    skip 'the schema: no jsonschema'
fi

finish
