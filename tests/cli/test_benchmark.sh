#!/bin/bash
# gonio benchmark: what it leaves, that a stopped run leaves the same, programs as methods, and what it refuses.
. "$(dirname "$0")/lib.sh"

expect_ok learn atlas:oak-sawn atlas:gold-polished atlas:plaster-cast --mixtures 40 --components 30 -o b.gonio

# 44 directions of a cloth, as scattered readings of one channel; 15 are in the plane of incidence.
awk 'BEGIN {
    print "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg"
    for (k = 0; k < 44; k++)
        printf "%d,0,%d,%d\n", 5 + 7 * k % 61, 3 + 11 * k % 67, k % 3 == 0 ? 180 : 13 * k % 360
}' >directions.csv
expect_ok measure directions.csv atlas:red-cotton -o cloth.csv

# ---- what it leaves ----

ways='--directions planned,next,random,in-plane,repeated --draws 2'
run_it() { # OUT OPTION...
    local out=$1
    shift
    # shellcheck disable=SC2086
    expect_output "$out: see report.md" benchmark --learn b.gonio cloth.csv -n 4,12 $ways "$@" -o "$out"
}
run_it out
for name in trials means times; do
    expect_true "table $name" test "$(wc -l <out/tables/$name.csv)" -gt 8
done
expect_true 'the page has its set' grep -q '^## cloth.csv' out/report.md
expect_true 'the curves have their data' test -s out/figures/e6-1.csv
expect_true 'all errors are in the tables' grep -q 'e6_percent,cube_root_percent,log_relative' out/tables/trials.csv
# set, material, learned_from, directions, method, draw, n, read, compared
expect_true 'every way, draw, n and method is there' test "$(grep -c '"posterior"' out/tables/trials.csv)" -eq 16
expect_true 'what was read is not compared' \
    test "$(awk -F, '$4 == "\"planned\"" { print $8 + $9 / 3 }' out/tables/trials.csv | sort -u)" = 44
expect_true 'a repeated direction is read ten times' \
    test "$(awk -F, '$4 == "\"repeated\"" { print $8 - $7 }' out/tables/trials.csv | sort -u)" = 9
expect_true 'means are means' awk -F, '
    NR == FNR { if ($4 == "\"random\"" && $5 == "\"interpolation\"" && $7 == 12) { sum += $10; count++ } next }
    $2 == "\"random\"" && $3 == "\"interpolation\"" && $4 == 12 { found = 1; off = $7 - sum / count }
    END { exit !(found && off < 1e-6 && off > -1e-6) }' out/tables/trials.csv out/tables/means.csv
expect_true 'repeated readings are compared with single ones' \
    grep -q '"worse_if_repeated": [0-9]' out/results.json
if command -v jq >/dev/null; then
    expect_true 'results.json holds the means' test "$(jq '.means | length' out/results.json)" -eq 30
fi

# ---- the same, however it was run ----

# same WHAT FOLDER: all but times is what the first run left.
same() {
    local file
    for file in report.md results.json tables/trials.csv tables/means.csv figures/e6-1.csv; do
        checks=$((checks + 1))
        cmp "out/$file" "$2/$file" >"$root/work/cmp" 2>&1 || failed "$1 leaves another $file" "$(cat "$root/work/cmp")"
    done
}
cp -r out again
rm again/pieces/*random* again/report.md
run_it again
expect_true 'going on is told' grep -q 'note: trials: resuming' "$root/work/stderr"
same 'going on' again
run_it one --threads 1
same 'one thread' one
expect_fail 1 'another run' benchmark --learn b.gonio cloth.csv -n 4,8 -o out

# ---- tables: by folds each is tested once, by what the others teach ----

expect_ok benchmark atlas:oak-sawn atlas:gold-polished atlas:red-cotton atlas:plaster-cast -n 6 --folds 2 \
    --candidates 200 --directions random --draws 1 --methods interpolation,lambert-ggx --noise 1 -o folds
expect_true 'each is tested once' \
    test "$(awk -F, 'NR > 1 { print $2 }' folds/tables/trials.csv | sort | uniq -c | awk '{ print $1 }' | sort -u)" = 2
expect_true 'errors are finite' awk -F, 'NR > 1 && !($10 > 0 && $10 < 100) { exit 1 }' folds/tables/trials.csv

# ---- a program as a method ----

# Predicts the mean of each channel of the readings.
cat >mean.sh <<'END'
awk -F, -v directions="$2" '
    /^#/ { next }
    !names { names = "R,G,B"; for (k = 1; k <= NF; k++) if ($k ~ /_per_sr$/) column[++count] = k; next }
    { for (k = 1; k <= count; k++) sum[k] += $column[k]; rows++ }
    END {
        print names
        getline line <directions
        while ((getline line <directions) > 0)
            for (k = 1; k <= count; k++) printf "%.10g%s", sum[k] / rows, k < count ? "," : "\n"
    }' "$1" >"$3"
END
expect_ok benchmark --learn b.gonio cloth.csv -n 4 --directions random --draws 1 --methods interpolation \
    --external 'sh mean.sh' -o external
expect_true 'the program is a method' grep -q '"external",0,4,4,' external/tables/trials.csv
expect_fail_in() { # PART ARGUMENTS...: as expect_fail 1, but the folder of the run stays
    local part=$1
    shift
    run "$@"
    expect_true "gonio $* fails" test $? -ne 0
    expect_true "$part is said" grep -qF "$part" "$root/work/stderr"
}
expect_fail_in "'false' failed (exit code 1)" benchmark --learn b.gonio cloth.csv -n 4 --directions random \
    --methods external --external false -o bad
expect_fail_in 'line 2 of its predictions' benchmark --learn b.gonio cloth.csv -n 4 --directions random \
    --methods external --external 'sh -c "echo R,G,B >$2" x' -o worse

expect_fail_in 'cloth.csv: not a material' benchmark --learn cloth.csv cloth.csv -n 4 -o bad-lesson

# ---- what it refuses ----

expect_fail 2 'no output' benchmark cloth.csv
expect_fail 2 'are needed' benchmark -o none
expect_fail 2 "--methods: 'best' is none of posterior, interpolation, lambert-ggx" benchmark cloth.csv --methods best -o none
expect_fail 2 "--directions: 'best' is none of planned, next, random" benchmark cloth.csv --directions best -o none
expect_fail 2 'needs --external' benchmark cloth.csv --methods external -o none
expect_fail 2 'takes numbers' benchmark cloth.csv -n 4,x -o none
expect_fail 2 'reach' benchmark cloth.csv --reach 91 -o none
expect_fail 2 'needs --candidates' benchmark --learn b.gonio atlas:oak-sawn --candidates 0 -o none
expect_fail 1 'too few to learn from' benchmark atlas:oak-sawn -o none
expect_fail 1 'another kind of basis' benchmark --learn b.gonio atlas:oak-sawn --directions frost -n 4 -o none
expect_fail 1 'missing.csv' benchmark --learn b.gonio missing.csv -o none

finish
