/* The trials of a benchmark as pieces of work that are kept (checkpoint.h), and what they found. */
#ifndef GONIO_BENCHMARK_RUN_H
#define GONIO_BENCHMARK_RUN_H

#include "directions.h"
#include "methods.h"

/* One method on one subject from one n. */
typedef struct benchmark_row {
    const benchmark_subject *subject;
    const benchmark_lesson *lesson;
    const benchmark_directions *ways;
    const char *method;
    bool simple;
    size_t draw, n, read, values;
    gonio_error error; /* NaN where the method could not do it */
    double inside, expected, expected_here;
    double psnr, delta_e_itp;
    double seconds;
} benchmark_row;

typedef struct benchmark_rows {
    size_t count;
    benchmark_row *row;
    json_t *kept; /* what the names of methods belong to */
} benchmark_rows;

/* Makes the trials that the folder lacks. The rows are in the order of lessons, subjects,
 * directions, draws, n and methods; they are to be freed in any case. Errors: those of checkpoint.h
 * and trial.h. */
gonio_status benchmark_run(gonio_context *context, const benchmark_setting *setting,
                           const benchmark_subjects *subjects, const benchmark_lessons *lessons,
                           const char *folder, benchmark_rows *rows);
void benchmark_rows_free(benchmark_rows *rows);

#endif
