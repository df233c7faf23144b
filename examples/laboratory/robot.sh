#!/bin/sh
# The gantry's program, played. robot.sh FROM TO appends lines of the rehearsed run to robot.csv; at
# line 40 the door is open, and the reading six times too bright. robot.sh again reads what rest.csv
# asks for.
case $1 in
again)
    gonio measure -q rest.csv atlas:sapphire-metallic --instrument gantry.json --seed 1 -o again.csv
    time=$(tail -n 1 robot.csv | cut -d, -f5)
    sed 1,/^theta/d again.csv | awk -F, -v OFS=, -v time="$time" '$6 == "" { $5 += time; print }' >>robot.csv
    ;;
*)
    awk -F, -v OFS=, -v from="$1" -v to="$2" '
        NR == 40 { $7 *= 6; $8 *= 6; $9 *= 6 }
        NR >= from && NR <= to' rehearsal.csv >>robot.csv
    ;;
esac
