#!/bin/bash
# gonio render and compare --render: what they leave, and input that cannot be used.
. "$(dirname "$0")/lib.sh"

small='--size 16 --samples 4'
# shellcheck disable=SC2086
expect_ok render atlas:oak-sawn $small -o probe.png
if [ ! -s probe.png ]; then
    printf 'SKIPPED: built without the renderer\n'
    exit 0
fi

# hex [OD OPTION...] [FILE]: bytes in hexadecimal digits, by what coreutils has
hex() { od -An -v -tx1 "$@" | tr -d ' \n'; }

# ---- what it leaves ----

# shellcheck disable=SC2086
{
    expect_output 'a.png: gold-polished, 24 x 16 pixels, 4 samples' \
        render atlas:gold-polished --size 24x16 --samples 4 -o a.png
    expect_ok render atlas:gold-polished --size 24x16 --samples 4 --threads 1 -o one.png
    expect_same a.png one.png
    expect_ok render atlas:gold-polished $small --seed 1 -o seed.exr
    expect_ok render atlas:gold-polished $small --seed 1 --threads 3 -o again.exr
    expect_same seed.exr again.exr
    for how in '-e sky --show-environment --turn 40' '-e furnace --fov 0' '--light point --light-at 0,30,3' \
        '--light directional --view 20,-10'; do
        expect_ok render atlas:oak-sawn $small $how -o how.png
    done
    expect_ok render atlas:oak-sawn $small -e seed.exr -o lit.png # an image of ours as environment
}
expect_true 'the magic number of PNG' test "$(hex -N 4 a.png)" = 89504e47
expect_true 'the magic number of OpenEXR' test "$(hex -N 4 seed.exr)" = 762f3101

printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >t.obj
# shellcheck disable=SC2086
expect_ok render atlas:oak-sawn $small -m t.obj -o mesh.png
expect_true 'missing normals are told' grep -q 't.obj: lacks normals' "$root/work/stderr"

# shellcheck disable=SC2086
{
    expect_output 'c.png: 2 x 2 renderings' render --compare --columns 2 atlas:oak-sawn atlas:red-cotton \
        atlas:gold-polished atlas:red-cotton $small --labels 'original,another' --differences -o c.png
    expect_output 'c.png: 1 x 3 renderings' render --compare atlas:oak-sawn atlas:red-cotton atlas:oak-sawn \
        $small -o c.png
    # Cairo is loaded for pictures with text alone. Where it cannot be, that is said.
    mkdir "$root/work/libraries"
    : >"$root/work/libraries/libcairo.so.2"
    LD_LIBRARY_PATH=$root/work/libraries expect_ok render atlas:oak-sawn $small -o without.png
    LD_LIBRARY_PATH=$root/work/libraries expect_fail 1 'a library cannot be loaded: ' \
        render --compare atlas:oak-sawn atlas:red-cotton $small -o d.png
}
if full; then
    expect_output 'PSNR dB' compare --render atlas:oak-sawn atlas:oak-sawn
fi
expect_output '"delta_e_itp": 0.0' compare --render --json atlas:oak-sawn atlas:oak-sawn

# ---- the command line ----

