#!/usr/bin/env bash
# Installs gonio into a scratch folder and builds a small program against it, shared and static, by
# pkg-config and by CMake: test_install.sh BUILD SOURCE
set -euo pipefail
build=$1
source=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r "$source/tests/package" "$scratch/consumer"

cmake --install "$build" --prefix "$scratch/installed" >/dev/null
libraries=$(dirname "$(find "$scratch/installed" -name libgonio.a)")
# The .pc file names the configured prefix; pkg-config is told where it is now.
export PKG_CONFIG_PATH=$libraries/pkgconfig
config() { pkg-config --define-variable=prefix="$scratch/installed" --define-variable=libdir="$libraries" \
    --define-variable=includedir="$scratch/installed/include" "$@" gonio; }

# The library exports the functions that the headers declare, and nothing else.
nm -D --defined-only "$libraries/libgonio.so" | awk '$2 == "T" || $2 == "D" || $2 == "B" || $2 == "R" { print $3 }' |
    sed 's/@.*//' | sort -u >"$scratch/exported"
cat "$source"/include/gonio/*.h | sed 's#/\*.*\*/##' | tr '\n' ' ' | grep -oE 'GONIO_API[^;(]*\(' |
    grep -oE 'gonio_[a-z0-9_]+ *\($' | tr -d ' (' | sort -u >"$scratch/declared"
diff "$scratch/declared" "$scratch/exported"
echo "exports: $(wc -l <"$scratch/exported") functions, those of the headers"

cc "$scratch/consumer/consumer.c" $(config --cflags --libs) -o "$scratch/shared"
LD_LIBRARY_PATH=$libraries "$scratch/shared"
echo "pkg-config, shared: works"

cc "$scratch/consumer/consumer.c" $(config --cflags) "$libraries/libgonio.a" \
    $(config --static --libs | sed 's/-lgonio//') -o "$scratch/static"
"$scratch/static"
if ldd "$scratch/static" | grep -q libgonio; then
    echo "the static program needs the shared library" >&2
    exit 1
fi
echo "pkg-config, static: works"

cmake -S "$scratch/consumer" -B "$scratch/build" -Dgonio_DIR="$libraries/cmake/gonio" >/dev/null
cmake --build "$scratch/build" >/dev/null
"$scratch/build/consumer-shared"
"$scratch/build/consumer-static"
echo "CMake package, shared and static: work"

"$scratch/installed/bin/gonio" --version
test -f "$scratch/installed/share/man/man1/gonio.1"
