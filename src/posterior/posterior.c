/* The posterior of all columns: see posterior.h. */
#include "posterior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "parallel_for.h"
#include "fields.h"
#include "learned_error.h"
#include "merge.h"
#include "models.h"
#include "variance.h"
#include "wrong_directions.h"

enum {
    MOST_READINGS = 3000,  /* of a column that are not merged */
    MOST_COVARIANCES = 64, /* columns whose covariances are held at the same time */
};

/* What is found of a column. */
typedef struct found_column {
    gonio_i_column merged; /* its observations, if there were too many; or empty */
    gonio_i_field_column field;
    size_t outlying;
    double surprise;
    double residual; /* sum of squares */
    gonio_i_variance_sums sums;
    double expected; /* mean square of the error to expect */
} found_column;

typedef struct finding {
    gonio_context *context;
    const gonio_i_prior *prior;
    const gonio_i_posterior_options *options;
    gonio_i_models models;
    gonio_i_learned_error *learned; /* NULL: the Gaussian's own */
    gonio_i_posterior *p;
    size_t count;
    gonio_i_column *column; /* [count]: observations, merged if there are many; owned elsewhere */
    found_column *found;    /* [count] */
    gonio_i_steps steps;
} finding;

/* Columns over the same sites, and what they have in common. */
typedef struct group {
    finding *all;
    gonio_i_sites *sites;
    gonio_i_folds *folds; /* NULL: not here */
    gonio_i_rows *rows;
    size_t count;
    size_t *member;     /* [count]: their numbers */
    size_t first;       /* of the members that are at work */
    double *covariance; /* [MOST_COVARIANCES][K][K], or NULL */
} group;

/* ---- one column ---- */

/* The sum of squared residuals of the field at the readings: D S^-1 (y - F z). */
static double square_left(const gonio_i_fit *e)
{
    double sum = 0.0;
    for (size_t i = 0; i < e->n; i++) {
        const double left = e->left_out[i] ? 0.0 : e->variance[i] * e->solved[i];
        sum += left * left;
    }
    return sum;
}

/* Adds a model's solution, times its weight. c: scratch of K; sum[K]. */
static void add_model(const gonio_i_fit *e, double weight, double *c, double *sum,
                      const gonio_i_field_column *field)
{
    const gonio_i_model *m = &e->model;
    gonio_i_fit_coefficients(e, c);
    for (size_t k = 0; k < e->components; k++) {
        sum[k] += weight * c[k];
    }
    for (size_t i = 0; i < e->n; i++) {
        const double smooth = weight * m->alpha * m->alpha * e->solved[i];
        field->smooth[i] += smooth;
        field->peaked[i] += smooth * m->peak * m->peak;
    }
}

/* The mean over the models, with the readings judged as they are. */
static gonio_status mix_models(gonio_i_fit *e, const gonio_i_models *models, double *sum,
                               gonio_i_field_column *field)
{
    double *c = gonio_i_allocate(e->context, e->components, sizeof *c);
    field->smooth = gonio_i_allocate(e->context, e->n, sizeof *field->smooth);
    field->peaked = gonio_i_allocate(e->context, e->n, sizeof *field->peaked);
    gonio_status status =
        c == NULL || field->smooth == NULL || field->peaked == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    memset(sum, 0, e->components * sizeof *sum);
    for (size_t k = 0; k < models->count && status == GONIO_OK; k++) {
        status = gonio_i_fit_solve(e, &models->model[k]);
        if (status == GONIO_OK) {
            add_model(e, models->weight[k], c, sum, field);
        }
    }
    free(c);
    return status;
}

/* The best model, with outliers set aside if the models were weighed without them. */
static gonio_status settle(const finding *all, gonio_i_fit *e, size_t *outlying)
{
    const gonio_status status = gonio_i_fit_solve(e, &all->models.best);
    return status == GONIO_OK ? gonio_i_fit_settle(e, all->models.judge_outliers, outlying)
                              : status;
}

/* The variance, of the best model, which e is solved for. c: scratch of K. */
static gonio_status find_variance(const group *g, const gonio_i_fit *e, size_t k, double *c)
{
    const finding *all = g->all;
    const size_t number = g->member[k];
    const size_t rows = all->prior->view->rows;
    const size_t square = e->components * e->components;
    double *deviation = all->p->deviation != NULL ? all->p->deviation + number * rows : NULL;
    double *covariance = g->covariance != NULL ? g->covariance + (k - g->first) * square : NULL;
    gonio_i_fit_coefficients(e, c);
    return gonio_i_variance_find(e, g->rows, c, deviation, covariance, &all->found[number].sums);
}

