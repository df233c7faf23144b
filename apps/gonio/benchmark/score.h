/* How good a completed BRDF is. */
#ifndef GONIO_BENCHMARK_SCORE_H
#define GONIO_BENCHMARK_SCORE_H

#include "methods.h"
#include "sample.h"

typedef struct benchmark_score {
    gonio_error error;
    size_t values; /* compared: bins or readings, times channels */
    double inside; /* share of them within 1.96 stated deviations, 0 .. 1; NaN: none stated */
    double expected_here; /* E6 by the stated deviations of these values, per cent; NaN */
} benchmark_score;

/* Of a table: over the grid's bins with data in it, both polar angles at the centre below the
 * reach, in the channels in which it was measured there (sample.h). The whole BRDF, as a material,
 * is in *whole, the caller's, which keeps a copy. Errors: those of the completion; _DATA if there
 * is nothing to compare. */
gonio_status benchmark_score_table(gonio_context *context, const benchmark_sample *sample,
                                   double reach, const benchmark_completion *completion,
                                   benchmark_score *score, gonio_material **whole);

/* Of scattered readings: over those at other directions than `read`. Errors: as above. */
gonio_status benchmark_score_readings(gonio_context *context, const benchmark_sample *sample,
                                      const gonio_readings *read,
                                      const benchmark_completion *completion,
                                      benchmark_score *score);

#endif
