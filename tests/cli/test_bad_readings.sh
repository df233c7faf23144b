#!/bin/bash
# Plans and readings: tables that must be refused, and unusual ones that must be understood.
. "$(dirname "$0")/lib.sh"

expect_ok learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast atlas:red-cotton -o b.gonio
expect_ok plan b.gonio -K 2 -n 4 -o p.csv
expect_ok measure p.csv atlas:white-linen -o r.csv
expect_ok reconstruct b.gonio r.csv -o good.binary
expect_ok convert atlas:red-cotton material.binary

# table NAME LINE...: a file of these lines, below the notes that readings carry.
table() {
    grep '^#' r.csv >"$1"
    printf '%s\n' "${@:2}" >>"$1"
}

header='theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel,R_per_sr,G_per_sr,B_per_sr'
first='10,0,20,180,R,0.1,0.2,0.3'
second='30,0,20,180,G,0.1,0.2,0.3'
third='50,0,20,90,B,0.1,0.2,0.3'

# every_reader CODE PART FILE: what each command says of a table.
every_reader() {
    expect_fail "$1" "$2" info "$3"
    expect_fail "$1" "$2" measure "$3" atlas:white-linen -o x.csv
    expect_fail "$1" "$2" reconstruct b.gonio "$3" -o x.binary
}

# ---- no file, no access, no table ----

mkdir folder
: >empty.csv
printf '\n\n  \n' >blank.csv
printf '# gonio plan\n' >comments.csv
expect_fail 1 'missing.csv: cannot read: No such file' measure missing.csv atlas:oak-sawn -o x.csv
expect_fail 1 'missing.csv: cannot read: No such file' \
    reconstruct b.gonio missing.csv -o x.binary
expect_fail 1 'folder: cannot read: Is a directory' measure folder atlas:oak-sawn -o x.csv
expect_fail 1 'folder: cannot read: Is a directory' reconstruct b.gonio folder -o x.binary
expect_fail 1 'empty.csv: the file is empty' measure empty.csv atlas:oak-sawn -o x.csv
expect_fail 1 'empty.csv: the file is empty' reconstruct b.gonio empty.csv -o x.binary
every_reader 1 'blank.csv: no line of column names' blank.csv
every_reader 1 'comments.csv: no line of column names' comments.csv
expect_fail 1 'material.binary: a material (MERL .binary table), not readings' \
    measure material.binary atlas:oak-sawn -o x.csv
expect_fail 1 'b.gonio: a basis (gonio basis), not readings' reconstruct b.gonio b.gonio -o x.binary
table noise.csv "$header" "$first"
printf '10,0,20,\0018,R,1,1,1\n' >>noise.csv
every_reader 1 'noise.csv:12: binary data' noise.csv
if permissions_apply; then
    cp r.csv secret.csv
    chmod 000 secret.csv
    runner=as_other_user expect_fail 1 'secret.csv: cannot read: Permission denied' \
        reconstruct b.gonio secret.csv -o x.binary
    chmod 600 secret.csv
else
    skip 'unreadable readings: no other user to run as'
fi

# ---- shape ----

table none.csv "$header"
every_reader 1 'none.csv: no lines below the column names' none.csv
table short.csv "$header" "$first" '30,0,20'
every_reader 1 'short.csv:12: 3 cells where the header names 8 columns' short.csv
table long.csv "$header" "$first,7"
every_reader 1 'long.csv:11: 9 cells where the header names 8 columns' long.csv
head -c $(($(stat -c %s r.csv) - 30)) r.csv >cut.csv
every_reader 1 'cells where the header names 8 columns' cut.csv
table twice.csv "$header,R_per_sr" "$first,7"
every_reader 1 "twice.csv:10: column 'R_per_sr' occurs twice" twice.csv
table case.csv "$header,r_PER_sr" "$first,7"
every_reader 1 "case.csv:10: column 'r_PER_sr' occurs twice" case.csv
table quote.csv "$header" '10,0,20,180,"R,1,1,1'
every_reader 1 'quote.csv:11: quotes that do not close' quote.csv
table inside.csv "$header" '10,0,20,180,R"G",1,1,1'
every_reader 1 'inside.csv:11: quotes that do not close or stand inside a cell' inside.csv
for column in theta_i_deg phi_i_deg theta_o_deg phi_o_deg; do
    table lacking.csv "${header/$column/note}" "$first"
    every_reader 1 "lacking.csv: no column '$column'" lacking.csv
