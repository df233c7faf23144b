/* Which models of the prior the readings speak for, and how loudly.
 *
 * A few readings cannot tell one h, alpha and peak from the next. So the reconstruction is the mean
 * over those that explain the readings well, as in Bayesian model averaging (Hoeting et al. 1999),
 * with leave-one-out densities in place of marginal likelihoods (pseudo-BMA; Yao et al. 2018).
 *
 * Readings that contradict the others can be wrong, or be right of a material that is like none of
 * the database's. Models are weighed without them only if that explains all readings so much better
 * than a larger remainder does that they must be wrong. */
#ifndef GONIO_MODELS_H
#define GONIO_MODELS_H

#include "leave_one_out.h"

enum { GONIO_I_MOST_MODELS = 20 };

typedef struct gonio_i_models {
    size_t count;
    gonio_i_model model[GONIO_I_MOST_MODELS];
    double weight[GONIO_I_MOST_MODELS]; /* add up to 1; none is negligible */
    gonio_i_model best;                 /* the likeliest by itself */
} gonio_i_models;

/* One model alone. */
gonio_i_models gonio_i_models_of(gonio_i_model model);

/* The models that leaving out readings one at a time is in favour of, all columns together.
 * Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_models_weigh(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_i_subset *subset, gonio_i_models *models);

#endif
