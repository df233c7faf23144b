#!/usr/bin/env bash
# Anisotropic materials on the command line: listed, described, compared over phi_h, written in
# formats that hold them, refused by others, averaged if that is asked for.
. "$(dirname "$0")/lib.sh"

steel=atlas:steel-hairline

expect_output 'atlas:steel-hairline               brushed metal, anisotropic' info atlas:

# Patches, which are looked up sooner than formulas.
expect_ok convert $steel k.xml
expect_output '"anisotropic": true' info --json k.xml
expect_also '"conserves_energy": true' '"turned_90_e6_percent": '

expect_fail 2 'cannot hold; .bsdf, .h5, .xml and .csv can' convert $steel a.binary
expect_fail 2 'cannot hold; .bsdf, .h5, .xml and .csv can' convert $steel --format zemax a.bsdf

expect_ok convert $steel a.bsdf
expect_output 'RGL anisotropic BSDF, RGB, 48 x 48 at 273 incidences' convert --json a.bsdf b.bsdf
expect_output ' directions compared, ' compare -v k.xml a.bsdf
expect_output '0.000     0.000    0.0000' compare a.bsdf b.bsdf
if ! writes_hdf5; then
    expect_fail 2 'a.h5: this gonio was built without HDF5' convert $steel a.h5
    expect_fail 2 'a.csv: this gonio was built without HDF5' convert $steel --format table a.csv
elif full; then
    expect_ok convert k.xml k.h5
    expect_output 'gonio anisotropic BRDF table 90 x 90 x 36, 13 orders of phi_h, 2-fold' info k.h5
    expect_also 'turned by 90 degrees it differs by'
fi

# The mean, with what it lacks.
run convert k.xml --average-azimuths mean.binary
grep -q 'the mean over azimuths differs from the anisotropic material by' "$root/work/stderr" ||
    failed 'the loss of the mean is not stated'
expect_output 'MERL table' info mean.binary
run convert k.xml --average-azimuths --format zemax --steps 30,30,30 mean.bsdf
grep -q 'the mean over azimuths differs from the anisotropic material by' "$root/work/stderr" ||
    failed 'the loss of the mean is not stated of a Zemax file'

# Readings see the azimuth of the sample.
printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n30,0,50,180\n30,90,50,270\n' >two.csv
expect_ok measure two.csv $steel -o readings.csv
values=$(grep -v '^#' readings.csv | tail -n 2 | cut -d , -f 5 | sort -u | wc -l)
[ "$values" -eq 2 ] || failed 'two azimuths have one value'

# Rendered along tangents: the sample's rotation shows, and not of isotropic materials.
small='--size 16 --samples 2 --light directional'
run render atlas:oak-sawn $small -o probe.png
if grep -q 'without the renderer' "$root/work/stderr"; then
    skip 'rendering: not built'
    finish
fi
for shape in '' --flat; do
    expect_ok render $steel $small $shape -o a.png
    expect_ok render $steel $small $shape --grain 90 -o b.png
    expect_ok render $steel $small $shape --grain 360 --threads 1 -o c.png
    cmp -s a.png b.png && failed 'the rotation of the sample does not show'
    cmp -s a.png c.png || failed 'a whole turn of the sample shows'
    expect_ok render atlas:oak-sawn $small $shape -o a.png
    expect_ok render atlas:oak-sawn $small $shape --grain 90 -o b.png
    cmp -s a.png b.png || failed 'the rotation of an isotropic sample shows'
done
expect_fail 2 '--flat and --mesh exclude each other' render $steel --flat -m x.obj -o x.png

finish
