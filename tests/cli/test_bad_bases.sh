#!/bin/bash
# Files that are no basis, a damaged one or another one, given to every command that reads a basis.
. "$(dirname "$0")/lib.sh"

materials='atlas:oak-sawn atlas:gold-polished atlas:plaster-cast atlas:red-cotton'
# shellcheck disable=SC2086
{
    expect_ok learn --grid bivariate $materials -o good.gonio
    expect_ok learn --grid bivariate $materials --channels separate -o separate.gonio
    expect_ok learn --grid bivariate $materials atlas:steel-brushed -o other.gonio
    expect_ok learn --grid bivariate atlas:oak-sawn atlas:red-cotton -o small.gonio
}
expect_ok plan good.gonio -n 9 -o p.csv
expect_ok measure p.csv atlas:white-linen -o r.csv
expect_ok convert atlas:red-cotton good.binary

# every_reader CODE PART FILE: what each command says of a basis.
every_reader() {
    expect_fail "$1" "$2" plan "$3" -n 9 -o x.csv
    expect_fail "$1" "$2" plan "$3" -n 9 --history x-history.csv -o x.csv
    expect_fail "$1" "$2" reconstruct "$3" r.csv -o x.binary
}

# ---- no file, no access, another kind ----

mkdir folder
: >empty.gonio
head -c 100 /dev/zero >zeros.gonio
every_reader 1 'missing.gonio: cannot read: No such file' missing.gonio
every_reader 1 'folder: cannot read: Is a directory' folder
every_reader 1 'empty.gonio: the file is empty' empty.gonio
every_reader 1 'zeros.gonio: not a basis that gonio reads (gonio basis)' zeros.gonio
every_reader 1 'good.binary: a material (MERL .binary table), not a basis' good.binary
every_reader 1 'p.csv: readings (CSV), not a basis' p.csv
if permissions_apply; then
    cp good.gonio secret.gonio
    chmod 000 secret.gonio
    runner=as_other_user expect_fail 1 'secret.gonio: cannot read: Permission denied' \
        plan secret.gonio -n 9 -o x.csv
    chmod 600 secret.gonio
else
    skip 'an unreadable basis: no other user to run as'
fi
real=${GONIO_SHARED:-}/data/neural-merl/chrome.h5
if [ -r "$real" ]; then
    every_reader 1 "$real: an HDF5 file, but not a gonio basis" "$real"
else
    skip 'a neural BRDF as basis: no folder of shared data ($GONIO_SHARED)'
fi

# ---- damage ----

size=$(stat -c %s good.gonio)
for length in 9 64 900 $((size / 2)) $((size - 1)); do
    head -c "$length" good.gonio >cut.gonio
    every_reader 1 'cut.gonio: ' cut.gonio
done
every_reader 1 "cut.gonio: damaged: 'material_names' has data_offsets that are not in the file" cut.gonio

# with FROM TO: the good basis with one text replaced by another of the same length.
with() { sed "s/$1/$2/" good.gonio >bad.gonio; }

with 'gonio basis' 'gonio bases'
expect_fail 1 'bad.gonio: ' plan bad.gonio -n 9 -o x.csv
with '"format_version":"2"' '"format_version":"9"'
every_reader 1 'bad.gonio: a basis of format version 9; this gonio reads version 2' bad.gonio
with theta_d_bins theta_d_bans
expect_fail 1 "bad.gonio: 'theta_d_bins' is missing; learn the basis again" info bad.gonio
with '"representation":"bivariate"' '"representation":"bivariant"'
expect_fail 1 "bad.gonio: 'representation' is missing or unknown" info bad.gonio
with '"channels":"joint"' '"channels":"paint"'
expect_fail 1 "bad.gonio: 'channels' is missing or unknown" info bad.gonio
with '"components"' '"composants"'
expect_fail 1 "bad.gonio: 'components' is missing" info bad.gonio
with '"variances"' '"varionces"'
expect_fail 1 "bad.gonio: 'variances' is missing" info bad.gonio
with '"centring":"mean"' '"centring":"none"'
every_reader 1 "bad.gonio: 'fingerprint' does not fit the contents" bad.gonio
with '"xxh3.mean":"....' '"xxh3.mean":"1234'
every_reader 1 "bad.gonio: 'xxh3.mean' does not fit the contents" bad.gonio
with '"shape":\[8023\]' '"shape":[9999]'
every_reader 1 "does not fit its data_offsets; learn the basis again" bad.gonio

fingerprint=$(gonio info good.gonio | sed -n 's/^ *fingerprint *//p')
with "$fingerprint" 0123456789abcdef
every_reader 1 "bad.gonio: 'fingerprint' does not fit the contents" bad.gonio

# The components are in the middle of the file: NaN there, or one bit.
for place in $((size / 2 / 4 * 4)) $((size * 3 / 4 / 4 * 4)); do
    cp good.gonio bad.gonio
    patch bad.gonio "$place" '\x00\x00\xc0\x7f\x00\x00\xc0\x7f'
    every_reader 1 'bad.gonio: ' bad.gonio
    cp good.gonio bad.gonio
    patch bad.gonio "$place" '\x01'
    if ! cmp -s bad.gonio good.gonio; then
        every_reader 1 "'components' are not those of the checksum (the file was changed)" bad.gonio
    fi
done

# ---- open elsewhere ----

# Nobody's lock matters: gonio takes none.
if command -v flock >/dev/null; then
    exec 9<good.gonio # as a notebook does that has it open
    flock -x 9
    expect_ok plan good.gonio -n 9 -o x.csv
    expect_ok info good.gonio
    exec 9<&-
    rm -f x.csv
else
    skip 'a basis that is locked: no flock'
fi

# ---- older files ----

old=${GONIO_SHARED:-}/cases/hostile
if [ -r "$old/basis-nan-design/forged1.gonio" ]; then
    every_reader 1 "'gonio convert $old/basis-nan-design/forged1.gonio NEW.gonio' makes one of today" \
        "$old/basis-nan-design/forged1.gonio"
    for forged in "$old"/basis-nan-design/*.gonio; do
        expect_fail 1 "$forged: " convert "$forged" x.gonio
    done
else
    skip 'older bases: no folder of shared data ($GONIO_SHARED)'
fi

# ---- the wrong basis ----

expect_fail 1 'r.csv: planned with another basis' reconstruct other.gonio r.csv -o x.binary
expect_fail 1 'r.csv: planned with another basis' reconstruct separate.gonio r.csv -o x.binary
expect_ok reconstruct other.gonio r.csv --other-basis -K 3 -o x.binary
expect_fail 1 'r.csv: planned for 3 components, but the basis has 1' \
    reconstruct small.gonio r.csv --other-basis -o x.binary
expect_ok reconstruct small.gonio r.csv --other-basis -K 1 -o x.binary
sed '/^# basis:/d; /^# components:/d' r.csv >free.csv
expect_ok reconstruct other.gonio free.csv -o x.binary

finish
