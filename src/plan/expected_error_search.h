/* The choice of the readings of least expected error: see expected_error_search.c. */
#ifndef GONIO_EXPECTED_ERROR_SEARCH_H
#define GONIO_EXPECTED_ERROR_SEARCH_H

#include "method.h"

typedef struct gonio_i_expected_error_problem {
    gonio_context *context;
    const float *f; /* [rows][components] */
    size_t rows;
    size_t components;
    const double *covariance; /* [components][components]: of z before the first reading; NULL: I */
    const double *loss;       /* [rows]: weight of the squared error of g there */
    const bool *allowed;      /* [rows]: whether it can be read */
    double variance;          /* of the noise of a reading, log units */
    size_t count;             /* of readings, at most the number of rows allowed */
    double enough;            /* the search ends early when the expected loss is below this */
} gonio_i_expected_error_problem;

/* Fills in chosen[count], in the order of reading, and remaining[count + 1] (unless NULL), the
 * expected loss before the first and after each reading. *found (unless NULL) is how many there
 * are: `count`, or the fewest blocks of readings that leave less than `enough`. Errors: _MEMORY,
 * _CANCELLED. */
gonio_status gonio_i_expected_error_search(const gonio_i_expected_error_problem *problem,
                                           size_t *chosen, double *remaining, size_t *found);

#endif
