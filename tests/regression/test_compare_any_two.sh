#!/bin/bash
# Readings could be compared with readings only, --leave-out that left nothing out said nothing, and a file with repeats
# differed from itself.
. "$(dirname "$0")/../cli/lib.sh"
same='0.000     0.000    0.0000'

# expect_note LEVEL PART ARGUMENTS...: exit code 0, and such a message on standard error.
expect_note() {
    local level=$1 part=$2
    shift 2
    run "$@" || failed "gonio $*" "$(cat "$root/work/stderr")"
    expect_true "gonio $* says '$part'" grep -q "^gonio $1: $level: .*$part" "$root/work/stderr"
}

cat >at.csv <<'END'
theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg
5,0,5,180
20,0,25,170
45,0,30,180
60,0,70,90
END
expect_ok convert atlas:red-cotton cotton.binary
expect_ok measure at.csv cotton.binary -o r.csv
expect_ok measure at.csv atlas:red-cotton --noise 5 -o noisy.csv

# ---- readings and materials in either order ----

expect_output "$same" compare r.csv cotton.binary
expect_output "$same" compare cotton.binary r.csv
expect_output "$same" compare atlas:red-cotton r.csv
expect_output '4 readings compared' compare cotton.binary noisy.csv
expect_output '4 readings compared' compare noisy.csv cotton.binary r.csv atlas:oak-sawn
expect_true 'three comparisons' test "$(grep -c 'readings compared' "$root/work/stdout")" -eq 3
expect_output '1096216 bins compared' compare -v cotton.binary cotton.binary
expect_output '"missing": 0' compare --json cotton.binary r.csv
expect_fail 1 "'gonio reconstruct r.csv -o x.binary' makes a material of them" convert r.csv x.binary
expect_fail 1 "readings (CSV), not a material; 'gonio reconstruct r.csv -o NEW.bsdf' makes a material of readings" report r.csv -o x.html
expect_fail 2 '--render needs whole materials, but r.csv is' compare --render cotton.binary r.csv

# ---- channels ----

printf '%s\n' 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value_per_sr' 5,0,5,180,0.25 45,0,30,180,0.15 >grey.csv
printf '%s\n' 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,600nm_per_sr,400nm_per_sr,500nm_per_sr' \
    5,0,5,180,0.25,0.05,0.15 45,0,30,180,0.3,0.1,0.2 >spectrum.csv
printf '%s\n' 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,450nm_per_sr,550nm_per_sr' \
    5,0,5,180,0.1,0.2 45,0,30,180,0.15,0.25 >between.csv
printf '%s\n' 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,900nm_per_sr' 5,0,5,180,0.1 45,0,30,180,0.15 >far.csv
printf '%s\n' 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R_per_sr,G_per_sr,B_per_sr' \
    5,0,5,180,0.25,0.25,0.25 45,0,30,180,0.15,0.15, >colours.csv
expect_output "$same" compare between.csv spectrum.csv
expect_output "$same" compare grey.csv colours.csv
expect_output "$same" compare colours.csv grey.csv
expect_output '2 readings compared' compare spectrum.csv cotton.binary
expect_output '2 readings compared' compare cotton.binary spectrum.csv
expect_output '2 readings compared' compare grey.csv cotton.binary
expect_fail 1 'no wavelength of spectrum.csv is within those of the other' compare spectrum.csv far.csv

# ---- what was left out, and repeats ----

printf '%s\n' theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg 33,0,44,55 33,0,44,66 >elsewhere.csv
printf '%s\n' theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg 5,0,5,180 33,0,44,66 >partly.csv
expect_note warning '0 of 2 directions of elsewhere.csv are among' compare r.csv cotton.binary --leave-out elsewhere.csv
expect_note note '1 of 2 directions of partly.csv are among' compare cotton.binary r.csv r.csv --leave-out partly.csv
expect_true 'it is said once' test "$(wc -l <"$root/work/stderr")" -eq 1
expect_output '3 readings compared' compare cotton.binary r.csv --leave-out partly.csv
printf '%s\n' 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,550nm_per_sr' 45,0,30,180,0.151 45,0,30,180,0.191 \
    5,0,5,180,0.251 >repeats.csv
expect_output "$same" compare repeats.csv repeats.csv
expect_note note 'repeats.csv: read more than once at 1 direction' compare repeats.csv repeats.csv
printf '%s\n' theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg 5,0,5,180 45,0,30,180 >two.csv
expect_note note 'read more than once at 1 of 2' measure two.csv repeats.csv -o mean.csv
expect_true 'the mean' grep -qx '45,0,30,180,0.171' mean.csv

finish