static gonio_status solve_fit(const group *g, gonio_i_fit *e, size_t k)
{
    const finding *all = g->all;
    const size_t number = g->member[k];
    found_column *found = &all->found[number];
    double *c = all->p->coefficients + number * e->components;
    gonio_status status = settle(all, e, &found->outlying);
    if (status == GONIO_OK) {
        status = gonio_i_fit_surprise(e, &found->surprise);
    }
    if (status == GONIO_OK) {
        found->residual = square_left(e);
        status = find_variance(g, e, k, c);
    }
    if (status == GONIO_OK && g->folds != NULL) {
        status = gonio_i_learned_error_find(g->folds, e, &found->expected);
    }
    return status == GONIO_OK ? mix_models(e, &all->models, c, &found->field) : status;
}

static gonio_status solve_column(void *data, gonio_context *context, size_t k)
{
    const group *g = data;
    const size_t member = g->first + k;
    gonio_i_fit e = {0};
    gonio_status status =
        gonio_i_fit_begin(context, g->sites, false, &g->all->column[g->member[member]], &e);
    if (status == GONIO_OK) {
        status = solve_fit(g, &e, member);
    }
    gonio_i_fit_end(&e);
    return status;
}

/* ---- columns over the same sites ---- */

static void add_covariances(const group *g, size_t columns)
{
    const size_t square = g->sites->components * g->sites->components;
    for (size_t k = 0; k < columns && g->covariance != NULL; k++) {
        for (size_t i = 0; i < square; i++) {
            g->all->p->covariance[i] += g->covariance[k * square + i];
        }
    }
}

static gonio_status solve_columns(group *g)
{
    finding *all = g->all;
    const size_t most = g->covariance != NULL ? MOST_COVARIANCES : g->count;
    gonio_status status = GONIO_OK;
    for (g->first = 0; g->first < g->count && status == GONIO_OK; g->first += most) {
        const size_t left = g->count - g->first;
        const size_t columns = left < most ? left : most;
        status = gonio_i_parallel_for(all->context, &all->steps, columns, solve_column, g);
        if (status == GONIO_OK) {
            add_covariances(g, columns);
        }
    }
    return status;
}

static gonio_status fill_fields(const group *g)
{
    const finding *all = g->all;
    const size_t components = g->sites->components;
    gonio_i_field_column *columns = gonio_i_allocate(all->context, g->count, sizeof *columns);
    if (columns == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < g->count; k++) {
        const size_t number = g->member[k];
        columns[k] = all->found[number].field;
        columns[k].c = all->p->coefficients + number * components;
        columns[k].field = all->p->field + number * all->prior->view->rows;
    }
    const gonio_status status = gonio_i_fields_fill(all->context, g->sites, columns, g->count);
    free(columns);
    return status;
}

/* What the columns have in common. */
static gonio_status begin_group(group *g)
{
    const finding *all = g->all;
    gonio_context *context = all->context;
    const size_t square = all->prior->components * all->prior->components;
    gonio_status status =
        gonio_i_sites_create(context, all->prior, &all->column[g->member[0]], &g->sites);
    if (status == GONIO_OK) {
        status = gonio_i_rows_create(context, g->sites, &all->models.best,
                                     all->p->deviation != NULL, &g->rows);
    }
    if (status == GONIO_OK && all->learned != NULL && g->sites->n <= GONIO_I_LEARNED_ERROR_MOST) {
        status = gonio_i_folds_create(context, all->learned, g->sites, &g->folds);
    }
    if (status == GONIO_OK && all->p->covariance != NULL) {
        const size_t held = g->count < MOST_COVARIANCES ? g->count : MOST_COVARIANCES;
        g->covariance = gonio_i_allocate(context, held * square, sizeof *g->covariance);
        status = g->covariance == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    }
    return status;
}

static void end_group(group *g)
{
    free(g->covariance);
    gonio_i_folds_free(&g->folds);
    gonio_i_rows_free(&g->rows);
    gonio_i_sites_free(&g->sites);
}

static gonio_status solve_group(group *g)
{
    gonio_status status = begin_group(g);
    if (status == GONIO_OK) {
        status = solve_columns(g);
    }
    if (status == GONIO_OK) {
        status = fill_fields(g);
    }
    for (size_t k = 0; k < g->count; k++) {
        gonio_i_field_column *field = &g->all->found[g->member[k]].field;
        free(field->smooth);
        free(field->peaked);
        *field = (gonio_i_field_column){0};
    }
    end_group(g);
    return status;
}

/* Calls solve for the columns of each group in turn. */
static gonio_status solve_groups(finding *all, gonio_status (*solve)(group *g))
{
    size_t *number = gonio_i_allocate(all->context, all->count, sizeof *number);
    size_t *member = gonio_i_allocate(all->context, all->count, sizeof *member);
    gonio_status status = number == NULL || member == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    const size_t groups =
        status == GONIO_OK ? gonio_i_sites_group(all->prior, all->column, all->count, number) : 0;
    for (size_t k = 0; k < groups && status == GONIO_OK; k++) {
        group g = {.all = all, .member = member};
        for (size_t c = 0; c < all->count; c++) {
            if (number[c] == k) {
                member[g.count++] = c;
            }
        }
        status = solve(&g);
    }
    free(number);
    free(member);
    return status;
}