r='render atlas:oak-sawn'
# shellcheck disable=SC2086
{
    expect_fail 2 'no output: give -o FILE' $r
    expect_fail 2 'must end in .png or .exr' $r -o x.jpg
    expect_fail 2 'must end in .png' render --compare atlas:oak-sawn atlas:red-cotton -o x.exr
    expect_fail 2 'one MATERIAL is needed' $r atlas:red-cotton -o x.png
    expect_fail 2 'at least one OTHER' render --compare atlas:oak-sawn -o x.png
    expect_fail 2 'do not fill rows of 2' render --compare --columns 2 atlas:oak-sawn atlas:red-cotton atlas:oak-sawn -o x.png
    expect_fail 2 'must be 2 names' render --compare atlas:oak-sawn atlas:red-cotton $small --labels a -o x.png
    expect_fail 2 'go with --compare' $r --columns 2 -o x.png
    expect_fail 2 '0 x 16 pixels' $r --size 0x16 -o x.png
    expect_fail 2 '0 x 0 pixels' $r --size 0 -o x.png
    expect_fail 2 'each side must be 1 to 65536' $r --size 99999999999999999999 -o x.png
    for size in 1x2x3 -5 x5 5x abc ''; do
        expect_fail 2 'is not N or WIDTHxHEIGHT' $r --size "$size" -o x.png
    done
    expect_fail 2 '--samples: 0 is too small' $r --samples 0 -o x.png
    expect_fail 2 '--seed: -1 is too small' $r --seed -1 -o x.png
    expect_fail 2 '--key: 0 must be above 0' $r --key 0 -o x.png
    expect_fail 2 '--fov: 180' $r --fov 180 -o x.png
    expect_fail 2 "--view: '1' is not" $r --view 1 -o x.png
    expect_fail 2 "--view: '0,91' is not" $r --view 0,91 -o x.png
    expect_fail 2 "--light: 'sun' is neither" $r --light sun -o x.png
    expect_fail 2 'exclude each other' $r --light point -e sky -o x.png
    expect_fail 2 'distance 0.5 must be above 1' $r --light point --light-at 0,0,0.5 -o x.png
    expect_fail 2 'is not AZIMUTH,ELEVATION' $r --light directional --light-at 0,0,2 -o x.png
}
cp t.obj t.obj.png
# shellcheck disable=SC2086
expect_fail 2 't.obj.png is an input' $r -m t.obj.png -o t.obj.png

# ---- meshes ----

# mesh CODE PART TEXT
mesh() {
    printf "$3" >bad.mesh
    # shellcheck disable=SC2086
    expect_fail "$1" "$2" $r $small -m bad.mesh -o x.png
}
mesh 1 'bad.mesh: the file is empty' ''
mesh 1 'bad.mesh: not a mesh that gonio reads' 'solid cube\nendsolid\n'
mesh 1 'no faces' 'v 0 0 0\nv 1 0 0\nv 0 1 0\n'
mesh 1 'none of its triangles has an area' 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n'
mesh 1 'bad.mesh:4: cannot be read as OBJ: a face names a corner that does not exist' 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n'
mesh 1 'its header does not end' 'ply\nformat ascii 1.0\nelement vertex 3\n'
mesh 1 'it is cut short' 'ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n'
mesh 1 "bad.mesh:3: cannot be read as PLY: 'element vertex many'" 'ply\nformat ascii 1.0\nelement vertex many\n'
mesh 1 'is not finite' 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\nnan 2 3\n'
mesh 1 'names a corner that does not exist' 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n1 2 3\n3 0 0 7\n'
# shellcheck disable=SC2086
{
    expect_fail 1 'missing.ply: cannot read: No such file' $r -m missing.ply -o x.png
    expect_fail 1 '.: cannot read: Is a directory' $r -m . -o x.png
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n' >flat.obj
    run $r $small -m flat.obj -o flat.png || failed 'a flat triangle' "$(cat "$root/work/stderr")"
    expect_true 'flat triangles are told' grep -q 'warning: flat.obj: 1 of 2 triangles have no area' "$root/work/stderr"
}

# ---- environments ----

# radiance FILE WIDTH BYTES
radiance() { printf "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X $2\n$3" >"$1"; }
radiance black.hdr 2 '\0\0\0\0\0\0\0\0'
radiance good.hdr 2 '\200\200\200\200\200\200\200\200'
radiance short.hdr 2000 '\200'
# shellcheck disable=SC2086
{
    expect_ok $r $small -e good.hdr -o hdr.png
    expect_fail 1 'black.hdr: the environment is all black' $r $small -e black.hdr -o x.png
    expect_fail 1 'nowhere: cannot read: No such file' $r $small -e nowhere -o x.png
    expect_fail 1 't.obj: not an image that gonio reads' $r $small -e t.obj -o x.png
    expect_fail 1 'a.png: not an image that gonio reads' $r $small -e a.png -o x.png
    head -c 300 seed.exr >torn.exr
    expect_fail 1 'torn.exr: cannot be read as OpenEXR' $r $small -e torn.exr -o x.png
    head -c 8 seed.exr >head.exr
    expect_fail 1 'head.exr: cannot be read as OpenEXR' $r $small -e head.exr -o x.png
    radiance wide.hdr 99999999 '\200'
    expect_fail 1 'wide.hdr: ' $r $small -e wide.hdr -o x.png
}

