#!/usr/bin/env bash
# Makes the wheel, and tries it in an environment that has nothing but Python and NumPy: test_wheel.sh SOURCE BUILD
set -euo pipefail
source=$1
build=$2
python=$("$source/scripts/find-python.sh" cffi setuptools wheel pip venv numpy 2>&1) || {
    echo "SKIPPED: $python"
    exit 0
}
command -v patchelf >/dev/null || {
    echo "SKIPPED: patchelf is missing"
    exit 0
}
wheel=$(GONIO_WHEEL=stored PYTHON=$python "$source/scripts/make-wheel.sh" "$build" "$build/python/wheel")
echo "made: $(basename "$wheel"), $(($(stat -c %s "$wheel") / 1000000)) MB without compression"

clean=$build/python/clean
rm -rf "$clean"
"$python" -m venv --without-pip "$clean"
packages=$(echo "$clean"/lib/python3*/site-packages)
ln -s "$("$python" -c 'import numpy, os; print(os.path.dirname(numpy.__file__))')" "$packages/numpy"
"$python" -m pip -q --disable-pip-version-check --python "$clean/bin/python" install --no-index --no-deps "$wheel"
"$clean/bin/python" -I "$source/python/tests/clean.py" "$clean"
