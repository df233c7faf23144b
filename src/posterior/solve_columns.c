/* Columns solved in groups over the same sites: see solve_columns.h. */
#include "solve_columns.h"

#include <stdlib.h>
#include <string.h>

#include "fit_inverse.h"

/* Columns whose covariances are held at the same time. */
enum { MOST_COVARIANCES = 64 };

/* Columns over the same sites, and what they have in common. */
typedef struct group {
    gonio_i_finding *all;
    gonio_i_sites *sites;
    gonio_i_folds *folds; /* NULL: not here */
    gonio_i_rows *rows;
    size_t count;
    size_t *member;     /* [count]: their numbers */
    size_t first;       /* of the members that are at work */
    double *covariance; /* [MOST_COVARIANCES][K][K], or NULL */
} group;

/* ---- one column ---- */

gonio_status gonio_i_column_begin(const gonio_i_finding *all, gonio_context *context,
                                  const gonio_i_sites *sites, size_t column, gonio_i_fit *e)
{
    const gonio_status status =
        gonio_i_fit_begin(context, sites, all->plain, &all->column[column], e);
    return status == GONIO_OK && all->plain ? gonio_i_fit_inverse_keep(e) : status;
}

gonio_status gonio_i_column_settle(const gonio_i_finding *all, gonio_i_fit *e, double *outlying)
{
    size_t count = 0;
    gonio_status status = gonio_i_fit_solve(e, &all->models.best);
    if (status == GONIO_OK) {
        status = gonio_i_fit_settle(e, all->models.judge_outliers, &count);
    }
    *outlying = (double)count;
    return status;
}

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

/* Adds an estimate by a model, times its weight, to terms (fields.h). c: [K]; solved: [n]. */
static void add_terms(const gonio_i_fit *e, double weight, const double *c, const double *solved,
                      double *terms)
{
    const gonio_i_model *m = &e->model;
    double *smooth = terms + e->components;
    double *peaked = smooth + e->n;
    for (size_t k = 0; k < e->components; k++) {
        terms[k] += weight * c[k];
    }
    for (size_t i = 0; i < e->n; i++) {
        const double part = weight * m->alpha * m->alpha * solved[i];
        smooth[i] += part;
        peaked[i] += part * m->peak * m->peak;
        if (e->sites->back != NULL) {
            peaked[e->n + i] += part * m->retro * m->retro;
        }
    }
}

/* Columns that are found with a fit of another one. */
typedef struct followers {
    size_t count;
    size_t *column; /* [count] */
    double *y;      /* [count][n] */
    double *c;      /* [count][K] */
} followers;

