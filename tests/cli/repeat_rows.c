/* repeat-rows [FACTOR]: writes each row of 180 values of a MERL table twice, the second time
 * multiplied, which makes it a table of 360 phi_d bins: standard input to standard output. For the
 * tests of the command line; little-endian machines. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { ROW = 180 };

int main(int argc, char **argv)
{
    int32_t bins[3];
    double row[ROW];
    const double factor = argc > 1 ? atof(argv[1]) : 1.0;
    if (fread(bins, sizeof *bins, 3, stdin) != 3 || bins[2] != ROW) {
        return 1;
    }
    bins[2] = 2 * ROW;
    fwrite(bins, sizeof *bins, 3, stdout);
    while (fread(row, sizeof *row, ROW, stdin) == ROW) {
        fwrite(row, sizeof *row, ROW, stdout);
        for (int k = 0; k < ROW; k++) {
            row[k] *= factor;
        }
        fwrite(row, sizeof *row, ROW, stdout);
    }
    return fflush(stdout) == 0 ? 0 : 1;
}
