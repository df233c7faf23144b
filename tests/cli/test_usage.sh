#!/bin/bash
# Command lines that cannot be meant: exit code 2, one line, nothing done.
. "$(dirname "$0")/lib.sh"

expect_ok learn --grid bivariate atlas:gold-polished atlas:red-cotton atlas:oak-sawn atlas:plaster-cast -o b.gonio
expect_ok plan b.gonio -n 5 -o p.csv
expect_ok measure p.csv atlas:white-linen -o r.csv

# ---- the program and its commands ----

expect_output 'gonio 0.' --version
expect_output 'Usage: gonio COMMAND' --help
expect_output 'Usage: gonio COMMAND' help
for command in info convert learn plan measure reconstruct compare reproduce demo; do
    expect_output "Usage: gonio $command" $command -h
    expect_output "Usage: gonio $command" $command --help
    expect_fail 2 '--nonsense: unknown option (see gonio' $command --nonsense
    expect_fail 2 '--threads: missing argument' $command --threads
    expect_fail 2 'many: invalid numeric value' $command --threads many
    expect_fail 2 '--threads cannot be negative' $command --threads -1
done

run
expect_true 'no command is a usage error' test $? -eq 2
run nonsense
expect_true 'an unknown command is a usage error' test $? -eq 2
expect_true 'an unknown command is named' \
    grep -q "no command is called 'nonsense'" "$root/work/stderr"

# ---- missing and superfluous arguments ----

expect_fail 2 'no file given' info
expect_fail 2 'IN and OUT are needed' convert
expect_fail 2 'IN and OUT are needed' convert b.gonio
expect_fail 2 'IN and OUT are needed' convert a b c
expect_fail 2 'no materials given' learn -o x.gonio
expect_fail 2 'give at most one BASIS, not 2' plan b.gonio b.gonio -o x.csv
expect_fail 2 'PLAN and MATERIAL are needed' measure p.csv -o x.csv
expect_fail 2 'PLAN and MATERIAL are needed' measure p.csv a b -o x.csv
expect_fail 2 'READINGS are needed; give a BASIS' reconstruct -o x.binary
expect_fail 2 'several READINGS need a folder that exists' reconstruct a b c -o x.binary
expect_fail 2 'REFERENCE and at least one OTHER are needed' compare
expect_fail 2 'REFERENCE and at least one OTHER are needed' compare atlas:white-linen
expect_fail 2 'no arguments are needed' demo all
expect_fail 2 'no such built-in material' info atlas:nonsense
expect_fail 2 'no such built-in material' convert atlas:nonsense x.binary

for command in 'learn atlas:oak-sawn atlas:red-cotton' 'plan b.gonio -n 5' \
    'measure p.csv atlas:white-linen' 'reconstruct b.gonio r.csv'; do
    # shellcheck disable=SC2086
    {
        expect_fail 2 'no output: give -o FILE' $command
        expect_fail 2 'no output: give -o FILE' $command -o ''
        expect_fail 2 '-o: missing argument' $command -o
    }
done
expect_fail 2 'no output' convert atlas:white-linen ''

# ---- learn ----

expect_fail 2 '4 components asked for, but 4 columns give at most 3' \
    learn --grid bivariate atlas:gold-polished atlas:red-cotton atlas:oak-sawn atlas:plaster-cast --components 4 \
    -o x.gonio
expect_fail 2 'a basis needs at least 2 materials' learn --grid bivariate atlas:oak-sawn -o x.gonio
expect_fail 2 '--components: -3 is too small' learn atlas:oak-sawn atlas:red-cotton -K -3 -o x.gonio
expect_fail 2 "--grid: 'trivariate' is none of bivariate, full, sectored" \
    learn atlas:oak-sawn atlas:red-cotton --grid trivariate -o x.gonio
expect_fail 2 "--channels: 'both' is none of joint, separate" \
    learn atlas:oak-sawn atlas:red-cotton --channels both -o x.gonio
expect_fail 2 "--mapping: 'cubic' is none of log, relative" \
    learn atlas:oak-sawn atlas:red-cotton --mapping cubic -o x.gonio
expect_fail 2 '3 components asked for, but 2 columns give at most 2' \
    learn --grid bivariate atlas:oak-sawn atlas:red-cotton --no-mean -K 3 -o x.gonio
