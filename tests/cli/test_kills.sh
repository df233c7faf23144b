#!/bin/bash
# Every command that writes, ended by SIGKILL, SIGTERM or SIGHUP at random moments, some KILLS of them: outputs are old
# or new as a whole, and nothing is left. Runs that can be resumed go on and leave what one that nobody ended does.
. "$(dirname "$0")/lib.sh"
kills=${KILLS:-$(full && echo 90 || echo 20)}
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
shim=$(full && echo "$FAULTS_SHIM" || echo -)
seed=${SEED:-1}
RANDOM=$seed

"$FUZZ_SEEDS" "$root/seeds" || exit 1
cp "$root/seeds/basis/1.gonio" b.gonio
cp "$root/seeds/basis/0.gonio" mixed.gonio
cp "$root/seeds/material/matrices.xml" m.xml
cat >r.csv <<'END_OF_READINGS'
theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R_per_sr,G_per_sr,B_per_sr
30,0,40,180,0.1,0.2,0.3
30,90,50,270,0.4,0.5,0.6
0,0,10,0,1.4,1.5,1.6
END_OF_READINGS
cut -d , -f 1-4 r.csv >p.csv
export TMPDIR=$root/scratch
mkdir "$TMPDIR" reach

# ---- every command of the program ----

declare -A ended # by command: what was done to it
weights=0
planned=()

# ends WEIGHT OUTPUTS ARGUMENTS...: a command that writes is to be ended; WEIGHT is its share of the kills.
ends() {
    planned+=("$*")
    weights=$((weights + $1))
    ended[$3]=killed
}
# only_reads COMMAND...; its_own COMMAND...: a command of which a test below ends a run, or which runs others.
only_reads() { for word in "$@"; do ended[$word]=reads; done; }
its_own() { for word in "$@"; do ended[$word]=own; done; }

only_reads info check-isotropy compare
its_own benchmark reproduce demo
ends 4 r.json convert -q r.csv r.json
ends 2 m.csv convert -q m.xml m.csv
ends 4 l.gonio learn -q --grid bivariate atlas:oak-sawn atlas:gold-polished -o l.gonio
ends 2 reach/reach.csv,reach/reach.gp,reach/reach.svg,reach/reach.png,reach/reach.pdf check -q two-arms -o reach
ends 8 p.out,h.out plan -q b.gonio -n 2 -K 2 --method random --history h.out -o p.out
ends 8 p.out plan -q mixed.gonio -n 2 --candidates p.csv -o p.out
ends 8 m.out measure -q p.csv r.csv -o m.out
ends 8 at.out reconstruct -q mixed.gonio r.csv --predict-at p.csv -o at.out
ends 4 t.out,d.out reconstruct -q mixed.gonio r.csv --deviation d.out -o t.out
ends 8 n.out next -q mixed.gonio r.csv -n 1 -o n.out
if "$GONIO" report atlas:plaster-cast -o probe.html >/dev/null 2>&1; then
    ends 2 page.html report -q atlas:plaster-cast -o page.html
else
    skip 'report, which was not built'
    its_own report
fi
if "$GONIO" render atlas:plaster-cast --size 16 --samples 1 -o probe.png >/dev/null 2>&1; then
    ends 4 s.png render -q atlas:plaster-cast --size 16 --samples 1 -o s.png
else
    skip 'render, which was not built'
    its_own render
fi
rm -f probe.*

commands=$("$GONIO" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
expect_true 'the commands are listed' test "$(wc -w <<<"$commands")" -gt 10
for word in $commands; do
    expect_true "gonio $word is ended by this test" test -n "${ended[$word]:-}"
    expect_true "gonio $word writes no file, or is ended" \
        test "${ended[$word]:-}" != reads -o "$("$GONIO" "$word" --help | grep -c -- '--output=')" -eq 0
done

for row in "${planned[@]}"; do
    # shellcheck disable=SC2086
    set -- $row
    weight=$1 outputs=$2
    shift 2
    checks=$((checks + 1))
    seed=$((seed + 1))
    "$KILLS_RUN" "$shim" $((kills * weight / weights)) $seed "$outputs" "$GONIO" "$@" >"$root/work/kills" 2>&1 ||
        failed "gonio $*" "$(head -30 "$root/work/kills")"
    [ -z "${KILLS:-}" ] || echo "gonio $*: $(tail -1 "$root/work/kills")"
done

# ---- runs that are resumed ----

now() { date +%s%3N; }

# wait_for JOB FOLDER: until there is a piece of the run in it, or the job has ended.
wait_for() {
    while [ -z "$(find "$2" -name '*.json' 2>/dev/null)" ] && kill -0 "$1" 2>/dev/null; do sleep 0.01; done
}

unfinished() {
    find . "$TMPDIR" -name '*.part' -o -name 'gonio-*' | sort
}

# killed SIGNAL MOMENT ARGUMENTS...: ended by the signal or well; MOMENT is the most milliseconds, or a folder of pieces.
killed() {
    local signal=$1 moment=$2 code before
    shift 2
    before=$(unfinished) # of a run before this one, that SIGKILL ended
    "$GONIO" "$@" >"$root/work/stdout" 2>"$root/work/stderr" &
    local job=$!
    case $moment in
    */*) wait_for $job "$moment" ;;
    *) moment=$((RANDOM % moment)) && sleep "$(printf '%d.%03d' $((moment / 1000)) $((moment % 1000)))" ;;
    esac
    kill -s "$signal" $job 2>/dev/null
    wait $job 2>/dev/null
    code=$?
    expect_true "SIG$signal ends gonio $1, or it ends well: $code" test $code -eq 0 -o "$(kill -l $code)" = "$signal"
    [ "$signal" = KILL ] ||
        expect_true "SIG$signal leaves nothing unfinished" test -z "$(unfinished | grep -vxF "$before")"
}

# resumes COUNT OUT ARGUMENTS...: a run into OUT that is ended so many times leaves what one does that nobody ends.
resumes() {
    local count=$1 out=$2 signals=(KILL TERM HUP) resumed=no start most
    shift 2
    start=$(now)
    expect_ok "$@" -o "$out-whole"
    most=$(($(now) - start))
    killed KILL "$out/pieces" "$@" -o "$out"
    for ((k = 1; k < count; k++)); do
        killed "${signals[k % 3]}" $most "$@" -o "$out"
        grep -q resuming "$root/work/stderr" && resumed=yes
    done
    expect_ok "$@" -o "$out"
    grep -q resuming "$root/work/stderr" && resumed=yes
    expect_true "gonio $1 goes on" test $resumed = yes
    rm -r "$out/pieces" "$out-whole/pieces" # they hold times
    checks=$((checks + 1))
    diff -r -x 'times*' -x 'machine*' "$out-whole" "$out" >"$root/work/diff" 2>&1 ||
        failed "gonio $1 leaves other files" "$(head "$root/work/diff")"
}

materials='atlas:gold-polished atlas:oak-sawn atlas:red-cotton atlas:plaster-cast'
# shellcheck disable=SC2086
resumes $((kills / 18)) paper reproduce $materials --quick --only fig3b
resumes $((kills / 10)) bench benchmark --learn mixed.gonio r.csv -n 1,2 --directions random --draws 60
for signal in KILL TERM HUP; do
    killed $signal 999 demo -q -o demo
done
finish
