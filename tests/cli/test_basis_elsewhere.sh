#!/bin/bash
# The programs of docs/basis-file.md that read a basis, in Python and JavaScript, where these are there.
. "$(dirname "$0")/lib.sh"

page=$(dirname "$0")/../../docs/basis-file.md

# program MARK: the indented lines that follow the line that begins with MARK.
program() {
    awk -v mark="$1" 'index($0, mark) == 1 { found = 1; next }
                      found && /^    / { print substr($0, 5); any = 1; next }
                      found && any && /^$/ { print ""; next }
                      found && any { exit }' "$page"
}

expect_ok learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o merl.gonio

python=
for candidate in python3 /usr/bin/python3; do
    if [ -z "$python" ] && "$candidate" -c 'import numpy' 2>/dev/null; then
        python=$candidate
    fi
done
if [ -n "$python" ]; then
    {
        program 'With Python and NumPy'
        cat <<'END'
assert names == ["oak-sawn", "gold-polished", "plaster-cast"]
assert v.shape == (24069, 2) and rho.shape == (8023, 3) and array["cell"].shape == (8023,)
assert array["loadings"].shape == (3, 2) and array["variances"].shape == (2,)
gram = v.T.astype(float) @ v
assert np.abs(gram - np.eye(2)).max() < 1e-7, gram
gram = array["loadings"].T @ array["loadings"]
assert np.abs(gram - np.eye(2)).max() < 1e-12, gram
assert (np.diff(array["cell"]) > 0).all() and (rho > 0).all() and theta_h.max() == 89
print("read")
END
    } >read.py
    expect_true 'Python reads a basis' test "$("$python" read.py 2>&1)" = read
else
    skip 'a basis read by Python: no NumPy'
fi

if command -v node >/dev/null; then
    {
        program 'With JavaScript'
        cat <<'END'
let square = 0;
for (let i = 0; i < rows; i++) square += v[i * k] * v[i * k];
const right = names.join() === "oak-sawn,gold-polished,plaster-cast" && rows === 24069 && k === 2 &&
    Math.abs(square - 1) < 1e-7 && array("mean").length === rows;
console.log(right ? "read" : [names, rows, k, square]);
END
    } >read.js
    expect_true 'JavaScript reads a basis' test "$(node read.js 2>&1)" = read
else
    skip 'a basis read by JavaScript: no Node.js'
fi

finish
