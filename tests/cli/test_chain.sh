#!/bin/bash
# The whole chain on a few built-in materials; same seed, same bytes; conversions and JSON.
. "$(dirname "$0")/lib.sh"

materials=(gold-polished bronze-aged steel-brushed titanium-blue-tempered graphite-metallic
    green-violet-shift white-moulded-plastic foamed-plastic white-emulsion-paint
    lemon-acrylic-paint burgundy-velvet black-nylon-weave red-glossy-plastic)
new=white-emulsion-paint

# ---- learn, plan, measure, reconstruct, compare ----

chain() { # FOLDER OPTION...
    mkdir "$1"
    expect_ok learn --grid bivariate "${materials[@]/#/atlas:}" --without $new -o "$1/b.gonio" "${@:2}"
    expect_ok plan "$1/b.gonio" -K 6 -n 20 --seed 3 --history "$1/history.csv" -o "$1/p.csv" \
        "${@:2}"
    expect_ok measure "$1/p.csv" atlas:$new --noise 1 --floor 1e-4 --seed 5 -o "$1/r.csv" "${@:2}"
    expect_ok reconstruct "$1/b.gonio" "$1/r.csv" -o "$1/out.binary" "${@:2}"
}
chain one --threads 1
chain two --threads 2

without_command() { sed '/^# command:/d' "$1"; }
for file in p.csv history.csv r.csv; do
    expect_same <(without_command one/$file) <(without_command two/$file)
done
expect_same one/out.binary two/out.binary
fingerprint() { "$GONIO" info "$1" | sed -n 's/^ *fingerprint *//p'; }
expect_true 'bases learned with 1 and 2 threads are the same' \
    test "$(fingerprint one/b.gonio)" = "$(fingerprint two/b.gonio)"
mv one/b.gonio b.gonio
expect_ok learn --grid bivariate "${materials[@]/#/atlas:}" --without $new -o one/b.gonio --threads 1
expect_same b.gonio one/b.gonio

error() { "$GONIO" compare "$@" | sed -n '2s/^[^ ]* *\([0-9]*\)\..*/\1/p'; }
expect_true 'the reconstruction of a new paint is within 10 per cent' \
    test "$(error atlas:$new one/out.binary)" -lt 10
expect_output '0.000     0.000    0.0000' compare one/out.binary two/out.binary
expect_output '1096216 bins compared, 0 of the reference' compare -v atlas:$new one/out.binary

# Another seed gives another plan and other readings.
expect_ok plan b.gonio -K 6 -n 20 --seed 4 --method random -o other.csv
expect_ok measure one/p.csv atlas:$new --noise 1 --seed 6 -o other-readings.csv
expect_true 'another seed, another plan' \
    bash -c '! cmp -s <(grep -v "^#" other.csv) <(grep -v "^#" one/p.csv)'
expect_true 'another seed, other noise' \
    bash -c '! cmp -s <(grep -v "^#" other-readings.csv) <(grep -v "^#" one/r.csv)'

# A plan says what it is; readings of it say so too.
expect_output 'gonio basis, bivariate, joint channels' info b.gonio
expect_output 'gonio plan, 20 directions, 0 measured' info one/p.csv
expect_output 'gonio readings, 20 directions, 20 measured' info one/r.csv
expect_output "$(fingerprint b.gonio)" info one/r.csv
expect_output 'MERL table 90 x 90 x 180' info one/out.binary

# ---- the other kinds of basis ----

for kind in '--grid bivariate --channels separate' '--grid full' '--grid full --channels separate'; do
    # shellcheck disable=SC2086
    expect_ok learn atlas:gold-polished atlas:red-glossy-plastic atlas:burgundy-velvet $kind \
        -K 2 -o kind.gonio
    expect_ok plan kind.gonio -n 4 --restarts 1 -o kind.csv
    expect_ok measure kind.csv atlas:red-glossy-plastic -o kind-readings.csv
    expect_ok reconstruct kind.gonio kind-readings.csv -o kind.binary
    expect_output 'kind.gonio: gonio basis' info kind.gonio
done
rm kind*

# Three materials, two components: one of the three is given back but for its phi_d.
expect_ok learn --grid bivariate atlas:gold-polished atlas:red-glossy-plastic atlas:burgundy-velvet -o 3.gonio
expect_ok plan 3.gonio -n 3 -o 3.csv
expect_ok measure 3.csv atlas:red-glossy-plastic -o 3-readings.csv
expect_ok reconstruct 3.gonio 3-readings.csv -o 3.binary
expect_true 'a material of the basis is given back' \
    test "$(error atlas:red-glossy-plastic 3.binary)" -lt 5
