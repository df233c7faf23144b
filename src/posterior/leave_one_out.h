/* What is tried out on the readings, models and doubts: on at most 128 readings of at most 8
 * columns, by what the readings say of each other. */
#ifndef GONIO_LEAVE_ONE_OUT_H
#define GONIO_LEAVE_ONE_OUT_H

#include "fit.h"

enum { GONIO_I_SUBSET_COLUMNS = 8, GONIO_I_SUBSET_READINGS = 128 };

/* At most so many readings of a column, evenly spaced: thinned has room for them, and may be the
 * column's own. Returns how many. */
size_t gonio_i_thin(const gonio_i_column *column, size_t most, gonio_i_observation *thinned);

/* The readings, evenly spaced among all. */
typedef struct gonio_i_subset {
    size_t count;
    gonio_i_column column[GONIO_I_SUBSET_COLUMNS];
    size_t readings[GONIO_I_SUBSET_COLUMNS]; /* of the whole column */
} gonio_i_subset;

/* To be ended in any case. Errors: _MEMORY. */
gonio_status gonio_i_subset_begin(gonio_context *context, const gonio_i_column *columns,
                                  size_t count, gonio_i_subset *probe);
void gonio_i_subset_end(gonio_i_subset *probe);

/* The model while wrong readings are looked for: found only afterwards, they would pass for a
 * remainder. */
static const gonio_i_model GONIO_I_SETTLING = {GONIO_I_KERNEL_WIDTH, 0.12, 0.0};

/* What a model is the less likely for beforehand, for each factor of e in alpha, in the unit of
 * scores. */
static const double GONIO_I_FOR_REMAINDERS = 16.0 / 3.0;

/* Solves for the model, and what the others say of each reading: the difference to it [n], then its
 * variance [n]. difference belongs to the caller, in any case. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_leave_one_out_differences(gonio_i_fit *gaussian, const gonio_i_model *model,
                                               double **difference);

/* ln of Student's density of a difference, but for a constant: readings are wrong more often than
 * Gaussians say. */
double gonio_i_leave_one_out_density(double difference, double variance);

/* Solves for the model and adds ln of the density of each reading given the others. Errors:
 * _MEMORY, _NUMERICAL. */
gonio_status gonio_i_leave_one_out_score(gonio_i_fit *gaussian, const gonio_i_model *model,
                                         double *score);

#endif
