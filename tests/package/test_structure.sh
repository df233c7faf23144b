#!/usr/bin/env bash
# The shape of the sources: every public header compiles alone, as C and as C++, and a stage includes
# only stages before it: test_structure.sh SOURCE
set -euo pipefail
cd "$1"
failed=0

for header in include/gonio/*.h; do
    name=${header#include/}
    echo "#include <$name>" | cc -std=c17 -Wall -Wextra -Wpedantic -Werror -Iinclude -fsyntax-only -xc - || failed=1
    if command -v c++ >/dev/null; then
        echo "#include <$name>" | c++ -std=c++17 -Wall -Wextra -Werror -Iinclude -fsyntax-only -xc++ - || failed=1
    fi
done

stages="core linalg direction metric atlas material database basis prior plan measurement posterior reconstruct evaluate render file page"
# Public headers of core go by other names than their folder.
declare -A stage_of=([status]=core [context]=core)
declare -A place
position=0
for stage in $stages; do
    place[$stage]=$position
    position=$((position + 1))
done

while IFS=: read -r file line; do
    stage=$(echo "$file" | cut -d/ -f2)
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

exit $failed
