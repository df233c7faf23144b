#!/bin/sh
# Installs the Debian or Ubuntu packages that are missing: install-dependencies.sh yes|no build|check
# "no" only looks. sudo is asked for only if needed and not root.
set -eu

packages="gcc libc6-dev make cmake ninja-build pkg-config libopenblas-dev liblapacke-dev libhdf5-dev
libxxhash-dev libcsv-dev libjansson-dev libpopt-dev libembree-dev libopenexr-dev libassimp-dev
libpng-dev libcairo2-dev libstb-dev"
if [ "$2" = check ]; then
    packages="$packages libcmocka-dev clang-format clang-tidy libomp-dev mandoc gnuplot-nox
libopenmpi-dev openmpi-bin"
fi

if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "This is not Debian or Ubuntu: install the equivalents of these packages yourself:" $packages
    exit 0
fi

missing=""
for package in $packages; do
    if [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
        missing="$missing $package"
    fi
done
[ -n "$missing" ] || exit 0
echo "Missing packages:$missing"
[ "$1" = yes ] || exit 1

as_root=""
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null 2>&1 || {
        echo "Become root, or have root run: apt-get install$missing" >&2
        exit 1
    }
    as_root=sudo
fi
$as_root apt-get update -q
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