done
expect_fail 1 'p.csv: no column of values (R_per_sr, G_per_sr, B_per_sr, or 400nm_per_sr ...)' \
    reconstruct b.gonio p.csv -o x.binary

# ---- angles ----

angle() { # THETA_I PHI_I THETA_O PHI_O PART
    table angle.csv "$header" "$first" "$1,$2,$3,$4,R,1,1,1"
    every_reader 1 "angle.csv:12: $5" angle.csv
}
angle 181 0 20 0 'theta_i = 181 is impossible in degrees'
angle 20 0 -200.5 0 'theta_o = -200.5 is impossible in degrees'
angle ten 0 20 0 "theta_i_deg 'ten' is not a finite number"
angle 10turns 0 20 0 "theta_i_deg '10turns' is not a finite number"
angle '' 0 20 0 "theta_i_deg '' is not a finite number"
angle nan 0 20 0 "theta_i_deg 'nan' is not a finite number"
angle inf 0 20 0 "theta_i_deg 'inf' is not a finite number"
angle 10 1e999 20 0 "phi_i_deg '1e999' is not a finite number"
long=$(printf '%05000d' 1)
angle "${long}x" 0 20 0 "theta_i_deg '000"

# What is at or below the horizon is no reading; the other side and more than a turn can be read.
beyond() { # THETA_I PHI_I THETA_O PHI_O PART
    table angle.csv "$header" "$first" "$second" "$third" "$1,$2,$3,$4,R,1,1,1"
    for command in 'info angle.csv' 'measure angle.csv atlas:white-linen -o beyond.csv' \
        'reconstruct b.gonio angle.csv -o x.binary'; do
        expect_ok $command
        expect_true "$command: $5" grep -q -- "$5" "$root/work/stderr"
    done
}
beyond 90 0 20 0 '3 readings; left out: 1 at or below the horizon'
expect_true 'a row that was left out is not written' test "$(grep -c '^[0-9]' beyond.csv)" -eq 3
beyond 20 0 120.5 0 '3 readings; left out: 1 at or below the horizon'
beyond -5 0 20 0 '4 readings; 1 with theta below zero (phi turned by 180)'
table turns.csv "$header" "$first" "$second" "$third" '5,361,20,-3599,R,1,1,1'
expect_ok reconstruct b.gonio turns.csv -o turns.binary
table once.csv "$header" "$first" "$second" "$third" '5,1,20,1,R,1,1,1'
expect_ok reconstruct b.gonio once.csv -o once.binary
expect_same turns.binary once.binary
table low.csv "$header" '90,0,20,0,R,1,1,1'
every_reader 1 'low.csv: none of the 1 rows is a reading above the horizon' low.csv

# ---- channels and values ----

value() { # CHANNEL R PART
    table value.csv "$header" "$first" "11,0,20,0,$1,$2,1,1"
    every_reader 1 "value.csv:12: $3" value.csv
}
value red 1 "channel 'red' is not a channel: R, G, B or all"
value 0 1 "channel '0' is not a channel"
value R bright "R_per_sr 'bright' is not a finite number (leave the cell empty"
value R inf "R_per_sr 'inf' is not a finite number"
value R 1e999 "R_per_sr '1e999' is not a finite number"
value R 1e300 "R_per_sr '1e300' is larger than any BRDF"
value R 1.5.2 "R_per_sr '1.5.2' is not a finite number"

table negative.csv "$header" "$first" '11,0,20,0,R,-0.5,1,1' "$third"
expect_fail 1 "negative.csv:12: R_per_sr '-0.5' is negative" \
    reconstruct b.gonio negative.csv -o x.binary
expect_ok reconstruct b.gonio negative.csv --negative-to-zero -o negative.binary
table zero.csv "$header" "$first" '11,0,20,0,R,0,1,1' "$third"
expect_ok reconstruct b.gonio zero.csv -o zero.binary
expect_same negative.binary zero.binary

table unread.csv "$header" "$first" '11,0,20,0,R,,1,1' "$third"
expect_fail 1 'unread.csv:12: channel R was planned here but not read' \
    reconstruct b.gonio unread.csv -o x.binary
