#!/bin/bash
# info of readings told how many there are, and nothing of what they are.
. "$(dirname "$0")/../cli/lib.sh"

{
    echo theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R_per_sr,G_per_sr,B_per_sr
    for theta in 0 10 20 30 40 50 60 70 80; do
        for phi in 0 15 30 45 60 75 90 105 120 135 150 165 180; do
            [ $theta -eq 0 ] && [ $phi -gt 0 ] || echo "30,0,$theta,$phi,0.1,0.2,"
        done
    done
    echo 10,0,30,0,0.11,0.2,0
    echo 10,0,30,0,0.11,0.2,-0.1
} >scan.csv
expect_output 'gonio readings, 107 directions, 107 measured' info scan.csv
output() { expect_true "info says '$1'" grep -q -- "$1" "$root/work/stdout"; }
output '^  format       CSV$'
output 'theta_i 10, 30 deg'
output 'theta_o 0 to 80 deg; some in the plane'
output '^ *R  *0.1  *0.1  *0.11$'
output '  30 deg    100 %  *0.314  *0.628  *-$'
output 'conserved at these incidences'
output '1 reading at the angles of others, which differ by 0.00 %'
output '1 pair with light and viewer exchanged differ'
output 'empty        105 of 321 values'
output 'below zero   1 value, taken as 0'
output 'zeros        1 of 321 values'
sed '20s/0.1,0.2/5,0.2/' scan.csv >wrong.csv
expect_output '1 reading far from those around it: line 20' info wrong.csv
printf '%s\n' theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,532nm_per_sr 5,0,5,180,0.3 >one.csv
expect_output '1 wavelength, 532 nm' info one.csv
output 'albedo       not known'
output 'reciprocity  not known'
output 'all in the plane of incidence'
expect_output 'viewer       theta_o' info <(cut -d, -f1-4 scan.csv | head -100)
expect_true 'a plan has no albedo' test "$(grep -c albedo "$root/work/stdout")" -eq 0
if jq --version >"$root/work/stdout" 2>&1; then
    expect_ok info --json wrong.csv
    expect_true 'JSON of readings' jq -e '.[0] | .outlier_lines == [20] and .channels[1].name == "G" and .channels[2].zeros == 2
        and .incidences[1].covered > 0.9 and .incidences[1].readings == 105 and .incidences[0].albedo == null
        and .empty == 105 and .below_zero == 1 and .repeats == 1 and .reciprocal_pairs == 1 and .kind == "readings"
        and .conserves_energy == true and .theta_o_deg == [0, 80]' "$root/work/stdout"
    expect_ok info --json one.csv
    expect_true 'what is not known is null' jq -e '.[0] | .reciprocity_rms_percent == null and .conserves_energy == null' \
        "$root/work/stdout"
fi

finish
