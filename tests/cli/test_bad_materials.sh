#!/bin/bash
# Files that are no material, or a damaged one, given to every command that reads materials.
. "$(dirname "$0")/lib.sh"

expect_ok learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o b.gonio
expect_ok plan b.gonio -n 4 -o p.csv
expect_ok convert atlas:red-cotton good.binary

# every_reader CODE PART FILE: what each command says of a material.
every_reader() {
    case $2 in
        *'not a material that gonio reads') expect_fail "$1" "$3: not a basis that gonio reads" info "$3" ;;
        *', not a material') ;; # but something else that info knows
        *) expect_fail "$1" "$2" info "$3" ;;
    esac
    expect_fail "$1" "$2" convert "$3" x.binary
    expect_fail "$1" "$2" learn "$3" atlas:oak-sawn atlas:plaster-cast -o x.gonio
    expect_fail "$1" "$2" measure p.csv "$3" -o x.csv
    expect_fail "$1" "$2" compare "$3" atlas:oak-sawn
    expect_fail "$1" "$2" compare atlas:oak-sawn "$3"
}

# ---- no file, no access ----

mkdir folder
mkfifo pipe
every_reader 1 'missing.binary: cannot read: No such file' missing.binary
every_reader 1 'good.binary/x: cannot read: Not a directory' good.binary/x
for command in 'info folder' 'convert folder x.binary' 'measure p.csv folder -o x.csv' \
    'compare folder atlas:oak-sawn'; do
    # shellcheck disable=SC2086
    expect_fail 1 'folder: cannot read: Is a directory' $command
done
expect_fail 1 'folder: no materials (*.binary, *.h5) in this folder' learn folder -o x.gonio
expect_fail 1 'pipe: cannot read: not a regular file' report pipe -o x.html
expect_fail 1 "pipe: these are readings; 'gonio reconstruct pipe -o x.binary' makes" convert pipe x.binary
expect_fail 1 "a?b: cannot read: No such file" convert $'a\nb' x.binary
if permissions_apply; then
    cp good.binary secret.binary
    mkdir closed
    chmod 000 secret.binary closed
    runner=as_other_user expect_fail 1 'secret.binary: cannot read: Permission denied' \
        info secret.binary
    runner=as_other_user expect_fail 1 'secret.binary: cannot read: Permission denied' \
        compare atlas:oak-sawn secret.binary
    runner=as_other_user expect_fail 1 'closed: cannot read: Permission denied' \
        learn closed -o x.gonio
    chmod 700 secret.binary closed
else
    skip 'unreadable files: no other user to run as'
fi

# ---- no known format ----

: >empty.binary
head -c 11 good.binary >start.binary
printf 'just some text\n' >text.csv
head -c 4096 /dev/zero | tr '\0' '\1' >noise.binary
every_reader 1 'empty.binary: the file is empty' empty.binary
every_reader 1 'start.binary: not a material that gonio reads' start.binary
every_reader 1 'text.csv: not a material that gonio reads' text.csv
every_reader 1 'noise.binary: not a material that gonio reads' noise.binary
expect_fail 1 "noise.binary: not a basis that gonio reads (gonio basis), nor a material (MERL .binary table, gonio BRDF table .h5, gonio anisotropic table .h5, neural BRDF .h5, \
RGL .bsdf, KAIST .pbsdf, UTIA .bin, BSDF-XML, Zemax BSDF), nor an image (OpenEXR, Radiance .hdr), nor a mesh (OBJ, PLY), nor readings (" info noise.binary
# every_table PART FILE: what is said of readings, which will do where the part is.
every_table() {
    expect_fail 1 "$2: these are readings; 'gonio reconstruct $2 -o x.binary' makes a material" convert "$2" x.binary
    expect_fail 1 "$2: readings (CSV), not a material" report "$2" -o x.html
    expect_fail 1 "$2: readings (CSV), not a material" \
        learn "$2" atlas:oak-sawn atlas:plaster-cast -o x.gonio
    expect_fail 1 "$2: readings (CSV), not a material; 'gonio reconstruct $2 -o NEW.bsdf' makes" render "$2" -o x.png --size 8
    expect_fail 1 "$2: $1" compare atlas:oak-sawn "$2"
    expect_fail 1 "$2: $1" measure p.csv "$2" -o x.csv
    expect_fail 1 "$2: $1" compare "$2" atlas:oak-sawn
}
printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R_per_sr\n' >table.csv
every_table 'no lines below the column names' table.csv
every_table 'no column of values (R_per_sr, G_per_sr, B_per_sr, or 400nm_per_sr ...)' p.csv

