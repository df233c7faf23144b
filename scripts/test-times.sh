#!/bin/sh
# How long each test took, from what ctest --output-junit left: test-times.sh RELEASE.xml SANITIZE.xml [PAGE]
# Shows a table in Markdown, the longest first, or writes it to PAGE; says last how many tests passed and failed.
set -eu

# kind name seconds outcome, of each test of one file
cases() {
    sed -n "s/.*<testcase name=\"\([^\"]*\)\".* time=\"\([^\"]*\)\" status=\"\([^\"]*\)\".*/$1 \1 \2 \3/p" "$2"
}

all() {
    cases release "$1"
    cases sanitize "$2"
}

table() {
    echo "| Test | Release, s | Sanitizers, s |"
    echo "|---|---:|---:|"
    all "$1" "$2" | awk '
        { time[$1, $2] = $3; names[$2] }
        function seconds(kind, name) { return (kind, name) in time ? sprintf("%.1f", time[kind, name]) : "" }
        END { for (name in names) printf "| %s | %s | %s |\n", name, seconds("release", name), seconds("sanitize", name) }
    ' | sort -t '|' -k 3,3nr -k 4,4nr -k 2,2
    all "$1" "$2" | awk '
        { sum[$1] += $3 }
        END { printf "| sum | %.1f | %.1f |\n", sum["release"], sum["sanitize"] }'
}

if [ $# -eq 3 ]; then
    {
        echo "# How long each test takes"
        echo
        echo "Seconds as \`make check\` took them on $(nproc) processors, where tests run beside each other. \`make times\`"
        echo "writes this page after it. Tests without a time in the last column are left out under the sanitizers."
        echo
        table "$1" "$2"
    } >"$3"
else
    table "$1" "$2"
fi
all "$1" "$2" | awk '
    { count[$4]++ }
    END { printf "%d passed, %d failed, %d skipped\n", count["run"], count["fail"], count["notrun"] }'
