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
for length in 96 2000 $((size / 2)) $((size - 1)); do
    head -c "$length" good.gonio >cut.gonio
    every_reader 1 'cut.gonio: not a gonio basis (not an HDF5 file, or a damaged one)' cut.gonio
done

# with FROM TO: the good basis with one text replaced by another of the same length.
with() { sed "s/$1/$2/" good.gonio >bad.gonio; }

with 'gonio basis' 'gonio bases'
every_reader 1 'bad.gonio: an HDF5 file, but not a gonio basis' bad.gonio
with format_version format_varsion
expect_fail 1 'bad.gonio: a basis of format version' plan bad.gonio -n 9 -o x.csv
with theta_d_bins theta_d_bans
expect_fail 1 "bad.gonio: 'theta_d_bins' is missing; learn the basis again" info bad.gonio
with bivariate univariate
expect_fail 1 'bad.gonio: ' info bad.gonio
with joint paint
expect_fail 1 "bad.gonio: 'channels' is missing or unknown" info bad.gonio
with components composants
expect_fail 1 "bad.gonio: 'components' is missing" info bad.gonio
with variances varionces
expect_fail 1 "bad.gonio: 'variances' is missing" info bad.gonio

with centring contring
expect_ok info bad.gonio
expect_ok learn --grid bivariate atlas:oak-sawn atlas:red-cotton --mapping relative --no-mean -o relative.gonio
sed 's/relative\x00/relatove\x00/' relative.gonio >bad.gonio
every_reader 1 "bad.gonio: 'mapping' is missing or unknown" bad.gonio
sed 's/mapping\x00/mopping\x00/' relative.gonio >bad.gonio
every_reader 1 "bad.gonio: 'checksum' does not fit the contents" bad.gonio
sed 's/centring\x00/contring\x00/' relative.gonio >bad.gonio
every_reader 1 "bad.gonio: 'checksum' does not fit the contents" bad.gonio
with loadings_checksum loadings_chocksum
every_reader 1 "bad.gonio: 'loadings_checksum' is missing" bad.gonio

# A bit in the last third of the file is one of the components; a NaN there; a text fingerprint.
fingerprint=$(gonio info good.gonio | sed -n 's/^ *fingerprint *//p')
with "$fingerprint" 0123456789abcdef
every_reader 1 "bad.gonio: 'fingerprint' does not fit the contents" bad.gonio
# Where the number around an offset begins: its last byte, of the sign and exponent, is 3f or bf.
number_at() {
    local start=$(($1 / 8 * 8))
    od -An -v -tx1 -w8 -j $start -N 4000 good.gonio | awk -v start=$start '
        { for (k = 1; k <= 8; k++) count[k] += $k == "3f" || $k == "bf" }
        END { last = 1; for (k = 2; k <= 8; k++) if (count[k] > count[last]) last = k
              print start + last % 8 }'
}
for place in $(number_at $((size / 2))) $(number_at $((size * 3 / 4))); do
    cp good.gonio bad.gonio
    patch bad.gonio "$place" '\x00\x00\x00\x00\x00\x00\xf8\x7f'
    every_reader 1 'bad.gonio: ' bad.gonio
    cp good.gonio bad.gonio
    printf '\x01' | dd of=bad.gonio bs=1 seek="$place" conv=notrunc status=none
    if ! cmp -s bad.gonio good.gonio; then
        every_reader 1 'does not fit the contents (the file was changed)' bad.gonio
    fi
done

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