# ---- MERL tables of the wrong size ----

head -c 12 good.binary >header.binary
head -c 20000000 good.binary >half.binary
head -c 34992011 good.binary >shorter.binary
{ cat good.binary; printf x; } >longer.binary
every_reader 1 'header.binary: truncated: 12 bytes' header.binary
every_reader 1 'half.binary: truncated: 20000000 bytes' half.binary
expect_fail 1 'shorter.binary: truncated: 34992011 bytes' info shorter.binary
expect_fail 1 'longer.binary: too long: 34992013 bytes' info longer.binary
rm half.binary shorter.binary longer.binary

largest=2147483647
for shape in '0 0 0' '-1 -1 -1' "$largest $largest $largest" "65536 65536 65536" '90 180 90'; do
    # shellcheck disable=SC2086
    { int32 $shape; head -c 24 /dev/zero; } >shape.binary
    expect_fail 1 'shape.binary: not a material that gonio reads' convert shape.binary x.binary
done
for third in $largest 0 -180 179 181 720; do
    { int32 90 90 $third; head -c 24 /dev/zero; } >shape.binary
    expect_fail 1 "shape.binary: header says 90 x 90 x $third bins; gonio reads" info shape.binary
done
{ int32 1 1 1; head -c 24 /dev/zero; } >shape.binary
every_reader 1 'shape.binary: header says 1 x 1 x 1 bins; gonio reads' shape.binary
{ int32 90 90 360; head -c 34992000 /dev/zero; } >folded.binary
expect_fail 1 'folded.binary: truncated: 34992012 bytes where a MERL table of 90 x 90 x 360' \
    info folded.binary
rm folded.binary

# ---- values ----

# The first bin of the grid is valid; its red value is at byte 12.
zero='\x00\x00\x00\x00\x00\x00'
cp good.binary nan.binary
patch nan.binary 12 "$zero\\xf8\\x7f"
expect_output 'valid bins   1096215 of 1096216' info nan.binary
patch nan.binary 20 "$zero\\xf0\\x7f" # infinity
expect_output 'valid bins   1096214 of 1096216' info nan.binary
patch nan.binary 28 "$zero\\xf0\\xff" # minus infinity
expect_output 'valid bins   1096213 of 1096216' info nan.binary
expect_output '3 bins of the reference have no data here' compare good.binary nan.binary
expect_ok convert nan.binary holes.binary
expect_output '1096213 bins compared, 0 of' compare nan.binary holes.binary -v
patch nan.binary 36 "$zero\\xd0\\x7e" # 1e300 is a number
expect_output 'valid bins   1096213 of 1096216' info nan.binary
expect_output '"peak_per_sr"' info --json nan.binary
expect_output '"e6_percent"' compare --json good.binary nan.binary
rm nan.binary holes.binary

# Slightly negative numbers beside data are 0; -1 in any channel is no data.
cp good.binary negative.binary
patch negative.binary 12 "$zero\\xc0\\xbf" # -0.125
expect_output 'valid bins   1096216 of 1096216' info negative.binary
expect_ok convert negative.binary zero.binary
expect_true 'a note says so' grep -q 'slightly negative numbers in a channel; 0 is taken' \
    "$root/work/stderr"
cp good.binary by-hand.binary
patch by-hand.binary 12 "$zero\\x00\\x00"
expect_ok convert by-hand.binary again.binary
expect_same zero.binary again.binary
patch negative.binary 12 "$zero\\xf0\\xbf" # -1
expect_output 'valid bins   1096215 of 1096216' info negative.binary
rm negative.binary zero.binary by-hand.binary again.binary

# Energy is not judged where directions have no data; the first 30 slabs have none.
{ head -c 12 good.binary; head -c 3888000 /dev/zero | tr '\0' '\377'; tail -c +3888013 good.binary; } >holes.binary
expect_output 'energy       not known: directions without data reflect too' info holes.binary
expect_output 'of the hemisphere has data' info holes.binary
expect_output '"conserves_energy": null' info --json holes.binary
expect_output '"conserves_energy": true' info --json good.binary
rm holes.binary

