#!/bin/bash
# gonio convert: readings of an instrument to CSV and BRDF JSON, and what they cannot become.
. "$(dirname "$0")/lib.sh"

cat > fred.txt <<'END'
type bsdf_data
format angles=deg bsdf=value scale=1
30 0
0 0 0.25
30 0 1.5
60 180 0.125
END

rows() { grep -v '^#' "$1"; }

expect_ok convert fred.txt fred.csv
expect_true 'three rows below the names' test "$(rows fred.csv | wc -l)" -eq 4
expect_true 'the mirror direction' test "$(rows fred.csv | grep ',1.5$')" = 30,0,30,180,1.5
expect_ok convert fred.csv fred.json
expect_ok convert fred.json back.csv
expect_true 'CSV to JSON and back' test "$(rows fred.csv)" = "$(rows back.csv)"
expect_ok measure fred.csv fred.txt -o read.json
expect_true 'what is measured is written as JSON' grep -q '"BRDF": {"unit": "sr^-1"' read.json
expect_ok convert read.json read.csv
expect_true 'and is read again' test "$(rows fred.csv)" = "$(rows read.csv)"
expect_ok convert fred.txt --as values=percent percent.csv
expect_true 'per cent of a reflectance factor' \
    test "$(rows percent.csv | grep '^30,0,30,180' | cut -d, -f5)" = 0.004774648293
expect_output '"readings": "fred.txt"' convert fred.txt --json x.json

# Units of one file of several, by its name.
sed 's/0.25/25/; s/1.5/150/; s/0.125/12.5/' fred.txt > hundred.txt
cp fred.txt 'a=b.txt'
expect_ok compare fred.txt hundred.txt
expect_ok compare fred.csv hundred.txt --as hundred.txt:values=percent,format=fred
expect_output '"bias_percent": -113.8' compare fred.csv fred.txt --as fred.txt:values=factor --json
expect_output '"bias_percent": -113.8' compare fred.csv a=b.txt --as a=b.txt:values=factor,format=fred --json
expect_fail 2 "--as names 'other.txt', which is none of the files" \
    compare fred.csv fred.txt --as other.txt:values=factor

# A plan that asks for directions twice is read twice.
printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n30,0,30,180\n30,0,0,0\n30,0,30,180\n' > twice.csv
expect_ok measure twice.csv atlas:red-cotton --noise 1 -o read-twice.csv
expect_true 'each with its own noise' \
    test "$(rows read-twice.csv | grep '^30,0,30,180' | sort -u | wc -l)" -eq 2
expect_ok measure twice.csv fred.txt -o looked-up.csv
expect_true 'looked up twice' test "$(rows looked-up.csv | grep -c ',1.5$')" -eq 2

# A plan is CSV, by whatever name.
expect_fail 2 'a plan is CSV; name it x.csv' plan atlas: -o x.json
expect_fail 2 'a plan is CSV; name it x.csv' next fred.csv -o x.brdf

# An RGL file is a material, and has readings in it.
expect_ok convert atlas:red-cotton cotton.bsdf
expect_output 'RGL isotropic BSDF' info cotton.bsdf
expect_output 'taken as the samples of an RGL .bsdf' info --as format=rgl cotton.bsdf

# Values of CUReT without their directions: one message.
{ printf '2'; for _ in $(seq 205); do printf ' 0.1'; done; echo; } > curet.dat
expect_fail 1 'are expected in table.txt beside it' info curet.dat

expect_fail 1 "these are readings; 'gonio reconstruct fred.txt -o x.binary' makes a material" \
    convert fred.txt x.binary
expect_fail 2 'the choices are brdf, factor' convert -q fred.txt --as values=lux x.csv
finish
