/* Scores by leave-one-out prediction: see leave_one_out.h. */
#include "leave_one_out.h"

#include <math.h>
#include <stdlib.h>

/* Degrees of freedom of Student's t. */
static const double FREEDOM = 4.0;

size_t gonio_i_thin(const gonio_i_column *column, size_t most, gonio_i_observation *thinned)
{
    const size_t count = column->count < most ? column->count : most;
    for (size_t i = 0; i < count; i++) {
        thinned[i] = column->observation[i * column->count / count];
    }
    return count;
}

gonio_status gonio_i_thin_copy(gonio_context *context, const gonio_i_column *column, size_t most,
                               gonio_i_column *copy)
{
    *copy = (gonio_i_column){0};
    copy->observation = gonio_i_allocate(context, column->count < most ? column->count : most,
                                         sizeof *copy->observation);
    if (copy->observation == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    copy->count = gonio_i_thin(column, most, copy->observation);
    return GONIO_OK;
}

gonio_status gonio_i_subset_begin(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_i_column *columns, size_t count,
                                  gonio_i_subset *subset)
{
    gonio_status status = GONIO_OK;
    *subset = (gonio_i_subset){0};
    subset->count = count < GONIO_I_SUBSET_COLUMNS ? count : GONIO_I_SUBSET_COLUMNS;
    for (size_t k = 0; k < subset->count && status == GONIO_OK; k++) {
        subset->from[k] = k * count / subset->count;
        const gonio_i_column *column = &columns[subset->from[k]];
        subset->readings[k] = column->count;
        status = gonio_i_thin_copy(context, column, GONIO_I_SUBSET_READINGS, &subset->column[k]);
    }
    return status == GONIO_OK
               ? gonio_i_sites_share(context, prior, subset->column, subset->count, subset->sites)
               : status;
}

void gonio_i_subset_read(gonio_i_subset *subset, const gonio_i_column *columns)
{
    for (size_t k = 0; k < subset->count; k++) {
        gonio_i_column *mine = &subset->column[k];
        mine->count =
            gonio_i_thin(&columns[subset->from[k]], GONIO_I_SUBSET_READINGS, mine->observation);
    }
}

void gonio_i_subset_end(gonio_i_subset *subset)
{
    gonio_i_sites_release(subset->sites, subset->count);
    for (size_t k = 0; k < subset->count; k++) {
        free(subset->column[k].observation);
    }
    *subset = (gonio_i_subset){0};
}

double gonio_i_leave_one_out_density(double difference, double variance)
{
    const double square = difference * difference / variance;
    return -0.5 * log(variance) - 0.5 * (FREEDOM + 1.0) * log1p(square / FREEDOM);
}

gonio_status gonio_i_leave_one_out_differences(gonio_i_fit *e, const gonio_i_model *model,
                                               double **difference)
{
    *difference = gonio_i_allocate(e->context, 2 * e->n, sizeof **difference);
    const gonio_status status =
        *difference == NULL ? GONIO_ERROR_MEMORY : gonio_i_fit_solve(e, model);
    return status == GONIO_OK ? gonio_i_fit_leave_one_out(e, *difference, *difference + e->n)
                              : status;
}

gonio_status gonio_i_leave_one_out_score(gonio_i_fit *e, const gonio_i_model *model, double *score)
{
    double *difference = NULL;
    if (!gonio_i_sites_tell_of(e->sites, model)) {
        for (size_t i = 0; i < e->n; i++) {
            score[i] = -INFINITY;
        }
        return GONIO_OK;
    }
    const gonio_status status = gonio_i_leave_one_out_differences(e, model, &difference);
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        score[i] = e->left_out[i]
                       ? 0.0
                       : gonio_i_leave_one_out_density(difference[i], difference[e->n + i]);
    }
    free(difference);
    return status;
}