# openexr FILE WIDTH BLUE GREEN RED: one line of pixels, uncompressed; a channel is WIDTH floats as printf has them.
openexr() {
    local box one='\x00\x00\x80\x3f'
    box=$(int32 0 0 $(($2 - 1)) 0 | hex | sed 's/../\\x&/g')
    {
        printf '\x76\x2f\x31\x01\x02\x00\x00\x00channels\x00chlist\x00'
        int32 55
        for name in B G R; do
            printf '%s\x00' $name
            int32 2 0 1 1
        done
        printf '\x00compression\x00compression\x00\x01\x00\x00\x00\x00'
        printf "dataWindow\\x00box2i\\x00\\x10\\x00\\x00\\x00$box"
        printf "displayWindow\\x00box2i\\x00\\x10\\x00\\x00\\x00$box"
        printf 'lineOrder\x00lineOrder\x00\x01\x00\x00\x00\x00'
        printf "pixelAspectRatio\\x00float\\x00\\x04\\x00\\x00\\x00$one"
        printf 'screenWindowCenter\x00v2f\x00\x08\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00'
        printf "screenWindowWidth\\x00float\\x00\\x04\\x00\\x00\\x00$one\\x00"
    } >"$1"
    int32 $(($(stat -c %s "$1") + 8)) 0 >"$root/work/offset"
    {
        cat "$root/work/offset"
        int32 0 $((12 * $2))
        printf "$3$4$5"
    } >>"$1"
}

# --repair takes pixels that cannot be light as black, all of their channels.
one='\x00\x00\x80\x3f' minus_one='\x00\x00\x80\xbf' zero='\x00\x00\x00\x00' nan='\x00\x00\xc0\x7f' infinity='\x00\x00\x80\x7f'
# shellcheck disable=SC2086
{
    openexr dark.exr 2 $one$zero $one$zero $one$zero
    openexr light.exr 2 $one$one $one$one $one$one
    expect_ok $r $small -e dark.exr -o dark-lit.exr
    expect_ok $r $small -e light.exr -o light-lit.exr
    expect_true 'the second pixel lights' test "$(cmp -s dark-lit.exr light-lit.exr; echo $?)" -eq 1
    for bad in $minus_one $nan $infinity; do
        openexr bad.exr 2 $one$bad $one$one $one$one
        expect_fail 1 '--repair replaces such pixels by black' $r $small -e bad.exr -o x.png
        run $r $small -e bad.exr --repair -o repaired.exr || failed '--repair' "$(cat "$root/work/stderr")"
        expect_true 'repaired pixels are told' \
            grep -qx 'gonio render: warning: bad.exr: 1 of 2 pixels are not radiances and are replaced by black' "$root/work/stderr"
        expect_same repaired.exr dark-lit.exr
    done
    expect_ok $r $small -e light.exr --repair -o untouched.exr
    expect_same untouched.exr light-lit.exr
}

# ---- materials, memory, places to write ----

expect_ok convert atlas:oak-sawn holes.binary
head -c 200000 /dev/zero | tr '\0' '\377' | dd of=holes.binary bs=1 seek=5000000 conv=notrunc status=none
# shellcheck disable=SC2086
expect_ok render holes.binary $small -o holes.png
expect_true 'holes are told' grep -q 'note: holes: .* directions have no data' "$root/work/stderr"
uniform_table 277 >none.binary
# shellcheck disable=SC2086
{
    expect_fail 1 'none: the material holds no data' render none.binary $small -o x.png
    expect_fail 1 'nowhere/x.png: cannot write' $r $small -o nowhere/x.png
}
# Programs under AddressSanitizer need more address space than that.
if (ulimit -v 3000000 && "$GONIO" --version) >"$root/work/stdout" 2>&1; then
    checks=$((checks + 1))
    (ulimit -v 3000000 && "$GONIO" $r --size 65536 --threads 1 -o x.png) >"$root/work/stdout" 2>"$root/work/stderr"
    grep -q 'gonio render: out of memory' "$root/work/stderr" || failed 'more memory than there is' "$(cat "$root/work/stderr")"
    expect_true 'nothing is half-written' test ! -e x.png
fi

finish
