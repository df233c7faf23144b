#!/usr/bin/env bash
# Readings on a grid, as Zemax files have them: readings where readings are wanted, and a material
# where a material is.
. "$(dirname "$0")/lib.sh"

zemax() { # ROTATIONS-AND-COUNT BLOCKS...
    printf 'Symmetry ASymmetrical4D\nScatterType BRDF\nSampleRotation %s\n' "$1"
    printf 'AngleOfIncidence 2\n10 50\nScatterAzimuth 3\n0 90 180\nScatterRadial 3\n0 30 120\n'
    printf 'Monochrome\nDataBegin\n'
    shift
    printf 'TIS 0.1\n%s 0.2 0.1\n%s 0.2 0.1\n%s 0.3 0.1\n' "$@"
    printf 'DataEnd\n'
}

zemax $'1\n0' 1 1 1 2 2 2 > round.bsdf
zemax $'4\n0 45 90 135' 1 1 1 2 2 2 3 3 3 4 4 4 5 5 5 6 6 6 7 7 7 8 8 8 > turned.bsdf
zemax $'2\n0 20' 1 1 1 2 2 2 3 3 3 4 4 4 > few.bsdf

expect_output '"kind": "readings"' info --json turned.bsdf
expect_ok convert turned.bsdf readings.csv
expect_ok convert turned.bsdf grid.xml
expect_output '"anisotropic": true' info --json grid.xml
expect_ok learn turned.bsdf round.bsdf --grid bivariate -o mean.gonio
expect_true 'what is learned of an anisotropic material is said' \
    grep -q 'note: turned: anisotropic; its mean over azimuths of the sample is learned' "$root/work/stderr"
expect_output 'from": "Zemax BSDF, 1 rotation x 2 incidences x 3 azimuths x 3"' convert --json round.bsdf r.xml
expect_fail 2 'cannot hold; .bsdf, .h5, .xml and .csv can' convert turned.bsdf x.binary
expect_fail 1 'is no whole, half or quarter turn' convert few.bsdf few.xml
# Files of other programs that are not read are named; keys in small letters are read.
printf 'PK\003\004\024' >book.xlsx
printf 'OPTIS - Anisotropic BSDF surface file v8.0\n0\n' >x.anisotropicbsdf
expect_fail 1 'a workbook (.xlsx, .ods) or another ZIP archive' info book.xlsx
expect_fail 1 'save the sheet as CSV' convert book.xlsx x.csv
expect_fail 1 'a scattering file of Speos' reconstruct x.anisotropicbsdf -o x.binary
tr 'A-Z' 'a-z' <round.bsdf | sed 's/e+/E+/' >small.bsdf
expect_ok convert -q small.bsdf small.csv
expect_ok convert -q round.bsdf large.csv
expect_true 'small letters are read' cmp <(grep -v '^#' small.csv) <(grep -v '^#' large.csv)
printf 'no table at all' >words.txt
expect_fail 1 'nor readings (' convert words.txt x.binary
expect_fail 1 "'gonio reconstruct readings.csv -o x.xml' makes a material of them" convert readings.csv x.xml

# Values at directions that the grid lacks are interpolated: ln 2 is halfway between 1 and 4.
printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n10,45,10,225\n10,0,10,180\n' > own.csv
printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n30,0,30,180\n' > other.csv
expect_ok measure own.csv turned.bsdf -o own-read.csv
expect_true 'its own rotation' test "$(grep '^10,45' own-read.csv | cut -d, -f5)" = 3
run measure other.csv turned.bsdf -o other-read.csv
grep -q '1 of 1 directions are none of its own: values are interpolated' "$root/work/stderr" ||
    failed 'interpolation is not said'
expect_true 'between 1 and 2' test "$(grep '^30,0' other-read.csv | cut -d, -f5 | cut -c1-7)" = 1.41421
expect_output '0.000     0.000    0.0000' compare turned.bsdf turned.bsdf
expect_output ' 1 readings compared' compare other-read.csv turned.bsdf

expect_ok render turned.bsdf --size 16 --samples 4 -o turned.png

finish
