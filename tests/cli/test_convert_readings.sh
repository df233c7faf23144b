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

# An RGL file is a material, and has readings in it.
expect_ok convert atlas:red-cotton cotton.bsdf
expect_output 'RGL isotropic BSDF' info cotton.bsdf
expect_output 'taken as the samples of an RGL .bsdf' info --as format=rgl cotton.bsdf

# Values of CUReT without their directions: one message.
{ printf '2'; for _ in $(seq 205); do printf ' 0.1'; done; echo; } > curet.dat
expect_fail 1 'are expected in table.txt beside it' info curet.dat

expect_fail 1 "these are readings; 'gonio reconstruct' makes a material of them" \
    convert fred.txt x.binary
expect_fail 2 'the choices are brdf, factor' convert -q fred.txt --as values=lux x.csv
finish