/* ---- the error to expect of many readings ---- */

static gonio_status expect_column(void *data, gonio_context *context, size_t k)
{
    const group *g = data;
    const size_t number = g->member[k];
    size_t outlying = 0;
    gonio_i_fit e = {0};
    gonio_status status = gonio_i_fit_begin(context, g->sites, false, &g->all->column[number], &e);
    if (status == GONIO_OK) {
        status = settle(g->all, &e, &outlying);
    }
    if (status == GONIO_OK) {
        status = gonio_i_learned_error_find(g->folds, &e, &g->all->found[number].expected);
    }
    gonio_i_fit_end(&e);
    return status;
}

static gonio_status expect_group(group *g)
{
    finding *all = g->all;
    gonio_i_steps steps = {.task = NULL};
    const gonio_i_column *column = &all->column[g->member[0]];
    if (column->count == 0) {
        return GONIO_OK; /* not one of many readings */
    }
    gonio_status status = gonio_i_sites_create(all->context, all->prior, column, &g->sites);
    if (status == GONIO_OK) {
        status = gonio_i_folds_create(all->context, all->learned, g->sites, &g->folds);
    }
    if (status == GONIO_OK) {
        status = gonio_i_parallel_for(all->context, &steps, g->count, expect_column, g);
    }
    end_group(g);
    return status;
}

/* Of columns of so many readings that learning takes long: from fewer, which neighbours are merged
 * to. */
static gonio_status expect_of_fewer(finding *all, const gonio_i_column *columns)
{
    finding fewer = *all;
    bool any = false;
    fewer.column = gonio_i_allocate(all->context, all->count, sizeof *fewer.column);
    gonio_status status = fewer.column == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t k = 0; k < all->count && status == GONIO_OK; k++) {
        if (all->column[k].count > GONIO_I_LEARNED_ERROR_MOST) {
            any = true;
            status = gonio_i_merge(all->context, &columns[k], GONIO_I_LEARNED_ERROR_MOST,
                                   &fewer.column[k]);
        }
    }
    if (status == GONIO_OK && any) {
        status = solve_groups(&fewer, expect_group);
    }
    for (size_t k = 0; fewer.column != NULL && k < all->count; k++) {
        free(fewer.column[k].observation);
    }
    free(fewer.column);
    return status;
}

/* ---- all columns ---- */

/* Sums over the columns, in their order. */
typedef struct totals {
    gonio_i_variance_sums sums;
    double expected; /* the square of the error to expect, over the bins */
    size_t readings; /* after merging */
} totals;

static totals add_up(const finding *all)
{
    totals t = {0};
    gonio_i_posterior *p = all->p;
    for (size_t k = 0; k < all->count; k++) {
        const found_column *found = &all->found[k];
        p->outlying += found->outlying;
        p->residual += found->residual;
        p->surprise += found->surprise;
        t.readings += all->column[k].count;
        t.sums.bins += found->sums.bins;
        t.sums.error += found->sums.error;
        t.sums.square += found->sums.square;
        t.expected += all->learned != NULL ? found->expected * found->sums.bins : found->sums.error;
    }
    return t;
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
static void conclude(const finding *all)
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
}

/* The observations of all columns, of many the merged ones. */
static gonio_status choose_observations(finding *all, const gonio_i_column *columns)
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

static gonio_status find_columns(finding *all, const gonio_i_column *columns)
{
    gonio_status status = choose_observations(all, columns);
    if (status == GONIO_OK) {
        status = gonio_i_learned_error_create(all->context, all->prior, &all->learned);
    }
    if (status == GONIO_OK) {
        status = solve_groups(all, solve_group);
    }
    if (status == GONIO_OK && all->learned != NULL) {
        status = expect_of_fewer(all, columns);
    }
    if (status == GONIO_OK) {
        conclude(all);
    }
    return status;
}

static gonio_status find(finding *all, const gonio_i_column *columns)
{
    all->column = gonio_i_allocate(all->context, all->count, sizeof *all->column);
    all->found = gonio_i_allocate(all->context, all->count, sizeof *all->found);
    const gonio_status status =
        all->column == NULL || all->found == NULL ? GONIO_ERROR_MEMORY : find_columns(all, columns);
    for (size_t k = 0; all->found != NULL && k < all->count; k++) {
        free(all->found[k].merged.observation);
    }
    free(all->found);
    free(all->column);
    gonio_i_learned_error_free(&all->learned);
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

/* Sets wrong directions aside in the columns and weighs models without them, over the same sites.
 */
static gonio_status weigh_models(finding *all, gonio_i_column *columns, size_t *wrong)
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
    gonio_i_subset_end(&subset);
    return status;
}

static gonio_status find_in_copies(finding *all, gonio_i_column *copies)
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
    finding all = {.context = context,
                   .prior = prior,
                   .options = options,
                   .models = gonio_i_models_of(
                       (gonio_i_model){GONIO_I_KERNEL_WIDTH, options->smoothness, 0.0}),
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
