#!/bin/sh
# Builds viewer/ into one HTML file: build-viewer.sh OUTPUT
# Without Node.js or its packages the file is left empty, and old, so that the next make tries again.
set -eu
output=$1
cd "$(dirname "$0")/../viewer"

without_page() {
    echo "gonio report will not work: $1" >&2
    : >"$output"
    touch -d @0 "$output"
    exit 0
}

command -v npm >/dev/null 2>&1 || without_page "no Node.js; install nodejs (18.19 or newer) and npm"
node -e 'const [a, b] = process.versions.node.split(".").map(Number);
    process.exit(a > 18 || (a === 18 && b >= 19) ? 0 : 1)' ||
    without_page "Node.js $(node --version) is too old; 18.19 or newer is needed"
# npm leaves this file when it is done.
if [ ! -e node_modules/.package-lock.json ] || [ node_modules/.package-lock.json -ot package-lock.json ]; then
    npm ci --silent --ignore-scripts >&2 || without_page "npm could not fetch the page's packages"
    touch node_modules/.package-lock.json
fi
node_modules/.bin/vite build --logLevel warn --outDir "$(dirname "$output")" --emptyOutDir false >&2
mv "$(dirname "$output")/index.html" "$output"
