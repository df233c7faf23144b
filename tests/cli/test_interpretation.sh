#!/bin/bash
# What readings seem to be, where that is not what they say: units, angles, readings of nothing,
# anisotropy. Right readings of the same kinds are not doubted.
. "$(dirname "$0")/lib.sh"

# shellcheck disable=SC2046
expect_ok learn $(printf 'atlas:%s ' gold-polished red-glossy-plastic burgundy-velvet oak-sawn \
    steel-brushed white-linen) --mixtures 50 --seed 2 -o b.gonio

# Readings of a white paint at 60 directions, evenly spread below 80 degrees.
header=theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg
awk -v header=$header 'function below(x) { x -= int(x); c = 1 - x * 0.82; return atan2(sqrt(1 - c * c), c) * 57.29578 }
    BEGIN { print header
        for (k = 1; k <= 60; k++) {
            turn = 360 * k * 0.618034; turn -= 360 * int(turn / 360)
            printf "%.6f,0,%.6f,%.6f\n", below(k * 0.754878), below(k * 0.569840), turn
        } }' >directions.csv
expect_ok measure directions.csv atlas:white-emulsion-paint --noise 1 -o right.csv
expect_ok measure directions.csv atlas:blue-glossy-plastic --noise 1 -o glossy.csv

# changed FILE AWK: a file with its values or angles changed; d: a degree in radians.
changed() {
    awk -F, -v OFS=, -v CONVFMT=%.12g -v OFMT=%.12g "/^[#t]/ { print; next } { d = 3.14159265358979 / 180; $2; print }" "$1"
}
# said FILE PART...: that is noted. unsaid FILE PART: that is not. Predicting at a few directions is quicker than a table.
head -n 5 directions.csv >few.csv
said() {
    local file=$1 part
    shift
    expect_ok reconstruct b.gonio "$file" --predict-at few.csv -o out.csv
    for part in "$@"; do
        expect_true "$file: '$part'" grep -q -e "$part" "$root/work/stderr"
    done
}
unsaid() {
    expect_ok reconstruct b.gonio "$1" --predict-at few.csv -o out.csv
    expect_true "$1: not '$2'" test "$(grep -c -e "$2" "$root/work/stderr")" -eq 0
}

# ---- right readings ----

unsaid right.csv note:
unsaid glossy.csv 'fit far better'
expect_ok reconstruct b.gonio right.csv -o out.binary
expect_true 'a table is written without a note too' test ! -s "$root/work/stderr"
expect_output '"alternatives": []' reconstruct b.gonio right.csv --json --predict-at few.csv -o out.csv
expect_also '"suspicion": null' '"unmeasured": 0' '"anisotropic": false' '"largest_albedo": 0.'

# ---- units: by the albedo ----

changed right.csv '$5 *= 3.14159; $6 *= 3.14159; $7 *= 3.14159' >factor.csv
changed right.csv '$5 *= 100; $6 *= 100; $7 *= 100' >percent.csv
changed right.csv '$5 *= 314.159; $6 *= 314.159; $7 *= 314.159' >factor-percent.csv
changed right.csv '$5 *= 1500; $6 *= 1500 / 1.15; $7 *= 1500 / 1.66' >merl.csv
expect_ok reconstruct b.gonio factor.csv -o out.binary
expect_true 'of a table too' grep -q 'reflectance factors; divide them by pi (albedo 0.' "$root/work/stderr"
said factor.csv 'whose albedo is 2' 'reflectance factors; divide them by pi (albedo 0.'
said percent.csv 'in per cent; divide them by 100 (albedo 0.'
said factor-percent.csv 'reflectance factors in per cent; divide them by 100 pi (albedo 0.'
said merl.csv 'numbers of a MERL file; multiply them by (1, 1.15, 1.66)/1500 (albedo 0.'

# Levels of an image are whole numbers. They are noted wherever readings are read; right readings, some of which may be
# whole numbers, are not.
changed right.csv 'for (k = 5; k <= 7; k++) { $k = int(800 * $k + 0.5); if ($k > 255) $k = 255 }' >levels.csv
said levels.csv 'far better if the values are levels of an image; .* divide them by 255 pi (albedo 0.'
expect_output 'the values are whole numbers up to 255' info levels.csv
changed levels.csv 'if (NR == 20) $6 += 0.5' >nearly.csv
expect_ok info nearly.csv
expect_true 'no levels' test "$(grep -c 'whole numbers' "$root/work/stdout" "$root/work/stderr" | grep -c ':0$')" -eq 2
expect_output '"albedo": 0.' reconstruct b.gonio percent.csv --json --predict-at few.csv -o out.csv
expect_also '"mistake": "the values are in per cent; divide them by 100"'

