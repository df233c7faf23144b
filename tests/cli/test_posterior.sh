#!/bin/bash
# The default chain on a few built-in materials: sectors and mixtures, the plan of least expected
# error, the posterior; readings at other directions, spectra, wrong units, bad input.
. "$(dirname "$0")/lib.sh"

materials='atlas:gold-polished atlas:red-glossy-plastic atlas:burgundy-velvet atlas:oak-sawn
    atlas:steel-brushed'
new=atlas:white-emulsion-paint
# shellcheck disable=SC2086
expect_output '64 components from 5 materials on 75848 cells' \
    learn $materials --mixtures 50 --seed 2 -o b.gonio
expect_output 'sectored, separate channels' info b.gonio

# ---- learn, plan, measure, reconstruct, compare ----

expect_output 'p.csv: 10 readings, in order of use; expected error (E6) ' plan b.gonio -n 10 -o p.csv
expect_output 'method       expected-error' info p.csv
expect_ok measure p.csv $new -o r.csv
expect_output 'from 10 readings in 3 channels; expected error (E6) ' \
    reconstruct b.gonio r.csv -o out.binary
expect_ok reconstruct b.gonio r.csv --method posterior --threads 1 -q -o one.binary
expect_same out.binary one.binary
error() { "$GONIO" compare "$@" | sed -n '2s/^[^ ]* *\([0-9]*\)\..*/\1/p'; }
expect_true 'a new paint is within 10 per cent' test "$(error $new out.binary)" -lt 10

# Other methods work on sectors too: cells at random, least squares.
expect_ok plan b.gonio --method random -n 200 -K 20 -o random.csv
expect_ok measure random.csv $new -o random.readings.csv
expect_ok reconstruct b.gonio random.readings.csv -o squares.binary
expect_true 'least squares on sectors is within 10 per cent' test "$(error $new squares.binary)" -lt 10

# The first of a longer plan are the shorter plan.
expect_ok plan b.gonio -n 40 -o p40.csv
directions() { grep -v '^#' "$1" | head -n "$2"; }
expect_same <(directions p.csv 11) <(directions p40.csv 11)
if full; then
    expect_ok plan b.gonio -n 40 --threads 1 -o same.csv
    expect_same <(directions same.csv 41) <(directions p40.csv 41)
fi

# As few readings as reach an error.
expect_ok plan b.gonio --target-error 5% -o target.csv
count=$(grep -vc '^[#t]' target.csv)
expect_same <(directions target.csv 6) <(directions p.csv 6)
if full; then
    expect_output "target.csv: $count readings" plan b.gonio --target-error 5 -o target.csv
fi
for metric in e6 cube-root log-relative; do
    expect_ok plan b.gonio -n 5 --metric $metric -o metric.csv
done

# ---- at the directions of a file; deviations ----

expect_ok measure p40.csv $new -o all.csv
expect_ok reconstruct b.gonio r.csv --predict-at all.csv -o at.csv
expect_ok reconstruct b.gonio r.csv --predict-at all.csv --bands -o bands.csv
expect_true 'predictions have bands' grep -q '^theta.*R_deviation_per_sr' bands.csv
expect_fail 2 '--bands needs --predict-at' reconstruct b.gonio r.csv --bands -o bands.binary
expect_true 'as many directions as asked for' test "$(grep -vc '^[#t]' at.csv)" -eq 40
expect_output '40 readings compared' compare all.csv at.csv
expect_output '30 readings compared' compare all.csv at.csv --leave-out p.csv
expect_true 'predictions are within 15 per cent' test "$(error all.csv at.csv --leave-out p.csv)" -lt 15
# The error is expected where nothing was read; a reading without values is none.
expected_at() { # READINGS DIRECTIONS
    expect_ok reconstruct b.gonio "$1" --predict-at "$2" -o expected.csv
    sed -n 's/.*expected error (E6) \([0-9.]*\) %.*/\1/p' "$root/work/stdout"
}
directions all.csv 1 >unread.csv
directions all.csv 41 | tail -n 30 >>unread.csv
directions all.csv 1 >without-one.csv
directions all.csv 41 | tail -n 31 >>without-one.csv
directions r.csv 11 | awk -F, -v OFS=, '{ for (k = 1; k <= NF; k++) { if (NR == 1 && $k ~ /_per_sr/) value[k] = 1 }
    for (k in value) { if (NR == 11) $k = "" } } 1' >gap.csv
