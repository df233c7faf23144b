/* From the readings of a column to all rows of the basis: the field and its deviation. */
#ifndef GONIO_PREDICT_H
#define GONIO_PREDICT_H

#include "fit.h"

/* Sums over the bins of the grid. */
typedef struct gonio_i_predicted_sums {
    double bins;
    double error;  /* the square of the field's error to expect of the Gaussian */
    double square; /* g^2 */
} gonio_i_predicted_sums;

/* What the readings leave open: sums over every row if the deviation[rows] is wanted (not NULL),
 * otherwise over a sample. c[K]: coefficients in units of the prior. covariance[K][K], or NULL:
 * that of z is added to it. */
gonio_status gonio_i_predict_variance(const gonio_i_fit *gaussian, const double *c,
                                      double *deviation, double *covariance,
                                      gonio_i_predicted_sums *sums);

/* The field of a column: what it is made of. */
typedef struct gonio_i_predicted_column {
    size_t n;             /* readings whose smoothness counts */
    gonio_i_place *place; /* [n] */
    double *smooth;       /* [n]: alpha^2 S^-1 (y - F z), the mean over the models */
    double *peaked;       /* [n]: alpha^2 peak^2 S^-1 (y - F z), the same */
    const double *c;      /* [K] */
    double *field;        /* [rows]: to be filled */
} gonio_i_predicted_column;

/* g = m + f c + k's two parts by their weights in every row, of all columns. */
gonio_status gonio_i_predict_fields(gonio_context *context, const gonio_i_prior *prior,
                                    const gonio_i_predicted_column *columns, size_t count);

#endif
