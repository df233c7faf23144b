/* What the readings of a column leave open: the variance of the field in the rows of the basis. */
#ifndef GONIO_VARIANCE_H
#define GONIO_VARIANCE_H

#include "fit.h"
#include "targets.h"

/* Rows of the basis as they are seen from some sites by a model: made once for all columns of the
 * sites and not changed, so that any number of threads may use them. all: every row of the basis,
 * or the targets' sample. Sites and targets must outlive them. Errors: _MEMORY. */
typedef struct gonio_i_rows gonio_i_rows;

gonio_status gonio_i_rows_create(gonio_context *context, const gonio_i_sites *sites,
                                 const gonio_i_model *model, const gonio_i_targets *targets,
                                 bool all, gonio_i_rows **rows);
void gonio_i_rows_free(gonio_i_rows **rows);

/* Sums over the targets, each times its weight. */
typedef struct gonio_i_variance_sums {
    double bins;   /* of the weights */
    double error;  /* the square of the field's error to expect of the Gaussian */
    double square; /* g^2 */
} gonio_i_variance_sums;

/* Adds to the sums. fit: over the sites of the rows, solved for their model. c[K]: coefficients in
 * units of the prior. deviation[rows of the basis]: of every row, which all have to be in `rows`,
 * or NULL. covariance[K][K]: of z, or NULL. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_variance_find(const gonio_i_fit *fit, const gonio_i_rows *rows,
                                   const double *c, double *deviation, double *covariance,
                                   gonio_i_variance_sums *sums);

#endif
