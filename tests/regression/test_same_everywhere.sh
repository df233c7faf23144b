#!/bin/bash
# The main commands give the same bytes on any number of threads, in any locale, and under any setting of the OpenMP
# runtime and of OpenBLAS. (comma_locale does the same with the library in a program with a locale of its own.)
. "$(dirname "$0")/../cli/lib.sh"
if ! full; then
    echo 'SKIPPED: a release build does this'
    exit 0
fi

cat >r.csv <<'END_OF_READINGS'
theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R_per_sr,G_per_sr,B_per_sr
30,0,40,180,0.11,0.2,0.3
30,90,50,270,0.4,0.52,0.6
0,0,10,0,0.14,0.15,0.16
55.5,0,20,100,0.15,0.16,0.17
10,0,70,30,0.1,0.1,0.12
END_OF_READINGS
materials='atlas:oak-sawn atlas:gold-polished atlas:plaster-cast atlas:red-cotton'

# run NAME ARGUMENTS...: in the setting of $setting (an array); what it prints goes to NAME.txt.
run_in() {
    local name=$1
    shift
    env "${setting[@]}" "$GONIO" "$@" "${threads[@]}" >"$name.txt" 2>&1 || echo "exit code $?" >>"$name.txt"
}

# shellcheck disable=SC2086
chain() {
    run_in learn learn $materials --mixtures 30 -K 12 -o b.gonio
    run_in learn-bivariate learn --grid bivariate $materials -o c.gonio
    run_in plan plan b.gonio -n 4 --candidates ../r.csv -o plan.csv
    run_in condition plan c.gonio -K 3 -n 4 --restarts 1 --history history.csv -o condition.csv
    run_in readings measure condition.csv atlas:white-linen -o condition-readings.csv
    run_in measure measure condition.csv atlas:white-linen --noise 3 --seed 2 -o noisy.csv
    run_in reconstruct reconstruct b.gonio ../r.csv --predict-at ../r.csv -o predicted.csv
    run_in table reconstruct b.gonio ../r.csv --deviation d.binary -o t.binary
    run_in ridge reconstruct c.gonio condition-readings.csv --method ridge -o ridge.binary
    run_in next next b.gonio ../r.csv -n 1 --candidates condition.csv -o next.csv
    run_in compare compare t.binary atlas:oak-sawn predicted.csv --json
    run_in isotropy check-isotropy b.gonio ../r.csv
    run_in check check in-plane --json
    run_in zemax convert t.binary --format zemax --steps 15,15,30 t.bsdf
    run_in csv convert t.bsdf t.csv
    run_in json convert noisy.csv noisy.json
    run_in render render t.binary --size 16 --samples 4 -o t.exr
}

# Leaves out what names the command and its threads, times, and bases, which hold the command too.
strip() {
    rm -rf ./*.gonio
    grep -rlI . . | xargs sed -i -e '/^# command/d' -e '/"command": /d' -e '/"threads": /d' -e '/"seconds": /d' \
        -e 's/"comments": "gonio[^"]*"//'
}

# same WHAT SETTING...: the chain under these variables; THREADS=N is an option of the program.
same() {
    local what=$1
    shift
    threads=()
    case $1 in THREADS=*) threads=(--threads "${1#*=}") && shift ;; esac
    setting=("$@")
    rm -rf now
    mkdir now
    (cd now && chain && strip)
    checks=$((checks + 1))
    diff -r first now >"$root/work/diff" 2>&1 || failed "$what gives other files" "$(head -c 1500 "$root/work/diff")"
}

mkdir first now
threads=(--threads 1)
setting=(LC_ALL=C)
(cd first && chain && strip)
expect_true 'no command fails' test -z "$(grep -l '^exit code' first/*.txt | grep -v render)" # it may not be built

same '2 threads' THREADS=2 OPENBLAS_NUM_THREADS=1
same '16 threads' THREADS=16 OMP_NUM_THREADS=2,2 OMP_THREAD_LIMIT=5 GOTO_NUM_THREADS=3 LC_ALL=C.UTF-8
mkdir locales
export LOCPATH=$PWD/locales
locale=nowhere
if localedef -c -i de_DE -f UTF-8 locales/de_DE.UTF-8 >/dev/null 2>&1 || [ -d locales/de_DE.UTF-8 ]; then
    locale=de_DE.UTF-8
else
    skip 'a locale with decimal commas: none can be made (localedef)'
fi
same '3 threads and a decimal comma' THREADS=3 LC_ALL=$locale OPENBLAS_NUM_THREADS=4 OMP_DYNAMIC=true \
    OMP_SCHEDULE=dynamic,1 OMP_PROC_BIND=true OMP_MAX_ACTIVE_LEVELS=3
finish
