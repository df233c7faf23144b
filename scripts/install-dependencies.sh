#!/bin/sh
# Installs the Debian or Ubuntu packages that are missing: install-dependencies.sh yes|no build|python|check|fuzz
# "no" only looks. sudo is asked for only if needed and not root. Node.js, with which the page of gonio
# report is built, may also come from elsewhere than Debian; without it all else is built.
set -eu

packages="gcc libc6-dev make cmake ninja-build pkg-config libopenblas-dev liblapacke-dev libhdf5-dev
libxxhash-dev libcsv-dev libjansson-dev libpopt-dev zlib1g-dev libexpat1-dev libembree-dev libopenexr-dev
libpng-dev libcairo2-dev"
if [ "$2" = python ] || [ "$2" = check ]; then
    packages="$packages python3-dev python3-numpy python3-cffi python3-setuptools python3-wheel python3-pip patchelf"
fi
if [ "$2" = check ]; then
    packages="$packages libcmocka-dev clang-format clang-tidy libomp-dev mandoc gnuplot-nox
libopenmpi-dev openmpi-bin jq locales openssl python3-venv python3-pytest python3-hypothesis mypy python3-sklearn
python3-pandas python3-xarray python3-matplotlib python3-tqdm"
fi

if [ "$2" = fuzz ]; then
    packages="$packages clang libclang-rt-14-dev libomp-dev"
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
wanted=""
command -v node >/dev/null 2>&1 || wanted="nodejs"
command -v npm >/dev/null 2>&1 || wanted="$wanted npm"
if [ "$2" = check ] && ! command -v chromium >/dev/null 2>&1; then
    wanted="$wanted chromium"
fi
if [ "$1" = yes ]; then
    missing="$missing${wanted:+ $wanted}"
elif [ -n "$wanted" ]; then
    echo "Without these there is no page to report with, or it is not tested: $wanted"
fi
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
