#!/bin/bash
# Readings of one colour were refused for two channels that nobody had read, which the message called by numbers.
. "$(dirname "$0")/../cli/lib.sh"

expect_ok learn --mixtures 20 --components 20 atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o b.gonio
printf '%s\n' theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,G_per_sr 5,0,5,180,0.251 45,0,30,180,0.151 >one.csv
printf '%s\n' theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R_per_sr,B_per_sr 5,0,5,180,0.251,0.1 >two.csv
printf '%s\n' theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,400nm_per_sr,500nm_per_sr 5,0,5,180,0.251, >spectrum.csv

expect_output 'from 2 readings in 1 channel' reconstruct b.gonio one.csv -o one.binary
expect_true 'the channels are named' grep -q 'one.csv: nothing was read in R_per_sr, B_per_sr: left out' "$root/work/stderr"
expect_ok info one.binary
expect_true 'all channels are the same' awk '/ deg / { n++; bad += $3 != $4 || $4 != $5 } END { exit bad || !n }' \
    "$root/work/stdout"
expect_output '2 readings compared' compare one.csv one.binary
expect_ok next b.gonio one.csv -n 2 -o more.csv
expect_ok next b.gonio two.csv -n 2 -o more.csv
expect_ok reconstruct b.gonio two.csv --predict-at one.csv -o predicted.csv
expect_output 'in 1 channel' reconstruct b.gonio spectrum.csv -o spectrum.binary
expect_ok learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o joint.gonio
expect_ok reconstruct joint.gonio one.csv --method posterior -o joint.binary

# ---- what an instrument can reach: each direction once, and no more than there are ----

{
    echo theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,550nm_per_sr
    for phi in 0 10 20 350 360; do echo "30,0,0,$phi,0.10$phi"; done
    for theta in 10 20 30 40; do echo "30,0,$theta,180,0.2"; done
    echo 30,0,10,180,0.2
} >pole.csv
# planned PLAN: how many directions it has.
planned() { grep -vc '^[#t]' "$1"; }
expect_ok plan b.gonio --candidates pole.csv -n 5 -o p.csv
expect_true 'five directions' test "$(planned p.csv)" -eq 5
expect_true 'the normal once' test "$(grep -c '^30.000000000,0.000000000,0.000000000' p.csv)" -eq 1
expect_ok plan b.gonio --candidates pole.csv -o p.csv
expect_true 'all five' test "$(planned p.csv)" -eq 5
expect_fail 2 '6 readings asked for, but there are only 5 directions' plan b.gonio --candidates p.csv -n 6 -o x.csv
expect_output 'from 10 readings' reconstruct b.gonio pole.csv --average-repeats -o pole.binary
expect_true 'repeats at the normal are said' \
    grep -q 'pole.csv: theta = 0 is one direction at any azimuth: 3 readings repeat another' "$root/work/stderr"
expect_ok plan b.gonio --candidates pole.csv --target-error 60% -o target.csv
expect_true 'few are enough' test "$(planned target.csv)" -lt 5
run plan b.gonio --candidates pole.csv --target-error 0.001% -o target.csv
expect_true 'a target out of reach' test "$(planned target.csv)" -eq 5
expect_true 'is said' grep -q 'warning: all 5 directions leave an expected error of' "$root/work/stderr"
expect_ok next b.gonio one.csv --candidates p.csv -o more.csv
expect_true 'those that are left' test "$(planned more.csv)" -le 5

finish
