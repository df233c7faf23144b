/* Means of what the trials found. */
#ifndef GONIO_BENCHMARK_SUMMARY_H
#define GONIO_BENCHMARK_SUMMARY_H

#include "run.h"

/* What stands in place of a set for all together. */
extern const char benchmark_all_sets[];

/* How a stated error fits the true one, over rows that have both. */
typedef struct benchmark_honesty {
    size_t rows;
    double ratio;       /* geometric mean of true over stated */
    double within;      /* share with a ratio of 1/2 to 2, 0 .. 1 */
    double correlation; /* of the logarithms */
} benchmark_honesty;

/* Over the rows of one set, way of choosing directions, n and method. Means leave out what is NaN,
 * and are NaN where nothing is left. */
typedef struct benchmark_mean {
    const char *set; /* or benchmark_all_sets, this pointer */
    const benchmark_directions *ways;
    const char *method;
    bool simple;
    size_t n;
    size_t rows;
    size_t failed; /* of them: the method could not do it */
    gonio_error error;
    double worst_e6;
    double inside;
    double psnr, delta_e_itp;
    double seconds;
    benchmark_honesty expected; /* the E6 that the method states for the whole BRDF */
    benchmark_honesty here;     /* that by its deviations of the compared values */
    double lost_any;            /* share of rows in which a simple method has a smaller E6, */
    double lost_all;            /* in which all simple methods have; NaN without any */
    double worse_repeated;      /* of rows with repeated readings: share in which E6 is more than
                                 * 1 % of it above that of the same directions read once; NaN */
} benchmark_mean;

typedef struct benchmark_summary {
    size_t count;
    benchmark_mean *mean; /* [count], by set, way, method and n */
    size_t sets;
    const char **set; /* [sets], as given; and "all" last if there are several */
} benchmark_summary;

/* To be freed in any case; the rows must outlive it. Errors: _MEMORY. */
gonio_status benchmark_summarise(gonio_context *context, const benchmark_rows *rows,
                                 benchmark_summary *summary);
void benchmark_summary_free(benchmark_summary *summary);

#endif
