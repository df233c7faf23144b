#!/bin/bash
# A file whose name was not UTF-8 was missing from the JSON of info, without an error.
. "$(dirname "$0")/../cli/lib.sh"
if ! jq --version >"$root/work/stdout" 2>&1; then
    printf 'SKIPPED: jq is not installed\n'
    exit 0
fi

name=$(printf 'gr\374n \342\202\254')
shown=$(printf 'gr\357\277\275n \342\202\254')
expect_ok learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o "$name.gonio"
expect_ok plan "$name.gonio" -n 4 -o "$name.csv"
expect_ok convert atlas:oak-sawn "$name.binary"

# expect_name FILTER EXPECTED ARGUMENTS...
expect_name() {
    local filter=$1 expected=$2
    shift 2
    expect_ok "$@" --json
    expect_true "$filter of gonio $*" test "$(jq -r "$filter" "$root/work/stdout")" = "$expected"
}
expect_name '.[0].file' "$shown.csv" info "$name.csv" "$name.binary" "$name.gonio"
expect_name '.[1].name' "$shown" info "$name.csv" "$name.binary" "$name.gonio"
expect_name '.[2].file' "$shown.gonio" info "$name.csv" "$name.binary" "$name.gonio"
expect_name '.output' "$shown.r" measure "$name.csv" "$name.binary" -o "$name.r"
expect_name '.material' "$shown" measure "$name.csv" "$name.binary" -o "$name.r"
expect_name '.reference' "$shown.r" compare "$name.r" "$name.binary"
expect_name '.comparisons[0].file' "$shown.binary" compare "$name.r" "$name.binary"
expect_name '.output' "$shown.x" reconstruct "$name.gonio" "$name.r" -o "$name.x"
expect_name '.material' "$shown" convert "$name.binary" "$name.h5"
expect_name '.plan' "$shown.csv" plan "$name.gonio" -n 4 -o "$name.csv"

finish