table nothing.csv "${header/channel,/}" '10,0,20,180,,,' '20,0,20,180,NA,nan,'
expect_fail 1 'nothing.csv: no usable reading to determine 2 coefficients' \
    reconstruct b.gonio nothing.csv -o x.binary

# ---- repeats ----

table repeat.csv "$header" "$first" "$second" '10,360,20,180,R,0.3,0.2,0.3' "$third"
expect_fail 1 'repeat.csv:13: the same directions and channel as line 11' \
    reconstruct b.gonio repeat.csv -o x.binary
expect_ok measure repeat.csv atlas:oak-sawn -o twice.csv
expect_ok reconstruct b.gonio repeat.csv --average-repeats -o repeat.binary
table all.csv "$header" "$first" '10,0,20,180,all,0.3,0.2,0.3' "$third"
expect_fail 1 'all.csv:12: the same directions and channel as line 11' \
    reconstruct b.gonio all.csv -o x.binary
table channels.csv "$header" "$first" '10,0,20,180,G,0.1,0.2,0.3' '10,0,20,180,B,0.1,0.2,0.3'
expect_ok reconstruct b.gonio channels.csv -o channels.binary

# ---- too few ----

table few.csv "$header" "$first"
expect_fail 1 'few.csv: 1 readings of which 1 are independent cannot determine 2 coefficients' \
    reconstruct b.gonio few.csv -o x.binary
# The same again is no news.
table same.csv "$header" "$first" "$first" "$first"
expect_fail 1 'same.csv: 3 readings of which 1 are independent cannot determine 2 coefficients' \
    reconstruct b.gonio same.csv --average-repeats -o x.binary
expect_ok reconstruct b.gonio few.csv --all-channels -o all.binary

# ---- the notes that a plan carries ----

sed 's/^# grid: .*/# grid: half\/difference 45 x 45 x 90/' r.csv >note.csv
every_reader 1 "note.csv: made for the grid 'half/difference 45 x 45 x 90'" note.csv
for note in 'basis: unknown' 'basis: -1' 'basis: 1123456789abcdef0' 'components: two' \
    'components: -2' 'components: 0' 'components: 99999999999999999999'; do
    sed "s/^# ${note%%:*}: .*/# $note/" r.csv >note.csv
    every_reader 1 "note.csv: '# $note' is not what gonio plan writes" note.csv
done
sed 's/^# basis: .*/# basis: 0123456789abcdef/' r.csv >note.csv
expect_fail 1 'note.csv: planned with another basis' reconstruct b.gonio note.csv -o x.binary
expect_ok reconstruct b.gonio note.csv --other-basis -o x.binary
expect_same x.binary good.binary
sed 's/^# components: .*/# components: 9/' r.csv >note.csv
expect_fail 1 'note.csv: planned for 9 components, but the basis has 3' \
    reconstruct b.gonio note.csv -o x.binary

# ---- unusual, but to be understood: the same readings give the same reconstruction ----

same_as_good() {
    expect_ok reconstruct b.gonio "$1" -o x.binary
    expect_same x.binary good.binary
}
sed 's/$/\r/' r.csv >crlf.csv
same_as_good crlf.csv
{ printf '\xef\xbb\xbf'; cat r.csv; } >mark.csv
same_as_good mark.csv
{ printf '\xef\xbb\xbf'; grep -v '^#' r.csv; printf '# basis: 1\n'; } >end.csv
expect_fail 1 'end.csv: planned with another basis' reconstruct b.gonio end.csv -o x.binary
sed '/^#/!s/,/\t/g' r.csv >tabs.csv
same_as_good tabs.csv
sed '/^#/!s/,/;/g' r.csv >semicolons.csv
same_as_good semicolons.csv
sed '/^#/!s/,/;/g; /^#/!s/\./,/g' r.csv >decimal.csv
same_as_good decimal.csv
sed '/^#/!s/,/ , /g' r.csv >spaces.csv
same_as_good spaces.csv
sed '/^#/!s/\([^,]*\)/"\1"/g' r.csv >quotes.csv
same_as_good quotes.csv
sed '/^[0-9]/s/^/# in between\n\n  \n/' r.csv >between.csv
same_as_good between.csv
head -c -1 r.csv >unended.csv
same_as_good unended.csv
sed 's/_deg/_DEG/g; s/_per_sr/_PER_SR/g; s/,R,/,r,/' r.csv >case.csv
same_as_good case.csv
sed 's/^#.*/&,,,,/; $a,,,,,,,' r.csv >padded.csv
same_as_good padded.csv
sed '/^#/!s/,/;/g; s/^#.*/"&";;;/; 1isep=;' r.csv >excel.csv
same_as_good excel.csv
tr '\n' '\r' <r.csv >cr.csv
same_as_good cr.csv
# Names that are not gonio's are said in a note, and so are numbers that are not read.
sed 's/^theta_i_deg,.*/incident angle,phi_in [deg],view zenith,view azimuth,channel,brdf R,brdf G,brdf B/' \
    r.csv >words.csv
