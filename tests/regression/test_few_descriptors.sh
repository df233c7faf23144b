#!/bin/bash
# Thirty-two open files are enough for any number of readings.
. "$(dirname "$0")/../cli/lib.sh"
"$FUZZ_SEEDS" "$root/seeds" || exit 1
cp "$root/seeds/basis/0.gonio" b.gonio
mkdir out
names=theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value_per_sr
for k in {10..49}; do
    printf '%s\n30,0,40,180,0.%s\n30,0,60,180,0.21\n50,0,20,90,0.26\n' $names "$k" >r"$k".csv
done
few() (ulimit -n 32 && exec "$GONIO" "$@")
runner=few
expect_ok reconstruct b.gonio r??.csv --format csv -o out
expect_true 'all are there' test "$(find out -type f | wc -l)" = 40
expect_ok compare out/r10.csv out/r11.csv
expect_ok info out/r10.csv
expect_ok next b.gonio r10.csv -n 2 -o next.csv
finish