expect_true 'an error' test -n "$(expected_at r.csv all.csv)"
expect_true 'what was read does not count' test "$(expected_at r.csv all.csv)" = "$(expected_at r.csv unread.csv)"
expect_true 'the whole is another' test "$(expected_at r.csv all.csv)" != "$(expected_at r.csv r.csv)"
expect_true 'a gap counts' test "$(expected_at gap.csv all.csv)" = "$(expected_at gap.csv without-one.csv)"
expect_true 'a gap is no reading' test "$(expected_at gap.csv all.csv)" != "$(expected_at gap.csv unread.csv)"
expect_ok measure p.csv all.csv -o looked-up.csv
expect_output '0.000     0.000    0.0000' compare r.csv looked-up.csv
expect_ok reconstruct b.gonio r.csv --deviation deviation.binary -o again.binary
expect_same out.binary again.binary
expect_output 'valid bins   1096216 of 1096216' info deviation.binary
rm again.binary one.binary deviation.binary

# ---- energy ----

expect_output ', albedo at most 0.' reconstruct b.gonio r.csv -o out.binary
expect_output '"largest_albedo": 0.' reconstruct b.gonio r.csv --json --predict-at p.csv -o energy.csv
awk -F, -v OFS=, '/^[#t]/ { print; next } { $6 *= 30; $7 *= 30; $8 *= 30; print }' r.csv >bright.csv
expect_ok reconstruct b.gonio bright.csv --no-checks -o bright.binary
expect_true 'more light than there is is told' \
    grep -q 'note: bright.binary reflects .* times the light' "$root/work/stderr"

# ---- one wrong reading ----

awk -F, -v OFS=, '/^[#t]/ { print; next } ++n == 7 { $6 *= 20; $7 *= 20; $8 *= 20 } { print }' \
    all.csv >wrong.csv
expect_output ' values contradicted by the others' reconstruct b.gonio wrong.csv -o wrong.binary
expect_ok reconstruct b.gonio all.csv -o right.binary
expect_true 'a wrong reading hardly matters' \
    test "$(error right.binary wrong.binary)" -lt 2

# ---- what to read next ----

expect_output 'next.csv: 5 more readings; expected error (E6) now ' next b.gonio r.csv -o next.csv
expect_ok next b.gonio r.csv --threads 1 -q -o again.csv
expect_same <(directions next.csv 6) <(directions again.csv 6)
expect_true 'nothing is read twice' \
    test "$(cat <(directions r.csv 11) <(directions next.csv 6) | cut -d, -f1-4 | sort -u | wc -l)" -eq 16
expect_ok measure next.csv $new -o more.csv
{ cat r.csv; grep -v '^[#t]' more.csv; } >longer.csv
expect_output 'from 15 readings in 3 channels' reconstruct b.gonio longer.csv -o longer.binary
expect_output '"target_met": false' next b.gonio r.csv --target-error 0.1% --json -o next.csv
rm next.csv
expect_output 'the target is met, no more readings are needed' \
    next b.gonio r.csv --target-error 60% -o next.csv
expect_true 'then there is no plan' test ! -e next.csv
expect_output '"target_met": true' next b.gonio r.csv --target-error 60% --json -o next.csv
expect_ok next b.gonio r.csv --candidates all.csv -n 3 -o among.csv
expect_ok measure among.csv all.csv -o among-readings.csv
expect_fail 2 "--target-error: '0' is not an error" next b.gonio r.csv --target-error 0 -o next.csv
expect_fail 2 'is an input' next b.gonio r.csv -o r.csv
expect_fail 1 'missing.csv: cannot read' next b.gonio missing.csv -o next.csv

# ---- choosing among directions ----

expect_ok plan b.gonio --candidates all.csv -n 7 -o chosen.csv
expect_ok measure chosen.csv all.csv -o chosen-readings.csv
expect_ok reconstruct b.gonio chosen-readings.csv -o chosen.binary

# ---- spectra ----

{
    printf '# a paint\n3\n450 550 650\n'
    grep -v '^[#t]' all.csv | awk -F, '{ d = 3.14159265358979 / 180
        printf "%.9f %.9f %.9f %.9f %s %s %s\n", $1 * d, $2 * d, $3 * d, $4 * d, $8, $7, $6 }'
} >paint.brdf
expect_output 'gonio readings, 40 directions, 40 measured' info paint.brdf
expect_ok plan b.gonio --candidates paint.brdf -n 6 -o spectral.csv
expect_ok measure spectral.csv paint.brdf -o spectral-readings.csv
expect_output 'from 6 readings in 3 channels' \
    reconstruct b.gonio spectral-readings.csv --predict-at paint.brdf -o spectral-at.csv
