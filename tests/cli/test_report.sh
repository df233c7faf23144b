#!/bin/bash
# gonio report: what the page holds, its size, and input that cannot be shown.
. "$(dirname "$0")/lib.sh"

gold=atlas:gold-polished
if "$GONIO" report $gold -o probe.html 2>&1 | grep -q 'built without Node.js'; then
    # All that can be said of it here.
    expect_fail 1 'install nodejs' report $gold -o page.html
    skip 'the page, which was not built'
    finish
fi

printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n10,0,20,90\n30,0,40,180\n' >plan.csv
expect_output 'page.html: open it in a browser' report $gold atlas:plaster-cast --readings plan.csv -o page.html
expect_true 'the page is under 6 MB' [ "$(stat -c %s page.html)" -lt 6000000 ]
expect_true 'data are in the page' grep -q '<script type="application/json" id="gonio-data">' page.html
expect_true 'no place is left for them' [ "$(grep -c '<!--gonio-data-->' page.html)" -eq 0 ]
expect_true 'nothing is asked of the network' [ "$(grep -cE '(src|href)="https?:' page.html)" -eq 0 ]
expect_ok report -q $gold atlas:plaster-cast --readings plan.csv --threads 1 -o again.html
expect_same page.html again.html

# A name that could end the element it stands in.
uniform_table 000 >'<script>.binary'
expect_ok report '<script>.binary' -o odd.html
expect_true 'the name is escaped' grep -qF '"name":"\u003cscript>"' odd.html

# A table of noise still fits.
{ int32 90 90 180; head -c 34992000 /dev/zero |
    openssl enc -aes-128-ctr -K 00 -iv 00 2>/dev/null | tr '\200-\377' '\100-\277'; } >noise.binary
if [ "$(stat -c %s noise.binary)" -eq 34992012 ]; then
    "$GONIO" report noise.binary $gold -o noise.html >/dev/null 2>&1
    expect_true 'a page of noise is under 6 MB' [ "$(stat -c %s noise.html)" -lt 6000000 ]
else
    skip 'noise: no openssl'
fi

# ---- bad input ----
expect_fail 2 'a REFERENCE' report -o x.html
expect_fail 2 'a REFERENCE' report $gold $gold $gold -o x.html
expect_fail 2 'no output' report $gold
expect_fail 2 'needs the RECONSTRUCTION' report $gold --deviation noise.binary -o x.html
expect_fail 2 'is an input' report '<script>.binary' -o '<script>.binary'
expect_fail 2 'is an input' report $gold --readings plan.csv -o plan.csv
expect_fail 1 'nowhere.binary' report nowhere.binary -o x.html
expect_fail 1 'plan.csv' report plan.csv -o x.html
expect_fail 1 'nowhere.csv' report $gold --readings nowhere.csv -o x.html
expect_fail 1 'no-folder' report $gold -o no-folder/x.html

mkdir -p empty broken/tables long/tables
expect_fail 1 'has no tables of figures' report empty -o x.html
expect_fail 2 'is a folder' report empty $gold -o x.html
printf 'components,cumulative\n1,2\n' >broken/tables/fig2a.csv
expect_fail 1 'has no column basis_of' report broken -o x.html
printf 'basis_of,component,cumulative\nall,1\n' >broken/tables/fig2a.csv
expect_fail 1 'fig2a.csv' report broken -o x.html
printf 'basis_of,component,cumulative\na\377b,1,1\n' >broken/tables/fig2a.csv
expect_fail 1 'not UTF-8' report broken -o x.html
{ echo basis_of,component,cumulative; yes all,1,0.5 | head -60000; } >long/tables/fig2a.csv
expect_fail 1 'more than a page can show' report long -o x.html
printf 'basis_of,component,cumulative\nall,1,nan\n' >broken/tables/fig2a.csv
expect_ok report broken -o fine.html
expect_true 'what is not a number is null' grep -qF '["all",1.0,null]' fine.html

finish
