/* The weights of the prior's models, given the readings.
 *
 * A few readings cannot distinguish values of h, alpha and peak. So the reconstruction is the mean
 * over the models that explain the readings well, as in Bayesian model averaging (Hoeting et al.
 * 1999), with leave-one-out densities in place of marginal likelihoods (pseudo-BMA; Yao et al.
 * 2018).
 *
 * Readings that contradict the others are either wrong, or right readings of a material unlike all
 * of the database's. They are set aside only if this explains the readings much better than a
 * larger remainder does. */
#ifndef GONIO_MODELS_H
#define GONIO_MODELS_H

#include "leave_one_out.h"

enum { GONIO_I_MOST_MODELS = 24 };

typedef struct gonio_i_models {
    size_t count;
    gonio_i_model model[GONIO_I_MOST_MODELS];
    double weight[GONIO_I_MOST_MODELS]; /* add up to 1; none is negligible */
    gonio_i_model best;                 /* the likeliest by itself */
    bool judge_outliers; /* readings that the others contradict are wrong, and are set aside */
} gonio_i_models;

/* One model alone. */
gonio_i_models gonio_i_models_of(gonio_i_model model);

/* The same models without the columns of the database as centres: h is 1. The weights of models
 * that are then the same are added. */
void gonio_i_models_make_plain(gonio_i_models *models);

/* Weighs the models by leave-one-out prediction, all columns together.
 * Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_models_weigh(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_i_subset *subset, gonio_i_models *models);

#endif
