#!/bin/sh
# Makes the wheel of the Python package from a build of the library: make-wheel.sh BUILD FOLDER
# GONIO_WHEEL=stored makes it without compression, which is quick.
set -eu
build=$(cd "$1" && pwd)
mkdir -p "$2"
folder=$(cd "$2" && pwd)
here=$(dirname "$0")
python=$("$here/find-python.sh" cffi setuptools wheel pip)
command -v patchelf >/dev/null || {
    echo "patchelf is missing" >&2
    exit 1
}
rm -f "$folder"/gonio-*.whl
GONIO_BUILD=$build "$python" -m pip -q --disable-pip-version-check wheel --no-index --no-build-isolation --no-deps \
    -w "$folder" "$here/../python"
ls "$folder"/gonio-*.whl
