#!/usr/bin/env bash
# What the commands make, so that two builds can be compared byte by byte:
#   same_bytes.sh GONIO OUT [MATERIALS]     runs every command into the folder OUT, writes OUT/SUMS
#   diff OLD/SUMS NEW/SUMS                  names the outputs that differ
# MATERIALS is a folder of measured materials; the shared ones by default, the built-in ones where there are none.
# Lines that say which command made a file are left out of the sums. THREADS=N is handed to every command.
# ONLY=REGEX runs the commands whose names match; the others' outputs are those that are in OUT already.
# Spellings of older builds are known, so that a build can be compared with one from before a change of words.
set -eu
gonio=$(realpath "$1")
out=$2
shared=${GONIO_SHARED:-$(cd "$(dirname "$0")/../.." && pwd)/../shared}
materials=${3:-$shared/data/neural-merl}
cornell=$shared/data/cornell
mkdir -p "$out"
out=$(realpath "$out")
cd "$out"
if [ -d "$materials" ]; then
    new=$materials/gold-paint.h5
    other=$materials/black-fabric.h5
    without=gold-paint,black-fabric
else
    materials=atlas:
    new=atlas:gold-polished
    other=atlas:red-plastic
    without=gold-polished,red-plastic
fi
case $(basename "$materials") in atlas:) set -- atlas: ;; *) set -- "$materials"/*.h5 ;; esac

# spelling COMMAND NEW OLD: whichever the build has
spelling() { if "$gonio" "$1" --help | grep -q -- "$2"; then echo "$2"; else echo "$3"; fi; }
components=$(spelling plan --components --basis)
leave_out=$(spelling compare --leave-out --without)
predict=$(spelling reconstruct --predict-at --at)
unchecked=$(spelling reconstruct --no-checks --believe)

# run NAME COMMAND ...: standard output goes to NAME.out
run() {
    name=$1
    command=$2
    shift 2
    [[ $name =~ ${ONLY:-.} ]] || return 0
    start=$(date +%s%N)
    "$gonio" "$command" --threads "${THREADS:-2}" "$@" >"$name.out" 2>"$name.err" || echo "exit $?" >>"$name.out"
    printf '%-28s %6d ms\n' "$name" $((($(date +%s%N) - start) / 1000000)) >&2
}

# Bases. The file's own format is not compared, but what is in it: the plans and reconstructions below.
run learn-default learn "$@" --without "$without" -o default.gonio --json
run learn-bivariate learn "$@" --without "$without" --grid bivariate -o bivariate.gonio --json
run learn-separate learn "$@" --without "$without" --grid bivariate --channels separate -o separate.gonio --json
run learn-full learn atlas: --grid full -o full.gonio --json
run learn-relative learn atlas: --grid full --channels separate --mapping relative -o relative.gonio --json
run learn-no-mean learn atlas: --grid full --no-mean -o matusik.gonio --json
run learn-small learn atlas: --mixtures 50 --seed 3 -o small.gonio --json
for basis in default bivariate separate full relative matusik small; do
    run "info-$basis" info "$basis.gonio"
done

# Plans.
run plan-default plan default.gonio -n 20 -o plan-default.csv --json
run plan-cube-root plan default.gonio -n 10 --metric cube-root -o plan-cube-root.csv --json
run plan-log-relative plan default.gonio -n 10 --metric log-relative -o plan-log-relative.csv
run plan-target plan default.gonio --target-error 4% -o plan-target.csv
run plan-few plan default.gonio -n 8 -o plan-few.csv
run plan-builtin plan -n 8 -o plan-builtin.csv
run plan-expected plan bivariate.gonio --method expected-error -n 12 -o plan-expected.csv
run plan-condition plan bivariate.gonio $components 20 -n 30 --restarts 2 --history history.csv -o plan-condition.csv
run plan-separate plan separate.gonio $components 20 -n 30 --start qr -o plan-separate.csv
run plan-volume plan bivariate.gonio $components 20 -n 30 --start volume --phi-d 0 -o plan-volume.csv
run plan-random plan bivariate.gonio --method random $components 20 -n 40 --seed 5 -o plan-random.csv
run plan-matusik plan matusik.gonio --method matusik $components 20 -n 40 -o plan-matusik.csv
run plan-nielsen plan relative.gonio --method nielsen -n 10 -o plan-nielsen.csv
run plan-frost plan relative.gonio --method frost -n 10 -o plan-frost.csv

# Readings.
for plan in default few expected condition separate random; do
    run "measure-$plan" measure "plan-$plan.csv" "$new" -o "readings-$plan.csv"
done
for plan in matusik nielsen frost builtin; do
    run "measure-$plan" measure "plan-$plan.csv" atlas:gold-polished -o "readings-$plan.csv"
done
run measure-noisy measure plan-default.csv "$other" --noise 2 --floor 1e-4 --outliers 10 --seed 4 -o readings-noisy.csv

# Materials.
run reconstruct-default reconstruct default.gonio readings-default.csv --deviation sd.binary -o default.binary --json
run reconstruct-noisy reconstruct default.gonio readings-noisy.csv --noise 2 --floor 1e-4 -o noisy.binary --json
run reconstruct-few reconstruct default.gonio readings-few.csv -o few.binary --json
run reconstruct-builtin reconstruct readings-builtin.csv -o builtin.binary --json
run reconstruct-predict reconstruct default.gonio readings-default.csv $predict plan-few.csv -o predicted.csv --json
run reconstruct-unchecked reconstruct default.gonio readings-noisy.csv $unchecked $predict plan-few.csv -o unchecked.csv
run reconstruct-saturated reconstruct default.gonio readings-default.csv --saturation 0.2 $predict plan-few.csv -o saturated.csv
run reconstruct-ridge reconstruct default.gonio readings-default.csv --method ridge --eta 10 -o ridge.binary --json
run reconstruct-expected reconstruct bivariate.gonio readings-expected.csv --method posterior -o expected.binary --json
run reconstruct-condition reconstruct bivariate.gonio readings-condition.csv -o condition.binary --json
run reconstruct-all reconstruct bivariate.gonio readings-condition.csv --all-channels -o all.binary --json
run reconstruct-separate reconstruct separate.gonio readings-separate.csv -o separate.binary --json
run reconstruct-random reconstruct bivariate.gonio readings-random.csv -o random.binary --json
run reconstruct-matusik reconstruct matusik.gonio readings-matusik.csv -o matusik.binary --json
run reconstruct-nielsen reconstruct relative.gonio readings-nielsen.csv -o nielsen.binary --json
run reconstruct-frost reconstruct relative.gonio readings-frost.csv -o frost.binary --json
run next next default.gonio readings-few.csv -n 3 -o next.csv --json
run next-cube-root next default.gonio readings-few.csv -n 2 --metric cube-root --noise 2 -o next-cube-root.csv
if [ -d "$cornell" ]; then
    cayman=$cornell/cayman.brdf
    run plan-candidates plan default.gonio --candidates "$cayman" -n 12 -o plan-candidates.csv --json
    run measure-candidates measure plan-candidates.csv "$cayman" -o readings-candidates.csv
    run reconstruct-spectral reconstruct default.gonio readings-candidates.csv $predict "$cayman" -o spectral.csv --json
    run compare-spectral compare "$cayman" spectral.csv $leave_out plan-candidates.csv --json
    run next-candidates next default.gonio readings-candidates.csv --candidates "$cayman" -n 2 -o next-candidates.csv
fi

# Errors, tables, pictures.
run compare compare "$new" default.binary condition.binary all.binary separate.binary --json
run compare-atlas compare atlas:gold-polished matusik.binary nielsen.binary frost.binary builtin.binary --json
run convert convert "$new" converted.binary
run info-material info "$new"
run info-readings info readings-default.csv
run render render default.binary --size 64 --samples 16 -o sphere.exr
run render-lamp render default.binary --size 64 --samples 4 --light point -o lamp.png
run render-compare render --compare --size 64 --samples 4 "$new" default.binary condition.binary -o compared.png
run reproduce reproduce "$@" --quick -o paper
rm -rf paper/timings* paper/machine*

# The sums: of files as they are, of text without the lines that name commands, versions and times.
plain() { grep -avE '^# (command|gonio)|"(seconds|version|command|threads)"|gonio (plan|measure|next|reconstruct)' "$1" || true; }
find . -type f ! -name '*.gonio' ! -name SUMS ! -name '*.err' | LC_ALL=C sort | while read -r file; do
    printf '%s  %s\n' "$(plain "$file" | sha256sum | cut -c 1-16)" "$file"
done >SUMS
