/* A subject that is open: what can be read of it, and its readings. */
#ifndef GONIO_BENCHMARK_SAMPLE_H
#define GONIO_BENCHMARK_SAMPLE_H

#include "setting.h"
#include "subjects.h"

/* Pairs of directions. */
typedef struct benchmark_pairs {
    size_t count;
    gonio_pair *pair; /* [count] */
} benchmark_pairs;

typedef struct benchmark_sample {
    const benchmark_subject *subject;
    gonio_material *material;    /* of a table; NULL of scattered readings, */
    gonio_table *table;          /* as is this */
    unsigned char *measured;     /* of a table, [GONIO_BINS]: a bit for each channel that it was
                                  * measured in at the bin's centre and its reciprocal */
    gonio_readings *known;       /* of scattered readings; NULL of a table */
    const gonio_pair *candidate; /* [candidates]: what can be read; none: anything */
    size_t candidates;
    gonio_pair *own; /* what candidate points to, unless all tables share it */
} benchmark_sample;

/* The directions of which those of tables are chosen: random points of the grid, uniform in
 * (sqrt theta_h, theta_d, phi_d) as its bins are, both polar angles below the reach. None for any.
 * Errors: _MEMORY. */
gonio_status benchmark_candidates(gonio_context *context, const benchmark_setting *setting,
                                  benchmark_pairs *candidates);

/* Opens a subject; `shared` are the candidates of tables and must outlive the sample, which is to
 * be freed in any case. Of scattered readings at most as many as setting->candidates can be chosen:
 * a random part of them where there are more. Errors: those of opening and reading it. */
gonio_status benchmark_sample_open(gonio_context *context, const benchmark_setting *setting,
                                   const benchmark_subject *subject, const benchmark_pairs *shared,
                                   benchmark_sample *sample);
void benchmark_sample_free(benchmark_sample *sample);

/* Reads the sample: of a table in R, G and B, by the instrument of the setting; of scattered
 * readings what the file holds, with its deviations. Directions without any value are left out.
 * *readings is the caller's. Errors: _DATA if there is no value at any; _MEMORY. */
gonio_status benchmark_sample_read(gonio_context *context, const benchmark_setting *setting,
                                   const benchmark_sample *sample, const benchmark_pairs *at,
                                   gonio_readings **readings);

/* The largest n of a sample: half of scattered readings, so that as many are left to be predicted.
 */
size_t benchmark_sample_most(const benchmark_sample *sample);

#endif
