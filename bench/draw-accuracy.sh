#!/usr/bin/env bash
# Error against readings, a curve a method, from the CSV of gonio-accuracy: docs/figures/accuracy.
#
#     bench/draw-accuracy.sh FIGURE.png accuracy.csv nielsen.csv ...
#
# Three panels, one a metric: means over all materials and splits of a file. Without noise only.
set -euo pipefail
figure=$1
shift
data=$(mktemp)
trap 'rm -f "$data"' EXIT

# Lines of: place of the method, n, its name, means; then a block a method, by ascending n.
cat "$@" | awk -F, '
    BEGIN { split("expected-error,nielsen,frost,condition,random", names, ","); for (m in names) place[names[m]] = m }
    !($1 in place) || $5 != 0 || $7 != 0 { next }
    { key = place[$1] " " $4 " " ($1 == "expected-error" ? "gonio" : $1)
      count[key]++; e6[key] += $8; root[key] += $9; relative[key] += $10 }
    END { for (key in count) print key, e6[key] / count[key], root[key] / count[key], relative[key] / count[key] }
' | sort -k1,1n -k2,2n | awk '
    $3 != last { if (last != "") print "\n"; printf "\"%s\"\n", $3; last = $3 }
    { print $2, $4, $5, $6 }
' >"$data"
blocks=$(grep -c '^"' "$data")

gnuplot <<EOF
set terminal pngcairo size 1500,520 noenhanced font 'sans-serif,13'
set output '$figure'
set multiplot layout 1,3
set linetype 1 lc rgb '#0072B2' lw 2.4 dt 1 pt 7 ps 1
set linetype 2 lc rgb '#D55E00' lw 1.6 dt (12,4) pt 5 ps 0.9
set linetype 3 lc rgb '#009E73' lw 1.6 dt (12,4,3,4) pt 9 ps 1.1
set linetype 4 lc rgb '#CC79A7' lw 1.6 dt (4,3) pt 13 ps 1.2
set linetype 5 lc rgb '#000000' lw 1.6 dt (18,4) pt 2 ps 1
set logscale xy
set xtics (5, 10, 20, 40, 80, 170)
set xrange [4.5:190]
set grid lw 0.5 lt 1 dt 1 lc rgb '#E3E3E3'
set border 3
set tics nomirror
set xlabel 'directions read, all channels'
set key top right samplen 3
do for [k = 1:3] {
    set title word("E6 cube-root log-relative", k)
    set ylabel k < 3 ? 'error, %' : 'error'
    if (k == 1) { set yrange [1:40]; set ytics (1, 1.5, 2, 3, 4, 5, 7, 10, 15, 20, 30) }
    if (k == 2) { unset key; set yrange [1.5:80]; set ytics (1.5, 2, 3, 5, 7, 10, 15, 20, 30, 50, 80) }
    if (k == 3) { set yrange [0.04:0.8]; set ytics (0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8) }
    plot for [b = 0:$blocks - 1] '$data' index b using 1:(column(k + 1)) \
        with linespoints lt b + 1 title columnheader(1)
}
EOF
