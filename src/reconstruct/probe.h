/* What is tried out on the readings, models and doubts: on at most 128 readings of at most 8
 * columns, by what the readings say of each other. */
#ifndef GONIO_PROBE_H
#define GONIO_PROBE_H

#include "equations.h"

enum { GONIO_I_PROBE_COLUMNS = 8, GONIO_I_PROBE_READINGS = 128 };

/* At most so many readings of a column, evenly spaced: thinned has room for them, and may be the
 * column's own. Returns how many. */
size_t gonio_i_probe_thin(const gonio_i_column *column, size_t most, gonio_i_observation *thinned);

/* The readings, evenly spaced among all. */
typedef struct gonio_i_probe {
    size_t count;
    gonio_i_column column[GONIO_I_PROBE_COLUMNS];
    size_t readings[GONIO_I_PROBE_COLUMNS]; /* of the whole column */
} gonio_i_probe;

/* To be ended in any case. Errors: _MEMORY. */
gonio_status gonio_i_probe_begin(gonio_context *context, const gonio_i_column *columns,
                                 size_t count, gonio_i_probe *probe);
void gonio_i_probe_end(gonio_i_probe *probe);

/* The model while wrong readings are looked for: found only afterwards, they would pass for a
 * remainder. */
static const gonio_i_model GONIO_I_SETTLING = {GONIO_I_KERNEL_WIDTH, 0.12, 0.0};

/* What a model is the less likely for beforehand, for each factor of e in alpha, in the unit of
 * scores. */
static const double GONIO_I_FOR_REMAINDERS = 16.0 / 3.0;

/* Solves for the model, and what the others say of each reading: the difference to it [n], then its
 * variance [n]. difference belongs to the caller, in any case. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_probe_differences(gonio_i_gaussian *gaussian, const gonio_i_model *model,
                                       double **difference);

/* ln of Student's density of a difference, but for a constant: readings are wrong more often than
 * Gaussians say. */
double gonio_i_probe_density(double difference, double variance);

/* Solves for the model and adds ln of the density of each reading given the others. Errors:
 * _MEMORY, _NUMERICAL. */
gonio_status gonio_i_probe_score(gonio_i_gaussian *gaussian, const gonio_i_model *model,
                                 double *score);

#endif