# The albedo is told where no table is written too, and what it is if the values are reflectance factors.
expect_output 'albedo at most 0.' reconstruct b.gonio right.csv --predict-at glossy.csv -o at.csv
expect_also ' if these are reflectance factors)'
expect_output 'albedo at most 2.' reconstruct b.gonio factor.csv --predict-at glossy.csv -o at.csv
expect_true 'more than is received' grep -q 'which no material can do' "$root/work/stderr"

# ---- angles: by what readings say of each other ----

changed right.csv 'c = cos($1 * d); $5 *= c; $6 *= c; $7 *= c' >cosine-i.csv
changed right.csv 'c = cos($3 * d); $5 *= c; $6 *= c; $7 *= c' >cosine-o.csv
changed right.csv '$1 *= d; $2 *= d; $3 *= d; $4 *= d' >radians.csv
changed right.csv '$1 = 90 - $1; $3 = 90 - $3' >elevation.csv
said cosine-i.csv 'the cosine of theta_i; divide them by it (albedo 0.'
said cosine-o.csv 'the cosine of theta_o; divide them by it (albedo 0.'
said radians.csv 'the angles are in radians'
said elevation.csv 'theta is measured from the surface'
expect_ok reconstruct b.gonio cosine-i.csv --no-checks --predict-at few.csv -o out.csv
expect_true '--no-checks looks for nothing' test ! -s "$root/work/stderr"
expect_ok next b.gonio cosine-i.csv -n 1 -o next.csv
expect_true 'next says the same' grep -q 'the cosine of theta_i' "$root/work/stderr"

# Readings about the mirror direction tell where it is.
awk -v header=$header 'BEGIN { print header
    for (t = 10; t < 80; t += 10) for (s = -6; s <= 6; s += 3) print t ",0," t + s ",180"
    for (t = 10; t < 80; t += 20) print t ",0," 80 - t ",90" }' >peak.csv
expect_ok measure peak.csv atlas:blue-glossy-plastic --noise 1 -o peak-right.csv
changed peak-right.csv '$4 = ($4 + 180) % 360' >peak-mirror.csv
unsaid peak-right.csv 'mirror direction'
said peak-mirror.csv 'phi_o is measured from the mirror direction'

# ---- readings of nothing ----

# Every tenth is hidden: zero, or the least that the instrument writes.
changed right.csv 'if (NR % 10 == 0) { $5 = $6 = $7 = NR % 20 == 0 ? 0 : 1e-5 }' >hidden.csv
awk 'NR % 10 != 0 || /^[#t]/' right.csv >seen.csv
hidden=$(awk '!/^[#t]/ && NR % 10 == 0' hidden.csv | wc -l)
said hidden.csv "$hidden readings are far below what the others predict: not measured?"
expect_ok reconstruct b.gonio hidden.csv -o hidden.binary
expect_ok reconstruct b.gonio seen.csv -o out.binary
expect_same hidden.binary out.binary
expect_output "\"unmeasured\": $hidden" reconstruct b.gonio hidden.csv --json --predict-at few.csv -o out.csv
expect_also '"unmeasured_lines": ['
# Low values that are no floor were measured.
changed right.csv 'if (NR % 3 == 0 && $1 < 70 && $3 < 70 && $1 + $3 > 30 && $4 > 90 && $4 < 270) { $5 = $6 = $7 = 1e-5 * (1 + NR / 977) }' >low.csv
expect_true 'some are low' test "$(diff right.csv low.csv | grep -c '^>')" -ge 2
expect_output '"unmeasured": 0' reconstruct b.gonio low.csv --json --predict-at few.csv -o out.csv
expect_output '60 readings' reconstruct b.gonio hidden.csv --no-checks --predict-at few.csv -o out.csv

# ---- anisotropy ----

# The same sample turned by 90 degrees: as before, and three times as bright.
{
    cat right.csv
    changed right.csv '$2 += 90; $4 += 90; if (NR % 2) { $5 *= 3; $6 *= 3; $7 *= 3 } else { $5 /= 3; $6 /= 3; $7 /= 3 }' |
        grep -v '^[#t]'
} >turned.csv
{
    cat right.csv
    changed right.csv '$2 += 90; $4 += 90; $5 *= 1.02' | grep -v '^[#t]'
} >isotropic.csv
said turned.csv 'the material seems anisotropic: 60 readings differ by a factor of 3'
unsaid isotropic.csv anisotropic
expect_output '"anisotropic": true' reconstruct b.gonio turned.csv --json --predict-at few.csv -o out.csv
expect_output "turned       60 pairs" info turned.csv
expect_also 'anisotropic?'
expect_output 'turned       60 pairs' info isotropic.csv
expect_output '"turned_pairs": 60' info turned.csv --json

finish
