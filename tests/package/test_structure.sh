#!/usr/bin/env bash
# The shape of the sources: every public header compiles alone, as C and as C++, a stage includes
# only stages before it, and no files use each other's work in a circle:
# test_structure.sh SOURCE OBJECT...
set -euo pipefail
cd "$1"
shift
failed=0

for header in include/gonio/*.h; do
    name=${header#include/}
    echo "#include <$name>" | cc -std=c17 -Wall -Wextra -Wpedantic -Werror -Iinclude -fsyntax-only -xc - || failed=1
    if command -v c++ >/dev/null; then
        echo "#include <$name>" | c++ -std=c++17 -Wall -Wextra -Werror -Iinclude -fsyntax-only -xc++ - || failed=1
    fi
done

stages="core linalg direction metric atlas material database basis prior instrument plan measurement posterior reconstruct evaluate render file page"
# Public headers of core go by other names than their folder.
declare -A stage_of=([status]=core [context]=core)
declare -A place
position=0
for stage in $stages; do
    place[$stage]=$position
    position=$((position + 1))
done

while IFS=: read -r file line; do
    stage=${file#src/}
    stage=${stage%%/*}
    if [[ $line =~ \<gonio/([a-z_]+)\.h\> ]]; then
        used=${stage_of[${BASH_REMATCH[1]}]:-${BASH_REMATCH[1]}}
    elif [[ $line =~ \"(\.\./)+([a-z]+)/ ]]; then
        used=${BASH_REMATCH[2]}
    else
        continue
    fi
    [[ $used == formats ]] && continue
    if [[ -z ${place[$used]:-} || ${place[$used]} -gt ${place[$stage]} ]]; then
        echo "$file: stage $stage includes $used, which comes after it" >&2
        failed=1
    fi
done < <(grep -rn '#include' src --include='*.[ch]' | sed 's/:[0-9]*:/:/')

# ties: of the listing of nm -A -P, "user owner symbol" for each symbol that a file takes from another.
ties() {
    awk '{
        file = $1
        sub(/^.*CMakeFiles\//, "", file)
        sub(/\.o:$/, "", file)
        if ($3 ~ /^[TDBRC]$/)
            owner[$2] = file
        else if ($3 == "U")
            use[file " " $2]
    }
    END {
        for (pair in use) {
            split(pair, p, " ")
            if ((p[2] in owner) && owner[p[2]] != p[1])
                print p[1], owner[p[2]], p[2]
        }
    }' | LC_ALL=C sort
}

# circles: the ties between files that are in circles.
circles() {
    local ties files
    ties=$(cat)
    files=$(cut -d ' ' -f 1,2 <<<"$ties" | tsort 2>&1 >/dev/null | sed -n 's/^tsort: //p' | grep -v 'loop:$' | sort -u)
    [[ -z $files ]] || awk 'NR == FNR { looping[$1]; next } ($1 in looping) && ($2 in looping)' <(echo "$files") - <<<"$ties"
}

found=$(printf '%s\n' 'a.o: f T' 'a.o: g U' 'b.o: g T' 'b.o: f U' 'c.o: f U' | ties | circles)
if [[ $found != $'a b g\nb a f' ]]; then
    echo "a circle of two files is not found: $found" >&2
    failed=1
fi
if [[ $# -gt 0 ]]; then
    found=$(nm -A -P "$@" | ties | circles)
    if [[ -n $found ]]; then
        echo "files use each other's work in a circle (user, owner, what):" >&2
        echo "$found" >&2
        failed=1
    fi
fi

# What is loaded when it is used (core/on_demand.h) is called by pointers alone.
called=$(nm -A -P "$@" | grep -E ' (H5|rtc|cairo_|LAPACKE_)[A-Za-z0-9_]* U' | grep -v '_library\.c\.o:' || true)
if [[ -n $called ]]; then
    echo "called without its header NAME_library.h naming it, so the program is linked with the library:" >&2
    echo "$called" >&2
    failed=1
fi

# Every public function is called by a test of the library's interface.
untested() { grep -vwFf <(cat) <(cat include/gonio/*.h | sed 's#/\*.*\*/##' | tr '\n' ' ' | grep -oE 'GONIO_API[^;(]*\(' |
    grep -oE 'gonio_[a-z0-9_]+ *\($' | tr -d ' (' | sort -u) || true; }
called=$(find tests -name '*.[ch]' -exec grep -ohE 'gonio_[a-z0-9_]+' {} + | sort -u)
if [[ $(untested <<<"gonio_plan_free") != *gonio_plan_create* ]]; then
    echo "functions without a test are not found" >&2
    failed=1
fi
found=$(untested <<<"$called")
if [[ -n $found ]]; then
    echo "public functions that no test calls:" >&2
    echo "$found" >&2
    failed=1
fi

exit $failed
