#!/bin/sh
# Formatting, lint and man pages: check-style.sh BUILD, with BUILD's compile_commands.json.
# ANALYZER_NODES is how far clang's analyzer follows the paths of a function. Its own default, 225000, takes three
# times as long; `ANALYZER_NODES=225000 make style` before a release.
set -eu
build=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
sources=$(find include src apps tests bench examples python -name '*.[ch]' 2>/dev/null | sort)

# Other versions format differently, so only the one that the code was formatted with judges.
if clang-format --version | grep -q 'version 14\.'; then
    clang-format --dry-run -Werror $sources
    echo "clang-format: fine"
else
    echo "clang-format: skipped, version 14 is needed"
fi

if clang-tidy --version | grep -q 'version 14\.'; then
    find src apps -name '*.c' | sort |
        xargs -P "$(nproc)" -n 4 clang-tidy --quiet -p "$build" --warnings-as-errors='*' \
            --extra-arg=-Xclang --extra-arg=-analyzer-config --extra-arg=-Xclang \
            --extra-arg="max-nodes=${ANALYZER_NODES:-50000}" 2>/dev/null
    echo "clang-tidy: fine"
else
    echo "clang-tidy: skipped, version 14 is needed"
fi

if [ -d viewer/node_modules/typescript ]; then
    (cd viewer && node_modules/.bin/tsc --noEmit && node_modules/.bin/prettier --check --log-level warn .)
    echo "viewer: fine"
else
    echo "viewer: skipped, its packages are not there (make with Node.js fetches them)"
fi

if command -v mypy >/dev/null; then
    (cd python && mypy --no-error-summary --cache-dir="$build/mypy")
    echo "mypy: fine"
else
    echo "mypy: skipped, it is not there"
fi

mandoc -Tlint -Wwarning docs/man/*.1
echo "mandoc: fine"
