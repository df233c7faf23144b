#!/bin/bash
# docs/laboratory.md: its commands give its output, and it shows the files of examples/laboratory. Words are the same;
# numbers may differ by a twentieth, as processors do. UPDATE=1 writes output and pictures anew: look at them.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"
full || { skip 'a whole run is for release builds'; finish; }
source=$(cd "$here/../.." && pwd)
page=$source/docs/laboratory.md
figures=$source/docs/figures/laboratory
mkdir "$root/bin"
ln -s "$GONIO" "$root/bin/gonio"
PATH=$root/bin:$PATH
cp "$source"/examples/laboratory/* .

# The page with the output of its commands: blocks are indented by four, a command begins with '$ ' and may go on after a
# backslash; what stands below it up to the end of the block or the next command is its output.
run_page() {
    local line command='' skipping=no
    while IFS= read -r line; do
        if [ -n "$command" ]; then
            printf '%s\n' "$line"
            command+=$'\n'$line
        elif [[ $line == '    $ '* ]]; then
            printf '%s\n' "$line"
            command=${line#'    $ '}
        elif [ $skipping = no ] || [[ $line != '    '* ]]; then
            skipping=no
            printf '%s\n' "$line"
            continue
        else
            continue
        fi
        if [[ $command != *\\ ]]; then
            bash -c "$command" 2>&1 </dev/null | sed 's/^/    /'
            command=''
            skipping=yes
        fi
    done <"$page"
}
run_page >"$root/work/page.md"

if [ "${UPDATE:-}" = 1 ]; then
    cp "$root/work/page.md" "$page"
    mkdir -p "$figures"
    cp picture/reach.png picture/tour.png "$figures/"
fi

# Prints the lines whose words differ, or numbers by more than a twentieth and a hundredth.
differences() {
    paste "$page" "$root/work/page.md" | awk -F '\t' '
        function numbers(text, list,    count) {
            while (match(text, /[0-9]+(\.[0-9]+)?(e-?[0-9]+)?/)) {
                list[++count] = substr(text, RSTART, RLENGTH) + 0
                text = substr(text, RSTART + RLENGTH)
            }
            return count + 0
        }
        function words(text) { gsub(/[-+]?[0-9]+(\.[0-9]+)?(e-?[0-9]+)?/, "0", text); gsub(/ +/, " ", text); return text }
        $1 != $2 {
            far = words($1) != words($2) || numbers($1, a) != (n = numbers($2, b))
            for (k = 1; k <= n && !far; k++) {
                d = a[k] - b[k]
                s = a[k] > b[k] ? a[k] : b[k]
                far = (d < 0 ? -d : d) > 0.05 * s + 0.01
            }
            if (far) { print NR ": " $1; print NR ": " $2 }
        }'
}
checks=$((checks + 1))
[ -z "$(differences)" ] || failed 'docs/laboratory.md does not show what its commands print' "$(differences)"

for file in gantry.json robot.sh blank.csv; do
    shown=$(sed 's/^/    /' "$source/examples/laboratory/$file")
    expect_true "the page shows $file" test "${_page:=$(cat "$page")}" != "${_page/"$shown"/}"
done
if command -v gnuplot >"$root/work/gnuplot"; then
    expect_true 'the page has its pictures' test -s "$figures/reach.png" -a -s "$figures/tour.png"
fi
finish
