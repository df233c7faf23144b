/* The posterior of a material's BRDF, given its readings and a prior (prior/prior.h).
 *
 * With y = g - m at the readings, F their rows f, k the smoothness between them and D the variances
 * of noise, the covariance of y is
 *
 *     S = h^2 F F' + alpha^2 k + D.
 *
 * The columns of the database are not only its covariance: each one, shrunk by a = (1 - h^2)^(1/2),
 * is the centre of a Gaussian of covariance h^2 I, weighted by how well it explains the readings
 * (a Gaussian mixture with a common covariance; Silverman 1986, West 1993):
 *
 *     q_j ~ share_j exp(-|L^-1 (y - a F z_j)|^2 / 2),   S = L L',   z = a sum q_j z_j,
 *     c = z + h^2 F' S^-1 (y - F z),   g(x) = m(x) + f(x) c + alpha^2 k(x, .) S^-1 (y - F z).
 *
 * Wrong directions are set aside first (wrong_directions.h). The field is the mean over models of
 * different h, alpha and peak of k, weighed by leave-one-out prediction, all columns together
 * (models.h). Standard deviations are those of the most likely model. The expected error is the
 * geometric mean of that of its variance and that learned from the database (learned_error.h). A
 * reading that the others contradict by more than `OUTLYING` standard deviations gets a variance to
 * match. From a thousand readings on, h is 1. */
#ifndef GONIO_POSTERIOR_H
#define GONIO_POSTERIOR_H

#include <gonio/basis.h>

#include "../prior/prior.h"

/* Standard deviation, in log units, of the errors of interpolation between cells and of the
 * variation inside a cell: of 0.01, 0.03, 0.06 the smallest at which the error of left-out
 * materials still falls. */
#define GONIO_I_MODEL_DEVIATION 0.03

/* Directions of which a reading is the mean in log space, with weights whose sum is 1. */
typedef struct gonio_i_spread {
    size_t count;
    const gonio_half_difference *at; /* [count] */
    const double *weight;            /* [count] */
} gonio_i_spread;

/* A reading of one column. */
typedef struct gonio_i_observation {
    gonio_half_difference at;
    double g;        /* in log space */
    double variance; /* of noise, in log space, and of what the model leaves open */
    int channel;     /* of the row, if the basis is joint */
    int bound;       /* 0; -1: g is at most this (a reading of zero); 1: at least (saturated) */
    size_t reading;  /* its number among the readings */
    const gonio_i_spread *spread; /* what it is the mean of; NULL: it is at `at` */
    bool wrong;                   /* its direction is set aside (wrong_directions.h) */
} gonio_i_observation;

typedef struct gonio_i_column {
    size_t count;
    gonio_i_observation *observation;
} gonio_i_column;

typedef struct gonio_i_posterior_options {
    double smoothness;        /* alpha; negative: a mean over models */
    bool deviation;           /* of every row wanted */
    size_t most;              /* readings of a column that are not merged (merge.h); 0: 3,000 */
    const double *wavelength; /* of the columns, nm: not all are fitted (neighbours.h); or NULL */
    const gonio_half_difference *expected_at; /* [expected_count]: where an error is expected */
    size_t expected_count;                    /* 0: all over the grid */
} gonio_i_posterior_options;

/* What is found; arrays belong to the caller and are filled in. */
typedef struct gonio_i_posterior {
    double *coefficients;         /* [columns][K], of V */
    double *field;                /* [columns][rows]: g */
    double *deviation;            /* [columns][rows] of g, or NULL */
    double smoothness;            /* alpha of the likeliest model */
    double remainder;             /* alpha, root mean square over the models; and */
    double peak;                  /* peak of the remainder, by the mean of (alpha peak)^2 */
    double predicted;             /* of E6, per cent; */
    double predicted_by_variance; /* and by the variance of the likeliest model alone */
    double surprise;    /* root mean square of leave-one-out errors, in standard deviations */
    double *covariance; /* [K][K], of z, the mean over the columns; or NULL */
    double norm;        /* root of the mean over the columns of the sum of g^2 over the grid */
    size_t outlying;    /* readings that the others contradict, all columns */
    double residual;    /* root mean square of what the others leave, log units */
    bool *contradicted; /* by number of the reading: whether a value is outlying; or NULL */
} gonio_i_posterior;

/* Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_posterior_find(gonio_context *context, const gonio_i_prior *prior,
                                    const gonio_i_column *columns, size_t count,
                                    const gonio_i_posterior_options *options,
                                    gonio_i_posterior *posterior);

#endif
