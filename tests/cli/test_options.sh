#!/bin/bash
# Help, man pages and completion against the tables of options: what one has, all have. Every command prints JSON.
source=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/lib.sh"

# expect_lists WHAT EXPECTED GOT: two lists of lines, in any order.
expect_lists() {
    checks=$((checks + 1))
    local difference
    difference=$(diff <(sort -u <<<"$2") <(sort -u <<<"$3")) || failed "$1" "$difference"
}

# ---- commands ----

commands=$(gonio --help | sed -n 's/^  \([a-z-]*\) .*/\1/p')
expect_true 'there are commands' test "$(wc -w <<<"$commands")" -ge 12
expect_lists 'commands of gonio(1)' "$commands" \
    "$(sed -n '/^\.Sh DESCRIPTION/,/^\.El/s/^\.It Cm //p' "$source/docs/man/gonio.1")"
expect_lists 'man pages' "$commands" \
    "$(find "$source/docs/man" -name 'gonio-*.1' -printf '%f\n' | sed 's/^gonio-\(.*\)\.1$/\1/')"

# ---- options: lines "-n --number N", of which flags are "-n --number" ----

# names: "-n --number" of lines "-n --number N"; with a value, " =" at the end.
names() { sed -E 's/^((-[a-zA-Z] )?--[a-z-]+)( .*)?$/\1\3/; s/^((-[a-zA-Z] )?--[a-z-]+) .*$/\1 =/'; }

in_help() { # "  -n, --number=N   ..."
    gonio "$1" -h | sed -nE 's/^  (-[a-zA-Z], |    )(--[a-z-]+)(=([^ ]+))?( .*)?$/\1\2 \4/p' |
        sed -E 's/,//; s/^ +//; s/ $//' | names
}

in_man() { # ".It Fl n , -number Ar N"
    sed -nE 's/^\.It (Fl .*)/\1/p' "$source/docs/man/gonio-$1.1" |
        sed -E 's/^Fl ([a-zA-Z]) , -([a-z-]+)/-\1 --\2/; s/^Fl -([a-z-]+)/--\1/' | names
}

# "-n" or "--metric", as the synopsis has each option: by its letter if there is one.
short() { sed -E 's/^(-[a-zA-Z]) .*/\1/; s/ .*//'; }

in_synopsis() {
    sed -n '/^\.Sh SYNOPSIS/,/^\.Sh DESCRIPTION/p' "$source/docs/man/gonio-$1.1" |
        grep -oE '\bFl [-a-zA-Z]+' | sed 's/^Fl /-/'
}

# complete WORD...: what the completion offers for the last word.
. "$source/completions/gonio.bash"
complete_words() {
    COMP_WORDS=("$GONIO" "$@")
    COMP_CWORD=$#
    COMPREPLY=()
    _gonio 2>/dev/null
    printf '%s\n' "${COMPREPLY[@]}"
}

expect_lists 'commands of the completion' "$commands" \
    "$(complete_words '' | grep -vxE 'help|--help|--version')"

for command in $commands; do
    table=$(gonio "$command" --list-options | names)
    expect_true "$command has options" test "$(wc -l <<<"$table")" -ge 4
    for common in --threads -q -h --json; do
        expect_true "$command has $common" grep -qE -- "^$common( |\$)" <<<"$table"
    done
    expect_lists "help of $command" "$table" "$(in_help "$command")"
    expect_lists "man page of $command" "$table" "$(in_man "$command")"
    if grep -q 'Ar option' <(sed -n '/SYNOPSIS/,/DESCRIPTION/p' "$source/docs/man/gonio-$command.1"); then
        for option in $(in_synopsis "$command"); do
            expect_true "$command has $option, as its synopsis says" grep -qx -- "$option" <(short <<<"$table")
        done
    else
        expect_lists "synopsis of $command" "$(short <<<"$table" | grep -vx -- -h)" "$(in_synopsis "$command")"
    fi
    expect_lists "completion of $command" "$(sed 's/ =$//' <<<"$table" | tr ' ' '\n')" \
        "$(complete_words "$command" -)"
done

# ---- words that the completion offers for a value are those of the help ----

for pair in learn:--grid learn:--channels learn:--mapping plan:--metric plan:--method plan:--start next:--metric \
    reconstruct:--method render:--environment render:--light reproduce:--only benchmark:--directions benchmark:--methods; do
    command=${pair%:*}
    offered=$(complete_words "$command" "${pair#*:}" '')
    expect_true "the completion offers words for $pair" test "$(wc -w <<<"$offered")" -ge 2
    for word in $offered; do
        expect_true "help of $command names $word" grep -qwe "$word" <(gonio "$command" -h)
    done
done
expect_true 'a number is not completed' test -z "$(complete_words plan -n '')"

# ---- every command prints one JSON value, and nothing else, on standard output ----

command -v jq >"$root/work/jq" || skip 'that the output is JSON: no jq'

# expect_json FILTER EXPECTED ARGUMENTS...: what jq finds in the output of a command with --json.
expect_json() {
    local filter=$1 expected=$2
    shift 2
    expect_ok "$@" --json
    if [ -s "$root/work/jq" ]; then
        expect_true "gonio $* --json: $filter" \
            test "$(jq -s -r ".[0] | $filter" "$root/work/stdout" 2>&1)" = "$expected"
        expect_true "gonio $* --json is one value" test "$(jq -s length "$root/work/stdout")" = 1
    fi
}

expect_json .components 2 learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o b.gonio
expect_json .readings 4 plan b.gonio -n 4 -o p.csv
expect_json '[.output, .readings, .channels, .material] | join(" ")' 'r.csv 4 3 red-cotton' \
    measure p.csv atlas:red-cotton -o r.csv
expect_json .material r.csv measure p.csv r.csv -o again.csv
expect_json .output out.binary reconstruct b.gonio r.csv -o out.binary
expect_json '.comparisons[0].readings' 4 compare r.csv again.csv
expect_json '[.output, .material, .from] | join(", ")' 'c.binary, red-cotton, built-in fabric' \
    convert atlas:red-cotton c.binary
expect_json '.[0].kind + " " + .[1].kind' 'readings basis' info r.csv b.gonio
if gonio render --compare atlas:red-cotton out.binary --size 16 --samples 2 -o probe.png >"$root/work/stdout" 2>&1; then
    expect_json '[.output, .width, .height, .samples] | join(" ")' 's.exr 24 16 2' \
        render out.binary --size 24x16 --samples 2 -o s.exr
    expect_json '.rows[0].comparisons | map(.file) | join(" ")' 'out.binary c.binary' \
        render --compare atlas:red-cotton out.binary c.binary --size 16 --samples 2 -o s.png
    expect_json '.rows[0].comparisons[1].e6_percent < 0.1' true \
        render --compare atlas:red-cotton out.binary c.binary --size 16 --samples 2 -o s.png
fi
if gonio report atlas:red-cotton -o probe.html >"$root/work/stdout" 2>&1; then
    expect_json '[.output, .reference, .reconstruction, .readings, .folder] | map(. // "-") | join(" ")' \
        'page.html atlas:red-cotton out.binary r.csv -' \
        report atlas:red-cotton out.binary --readings r.csv -o page.html
fi

finish
