/* Scores of models and mistakes by leave-one-out prediction: the density of each reading given the
 * others, on at most 128 readings of at most 8 columns. */
#ifndef GONIO_LEAVE_ONE_OUT_H
#define GONIO_LEAVE_ONE_OUT_H

#include "fit.h"

enum { GONIO_I_SUBSET_COLUMNS = 8, GONIO_I_SUBSET_READINGS = 128 };

/* Copies evenly spaced readings of a column, at most the given number, to `thinned`, which may be
 * the column's own. Returns their number. */
size_t gonio_i_thin(const gonio_i_column *column, size_t most, gonio_i_observation *thinned);

/* Thinned copies of columns, copies[count], each to be freed in any case. Errors: _MEMORY. */
gonio_status gonio_i_thin_copy(gonio_context *context, const gonio_i_column *column, size_t most,
                               gonio_i_column *copy);

/* Some of the readings, evenly spaced among all. */
typedef struct gonio_i_subset {
    size_t count;
    gonio_i_column column[GONIO_I_SUBSET_COLUMNS];
    gonio_i_sites *sites[GONIO_I_SUBSET_COLUMNS]; /* shared where they are the same */
    size_t readings[GONIO_I_SUBSET_COLUMNS];      /* of the whole column */
    size_t from[GONIO_I_SUBSET_COLUMNS];          /* the whole column's number */
} gonio_i_subset;

/* To be ended in any case. Errors: _MEMORY. */
gonio_status gonio_i_subset_begin(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_i_column *columns, size_t count,
                                  gonio_i_subset *subset);
void gonio_i_subset_end(gonio_i_subset *subset);

/* Reads the values again from the subset's columns. Their directions must be the same. */
void gonio_i_subset_read(gonio_i_subset *subset, const gonio_i_column *columns);

/* The score that a peak towards the light has to explain: few materials have one. */
#define GONIO_I_FOR_RETRO 16.0

/* The alpha of the model while wrong readings are searched. If models were chosen first, wrong
 * readings would look like a remainder. */
static const gonio_i_model GONIO_I_SETTLING = {GONIO_I_KERNEL_WIDTH, 0.12, 0.0, 0.0};

/* The prior's penalty for each factor of e in alpha, in the unit of scores. */
static const double GONIO_I_FOR_REMAINDERS = 16.0 / 3.0;

/* Solves for the model and predicts each reading from the others. *difference: the differences [n],
 * then their variances [n]; the caller frees it in any case. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_leave_one_out_differences(gonio_i_fit *fit, const gonio_i_model *model,
                                               double **difference);

/* ln of Student's density of a difference, up to a constant. Readings are wrong more often than a
 * Gaussian allows. */
double gonio_i_leave_one_out_density(double difference, double variance);

/* Solves for the model; score[n]: ln of the density of each reading given the others, 0 for those
 * that are left out; -INFINITY if the sites cannot tell of the model. Errors: _MEMORY, _NUMERICAL.
 */
gonio_status gonio_i_leave_one_out_score(gonio_i_fit *fit, const gonio_i_model *model,
                                         double *score);

#endif