same_as_good words.csv
expect_true 'a note says what columns were taken for' \
    grep -q "note: words.csv: taken as CSV (angles 'incident angle', 'phi_in \[deg\]', 'view zenith'" \
    "$root/work/stderr"
sed '/^theta/s/$/,lux/; /^[0-9]/s/$/,250/' r.csv >lux.csv
same_as_good lux.csv
expect_true 'a note names numbers that are not read' \
    grep -q "lux.csv: columns of numbers that are not read: 'lux'" "$root/work/stderr"
if iconv -l >"$root/work/noise" 2>&1; then
    for order in UTF-16LE UTF-16BE; do
        { printf '\xef\xbb\xbf'; tr , '\t' <r.csv; } | iconv -f UTF-8 -t $order >unicode.txt
        same_as_good unicode.txt
        expect_output 'unicode.txt: gonio readings' info unicode.txt
    done
else
    skip 'UTF-16: no iconv'
fi
reversed() { # columns in the opposite order, and one more
    local line cells
    while IFS= read -r line; do
        if [[ $line == '#'* ]]; then
            printf '%s\n' "$line"
            continue
        fi
        IFS=, read -r -a cells <<<"$line"
        printf '%s,' "${cells[7]}" "${cells[6]}" "${cells[5]}" "${cells[4]}" "${cells[3]}" \
            "${cells[2]}" "${cells[1]}"
        printf '%s,%s\n' "${cells[0]}" 'some note'
    done <r.csv
}
reversed | sed '/^B_per_sr/s/some note/remark/' >order.csv
same_as_good order.csv

# Only the planned channel is needed.
only_planned() {
    local line cells
    grep '^#' r.csv
    printf '%s\n' "$header"
    while IFS=, read -r -a cells; do
        case ${cells[4]} in
        R) cells[6]='' cells[7]='' ;;
        G) cells[5]='' cells[7]=NA ;;
        B) cells[5]='' cells[6]='nan' ;;
        *) continue ;;
        esac
        (IFS=, && printf '%s,%s,%s,%s,%s,%s,%s,%s\n' "${cells[@]}")
    done < <(grep -v '^#' r.csv)
}
only_planned >planned.csv
same_as_good planned.csv

# ---- measure keeps what it does not know ----

expect_ok measure order.csv atlas:white-linen -o kept.csv
expect_true 'the other column is kept' test "$(grep -c 'some note$' kept.csv)" -eq 4
expect_true 'the order of the columns is kept' grep -q '^B_per_sr,.*,theta_i_deg,remark$' kept.csv
expect_true 'the notes are kept' grep -q "^$(grep '^# basis:' p.csv)$" kept.csv
same_as_good kept.csv
expect_ok measure semicolons.csv atlas:white-linen -o kept.csv
expect_true 'the separator is kept' grep -q '^theta_i_deg;' kept.csv
same_as_good kept.csv
expect_ok measure decimal.csv atlas:white-linen -o kept.csv
same_as_good kept.csv
{
    printf 'theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,"remark, ""quoted"""\n'
    printf '10,0,20,180,"a, ""b"""\n'
} >remark.csv
expect_ok measure remark.csv atlas:white-linen -o kept.csv
expect_true 'quotes are kept' grep -q '^10,0,20,180,"a, ""b""",' kept.csv
expect_ok measure kept.csv atlas:white-linen -o again.csv
expect_same <(grep -v '^# command' kept.csv) <(grep -v '^# command' again.csv)

finish
