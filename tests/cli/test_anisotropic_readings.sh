#!/usr/bin/env bash
# Materials that change as the sample turns: plan, measure, check, reconstruct, next; what is refused.
. "$(dirname "$0")/lib.sh"

expect_ok learn atlas:gold-polished atlas:red-glossy-plastic atlas:burgundy-velvet atlas:steel-brushed \
    --mixtures 30 -o b.gonio
brushed=atlas:brass-wheel-brushed

# Few candidates: plans over the whole grid are tried by property/anisotropic.
awk 'BEGIN {
    OFS = ","
    print "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg"
    for (k = 1; k <= 300; k++)
        print k * 37 % 80, k * 101 % 360, k * 53 % 79, k * 67 % 360
}' >candidates.csv
awk 'NR == 1 || NR % 10 == 5' candidates.csv >all.csv
expect_output 'p.csv: 40 readings, in order of use; expected error (E6) ' \
    plan b.gonio --anisotropic --candidates candidates.csv -n 40 -o p.csv
expect_ok plan b.gonio --anisotropic --candidates candidates.csv -n 40 --threads 1 -q -o same.csv
expect_same <(grep -v '^#' p.csv) <(grep -v '^#' same.csv)
expect_ok measure p.csv $brushed -o r.csv
expect_ok measure all.csv $brushed -o truth.csv

expect_output 'from 40 readings in 3 channels; expected error (E6) ' \
    reconstruct b.gonio r.csv --anisotropic --predict-at truth.csv -o at.csv
expect_also 'anisotropic (' 'grain at '
expect_output '"rotation_deg": ' \
    reconstruct b.gonio r.csv --anisotropic --json --predict-at truth.csv -o at.csv
expect_true 'predictions have deviations' grep -q 'R_deviation_per_sr' at.csv
expect_ok reconstruct b.gonio r.csv --no-checks --predict-at truth.csv -o isotropic.csv
error() { "$GONIO" compare "$@" | sed -n '2s/^[^ ]* *\([0-9]*\)\..*/\1/p'; }
expect_true 'better than the isotropic model' \
    test "$(error truth.csv at.csv)" -lt "$(error truth.csv isotropic.csv)"

# ---- as a material ----

if writes_hdf5; then
    expect_output ', albedo at most ' reconstruct b.gonio r.csv --anisotropic -o m.h5
    expect_output 'gonio anisotropic BRDF table 90 x 90 x 36, 7 orders of phi_h, 2-fold, 3 channels' info m.h5
    expect_true 'the table is the prediction' \
        test "$(error at.csv m.h5)" -eq 0
    expect_output '"largest_albedo": 0.' reconstruct b.gonio r.csv --anisotropic --json --threads 1 \
        -o same.h5
    expect_same m.h5 same.h5
else
    expect_fail 2 'm.h5: this gonio was built without HDF5' reconstruct b.gonio r.csv --anisotropic -o m.h5
fi
expect_ok reconstruct b.gonio r.csv --anisotropic -o m.bsdf
expect_output 'RGL anisotropic BSDF' convert --json m.bsdf copy.bsdf
expect_fail 2 'cannot hold; .bsdf, .h5, .xml and .csv can' \
    reconstruct b.gonio r.csv --anisotropic -o m.binary
expect_true 'nothing is left behind' test ! -e m.binary
expect_ok reconstruct b.gonio r.csv --anisotropic --average-azimuths -o mean.binary
expect_true 'the loss is stated' \
    grep -q 'the mean over azimuths differs from the anisotropic material by' "$root/work/stderr"
expect_fail 2 '--albedo-at is of isotropic materials' \
    reconstruct b.gonio r.csv --anisotropic --albedo-at 0 -o m.h5

# ---- noticed and checked ----

expect_ok reconstruct b.gonio r.csv -o isotropic.binary
expect_true 'anisotropy is noticed' grep -q 'note: .*the material seems anisotropic' "$root/work/stderr"
expect_true 'and not taken for wrong azimuths' test "$(grep -c 'phi_o' "$root/work/stderr")" -eq 0
expect_output '"anisotropic": true' reconstruct b.gonio r.csv --json -o isotropic.binary
expect_output 'r.csv: anisotropic with a probability of ' check-isotropy b.gonio r.csv
expect_output '"isotropic": ' check-isotropy b.gonio r.csv --json
expect_ok measure p.csv atlas:red-glossy-plastic -o plastic.csv
expect_output 'plastic.csv: isotropic with a probability of ' check-isotropy b.gonio plastic.csv
expect_ok plan b.gonio -n 10 -o flat.csv
expect_ok measure flat.csv $brushed -o flat-readings.csv
expect_output 'cannot tell: all readings are at one azimuth' check-isotropy b.gonio flat-readings.csv

# ---- what to read next ----

expect_output 'next.csv: 5 more readings; expected error (E6) now ' \
    next b.gonio r.csv --anisotropic --candidates candidates.csv -n 5 -o next.csv

# ---- what is refused ----

expect_fail 2 '--symmetry must be 1, 2 or 4' \
    reconstruct b.gonio r.csv --anisotropic --symmetry 3 --predict-at truth.csv -o x.csv
expect_fail 2 '--anisotropic needs --method posterior' \
    reconstruct b.gonio r.csv --anisotropic --method ridge --predict-at truth.csv -o x.csv
expect_fail 2 '--anisotropic needs --method expected-error' \
    plan b.gonio --anisotropic --method random -n 5 -o x.csv
expect_fail 2 'metric e6' plan b.gonio --anisotropic --metric cube-root -n 5 -o x.csv
expect_fail 2 'READINGS are needed' check-isotropy
expect_fail 1 'missing.csv: cannot read' check-isotropy b.gonio missing.csv

finish