expect_output '34 readings compared' compare paint.brdf spectral-at.csv --leave-out spectral.csv
expect_ok reconstruct b.gonio spectral-readings.csv --deviation deviation.binary -o paint.bsdf
expect_output 'RGL isotropic BSDF, spectral' info paint.bsdf
expect_also 'channels     3 wavelengths, 450 to 650 nm' 'measured to  80 degrees'
expect_output '"anisotropic": false' info --json paint.bsdf
expect_output 'valid bins   1096216 of 1096216' info deviation.binary
expect_ok convert paint.bsdf --illuminant A paint.xml
expect_output 'BSDF-XML Reflection Front, LBNL/Klems Full, 145 x 145 patches, CIE X, Y, Z' info paint.xml
expect_fail 2 "--illuminant: 'F11' is none of E, D65, A" convert paint.bsdf --illuminant F11 x.xml
expect_fail 2 "--steps: '10,5' is not three steps" convert paint.bsdf --steps 10,5 x.csv
expect_fail 2 "--format: 'exr' is none of merl, rgl," convert paint.bsdf --format exr x.exr
rm paint.bsdf paint.xml deviation.binary
expect_output 'from 40 readings in 3 channels' reconstruct b.gonio paint.brdf -o paint.binary

# ---- readings that are not what they say ----

# changed AWK: the readings with each line of values changed.
changed() {
    awk -F, -v OFS=, "/^[#t]/ { print; next } { d = 3.14159265358979 / 180; $1; print }" all.csv
}
changed '$6 *= 100; $7 *= 100; $8 *= 100' >percent.csv
changed 'c = cos($3 * d); $6 *= c; $7 *= c; $8 *= c' >cosine.csv
changed '$1 *= d; $2 *= d; $3 *= d; $4 *= d' >radians.csv
changed '$1 = 90 - $1; $3 = 90 - $3' >elevation.csv
expect_not_said() { # PART NAME
    expect_true "$2" test "$(grep -c "$1" "$root/work/stderr")" -eq 0
}
suspect() { # FILE PART
    expect_output "\"suspicion\": \"" reconstruct b.gonio "$1" --json --predict-at p.csv -o suspect.csv
    expect_true "$1: '$2'" grep -q "note: .*$2" "$root/work/stderr"
    expect_ok reconstruct b.gonio "$1" --no-checks --predict-at p.csv -o suspect.csv
    expect_not_said 'fit far better' "$1: --no-checks does not look"
    expect_output "\"suspicion\": \"" next b.gonio "$1" -n 1 --json -o suspect.csv
    expect_true "next, $1: '$2'" grep -q "note: .*$2" "$root/work/stderr"
    expect_ok next b.gonio "$1" -n 1 --no-checks -o suspect.csv
    expect_not_said 'fit far better' "next, $1: --no-checks does not look"
}
suspect percent.csv 'the values are in per cent'
if full; then
    suspect cosine.csv 'the values include the cosine'
    suspect radians.csv 'the angles are in radians'
    suspect elevation.csv 'theta is measured from the surface'
    expect_ok reconstruct b.gonio elevation.csv -o suspect.binary
    expect_true 'of a table too' grep -q 'note: .*theta is measured from the surface' "$root/work/stderr"
fi
expect_output '"suspicion": null' next b.gonio all.csv -n 1 --json -o suspect.csv
expect_output '"suspicion": null' reconstruct b.gonio all.csv --json --predict-at p.csv -o suspect.csv
expect_true 'good readings are not suspicious' test ! -s "$root/work/stderr"

# ---- what an instrument subtracts too much ----

awk -F, -v OFS=, '/^#/ { next } /^t/ { print; next }
    { for (k = NF - 2; k <= NF; k++) { $k -= 0.01 / cos($1 * 3.14159265358979 / 180); if ($k < 0) $k = 0 }
      print }' all.csv >dark.csv
expect_ok reconstruct b.gonio dark.csv --no-checks -o unchecked.binary
expect_not_said 'seems to subtract' '--no-checks looks for no dark level'
expect_ok reconstruct b.gonio dark.csv -o dark.binary
expect_true 'what is subtracted is told' \
    grep -q 'note: dark.binary: the instrument seems to subtract up to 0.*/cos(theta_i)' "$root/work/stderr"
expect_true 'without it the paint is within 8 per cent' test "$(error $new dark.binary)" -lt 8
expect_true 'with it it is not within 15' test "$(error $new unchecked.binary)" -ge 15
expect_output '"dark_level_per_sr": [' reconstruct b.gonio dark.csv --json --predict-at p.csv -o dark-at.csv
expect_output '"dark_level_per_sr": null' reconstruct b.gonio all.csv --json --predict-at p.csv -o dark-at.csv
expect_ok next b.gonio dark.csv -n 2 -o dark-next.csv

# ---- bad input ----