expect_fail 2 "--without: no material is called 'steel'" \
    learn atlas:oak-sawn atlas:red-cotton --without steel -o x.gonio
expect_fail 2 'no materials given' \
    learn atlas:oak-sawn atlas:red-cotton --without oak-sawn,red-cotton -o x.gonio

# ---- plan ----

expect_fail 2 '4 components asked for, but the basis has 3' plan b.gonio -K 4 -n 9 -o x.csv
expect_fail 2 '2 readings cannot determine 3 coefficients' plan b.gonio -n 2 -o x.csv
expect_fail 2 'the basis has only 24069 rows' plan b.gonio -n 24070 -o x.csv
expect_fail 2 '-n: 0 is too small' plan b.gonio -n 0 -o x.csv
expect_fail 2 '-n: -5 is too small' plan b.gonio -n -5 -o x.csv
expect_fail 2 'number too large' plan b.gonio -n 99999999999 -o x.csv
expect_fail 2 'invalid numeric value' plan b.gonio -n 5x -o x.csv
expect_fail 2 '--components: -1 is too small' plan b.gonio -K -1 -o x.csv
expect_fail 2 '--restarts: 0 is too small' plan b.gonio --restarts 0 -o x.csv
expect_fail 2 "no selection method is called 'best'" plan b.gonio --method best -n 5 -o x.csv
expect_fail 2 'phi_d of 180 degrees is outside' plan b.gonio --phi-d 180 -n 5 -o x.csv
expect_fail 2 'phi_d of nan degrees is outside' plan b.gonio --phi-d nan -n 5 -o x.csv
expect_fail 2 '--history and -o name the same file' plan b.gonio -n 5 --history x.csv -o x.csv
expect_fail 2 'b.gonio is an input' plan b.gonio -n 5 --history b.gonio -o x.csv

# ---- measure and reconstruct ----

expect_fail 2 'cannot be negative' measure p.csv atlas:white-linen --noise -1 -o x.csv
expect_fail 2 'cannot be negative' measure p.csv atlas:white-linen --floor -1 -o x.csv
expect_fail 2 'cannot be negative' measure p.csv atlas:white-linen --noise nan -o x.csv
expect_fail 2 'must be finite and not negative' measure p.csv atlas:white-linen --noise inf -o x.csv
expect_fail 2 'must be finite and not negative, at most' measure p.csv atlas:white-linen --floor 1e308 -o x.csv
expect_fail 2 '4 components asked for, but the basis has 3' \
    reconstruct b.gonio r.csv -K 4 -o x.binary
expect_fail 2 '--components: -1 is too small' reconstruct b.gonio r.csv -K -1 -o x.binary

# ---- more threads than any machine has are no error ----

expect_ok plan b.gonio -n 5 --threads 1000000 -o many.csv

# ---- kernels are not older than the processor; those that the user names are used ----

cores() { OPENBLAS_VERBOSE=2 "$GONIO" info b.gonio 2>&1 | sed -n 's/^Core: //p'; }
if grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo; then
    expect_true 'kernels use AVX2 at least' \
        test -n "$(cores | tail -n 1 | grep -iE '^(Haswell|Zen|Excavator|SkylakeX|Cooperlake|SapphireRapids)$')"
    expect_true 'the kernels that the user names' \
        test "$(OPENBLAS_CORETYPE=Nehalem cores | tr '\n' ' ')" = 'Nehalem '
    expect_true 'kernels that nobody knows do no harm' test "$(OPENBLAS_CORETYPE=none cores | wc -l)" -eq 1
fi

# ---- threads that wait sleep soon, unless the user says how they wait ----

waits() { env -u OMP_WAIT_POLICY "$@" OMP_DISPLAY_ENV=verbose "$GONIO" plan b.gonio -n 5 --threads 2 -o w.csv 2>&1 |
    sed -n "s/.*GOMP_SPINCOUNT = '\\(.*\\)'/\\1/p" | tail -n 1; }
if [ "$(getconf _NPROCESSORS_ONLN)" -gt 1 ]; then
    expect_true 'a tenth of what libgomp waits' test "$(waits -u OMP_NUM_THREADS)" = 30000
fi
expect_true 'what the user says' test "$(waits GOMP_SPINCOUNT=7)" = 7
expect_true 'how the user lets threads wait' test "$(waits OMP_WAIT_POLICY=passive)" = 0

finish
