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

    /* All of these may be 0. */
    const double *weights;      /* [components][components]: W where the loss is not over these
                                 * rows, by gonio_i_expected_error_weights; `loss` is not read */
    const double *row_variance; /* [rows]: of the noise of each reading; NULL: `variance` */
    const int *group; /* [rows], below `groups`: of rows whose first reading has a price */
    size_t groups;
    double price; /* of the first reading of a group, in readings */
    int sweeps;   /* of exchanges in a block: 0: the usual number; -1: none */
} gonio_i_expected_error_problem;

/* After these, 5, 10, 20, 40 ... readings a plan is a good one too. */
enum { GONIO_I_FIRST_BLOCK = 5 };

/* W = f' diag(loss) f for f[rows][components]: weights[components][components]. Errors: _MEMORY. */
gonio_status gonio_i_expected_error_weights(gonio_context *context, const float *f, size_t rows,
                                            size_t components, const double *loss, double *weights);

/* The expected loss before and after each of the readings chosen[count]: remaining[count + 1]; and
 * the covariance of z at the end, [components][components] (may be NULL). Errors: _MEMORY. */
gonio_status gonio_i_expected_error_remaining(const gonio_i_expected_error_problem *problem,
                                              const size_t *chosen, size_t count, double *remaining,
                                              double *covariance);

/* Fills in chosen[count], in the order of reading, and remaining[count + 1] (unless NULL), the
 * expected loss before the first and after each reading. *found (unless NULL) is how many there
 * are: `count`, or the fewest blocks of readings that leave less than `enough`. Errors: _MEMORY,
 * _CANCELLED. */
gonio_status gonio_i_expected_error_search(const gonio_i_expected_error_problem *problem,
                                           size_t *chosen, double *remaining, size_t *found);

#endif
