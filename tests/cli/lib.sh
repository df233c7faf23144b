# What the command-line tests share; sourced by them. They need $GONIO, the program; files live in
# a folder of their own, in which the test runs.
set -u
: "${GONIO:?the program to test}"
export LC_ALL=C
LSAN_OPTIONS=print_suppressions=0:suppressions=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/leaks.supp
export LSAN_OPTIONS
root=$(mktemp -d "${TMPDIR:-/tmp}/gonio-cli-XXXXXX")
trap 'chmod -R u+rwX "$root"; rm -rf "$root"' EXIT
mkdir "$root/files" "$root/work"
export XDG_CACHE_HOME=$root/cache
cd "$root/files" || exit 1

failures=0
checks=0

failed() {
    failures=$((failures + 1))
    printf 'FAILED: %s\n' "$1"
    shift
    printf '    %s\n' "$@"
}

# How the program is started; a test may name another function in $runner.
gonio() { "$GONIO" "$@"; }

# Every file with its size and the times of its last change, which nothing can hide; folders and
# links by name. In the order of the folder, which stays as long as its files do.
snapshot() { find . -type f -printf '%p %i %s %T@ %C@\n' -o -printf '%p\n'; }

# The functions below run some thousand times, so they start few processes.

# contents NAME FILE: the variable NAME becomes what $(cat FILE) is.
contents() {
    local text=
    IFS= read -r -d '' text <"$2"
    while [[ $text == *$'\n' ]]; do
        text=${text%$'\n'}
    done
    printf -v "$1" %s "$text"
}

# is_one_line FILE: whether there is one newline, at the end.
is_one_line() {
    local text=
    IFS= read -r -d '' text <"$1"
    [[ $text == *$'\n' && ${text%$'\n'} != *$'\n'* ]]
}

run() {
    checks=$((checks + 1))
    "${runner:-gonio}" "$@" >"$root/work/stdout" 2>"$root/work/stderr" </dev/null
}

# expect_ok ARGUMENTS...: exit code 0 and nothing but notes on standard error.
expect_ok() {
    run "$@"
    local code=$?
    if [ $code -ne 0 ]; then
        failed "gonio $*" "exit code $code, not 0" "$(cat "$root/work/stderr")"
    elif [ -s "$root/work/stderr" ] && grep -v "^gonio $1: note: " "$root/work/stderr" >"$root/work/noise"; then
        failed "gonio $*" "unexpected on standard error: $(cat "$root/work/noise")"
    fi
}

# expect_output PART ARGUMENTS...: the same, and the part occurs on standard output.
expect_output() {
    local part=$1 output
    shift
    expect_ok "$@"
    contents output "$root/work/stdout"
    [[ $output == *"$part"* ]] || failed "gonio $*" "'$part' is not in the output:" "$output"
}

# expect_also PART...: each part occurs on standard output of the last command too.
expect_also() {
    local part output
    contents output "$root/work/stdout"
    for part in "$@"; do
        checks=$((checks + 1))
        [[ $output == *"$part"* ]] || failed "'$part' is not in the output:" "$output"
    done
}

# expect_fail CODE PART ARGUMENTS...: this exit code; on standard error one line, of this command,
# that holds the part; no file made, changed or left behind.
expect_fail() {
    local code=$1 part=$2
    shift 2
    local before after message
    before=$(snapshot)
    run "$@"
    local got=$?
    contents message "$root/work/stderr"
    [ $got -eq "$code" ] || failed "gonio $*" "exit code $got, not $code" "$message"
    if ! is_one_line "$root/work/stderr"; then
        failed "gonio $*" "not one line on standard error:" "$message"
    fi
    if [[ $message != "gonio $1: "* || $message != *"$part"* ]]; then
        failed "gonio $*" "expected: gonio $1: ... $part ..." "got:      $message"
    fi
    after=$(snapshot)
    if [ "$after" != "$before" ]; then
        failed "gonio $*" "files changed:" "$(diff <(printf '%s\n' "$before") <(printf '%s\n' "$after"))"
    fi
}

# expect_same A B: two files with the same bytes.
expect_same() {
    checks=$((checks + 1))
    cmp "$1" "$2" >"$root/work/cmp" 2>&1 || failed "$1 and $2 differ" "$(cat "$root/work/cmp")"
}

# expect_true WHAT CONDITION...: any other check.
expect_true() {
    local what=$1
    shift
    checks=$((checks + 1))
    "$@" || failed "$what" "$*"
}

# Whether everything is to be run, not the smaller sizes that do for the sanitizers.
full() { [ "${GONIO_TESTS:-}" != small ]; }

# Whether the program writes HDF5: not if it was built without its library.
writes_hdf5() { [ "${WITH_HDF5:-ON}" = ON ]; }

skip() { printf 'not tested: %s\n' "$1"; }

# Runs the program as a user who is not root, to whom permissions apply.
as_other_user() {
    if [ "$(id -u)" -eq 0 ]; then
        setpriv --reuid=65534 --regid=65534 --clear-groups "$GONIO" "$@"
    else
        "$GONIO" "$@"
    fi
}

# Whether as_other_user can run the program here.
permissions_apply() {
    chmod a+rx "$root" "$root/files"
    as_other_user --version >"$root/work/stdout" 2>&1
}

# int32 NUMBER...: little-endian.
int32() {
    local number
    for number in "$@"; do
        # shellcheck disable=SC2059
        printf "$(printf '\\x%02x\\x%02x\\x%02x\\x%02x' $((number & 255)) $((number >> 8 & 255)) \
            $((number >> 16 & 255)) $((number >> 24 & 255)))"
    done
}

# patch FILE OFFSET BYTES: BYTES as printf writes them ('\x00\x01').
patch() {
    # shellcheck disable=SC2059
    printf "$3" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}

# 34,992,012 bytes: a MERL table in which every byte of the values is the octal number given.
uniform_table() { # OCTAL
    int32 90 90 180
    head -c 34992000 /dev/zero | tr '\0' "\\$1"
}

finish() {
    printf '%d checks, %d failed\n' "$checks" "$failures"
    [ "$failures" -eq 0 ]
    exit
}
