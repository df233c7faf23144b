#!/bin/bash
# Readings from a pipe were said to be empty: what a file is was found out by reading its beginning, which is then gone.
. "$(dirname "$0")/../cli/lib.sh"

expect_ok learn --grid bivariate atlas:oak-sawn atlas:gold-polished atlas:plaster-cast -o b.gonio
expect_ok plan b.gonio -n 4 -o p.csv
expect_ok measure p.csv atlas:red-cotton -o r.csv
expect_ok reconstruct b.gonio r.csv -o file.binary
expect_ok reconstruct b.gonio <(cat r.csv) -o pipe.binary
expect_same file.binary pipe.binary
expect_output 'gonio readings, 4 directions, 4 measured' info <(cat r.csv)
expect_output 'gonio plan, 4 directions, 0 measured' info <(cat p.csv)
expect_ok measure <(cat p.csv) atlas:red-cotton -o again.csv
expect_output '0.000     0.000    0.0000' compare r.csv <(cat again.csv)
expect_ok measure p.csv <(cat r.csv) -o looked-up.csv
expect_output '0.000     0.000    0.0000' compare r.csv looked-up.csv
expect_output '0.000     0.000    0.0000' compare <(cat r.csv) again.csv
expect_output '0.000     0.000    0.0000' compare <(cat r.csv) <(cat again.csv)
expect_output '2 readings compared' compare <(cat r.csv) <(cat again.csv) --leave-out <(sed '$d' r.csv | sed '$d')
printf '2\n400 500\n0.1 0 0.2 1 0.3 0.4\n' >s.brdf
expect_output 'gonio readings, 1 directions, 1 measured' info <(cat s.brdf)

finish
