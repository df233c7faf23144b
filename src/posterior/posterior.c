/* The posterior of all columns: see posterior.h. */
#include "posterior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "expected_of_fewer.h"
#include "merge.h"
#include "solve_columns.h"
#include "wrong_directions.h"

/* Readings of a column that are not merged. */
enum { MOST_READINGS = 3000 };

/* From so many of every column on, fits are plain. */
enum { MANY_READINGS = 1000 };

/* ---- all columns ---- */

/* Sums over the columns, in their order. */
typedef struct totals {
    gonio_i_variance_sums sums;
    double expected; /* the square of the error to expect, over the bins */
    size_t readings; /* after merging */
} totals;

static totals add_up(const gonio_i_finding *all)
{
    totals t = {0};
    gonio_i_posterior *p = all->p;
    double outlying = 0.0;
    for (size_t k = 0; k < all->count; k++) {
        const gonio_i_found_column *found = &all->found[k];
        outlying += found->outlying;
        p->residual += found->residual;
        p->surprise += found->surprise;
        t.readings += all->column[k].count;
        t.sums.bins += found->sums.bins;
        t.sums.error += found->sums.error;
        t.sums.square += found->sums.square;
        t.expected += all->learned != NULL ? found->expected * found->sums.bins : found->sums.error;
    }
    p->outlying += (size_t)lround(outlying);
    return t;
}

/* alpha and peak, means over the models. */
static void find_remainder(const gonio_i_models *models, gonio_i_posterior *p)
{
    double smooth = 0.0;
    double peaked = 0.0;
    for (size_t k = 0; k < models->count; k++) {
        const gonio_i_model *m = &models->model[k];
        smooth += models->weight[k] * m->alpha * m->alpha;
        peaked += models->weight[k] * m->alpha * m->alpha * m->peak * m->peak;
    }
    p->remainder = sqrt(smooth);
    p->peak = smooth > 0.0 ? sqrt(peaked / smooth) : 0.0;
}

/* 100 times the root of the error's square over that of g. The square of g is that of the estimate
 * plus that of the error. */
static double relative(const totals *t, double error)
{
    return 100.0 * sqrt(error / (t->sums.square + error));
}

/* From sums over the columns to the results. The expected error is the geometric mean of that of
 * the most likely model's Gaussian and that learned from the database. It is closer to the true
 * error than either, in and out of the database (docs/experiments.md). */
static void conclude(const gonio_i_finding *all)
{
    const totals t = add_up(all);
    const size_t components = all->prior->components;
    const double count = (double)all->count;
    gonio_i_posterior *p = all->p;
    for (size_t k = 0; k < all->count * components; k++) {
        p->coefficients[k] *= all->prior->deviation[k % components];
    }
    for (size_t k = 0; p->covariance != NULL && k < components * components; k++) {
        p->covariance[k] /= count;
    }
    const double readings = fmax((double)t.readings, 1.0);
    p->norm = sqrt((t.sums.square + t.sums.error) / count);
    p->predicted_by_variance = relative(&t, t.sums.error);
    p->predicted = sqrt(p->predicted_by_variance * relative(&t, t.expected));
    p->residual = sqrt(p->residual / readings);
    p->surprise = sqrt(p->surprise / readings);
    p->smoothness = all->models.best.alpha;
    find_remainder(&all->models, p);
}

/* The observations of all columns, of many the merged ones. */
static gonio_status choose_observations(gonio_i_finding *all, const gonio_i_column *columns)
{
    const size_t most = all->options->most > 0 ? all->options->most : MOST_READINGS;
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < all->count && status == GONIO_OK; k++) {
        all->column[k] = columns[k];
        if (columns[k].count > most) {
            status = gonio_i_merge(all->context, &columns[k], most, &all->found[k].merged);
            all->column[k] = all->found[k].merged;
        }
    }
    return status;
}

static gonio_status find_columns(gonio_i_finding *all, const gonio_i_column *columns)
{
    gonio_status status = choose_observations(all, columns);
    if (status == GONIO_OK) {
        status = gonio_i_targets_create(all->context, all->prior, all->options->expected_at,
                                        all->options->expected_count, &all->targets);
    }
    if (status == GONIO_OK) {
        status =
            gonio_i_learned_error_create(all->context, all->prior, &all->targets, &all->learned);
    }
    if (status == GONIO_OK) {
        status = gonio_i_solve_columns(all);
    }
    if (status == GONIO_OK && all->learned != NULL) {
        status = gonio_i_expect_of_fewer(all, columns);
    }
    if (status == GONIO_OK) {
        conclude(all);
    }
    return status;
}

