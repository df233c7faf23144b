#!/bin/bash
# The methods that plans are compared with, from the materials to the BRDF.
. "$(dirname "$0")/lib.sh"

materials='atlas:oak-sawn atlas:gold-polished atlas:plaster-cast atlas:red-cotton atlas:steel-brushed'
# shellcheck disable=SC2086
{
    expect_ok learn --grid bivariate $materials -o log.gonio
    expect_output '12 components from 5 materials' \
        learn --grid bivariate $materials --mapping relative --channels separate -K 12 -o relative.gonio
    expect_output '5 components from 5 materials' learn --grid bivariate $materials --no-mean -o materials.gonio
}
expect_output 'mapping      log, with mean' info log.gonio
expect_output 'mapping      relative, with mean' info relative.gonio
expect_output 'mapping      log, without mean' info materials.gonio
expect_output '"mean": false' info --json materials.gonio

# chain METHOD BASIS N K RECONSTRUCTION: plans, measures, reconstructs as the plan says and as told.
chain() {
    expect_output "$3 readings for $4 components" plan "$2" --method "$1" -n "$3" -o p.csv
    expect_output "method       $1" info p.csv
    expect_ok plan "$2" --method "$1" -n "$3" --threads 1 -q -o same.csv
    expect_true "$1: one thread, the same plan" cmp -s <(grep -v '^#' p.csv) <(grep -v '^#' same.csv)
    expect_ok measure p.csv atlas:walnut-oiled -o r.csv
    expect_ok reconstruct "$2" r.csv -o default.binary
    expect_ok reconstruct "$2" r.csv --method "$5" -o named.binary
    expect_same default.binary named.binary
}
chain matusik materials.gonio 12 5 least-squares
expect_ok reconstruct materials.gonio r.csv --method ridge -o ridge.binary
expect_true 'ridge is another result' test "$(cmp -s ridge.binary default.binary; echo $?)" -eq 1
chain frost relative.gonio 7 7 ridge
chain nielsen relative.gonio 7 7 ridge
expect_ok reconstruct relative.gonio r.csv --eta 40 -o eta.binary
expect_same eta.binary default.binary
expect_ok reconstruct relative.gonio r.csv --eta 1 -o eta.binary
expect_true 'eta matters' test "$(cmp -s eta.binary default.binary; echo $?)" -eq 1
chain nielsen relative.gonio 20 12 ridge

# On bases of other kinds: what makes sense works, the rest says which basis it takes.
expect_ok plan log.gonio --method nielsen -n 4 -o x.csv
expect_ok plan log.gonio --method frost -n 4 -o x.csv
expect_fail 2 'gonio learn --no-mean --grid full' plan log.gonio --method matusik -n 9 -o y.csv
expect_fail 2 'frost plans a reading for each component: 5 readings need a basis with as many' \
    plan log.gonio --method frost -n 5 -o y.csv
expect_fail 2 '4 readings cannot determine 5 coefficients' \
    plan materials.gonio --method matusik -n 4 -o y.csv

# Readings that no plan belongs to; few of them.
sed '/^#/d' r.csv | head -4 >free.csv
expect_fail 1 '3 readings in R of which 3 are independent cannot determine 12 coefficients' \
    reconstruct relative.gonio free.csv -o x.binary
expect_output '3 coefficients from 3 readings' \
    reconstruct relative.gonio free.csv --method ridge -o x.binary
expect_output '12 coefficients from 3 readings' \
    reconstruct relative.gonio free.csv --method ridge -K 12 -o x.binary
sed '4,$s/,[^,]*,[^,]*,[^,]*$/,,,/; 2,3s/,[^,]*,[^,]*,[^,]*$/,,,/' free.csv >empty.csv
expect_fail 1 'no usable reading in R to determine 3 coefficients from' \
    reconstruct relative.gonio empty.csv --method ridge -o x.binary

expect_fail 2 "no reconstruction method is called 'lasso'" \
    reconstruct relative.gonio free.csv --method lasso -o x.binary
expect_fail 2 '--eta must be above 0' reconstruct relative.gonio free.csv --eta 0 -o x.binary
expect_fail 2 '--eta must be above 0' reconstruct relative.gonio free.csv --eta nan -o x.binary
expect_fail 2 'eta must be above 0' \
    reconstruct relative.gonio free.csv --method ridge --eta inf -o x.binary

finish
