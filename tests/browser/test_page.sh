#!/bin/bash
# The page in a real browser: makes reports and hands them to viewer/test, which drives headless
# Chromium. Needs $GONIO, $PAGE_FACTS (page_facts.c) and $VIEWER, the folder.
set -eu
skip() {
    echo "SKIPPED: $1"
    exit 0
}
command -v node >/dev/null || skip "no Node.js"
chromium=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || true)}
[ -n "$chromium" ] || skip "no Chromium"
[ -d "$VIEWER/node_modules/playwright-core" ] || skip "the page's packages are not there"

folder=$(mktemp -d "${TMPDIR:-/tmp}/gonio-page-XXXXXX")
trap 'rm -rf "$folder"' EXIT
cd "$folder"
original=atlas:red-glossy-plastic
other=atlas:orange-acrylic

"$GONIO" report "$original" -o probe.html >/dev/null 2>probe.txt || {
    grep -q "built without Node.js" probe.txt && skip "the page was not built"
    cat probe.txt
    exit 1
}
"$PAGE_FACTS" "$original" .

# Directions on a spiral, in the order of an instrument.
awk 'BEGIN {
    print "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel"
    for (k = 0; k < 24; k++)
        printf "%.3f,%.3f,%.3f,%.3f,%s\n", 3 + 3.4 * k, (k * 137.5) % 360, 80 - 3.2 * k,
            (k * 137.5 + 150) % 360, substr("RGB", 1 + k % 3, 1)
}' >plan.csv
"$GONIO" measure plan.csv "$original" -o readings.csv >/dev/null
"$GONIO" report "$original" "$other" --readings readings.csv --deviation deviation.binary -o page.html
"$GONIO" report "$original" -o alone.html
"$GONIO" report poles.binary -o poles.html

# A sample that is brighter and shinier at some turns; readings in the plane of incidence at two.
{
    printf 'Symmetry ASymmetrical4D\nScatterType BRDF\nSampleRotation 4\n0 45 90 135\nAngleOfIncidence 2\n10 70\n'
    printf 'ScatterAzimuth 3\n0 90 180\nScatterRadial 3\n0 30 150\nMonochrome\nDataBegin\n'
    for peak in 1 1 2 2 4 4 2 2; do
        printf 'TIS 0.1\n%s 0.2 0.1\n%s 0.2 0.1\n%s 0.2 0.1\n' $peak $peak $peak
    done
    echo DataEnd
} >turned.bsdf
printf '%s\n' theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg 30,0,40,180 60,0,20,180 30,90,40,270 60,90,20,270 \
    20,90,35,90 >turned-plan.csv
"$GONIO" report turned.bsdf --readings turned-plan.csv -o turned.html

mkdir -p out/tables
printf 'basis_of,component,variance,cumulative\nall,1,4,0.8\nall,2,1,1\nsplit 1,1,3,0.75\nsplit 1,2,1,1\n' \
    >out/tables/fig2a.csv
printf 'start,swap,condition_number\n1,0,90\n1,1,12\n1,2,4\n2,0,70\n2,1,5\n' >out/tables/fig2b.csv
{
    echo components,samples,condition_number,e6_percent,cube_root_percent,log_relative
    printf '%s\n' 20,40,5,4,6,.2 20,80,4,3.5,5,.15 20,all,1,3,4,.1 35,80,5,3.4,5,.14 35,all,1,2.9,4,.1
} >out/tables/fig3a-means.csv
{
    echo material,reconstructed_from,components,condition_number,e6_percent,cube_root_percent,log_relative
    printf '%s\n' 'tin,80 samples,35,4,3,5,.1' 'oak,80 samples,35,4,2,4,.1' '"</script>,odd",80 samples,35,4,1,3,.1' \
        'tin,bivariate,,,1,2,.1' 'oak,bivariate,,,1.5,2,.1'
} >out/tables/fig5.csv
"$GONIO" report out -o figures.html

if "$GONIO" render --help >/dev/null 2>&1; then
    "$GONIO" render "$original" --light directional --light-at=-45,45 --size 96 --samples 64 -o lamp.png
    for environment in studio sky; do
        "$GONIO" render "$original" --environment $environment --size 96 --samples 256 -o $environment.png
    done
fi

PAGES=$folder CHROMIUM=$chromium node --test "$VIEWER"/test/*.test.mjs