static gonio_status find(gonio_i_finding *all, const gonio_i_column *columns)
{
    all->column = gonio_i_allocate(all->context, all->count, sizeof *all->column);
    all->found = gonio_i_allocate(all->context, all->count, sizeof *all->found);
    all->neighbours = gonio_i_allocate(all->context, all->count, sizeof *all->neighbours);
    const bool done = all->column != NULL && all->found != NULL && all->neighbours != NULL;
    if (done) {
        gonio_i_neighbours_none(all->neighbours, all->count);
    }
    const gonio_status status = done ? find_columns(all, columns) : GONIO_ERROR_MEMORY;
    for (size_t k = 0; all->found != NULL && k < all->count; k++) {
        free(all->found[k].merged.observation);
    }
    free(all->found);
    free(all->neighbours);
    free(all->column);
    gonio_i_learned_error_free(&all->learned);
    gonio_i_targets_free(&all->targets);
    return status;
}

/* ---- wrong directions and models ---- */

/* Copies, as what is read wrongly gets another variance; readings of one place are merged. */
static gonio_status copy_columns(gonio_context *context, const gonio_i_column *columns,
                                 size_t count, gonio_i_column *copies)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = gonio_i_merge_repeats(context, &columns[k], &copies[k]);
    }
    return status;
}

/* Whether the readings are so many that the columns of the database need not be centres: of a
 * thousand, h^2 is 0.995, and what the centres add to a Gaussian is below the noise
 * (docs/performance.md). */
static bool are_many(const gonio_i_finding *all, const gonio_i_column *columns)
{
    bool many = true;
    for (size_t k = 0; k < all->count && many; k++) {
        many = columns[k].count >= MANY_READINGS;
    }
    return many;
}

/* Sets wrong directions aside in the columns and weighs models without them, over the same sites.
 */
static gonio_status weigh_models(gonio_i_finding *all, gonio_i_column *columns, size_t *wrong)
{
    gonio_i_subset subset;
    gonio_status status =
        gonio_i_subset_begin(all->context, all->prior, columns, all->count, &subset);
    if (status == GONIO_OK) {
        status = gonio_i_wrong_directions_find(all->context, &subset, columns, all->count, wrong);
    }
    if (status == GONIO_OK) {
        gonio_i_subset_read(&subset, columns);
        status = gonio_i_models_weigh(all->context, all->prior, &subset, &all->models);
    }
    if (status == GONIO_OK && are_many(all, columns)) {
        all->plain = true;
        gonio_i_models_make_plain(&all->models);
    }
    gonio_i_subset_end(&subset);
    return status;
}

static gonio_status find_in_copies(gonio_i_finding *all, gonio_i_column *copies)
{
    size_t wrong = 0;
    const bool weigh = all->options->smoothness < 0.0;
    const gonio_status status = weigh ? weigh_models(all, copies, &wrong) : GONIO_OK;
    all->p->outlying += wrong;
    return status == GONIO_OK ? find(all, copies) : status;
}

gonio_status gonio_i_posterior_find(gonio_context *context, const gonio_i_prior *prior,
                                    const gonio_i_column *columns, size_t count,
                                    const gonio_i_posterior_options *options, gonio_i_posterior *p)
{
    gonio_i_finding all = {.context = context,
                           .prior = prior,
                           .options = options,
                           .models = gonio_i_models_of((gonio_i_model){
                               GONIO_I_KERNEL_WIDTH, options->smoothness, 0.0, 0.0}),
                           .p = p,
                           .count = count,
                           .steps = {.task = "reconstructing", .all = count}};
    p->outlying = 0;
    p->residual = 0.0;
    p->surprise = 0.0;
    gonio_i_column *copies = gonio_i_allocate(context, count, sizeof *copies);
    gonio_status status =
        copies == NULL ? GONIO_ERROR_MEMORY : copy_columns(context, columns, count, copies);
    if (status == GONIO_OK) {
        status = find_in_copies(&all, copies);
    }
    for (size_t k = 0; copies != NULL && k < count; k++) {
        free(copies[k].observation);
    }
    free(copies);
    return status;
}
