#!/bin/sh
# Prints a Python 3 that has all of the modules, or fails and says which are missing: find-python.sh MODULE...
for python in ${PYTHON:-} /usr/bin/python3 python3; do
    missing=$("$python" - "$@" 2>/dev/null <<'END'
import importlib.util
import sys
print(*[name for name in sys.argv[1:] if importlib.util.find_spec(name) is None])
END
    ) || continue
    if [ -z "$missing" ]; then
        echo "$python"
        exit 0
    fi
    least=${least:-$missing}
done
echo "no Python 3 with these modules: ${least:-$*}" >&2
exit 1