static gonio_status list_followers(const group *g, const gonio_i_fit *e, size_t fit, followers *f)
{
    const gonio_i_neighbours *neighbours = g->all->neighbours;
    f->column = gonio_i_allocate(e->context, g->count, sizeof *f->column);
    for (size_t k = 0; f->column != NULL && k < g->count; k++) {
        f->column[f->count] = g->member[k];
        f->count +=
            g->member[k] != fit && gonio_i_neighbour_weight(neighbours, fit, g->member[k]) > 0.0;
    }
    f->y = gonio_i_allocate(e->context, f->count * e->n, sizeof *f->y);
    f->c = gonio_i_allocate(e->context, f->count * e->components, sizeof *f->c);
    return f->column != NULL && f->y != NULL && f->c != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static void free_followers(followers *f)
{
    free(f->column);
    free(f->y);
    free(f->c);
}

/* Adds what a solved fit says of its followers. */
static gonio_status add_followers(const group *g, const gonio_i_fit *e, size_t fit, double weight,
                                  const followers *f)
{
    const gonio_i_finding *all = g->all;
    for (size_t k = 0; k < f->count; k++) {
        for (size_t i = 0; i < e->n; i++) {
            f->y[k * e->n + i] = all->column[f->column[k]].observation[i].g - g->sites->mean[i];
        }
    }
    const gonio_status status =
        f->count > 0 ? gonio_i_neighbours_estimate(e, f->count, f->y, f->c) : GONIO_OK;
    for (size_t k = 0; k < f->count && status == GONIO_OK; k++) {
        const size_t column = f->column[k];
        const int side = all->neighbours[column].fit[0] == fit ? 0 : 1;
        add_terms(e, weight * all->neighbours[column].weight[side], f->c + k * e->components,
                  f->y + k * e->n, all->found[column].part[side]);
    }
    return status;
}

/* Solves a settled fit for what its mean needs; of many readings, less work where no followers need
 * the factor of S. */
static gonio_status solve_for_mean(gonio_i_fit *e, const gonio_i_model *model, bool followed)
{
    if (e->inverse == NULL || followed) {
        return gonio_i_fit_solve(e, model);
    }
    const bool solved = e->is_inverted && gonio_i_model_is_same(&e->model, model);
    return solved ? GONIO_OK : gonio_i_fit_solve_kept(e, model);
}

/* The mean over the models, with the readings judged as they are. */
static gonio_status mix_models(const group *g, gonio_i_fit *e, size_t fit)
{
    const gonio_i_models *models = &g->all->models;
    followers others = {0};
    double *c = gonio_i_allocate(e->context, e->components, sizeof *c);
    gonio_status status = c == NULL ? GONIO_ERROR_MEMORY : list_followers(g, e, fit, &others);
    for (size_t k = 0; k < models->count && status == GONIO_OK; k++) {
        status = solve_for_mean(e, &models->model[k], others.count > 0);
        if (status == GONIO_OK) {
            gonio_i_fit_coefficients(e, c);
            add_terms(e, models->weight[k], c, e->solved, g->all->found[fit].terms);
            status = add_followers(g, e, fit, models->weight[k], &others);
        }
    }
    free_followers(&others);
    free(c);
    return status;
}

/* Whether Q is wanted (variance.h). */
static bool needs_factor(const gonio_i_finding *all)
{
    return all->p->deviation != NULL || all->p->covariance != NULL;
}

/* The variance, of the best model, which e is solved for. c: scratch of K. */
static gonio_status find_variance(const group *g, const gonio_i_fit *e, size_t k, double *c)
{
    const gonio_i_finding *all = g->all;
    const size_t number = g->member[k];
    const size_t rows = all->prior->view->rows;
    const size_t square = e->components * e->components;
    double *deviation = all->p->deviation != NULL ? all->p->deviation + number * rows : NULL;
    double *covariance = g->covariance != NULL ? g->covariance + (k - g->first) * square : NULL;
    gonio_i_fit_coefficients(e, c);
    return gonio_i_variance_find(e, g->rows, c, deviation, covariance, &all->found[number].sums);
}

/* Marks the readings that the others contradict. Columns have readings in common. */
static void mark_contradicted(const gonio_i_finding *all, const gonio_i_fit *e,
                              const gonio_i_column *column)
{
    for (size_t i = 0; all->p->contradicted != NULL && i < e->n; i++) {
        const gonio_i_observation *o = &column->observation[i];
        if (o->wrong || e->variance[i] > o->variance) {
#pragma omp atomic write
            all->p->contradicted[o->reading] = true;
        }
    }
}

static gonio_status solve_fit(const group *g, gonio_i_fit *e, size_t k)
{
    const gonio_i_finding *all = g->all;
    const size_t number = g->member[k];
    gonio_i_found_column *found = &all->found[number];
    double *c = all->p->coefficients + number * e->components;
    gonio_status status = gonio_i_column_settle(all, e, &found->outlying);
    if (status == GONIO_OK) {
        mark_contradicted(all, e, &all->column[number]);
        status = gonio_i_fit_surprise(e, &found->surprise);
    }
    if (status == GONIO_OK && e->inverse != NULL) {
        status = needs_factor(all) ? gonio_i_fit_solve(e, &all->models.best)
                                   : gonio_i_fit_inverse_complete(e);
    }
    if (status == GONIO_OK) {
        found->residual = square_left(e);
        status = find_variance(g, e, k, c);
    }
    if (status == GONIO_OK && g->folds != NULL) {
        status = gonio_i_learned_error_find(g->folds, e, &found->expected);
    }
    return status == GONIO_OK ? mix_models(g, e, number) : status;
}

static gonio_status solve_column(void *data, gonio_context *context, size_t k)
{
    const group *g = data;
    const size_t member = g->first + k;
    if (!gonio_i_is_fitted(g->all->neighbours, g->member[member])) {
        return GONIO_OK;
    }
    gonio_i_fit e = {0};
    gonio_status status = gonio_i_column_begin(g->all, context, g->sites, g->member[member], &e);
    if (status == GONIO_OK) {
        status = solve_fit(g, &e, member);
    }
    gonio_i_fit_end(&e);
    return status;
}

/* ---- columns over the same sites ---- */

/* How many columns a fit stands for: itself and parts of its followers. */
static double columns_of(const group *g, size_t fit)
{
    double sum = 0.0;
    for (size_t k = 0; k < g->count; k++) {
        sum += gonio_i_neighbour_weight(g->all->neighbours, fit, g->member[k]);
    }
    return sum;
}

static void add_covariances(const group *g, size_t columns)
{
    const size_t square = g->sites->components * g->sites->components;
    for (size_t k = 0; k < columns && g->covariance != NULL; k++) {
        const size_t number = g->member[g->first + k];
        const double weight = columns_of(g, number);
        for (size_t i = 0; i < square && gonio_i_is_fitted(g->all->neighbours, number); i++) {
            g->all->p->covariance[i] += weight * g->covariance[k * square + i];
        }
    }
}

static gonio_status solve_columns(group *g)
{
    gonio_i_finding *all = g->all;
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

/* The mean of what is found of a column's neighbours. */
static void follow(const gonio_i_finding *all, size_t column)
{
    const gonio_i_neighbours *n = &all->neighbours[column];
    const gonio_i_found_column *low = &all->found[n->fit[0]];
    const gonio_i_found_column *high = &all->found[n->fit[1]];
    const double a = n->weight[0];
    const double b = n->weight[1];
    gonio_i_found_column *found = &all->found[column];
    found->outlying = a * low->outlying + b * high->outlying;
    found->surprise = a * low->surprise + b * high->surprise;
    found->residual = a * low->residual + b * high->residual;
    found->expected = a * low->expected + b * high->expected;
    found->sums.bins = a * low->sums.bins + b * high->sums.bins;
    found->sums.error = a * low->sums.error + b * high->sums.error;
    found->sums.square = a * low->sums.square + b * high->sums.square;
}

static void follow_deviation(const gonio_i_finding *all, size_t column)
{
    const gonio_i_neighbours *n = &all->neighbours[column];
    const size_t rows = all->prior->view->rows;
    const double *low = all->p->deviation + n->fit[0] * rows;
    const double *high = all->p->deviation + n->fit[1] * rows;
    for (size_t row = 0; row < rows; row++) {
        all->p->deviation[column * rows + row] = n->weight[0] * low[row] + n->weight[1] * high[row];
    }
}

/* Columns that are not fitted, once their neighbours are. */
static void follow_fits(const group *g)
{
    const gonio_i_finding *all = g->all;
    const size_t terms = gonio_i_terms(g->sites);
    for (size_t k = 0; k < g->count; k++) {
        const size_t column = g->member[k];
        if (!gonio_i_is_fitted(all->neighbours, column)) {
            gonio_i_found_column *found = &all->found[column];
            follow(all, column);
            for (size_t i = 0; i < terms; i++) {
                found->terms[i] = found->part[0][i] + found->part[1][i];
            }
            if (all->p->deviation != NULL) {
                follow_deviation(all, column);
            }
        }
    }
}

static gonio_status fill_fields(const group *g)
{
    const gonio_i_finding *all = g->all;
    const size_t components = g->sites->components;
    gonio_i_field_column *columns = gonio_i_allocate(all->context, g->count, sizeof *columns);
    if (columns == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < g->count; k++) {
        const size_t number = g->member[k];
        columns[k].terms = all->found[number].terms;
        columns[k].field = all->p->field + number * all->prior->view->rows;
        memcpy(all->p->coefficients + number * components, columns[k].terms,
               components * sizeof *columns[k].terms);
    }
    const gonio_status status = gonio_i_fields_fill(all->context, g->sites, columns, g->count);
    free(columns);
    return status;
}

/* Chooses which columns are fitted, and makes room for the terms of all. */
static gonio_status begin_columns(const group *g)
{
    const gonio_i_finding *all = g->all;
    const double *wavelength = all->options->wavelength;
    const size_t terms = gonio_i_terms(g->sites);
    gonio_status status = GONIO_OK;
    if (wavelength != NULL) {
        status = gonio_i_neighbours_choose(all->context, all->column, wavelength, g->member,
                                           g->count, all->neighbours);
    }
    for (size_t k = 0; k < g->count && status == GONIO_OK; k++) {
        gonio_i_found_column *found = &all->found[g->member[k]];
        const bool fitted = gonio_i_is_fitted(all->neighbours, g->member[k]);
        found->terms = gonio_i_allocate(all->context, terms, sizeof *found->terms);
        for (int side = 0; side < 2 && !fitted; side++) {
            found->part[side] = gonio_i_allocate(all->context, terms, sizeof *found->terms);
        }
        const bool done = found->terms && (fitted || (found->part[0] && found->part[1]));
        status = done ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    return status;
}

static void end_columns(const group *g)
{
    for (size_t k = 0; k < g->count; k++) {
        gonio_i_found_column *found = &g->all->found[g->member[k]];
        free(found->terms);
        free(found->part[0]);
        free(found->part[1]);
        found->terms = NULL;
        found->part[0] = NULL;
        found->part[1] = NULL;
    }
}

/* What the columns have in common. */
static gonio_status begin_group(group *g)
{
    const gonio_i_finding *all = g->all;
    gonio_context *context = all->context;
    const size_t square = all->prior->components * all->prior->components;
    gonio_status status =
        gonio_i_sites_create(context, all->prior, &all->column[g->member[0]], &g->sites);
    if (status == GONIO_OK) {
        status = gonio_i_rows_create(context, g->sites, &all->models.best, &all->targets,
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
        status = begin_columns(g);
    }
    if (status == GONIO_OK) {
        status = solve_columns(g);
    }
    if (status == GONIO_OK) {
        follow_fits(g);
        status = fill_fields(g);
    }
    end_columns(g);
    end_group(g);
    return status;
}

gonio_status gonio_i_solve_columns(gonio_i_finding *all)
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
        status = solve_group(&g);
    }
    free(number);
    free(member);
    return status;
}
