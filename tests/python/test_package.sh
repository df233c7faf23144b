#!/usr/bin/env bash
# The tests of the Python package, by pytest, with the wheel that test_wheel.sh installed: test_package.sh SOURCE BUILD
set -euo pipefail
source=$1
clean=$2/python/clean
python=$("$source/scripts/find-python.sh" numpy pytest hypothesis 2>&1) || {
    echo "SKIPPED: $python"
    exit 0
}
installed=$(echo "$clean"/lib/python3*/site-packages/gonio)
if [ ! -d "$installed" ]; then
    echo "SKIPPED: there is no wheel (python/wheel says why)"
    exit 0
fi
# Beside the packages of the system, in an environment of its own.
own=$2/python/tested
rm -rf "$own"
mkdir -p "$own"
ln -s "$installed" "$own/gonio"
cd "$source/python"
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$own "$python" -m pytest -W error::gonio.GonioWarning --durations=8 ${PYTEST_ARGUMENTS:-}
