/* Columns solved in groups that were read at the same directions: for posterior.c. */
#ifndef GONIO_SOLVE_COLUMNS_H
#define GONIO_SOLVE_COLUMNS_H

#include "fields.h"
#include "learned_error.h"
#include "models.h"
#include "neighbours.h"
#include "parallel_for.h"
#include "variance.h"

/* What is found of a column. */
typedef struct gonio_i_found_column {
    gonio_i_column merged; /* its observations, if there were too many; or empty */
    double *terms;         /* of its field (fields.h), the mean over the models */
    double *part[2];       /* the same by each neighbour, of a column that is not fitted */
    double outlying;
    double surprise;
    double residual; /* sum of squares */
    gonio_i_variance_sums sums;
    double expected; /* mean square of the error to expect */
} gonio_i_found_column;

typedef struct gonio_i_finding {
    gonio_context *context;
    const gonio_i_prior *prior;
    const gonio_i_posterior_options *options;
    gonio_i_models models;
    bool plain; /* of many readings: all of them are without samples */
    gonio_i_targets targets;
    gonio_i_learned_error *learned; /* NULL: the Gaussian's own */
    gonio_i_posterior *p;
    size_t count;
    gonio_i_column *column; /* [count]: observations, merged if there are many; owned elsewhere */
    gonio_i_found_column *found;    /* [count] */
    gonio_i_neighbours *neighbours; /* [count] */
    gonio_i_steps steps;
} gonio_i_finding;

/* Finds every column: its coefficients in units of the prior, field and deviation go to all->p, as
 * does the sum of the covariances. Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_solve_columns(gonio_i_finding *all);

/* Begins a fit of a column over its sites, without samples if the finding is plain; then the
 * inverse is kept (fit_inverse.h). To be ended in any case. Errors: _MEMORY. */
gonio_status gonio_i_column_begin(const gonio_i_finding *all, gonio_context *context,
                                  const gonio_i_sites *sites, size_t column, gonio_i_fit *fit);

/* Solves for the best model, with outliers set aside if the models were weighed without them.
 * Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_column_settle(const gonio_i_finding *all, gonio_i_fit *fit, double *outlying);

#endif