rm 3*

# ---- the built-in basis, learned on first use by regression/cache_file_name ----

mkdir -p "$XDG_CACHE_HOME/gonio"
cp "${BUILTIN_BASES:?bases that regression/cache_file_name leaves}"/*-bivariate.gonio "$XDG_CACHE_HOME/gonio"
expect_ok plan --method condition --components 3 -n 5 --restarts 1 -o builtin.csv
expect_true 'a basis that is kept is not learned again' test ! -s "$root/work/stderr"
expect_ok measure builtin.csv atlas:$new -o builtin-readings.csv
expect_ok reconstruct builtin-readings.csv -o builtin.binary
expect_true 'the second use is silent' test ! -s "$root/work/stderr"
rm builtin*

# ---- conversions ----

expect_ok convert atlas:red-glossy-plastic a.binary
expect_ok convert a.binary b.binary
expect_same a.binary b.binary
expect_true 'the built-in material and its table are the same' \
    test "$(fingerprint a.binary)" = "$(fingerprint b.binary)"
expect_output '0.000     0.000    0.0000' compare atlas:red-glossy-plastic a.binary
if [ -x "${REPEAT_ROWS:-}" ]; then
    "$REPEAT_ROWS" <a.binary >360.binary
    expect_output 'MERL table 90 x 90 x 360' info 360.binary
    expect_output 'phi_d and phi_d + 180 degrees differ by 0.00 %' info 360.binary
    patch 360.binary 12 '\x00\x00\x00\x00\x00\x00\xf0\x7f' # infinity in one half
    expect_ok convert 360.binary b.binary
    expect_same a.binary b.binary
    expect_ok convert one/out.binary c.binary
    "$REPEAT_ROWS" <c.binary >360.binary
    expect_ok convert 360.binary b.binary
    expect_same c.binary b.binary
    "$REPEAT_ROWS" 2 <c.binary >360.binary
    for command in 'info 360.binary' 'convert 360.binary b.binary' 'compare c.binary 360.binary'; do
        # shellcheck disable=SC2086
        run $command
        expect_true "$command warns of halves that differ" grep -q \
            'warning: 360.binary: phi_d and phi_d + 180 degrees.* differ by 67 % (RMS)' \
            "$root/work/stderr"
    done
else
    skip 'tables of 360 phi_d bins: no $REPEAT_ROWS'
fi

# ---- several materials at once ----

mkdir many
cp one/r.csv other.csv
cp other.csv again.csv
expect_ok reconstruct b.gonio other.csv again.csv -o many
expect_same many/other.binary many/again.binary
expect_same many/other.binary one/out.binary
expect_fail 2 'several READINGS need a folder that exists' reconstruct b.gonio other.csv again.csv -o new
cp other.csv many/again.csv
expect_fail 2 'would both be written to many/again.binary' \
    reconstruct b.gonio again.csv many/again.csv -o many

# ---- JSON ----

json() { # FIELD ARGUMENTS...: valid JSON in which the field is not null
    expect_ok "${@:2}"
    expect_true "JSON of gonio ${*:2}" jq -e "$1 != null" "$root/work/stdout"
}
if jq --version >"$root/work/stdout" 2>&1; then
    jq() { command jq "$@" >"$root/work/jq" 2>&1; }
    json '.[0].albedo[5].albedo_rgb[2]' info --json a.binary
    json '.[99].class' info --json atlas:
    json '.[0].materials[11]' info --json b.gonio
    json '.[0].components' info --json one/p.csv
    json '.[2].measured' info --json b.gonio a.binary one/r.csv
    json '.explained_variance' learn --grid bivariate atlas:gold-polished atlas:burgundy-velvet --json -o x.gonio
    json '.condition_number' plan b.gonio -K 2 -n 4 --json -o x.csv
    json '.residual_log' reconstruct b.gonio one/r.csv --json -o x.binary
    json '.comparisons[1].B.log_relative' compare --json a.binary b.binary one/out.binary
    # What cannot be determined has no condition number.
    expect_ok plan b.gonio -n 1 --method random --json -o x.csv
    expect_true 'an infinite number is null' \
        jq -e '.condition_number == null' "$root/work/stdout"
else
    skip 'JSON output: no jq'
fi

finish
