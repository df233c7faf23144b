#!/bin/bash
# Options that change what is made: what each does to the result, beyond that it is accepted.
. "$(dirname "$0")/lib.sh"

# number FILTER ARGUMENTS...: a number of the command's JSON, in millionths.
number() {
    local name=$1
    shift
    "$GONIO" "$@" --json -q 2>"$root/work/stderr" |
        sed -n "s/^ *\"$name\": \([-0-9.e]*\),*\$/\1/p" | awk '{ printf "%.0f", 1e6 * $1 }'
}

# expect_less WHAT A B
expect_less() { expect_true "$1: $2 is less than $3" test "$2" -lt "$3"; }

# column FILE NUMBER: of the lines of a CSV file.
column() { grep -v '^[#t]' "$1" | cut -d, -f"$2"; }

lines() { grep -v '^#' "$1"; }

# ---- plan --start: what the swaps begin with ----

# shellcheck disable=SC2046
expect_ok learn --grid bivariate $(printf 'atlas:%s ' gold-polished red-glossy-plastic burgundy-velvet oak-sawn \
    steel-brushed plaster-cast red-cotton) -o bivariate.gonio
first_step() { lines "$1" | sed -n 2p; }
for start in random qr volume; do
    for seed in 1 2; do
        expect_ok plan bivariate.gonio --start $start --seed $seed --restarts "$(full && echo 2 || echo 1)" -n 12 \
            --history $start-$seed.history -o $start-$seed.csv
    done
    expect_true "$start: swaps only lower the condition number" test "$(lines $start-1.history | awk -F, '
        NR > 2 && $1 == restart && $3 > last { worse++ } { restart = $1; last = $3 } END { print worse + 0 }')" -eq 0
done
for start in qr volume; do
    expect_same <(first_step $start-1.history) <(first_step $start-2.history)
    expect_true "$start begins elsewhere than random" \
        test "$(first_step $start-1.history)" != "$(first_step random-1.history)"
done
expect_true 'random starts are those of the seed' \
    test "$(first_step random-1.history)" != "$(first_step random-2.history)"
expect_true 'qr and volume begin differently' \
    test "$(first_step qr-1.history)" != "$(first_step volume-1.history)"
expect_fail 2 "no start is called 'best'" plan bivariate.gonio --start best -n 12 -o x.csv

# ---- reconstruct and next: what is known of the instrument ----

# shellcheck disable=SC2046
expect_ok learn $(printf 'atlas:%s ' gold-polished red-glossy-plastic burgundy-velvet oak-sawn steel-brushed) \
    --mixtures 50 --seed 2 -o b.gonio
expect_ok plan b.gonio -n 10 -o p.csv
expect_ok measure p.csv atlas:white-emulsion-paint --noise 1 -o r.csv

# The noisier the readings are said to be, the less the result follows them.
residual() { number residual_log reconstruct b.gonio r.csv "$@" -o x.binary; }
expect_less 'residual of reconstruct --noise' "$(residual --noise 0.1)" "$(residual --noise 5)"
expect_less 'residual of reconstruct --floor' "$(residual --floor 1e-6)" "$(residual --floor 0.05)"
expect_true 'the defaults of --noise and --floor' test "$(residual)" -eq "$(residual --noise 1 --floor 1e-5)"
for option in --noise --floor --saturation; do
    expect_fail 2 "$option cannot be negative" reconstruct b.gonio r.csv $option -1 -o x.binary
    expect_fail 2 "$option cannot be negative" next b.gonio r.csv $option -1 -o x.csv
done

# The noisier readings are, the less five more of them help.
error_then() { number expected_then_percent next b.gonio r.csv "$@" -o next.csv; }
expect_less 'error after next --noise' "$(error_then --noise 0.1)" "$(error_then --noise 20)"
small=$(error_then --floor 1e-5)
cp next.csv small.csv
expect_true 'next --floor: another error to expect' test "$(error_then --floor 0.05)" -ne "$small"
expect_true 'next --floor: other directions' test "$(lines next.csv)" != "$(lines small.csv)"

# A detector that saturates at 0.25: its readings there are lower bounds, and taken so lead nearer to the truth.
awk -F, -v OFS=, '/^[#t]/ { print; next } { for (k = 7; k <= 9; k++) if ($k > 0.25) $k = 0.25; print }' r.csv >clipped.csv
expect_true 'some readings are clipped' test "$(column clipped.csv 7 | grep -cx 0.25)" -ge 3
predict() { expect_ok reconstruct b.gonio clipped.csv --predict-at p.csv "$@"; }
predict --saturation 0.25 -o bounded.csv
predict -o unbounded.csv
expect_true 'bounds are kept, to 3 per cent' test "$(paste -d, <(column clipped.csv 7) <(column bounded.csv 7) |
    awk -F, '$1 == 0.25 && $2 < 0.97 * 0.25 { n++ } END { print n + 0 }')" -eq 0
error() { number e6_percent compare r.csv "$1"; }
expect_less 'error with --saturation' "$(error bounded.csv)" "$(error unbounded.csv)"
expect_true 'next --saturation: more is expected to be wrong' test \
    "$(number expected_e6_percent next b.gonio clipped.csv --saturation 0.25 -n 1 -o next.csv)" -ne \
    "$(number expected_e6_percent next b.gonio clipped.csv -n 1 -o next.csv)"

# ---- next --metric ----

for metric in e6 cube-root log-relative; do
    expect_ok next b.gonio r.csv --metric $metric -n 5 -o $metric.csv
done
expect_same <(lines e6.csv) <("$GONIO" next b.gonio r.csv -n 5 -q -o default.csv && lines default.csv)
expect_true 'cube-root: other directions than e6' test "$(lines cube-root.csv)" != "$(lines e6.csv)"
expect_true 'log-relative: other directions than e6' test "$(lines log-relative.csv)" != "$(lines e6.csv)"
expect_fail 2 "--metric: 'rms' is none of e6, cube-root, log-relative" next b.gonio r.csv --metric rms -o x.csv

finish
