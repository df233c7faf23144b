#!/bin/bash
# gonio check: instruments in words, as JSON and as a picture; the schema knows what the program knows.
source=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/lib.sh"

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

# ---- JSON ----

if command -v jq >"$root/work/jq"; then
    expect_ok check four-axis --json
    expect_true 'the share that is reached' jq -e '.reach.share > 0.5 and .reach.share < 1' "$root/work/stdout"
    expect_true 'the axes' jq -e '.axes.beta.to_deg == 75 and .sensor.saturation_per_sr == null' "$root/work/stdout"
else
    skip 'JSON: no jq'
fi

# ---- the picture ----

expect_ok check rig.json -o picture
expect_true 'the data of the picture' grep -q 'theta_i = 20 degrees' picture/reach.csv
if command -v gnuplot >"$root/work/gnuplot"; then
    expect_true 'the picture' test -s picture/reach.svg -a -s picture/reach.png
fi

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