learned='learn atlas:oak-sawn atlas:red-cotton -o x.gonio'
# shellcheck disable=SC2086
{
    expect_fail 2 '--mixtures: -5 is too small' $learned --mixtures -5
    expect_fail 2 'invalid numeric value' $learned --mixtures many
    expect_fail 2 'invalid numeric value' $learned --seed one
    expect_fail 2 'mixtures need the log mapping' $learned --mixtures 5 --mapping relative --grid full
    expect_fail 2 'the relative mapping needs the full or the bivariate grid' $learned --mapping relative
    expect_fail 2 'mixtures need the log mapping' $learned --mixtures 5 --no-mean
    expect_fail 2 'mixtures need the log mapping' $learned --mixtures 5 --grid full
}
planned='plan b.gonio -n 4 -o x.csv'
# shellcheck disable=SC2086
{
    expect_fail 2 "--metric: 'best' is none of e6, cube-root, log-relative" $planned --metric best
    for target in 0 -1 nan inf 3x % '5%%'; do
        expect_fail 2 "--target-error: '$target' is not an error in per cent" \
            $planned --target-error $target
    done
    expect_fail 2 'above the target of 0.01 %' $planned --target-error 0.01
    expect_fail 2 'expected-error uses all 64 components' $planned --components 10
    expect_fail 1 'missing.csv: cannot read' $planned --candidates missing.csv
    expect_fail 1 'out.binary: a material (MERL .binary table), not readings' $planned --candidates out.binary
    expect_fail 2 'is an input' plan b.gonio -n 4 --candidates all.csv -o all.csv
    expect_fail 2 '41 readings asked for, but there are only 40 directions' \
        plan b.gonio -n 41 --candidates all.csv -o x.csv
}
expect_fail 2 '-n: 0 is too small' plan b.gonio -n 0 --target-error 3 -o x.csv
for share in -1 101 nan; do
    expect_fail 2 '--outliers must be 0 to 100 per cent' measure p.csv $new --outliers $share -o x.csv
done
expect_fail 1 'has no reading at these directions' measure p40.csv r.csv -o x.csv
made='reconstruct b.gonio r.csv -o x.binary'
# shellcheck disable=SC2086
{
    for option in --noise --floor --saturation; do
        expect_fail 2 'cannot be negative' $made $option -1
        expect_fail 2 'cannot be negative' $made $option nan
        expect_fail 2 'invalid numeric value' $made $option much
    done
    expect_fail 2 'noise, floor and saturation must not be negative' $made --noise inf
    expect_fail 2 'noise and floor at most 1e+06' $made --noise 1e308
    expect_fail 2 'noise and floor at most 1e+06' $made --floor 1e300
    expect_fail 1 'missing.csv: cannot read' $made --predict-at missing.csv
    expect_fail 2 'posterior uses all 64 components' $made --components 10
    expect_fail 1 'nowhere/d.binary' $made --deviation nowhere/d.binary
    expect_fail 1 'nowhere/x.csv' reconstruct b.gonio r.csv --predict-at all.csv \
        --deviation d.binary -o nowhere/x.csv
    expect_fail 2 '--deviation and -o name the same file' $made --deviation x.binary
    printf 'old' >old.binary
    expect_fail 1 'nowhere/x.csv' reconstruct b.gonio r.csv --predict-at all.csv \
        --deviation old.binary -o nowhere/x.csv
    expect_true 'older deviations stay where the other output fails' test "$(cat old.binary)" = old
    expect_fail 2 "no start is called 'nonsense'" plan b.gonio -n 2 --start nonsense -o x.csv
    expect_fail 2 'phi_d of nan degrees' plan b.gonio -n 2 --phi-d nan -o x.csv
    rm old.binary
    expect_fail 2 'r.csv is an input' $made --deviation r.csv
}
expect_fail 2 'is an input' reconstruct b.gonio r.csv --predict-at all.csv -o all.csv
mkdir folder
expect_fail 2 '--predict-at and --deviation take one READINGS' \
    reconstruct b.gonio r.csv all.csv --predict-at p.csv -o folder
expect_fail 2 '--leave-out needs readings' compare out.binary out.binary --leave-out p.csv
expect_fail 1 'missing.csv: cannot read' compare all.csv at.csv --leave-out missing.csv
expect_fail 1 'no readings to compare' compare all.csv at.csv --leave-out all.csv
expect_fail 1 'has no reading at these directions' compare all.csv r.csv
printf '2\n400 500\n0.1 0 0.2 0 1\n' >cut.brdf
expect_fail 1 'ends within a reading' reconstruct b.gonio cut.brdf -o x.binary
# shellcheck disable=SC2086
expect_ok learn $materials --grid bivariate -o joint.gonio
expect_fail 1 'spectral readings need a basis of separate channels' \
    reconstruct joint.gonio paint.brdf --method posterior -q -o x.binary

finish
