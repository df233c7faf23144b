/* Readings that models and doubts are tried on: see leave_one_out.h. */
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

static gonio_status copy_thinned(gonio_context *context, const gonio_i_column *column,
                                 gonio_i_column *copy)
{
    copy->observation =
        gonio_i_allocate(context, GONIO_I_SUBSET_READINGS, sizeof *copy->observation);
    if (copy->observation == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    copy->count = gonio_i_thin(column, GONIO_I_SUBSET_READINGS, copy->observation);
    return GONIO_OK;
}

gonio_status gonio_i_subset_begin(gonio_context *context, const gonio_i_column *columns,
                                  size_t count, gonio_i_subset *probe)
{
    gonio_status status = GONIO_OK;
    *probe = (gonio_i_subset){0};
    probe->count = count < GONIO_I_SUBSET_COLUMNS ? count : GONIO_I_SUBSET_COLUMNS;
    for (size_t k = 0; k < probe->count && status == GONIO_OK; k++) {
        const gonio_i_column *column = &columns[k * count / probe->count];
        probe->readings[k] = column->count;
        status = copy_thinned(context, column, &probe->column[k]);
    }
    return status;
}

void gonio_i_subset_end(gonio_i_subset *probe)
{
    for (size_t k = 0; k < probe->count; k++) {
        free(probe->column[k].observation);
    }
    *probe = (gonio_i_subset){0};
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
    const gonio_status status = gonio_i_leave_one_out_differences(e, model, &difference);
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        *score += e->left_out[i]
                      ? 0.0
                      : gonio_i_leave_one_out_density(difference[i], difference[e->n + i]);
    }
    free(difference);
    return status;
}
