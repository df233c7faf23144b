/* Readings that models and doubts are tried on: see probe.h. */
#include "probe.h"

#include <math.h>
#include <stdlib.h>

/* Degrees of freedom of Student's t. */
static const double FREEDOM = 4.0;

size_t gonio_i_probe_thin(const gonio_i_column *column, size_t most, gonio_i_observation *thinned)
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
        gonio_i_allocate(context, GONIO_I_PROBE_READINGS, sizeof *copy->observation);
    if (copy->observation == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    copy->count = gonio_i_probe_thin(column, GONIO_I_PROBE_READINGS, copy->observation);
    return GONIO_OK;
}

gonio_status gonio_i_probe_begin(gonio_context *context, const gonio_i_column *columns,
                                 size_t count, gonio_i_probe *probe)
{
    gonio_status status = GONIO_OK;
    *probe = (gonio_i_probe){0};
    probe->count = count < GONIO_I_PROBE_COLUMNS ? count : GONIO_I_PROBE_COLUMNS;
    for (size_t k = 0; k < probe->count && status == GONIO_OK; k++) {
        const gonio_i_column *column = &columns[k * count / probe->count];
        probe->readings[k] = column->count;
        status = copy_thinned(context, column, &probe->column[k]);
    }
    return status;
}

void gonio_i_probe_end(gonio_i_probe *probe)
{
    for (size_t k = 0; k < probe->count; k++) {
        free(probe->column[k].observation);
    }
    *probe = (gonio_i_probe){0};
}

double gonio_i_probe_density(double difference, double variance)
{
    const double square = difference * difference / variance;
    return -0.5 * log(variance) - 0.5 * (FREEDOM + 1.0) * log1p(square / FREEDOM);
}

gonio_status gonio_i_probe_differences(gonio_i_gaussian *e, const gonio_i_model *model,
                                       double **difference)
{
    *difference = gonio_i_allocate(e->context, 2 * e->n, sizeof **difference);
    const gonio_status status =
        *difference == NULL ? GONIO_ERROR_MEMORY : gonio_i_gaussian_solve(e, model);
    return status == GONIO_OK ? gonio_i_gaussian_leave_one_out(e, *difference, *difference + e->n)
                              : status;
}

gonio_status gonio_i_probe_score(gonio_i_gaussian *e, const gonio_i_model *model, double *score)
{
    double *difference = NULL;
    const gonio_status status = gonio_i_probe_differences(e, model, &difference);
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        *score += e->left_out[i] ? 0.0 : gonio_i_probe_density(difference[i], difference[e->n + i]);
    }
    free(difference);
    return status;
}
