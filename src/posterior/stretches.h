/* The weights of stretches (prior/stretch.h) and models, given readings.
 *
 * The ratio of the axes, the azimuth of the grain, the share of the covariance that depends on the
 * azimuth, and alpha, peak and h of the model (fit.h) are weighed together by leave-one-out
 * prediction, as isotropic models are (models.h). Isotropic models are among them and are the
 * likelier ones before any reading. A coarse grid of ratios and azimuths is refined about its best,
 * once with the grain a plane of symmetry and once without. What readings leave open of the best is
 * kept by stretches around it, which share its weight (stretch_spread.h). */
#ifndef GONIO_STRETCHES_H
#define GONIO_STRETCHES_H

#include "fit.h"
#include "stretched_sites.h"

/* A stretch and a model of the rest. */
typedef struct gonio_i_hypothesis {
    gonio_i_stretch stretch;
    gonio_i_model model;
    double weight;
} gonio_i_hypothesis;

/* Readings in columns, separate channels, with their directions. */
typedef struct gonio_i_oriented_columns {
    const gonio_i_prior *prior;
    const gonio_pair *pair; /* by gonio_i_observation.reading */
    const gonio_i_column *column;
    size_t count;
    int symmetry; /* stated: 1, 2 or 4; 0: found */
} gonio_i_oriented_columns;

typedef struct gonio_i_stretches {
    size_t count;
    gonio_i_hypothesis hypothesis[GONIO_I_MOST_HYPOTHESES]; /* the likeliest first; weights add up
                                                             * to 1; none is negligible */
    double odds;               /* ln of the odds that the material is anisotropic */
    gonio_i_stretch likeliest; /* of those that are not isotropic */
} gonio_i_stretches;

/* Weighs stretches by at most 8 columns and 192 readings of each.
 * Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_stretches_weigh(gonio_context *context,
                                     const gonio_i_oriented_columns *columns,
                                     gonio_i_stretches *stretches);

/* ln of the odds alone, sooner: by at most 3 columns and 96 readings of each, without refinement.
 * It is rather too low. Errors: the same. */
gonio_status gonio_i_stretches_notice(gonio_context *context,
                                      const gonio_i_oriented_columns *columns, double *odds);

/* What another reading at another turn of the sample adds to the odds, on average, if the readings
 * seem isotropic but the ratio of the axes is exp(log_ratio). Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_stretches_expect_gain(gonio_context *context,
                                           const gonio_i_oriented_columns *columns,
                                           double log_ratio, double *gain);

/* Whether the readings cannot tell what depends on the azimuth of the half vector: they all have
 * the same, or are at mirror directions. */
bool gonio_i_azimuths_are_same(const gonio_i_oriented_columns *columns);

/* ln of the odds of ratios[count], with any azimuth of the grain, against the isotropic material,
 * odds[count]. Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_stretches_compare_ratios(gonio_context *context,
                                              const gonio_i_oriented_columns *columns,
                                              const double *log_ratios, size_t count, double *odds);

#endif