for none in 377 277; do # NaN everywhere; -0.12 everywhere
    uniform_table $none >none.binary
    expect_output 'valid bins   0 of 1096216' info none.binary
    expect_output '"valid_bins": 0' info --json none.binary
    expect_fail 1 'none.binary: the material holds no data' \
        learn atlas:oak-sawn none.binary atlas:plaster-cast -o x.gonio
    expect_fail 1 'none.binary: the material holds no data' \
        learn none.binary none.binary -o x.gonio
    expect_fail 1 'p.csv:11: the material has no data around' measure p.csv none.binary -o x.csv
    expect_fail 1 'none and good have data in no common bin' compare none.binary good.binary
    expect_fail 1 'good and none have data in no common bin' compare good.binary none.binary
done
uniform_table 000 >black.binary
expect_fail 1 'black is black' compare black.binary good.binary
expect_ok compare good.binary black.binary
expect_ok measure p.csv black.binary -o black.csv
rm none.binary black.csv

# One channel black: an error relative to nothing is no number, and JSON has none.
{ head -c 23328012 good.binary; head -c 11664000 /dev/zero; } >yellow.binary
expect_output '"e6_percent": null' compare --json yellow.binary good.binary
rm yellow.binary black.binary

# ---- two bad files at once are told one at a time ----

expect_fail 1 'cannot read' learn no-1 no-2 no-3 no-4 --threads 4 -o x.gonio
expect_fail 1 "two materials are called 'good'" \
    learn good.binary good.binary atlas:oak-sawn -o x.gonio
expect_fail 1 "two materials are called 'oak-sawn'" \
    learn atlas:oak-sawn atlas:oak-sawn atlas:plaster-cast -o x.gonio
cp good.binary copy.binary
expect_fail 1 'span only 1 dimensions' \
    learn --grid bivariate good.binary copy.binary atlas:oak-sawn --components 2 -o x.gonio
rm copy.binary

# ---- HDF5 of another kind, and neural BRDFs ----

every_reader 1 'b.gonio: a basis (gonio basis), not a material' b.gonio
printf '\x89HDF\r\n\x1a\n' >signature.h5
every_reader 1 'signature.h5: cannot be opened as HDF5: damaged or truncated' signature.h5

real=${GONIO_SHARED:-}/data/neural-merl/chrome.h5
if [ ! -r "$real" ]; then
    skip 'damaged neural BRDFs: no folder of shared data ($GONIO_SHARED)'
    finish
fi

# with FROM TO: the real file with one text replaced by another of the same length.
with() { sed "s/$1/$2/" "$real" >bad.h5; }

cat "$real" >good.h5
expect_output 'neural BRDF 6-21-21-3' info good.h5
expect_output 'seam         ln(1 + rho/s) jumps by 0.111 at phi_d = 0, by 0.0031 elsewhere' info good.h5
if command -v flock >/dev/null; then # as HDF5 does of a program that has it open for writing
    flock good.h5 "$GONIO" info good.h5 >/dev/null || failed 'a file that another program has open'
fi
head -c 10000 "$real" >half.h5
every_reader 1 'half.h5: cannot be opened as HDF5: damaged or truncated' half.h5
with layer_names layer_nomes
every_reader 1 "bad.h5: an HDF5 file, but not a neural BRDF: it has no attribute 'layer_names'" \
    bad.h5
with weight_names weight_nomes
expect_fail 1 "has no attribute 'weight_names'" info bad.h5
with dense_1 dense_9
expect_fail 1 'bad.h5: ' info bad.h5

# The weights of the first layer stand at bytes 8192 (kernel) and 8696 (bias) of this file.
cat "$real" >bad.h5
patch bad.h5 8192 '\x00\x00\xc0\x7f'
every_reader 1 "kernel:0' holds a number that is not finite" bad.h5
cat "$real" >bad.h5
patch bad.h5 8700 '\x00\x00\x80\xff'
every_reader 1 "bias:0' holds a number that is not finite" bad.h5

# A finite but absurd weight, 2e38, gives finite values.
cat "$real" >bad.h5
patch bad.h5 8192 '\x99\x76\x16\x7f'
expect_output 'valid bins   1096216 of 1096216' info bad.h5
expect_ok convert bad.h5 absurd.binary
expect_output 'valid bins   1096216 of 1096216' info absurd.binary

finish
