/* A trial: one subject, read at directions chosen in one way, completed by every method from every
 * n.
 */
#ifndef GONIO_BENCHMARK_TRIAL_H
#define GONIO_BENCHMARK_TRIAL_H

#include "directions.h"
#include "methods.h"

typedef struct benchmark_trial {
    const benchmark_setting *setting;
    const benchmark_subject *subject;
    const benchmark_directions *ways;
    size_t draw;
    const benchmark_pairs *candidates; /* of tables */
    const json_t *plan;                /* of tables; NULL where there is none */
    benchmark_bases *bases;
} benchmark_trial;

/* Makes a trial: an array with an object for each n and method,
 *     {"n", "method", "read", "values", "errors": [by metric], "inside", "expected",
 *      "expected_here", "psnr", "delta_e_itp", "seconds"}.
 * Numbers that there are not are null. n that the subject has too few readings for are left out; a
 * method that cannot do with what was read has null errors. Errors: those of reading, and of
 * methods but for those that say so (methods.h). */
gonio_status benchmark_trial_run(gonio_context *context, const benchmark_trial *trial,
                                 json_t **rows);

/* Whether JSON from a file has the form of rows. If not, complaint[size] says what is wrong. */
bool benchmark_rows_accept(const json_t *rows, char *complaint, size_t size);

#endif
