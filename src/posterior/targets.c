/* Where an error is to be expected: see targets.h. */
#include "targets.h"

#include <math.h>
#include <stdlib.h>

#include "../database/layout.h"

static void count_bins(const gonio_basis_view *view, gonio_i_targets *t)
{
    for (size_t row = 0; row < view->rows; row++) {
        t->all[row] = gonio_i_row_bins(view, row);
    }
}

static void count_direction(const gonio_i_prior *prior, gonio_half_difference at,
                            gonio_i_targets *t)
{
    const int channels = (int)gonio_i_rows_per_cell(prior->view->channels);
    for (int channel = 0; channel < channels; channel++) {
        gonio_i_row_weight around[GONIO_I_MOST_POINTS];
        const int points = gonio_i_rows_around(prior->basis, at, channel, around);
        for (int k = 0; k < points; k++) {
            t->all[around[k].row] += around[k].weight;
        }
    }
}

static double sum_of(const double *value, size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; k++) {
        sum += value[k];
    }
    return sum;
}

/* Every so many of the rows that count. */
static gonio_status draw_sample(gonio_context *context, size_t rows, gonio_i_targets *t)
{
    size_t counting = 0;
    for (size_t row = 0; row < rows; row++) {
        counting += t->all[row] > 0.0;
    }
    const size_t step = gonio_i_sample_step(counting);
    const size_t most = (counting + step - 1) / step;
    t->row = gonio_i_allocate(context, most, sizeof *t->row);
    t->weight = gonio_i_allocate(context, most, sizeof *t->weight);
    if (t->row == NULL || t->weight == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    size_t met = 0;
    for (size_t row = 0; row < rows; row++) {
        if (t->all[row] > 0.0 && met++ % step == 0) {
            t->row[t->count] = row;
            t->weight[t->count++] = t->all[row];
        }
    }
    const double more = sum_of(t->all, rows) / fmax(sum_of(t->weight, t->count), 1e-300);
    for (size_t k = 0; k < t->count; k++) {
        t->weight[k] *= more;
    }
    return GONIO_OK;
}

gonio_status gonio_i_targets_create(gonio_context *context, const gonio_i_prior *prior,
                                    const gonio_half_difference *at, size_t count,
                                    gonio_i_targets *targets)
{
    const gonio_basis_view *view = prior->view;
    *targets = (gonio_i_targets){0};
    targets->all = gonio_i_allocate(context, view->rows, sizeof *targets->all);
    if (targets->all == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    if (count == 0) {
        count_bins(view, targets);
    }
    for (size_t k = 0; k < count; k++) {
        count_direction(prior, at[k], targets);
    }
    return draw_sample(context, view->rows, targets);
}

void gonio_i_targets_free(gonio_i_targets *targets)
{
    free(targets->all);
    free(targets->row);
    free(targets->weight);
    *targets = (gonio_i_targets){0};
}
