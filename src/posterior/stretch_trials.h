/* Trials of stretches: leave-one-out scores of models under each, and what the scores weigh. */
#ifndef GONIO_STRETCH_TRIALS_H
#define GONIO_STRETCH_TRIALS_H

#include "parallel_for.h"
#include "stretches.h"

enum {
    GONIO_I_SEARCH_COLUMNS = 8, /* at most, of a search, */
    GONIO_I_SEARCH_READINGS = 192,
    GONIO_I_ROTATIONS = 8, /* azimuths of the grain in half a turn */
    GONIO_I_TRIAL_MODELS = 10,
    GONIO_I_SEARCHED_MODELS = 2,
    GONIO_I_TRIAL_SHARES = 5,
    GONIO_I_MOST_TRIALS = 96 /* of a round */
};

/* Remainders, as in models.c; and those of the search over the grid. */
extern const gonio_i_model gonio_i_trial_models[GONIO_I_TRIAL_MODELS];
extern const gonio_i_model gonio_i_searched_models[GONIO_I_SEARCHED_MODELS];

/* Shares of the isotropic covariance that depend on the azimuth; the first is 0. */
extern const double gonio_i_trial_shares[GONIO_I_TRIAL_SHARES];

/* As in models.c: the share of a score that counts. */
extern const double gonio_i_score_share;

/* The log prior ratio of an isotropic material. Stretches that are chosen to suit the readings of
 * an isotropic material gain up to half of it. */
extern const double gonio_i_for_isotropic;

/* A stretch, and the scores of models under it. */
typedef struct gonio_i_trial {
    gonio_i_stretch stretch;
    size_t count;
    gonio_i_model model[GONIO_I_TRIAL_MODELS];
    double score[GONIO_I_TRIAL_MODELS];
} gonio_i_trial;

/* The columns that are scored, thinned. */
typedef struct gonio_i_search {
    gonio_context *context;
    const gonio_i_prior *prior;
    gonio_i_prior plain; /* the same without samples */
    const gonio_pair *pair;
    size_t columns;
    gonio_i_column column[GONIO_I_SEARCH_COLUMNS];
    double h; /* of mixtures */
    int symmetry;
    gonio_i_steps steps;
    gonio_i_trial *trial; /* those of the present round */
} gonio_i_search;

/* Thins columns; to be ended in any case. Errors: _MEMORY. */
gonio_status gonio_i_search_begin(gonio_context *context, const gonio_i_oriented_columns *columns,
                                  size_t most_columns, size_t most_readings, gonio_i_search *s);
void gonio_i_search_end(gonio_i_search *s);

/* The symmetry that kappa has beside an elliptical stretch. */
int gonio_i_search_symmetry(const gonio_i_search *s);

gonio_i_trial gonio_i_trial_of(gonio_i_stretch stretch, const gonio_i_model *models, size_t count);

/* trials[GONIO_I_MOST_TRIALS]: the grid of ratios and azimuths, for stretches that are otherwise as
 * `kind`. A quarter turn's symmetry has none, nor has a mirrored one without that of half a turn.
 * Returns how many. */
size_t gonio_i_trials_grid(const gonio_i_search *s, gonio_i_stretch kind, gonio_i_trial *trials);

/* Finds the scores of trials. Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_trials_score(gonio_i_search *s, gonio_i_trial *trials, size_t count);

/* The log prior of ln r: that of a Gaussian of deviation 1 in the plane of ln r (cos 2 psi, sin 2
 * psi), whose azimuths are alike. 0 at its largest, which is ln r = 1, and at 0, where there is no
 * stretch. */
double gonio_i_log_ratio_prior(double log_ratio);

/* The logarithm of a model's weight, the model of the largest, and that weight. */
double gonio_i_trial_model_weight(const gonio_i_trial *t, size_t m);
size_t gonio_i_trial_best(const gonio_i_trial *t);
double gonio_i_trial_weight(const gonio_i_trial *t);

#endif
