/* The database with a tenth of its materials left out at a time: see learned_error.h. */
#include "folds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/random.h"
#include "../linalg/linalg.h"

enum { FEW_MATERIALS = 10 };

static bool can_tell(const gonio_i_prior *prior)
{
    const gonio_basis_view *view = prior->view;
    return prior->samples > 0 && view->materials >= FEW_MATERIALS &&
           (view->mixtures == 0 || view->parents != NULL);
}

/* Mean of f' f over the bins, from a sample of rows. */
static gonio_status find_metric(gonio_context *context, const gonio_i_targets *targets,
                                gonio_i_learned_error *x)
{
    const size_t count = targets->count;
    double *rows = gonio_i_allocate(context, count * x->components, sizeof *rows);
    if (rows == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double all = 0.0;
    for (size_t i = 0; i < count; i++) {
        double *row = rows + i * x->components;
        gonio_i_prior_row(x->prior, targets->row[i], row);
        for (size_t k = 0; k < x->components; k++) {
            row[k] *= sqrt(targets->weight[i]);
        }
        all += targets->weight[i];
    }
    const gonio_status status =
        gonio_i_gram_rows(context, rows, count, x->components, x->components, x->metric);
    for (size_t k = 0; k < x->components * x->components && status == GONIO_OK; k++) {
        x->metric[k] /= all;
    }
    free(rows);
    return status;
}

gonio_status gonio_i_learned_error_create(gonio_context *context, const gonio_i_prior *prior,
                                          const gonio_i_targets *targets,
                                          gonio_i_learned_error **learned)
{
    *learned = NULL;
    if (!can_tell(prior)) {
        return GONIO_OK;
    }
    gonio_i_learned_error *x = gonio_i_allocate(context, 1, sizeof *x);
    if (x == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    x->prior = prior;
    x->components = prior->components;
    x->measured = gonio_i_measured_columns(prior->view);
    x->each = x->measured / prior->view->materials;
    x->metric = gonio_i_allocate(context, x->components * x->components, sizeof *x->metric);
    const gonio_status status =
        x->metric == NULL ? GONIO_ERROR_MEMORY : find_metric(context, targets, x);
    if (status != GONIO_OK) {
        gonio_i_learned_error_free(&x);
    }
    *learned = x;
    return status;
}

void gonio_i_learned_error_free(gonio_i_learned_error **learned)
{
    if (learned == NULL || *learned == NULL) {
        return;
    }
    free((*learned)->metric);
    free((*learned)->means);
    free((*learned)->covariances);
    free(*learned);
    *learned = NULL;
}

/* ---- leaving out ---- */

static bool is_of_fold(const gonio_i_learned_error *x, size_t measured, size_t k)
{
    return measured / x->each % GONIO_I_FOLDS == k;
}

/* Whether fold k leaves a column out: none is by the last one. */
static bool is_left_out(const gonio_i_learned_error *x, size_t column, size_t k)
{
    if (column < x->measured) {
        return is_of_fold(x, column, k);
    }
    if (column >= x->prior->samples - x->prior->view->analytic) {
        return false;
    }
    const int32_t *parent = x->prior->view->parents + 2 * (column - x->measured);
    return is_of_fold(x, (size_t)parent[0], k) || is_of_fold(x, (size_t)parent[1], k);
}

/* The share of each column in fold k: 0 for those left out. */
static void share_out(const gonio_i_learned_error *x, size_t k, double *share)
{
    double all = 0.0;
    for (size_t j = 0; j < x->prior->samples; j++) {
        share[j] = is_left_out(x, j, k) ? 0.0 : x->prior->share[j];
        all += share[j];
    }
    for (size_t j = 0; j < x->prior->samples; j++) {
        share[j] /= all;
    }
}

/* from[samples][n], less its mean, times the root of the share, row after row; mean[n]. */
static void centre(const double *from, const double *share, size_t samples, size_t n, double *mean,
                   double *to)
{
    for (size_t j = 0; j < samples; j++) {
        for (size_t i = 0; i < n; i++) {
            mean[i] += share[j] * from[j * n + i];
        }
    }
    for (size_t j = 0; j < samples; j++) {
        const double root = sqrt(share[j]);
        for (size_t i = 0; i < n; i++) {
            to[j * n + i] = root * (from[j * n + i] - mean[i]);
        }
    }
}

gonio_status gonio_i_learned_error_prepare(gonio_context *context, gonio_i_learned_error *x)
{
    const size_t k = x->components;
    const size_t samples = x->prior->samples;
    const size_t folds = GONIO_I_FOLDS + 1;
    double *share = gonio_i_allocate(context, samples, sizeof *share);
    double *z = gonio_i_allocate(context, samples * k, sizeof *z);
    x->means = gonio_i_allocate(context, folds * k, sizeof *x->means);
    x->covariances = gonio_i_allocate(context, folds * k * k, sizeof *x->covariances);
    const bool done = share != NULL && z != NULL && x->means != NULL && x->covariances != NULL;
    gonio_status status = done ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t f = 0; f < folds && status == GONIO_OK; f++) {
        share_out(x, f, share);
        centre(x->prior->sample, share, samples, k, x->means + f * k, z);
        status = gonio_i_gram_rows(context, z, samples, k, k, x->covariances + f * k * k);
    }
    free(share);
    free(z);
    return status;
}

/* A fold from the mean and covariance of z: what is seen of z is F z. */
static gonio_status see_fold(gonio_context *context, const gonio_i_folds *folds, size_t number,
                             gonio_i_fold *f)
{
    const gonio_i_learned_error *x = folds->of;
    const gonio_i_sites *sites = folds->sites;
    const size_t k = x->components;
    const size_t n = sites->n;
    memcpy(f->mean, x->means + number * k, k * sizeof *f->mean);
    for (size_t i = 0; i < n; i++) {
        f->mean_seen[i] = gonio_i_dot(sites->f + i * k, f->mean, k);
    }
    const gonio_status status =
        gonio_i_product(context, sites->f, n, k, x->covariances + number * k * k, k, f->cross);
    return status == GONIO_OK
               ? gonio_i_product_transposed(context, f->cross, n, k, sites->f, n, f->covariance, n)
               : status;
}

/* What folds are made with: every column, centred. */
typedef struct fold_scratch {
    double *share; /* [samples] */
    double *seen;  /* [samples][n] */
    double *z;     /* [samples][K] */
} fold_scratch;

static gonio_status fill_fold(gonio_context *context, gonio_i_folds *folds, size_t k,
                              const fold_scratch *s)
{
    gonio_i_fold *f = &folds->fold[k];
    const gonio_i_learned_error *x = folds->of;
    const gonio_i_sites *sites = folds->sites;
    const size_t n = sites->n;
    const size_t samples = x->prior->samples;
    f->mean_seen = gonio_i_allocate(context, n, sizeof *f->mean_seen);
    f->mean = gonio_i_allocate(context, x->components, sizeof *f->mean);
    f->covariance = gonio_i_allocate(context, n * n, sizeof *f->covariance);
    f->cross = gonio_i_allocate(context, n * x->components, sizeof *f->cross);
    if (f->mean_seen == NULL || f->mean == NULL || f->covariance == NULL || f->cross == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    if (x->means != NULL) {
        return see_fold(context, folds, k, f);
    }
    share_out(x, k, s->share);
    centre(sites->seen, s->share, samples, n, f->mean_seen, s->seen);
    centre(x->prior->sample, s->share, samples, x->components, f->mean, s->z);
    const gonio_status status = gonio_i_gram_rows(context, s->seen, samples, n, n, f->covariance);
    return status == GONIO_OK ? gonio_i_product_columns(context, s->seen, n, samples, s->z,
                                                        x->components, f->cross)
                              : status;
}

size_t gonio_i_folds_list(const gonio_i_learned_error *x, size_t k, size_t *column)
{
    size_t count = 0;
    for (size_t j = 0; j < x->measured; j++) {
        if (is_of_fold(x, j, k)) {
            column[count++] = j;
        }
    }
    return count;
}

size_t gonio_i_folds_most(const gonio_i_learned_error *x)
{
    return (x->prior->view->materials / GONIO_I_FOLDS + 1) * x->each;
}

/* What find_errors needs: away, moved: scratch of [columns][K]; cross: of [n][K]. */
static gonio_status fill_products(gonio_context *context, const gonio_i_learned_error *x, size_t n,
                                  const size_t *column, size_t count, double *away, double *moved,
                                  double *cross, gonio_i_fold *f)
{
    const size_t k = x->components;
    for (size_t j = 0; j < count * k; j++) {
        away[j] = x->prior->sample[column[j / k] * k + j % k] - f->mean[j % k];
    }
    gonio_status status = gonio_i_product(context, away, count, k, x->metric, k, moved);
    if (status == GONIO_OK) {
        status = gonio_i_product(context, f->cross, n, k, x->metric, k, cross);
    }
    if (status == GONIO_OK) {
        status = gonio_i_product_transposed(context, moved, count, k, f->cross, n, f->mixed, n);
    }
    if (status == GONIO_OK) {
        status = gonio_i_product_transposed(context, cross, n, k, f->cross, n, f->cross_square, n);
    }
    for (size_t j = 0; j < count; j++) {
        f->square[j] = gonio_i_dot(away + j * k, moved + j * k, k);
    }
    return status;
}

static gonio_status fill_left_out(gonio_context *context, gonio_i_folds *folds, size_t k)
{
    gonio_i_fold *f = &folds->fold[k];
    const gonio_i_learned_error *x = folds->of;
    const size_t n = folds->sites->n;
    const size_t most = gonio_i_folds_most(x);
    size_t *column = gonio_i_allocate(context, most, sizeof *column);
    double *room = gonio_i_allocate(context, (2 * most + n) * x->components, sizeof *room);
    f->square = gonio_i_allocate(context, most, sizeof *f->square);
    f->mixed = gonio_i_allocate(context, most * n, sizeof *f->mixed);
    f->cross_square = gonio_i_allocate(context, n * n, sizeof *f->cross_square);
    const bool done = column && room && f->square && f->mixed && f->cross_square;
    gonio_status status = done ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (done) {
        double *moved = room + most * x->components;
        status = fill_products(context, x, n, column, gonio_i_folds_list(x, k, column), room, moved,
                               moved + most * x->components, f);
    }
    free(column);
    free(room);
    return status;
}

static gonio_status draw_noise(gonio_context *context, gonio_i_folds *folds)
{
    const size_t n = folds->sites->n;
    folds->noise = gonio_i_allocate(context, folds->of->measured * n, sizeof *folds->noise);
    if (folds->noise == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t j = 0; j < folds->of->measured; j++) {
        gonio_i_random random;
        gonio_i_random_seed(&random, 0, j);
        for (size_t i = 0; i < n; i++) {
            folds->noise[j * n + i] = gonio_i_random_normal(&random);
        }
    }
    return GONIO_OK;
}

static gonio_status fill_folds(gonio_context *context, gonio_i_folds *folds)
{
    const gonio_i_learned_error *x = folds->of;
    const size_t samples = x->prior->samples;
    fold_scratch s = {gonio_i_allocate(context, samples, sizeof *s.share),
                      gonio_i_allocate(context, samples * folds->sites->n, sizeof *s.seen),
                      gonio_i_allocate(context, samples * x->components, sizeof *s.z)};
    gonio_status status = s.share == NULL || s.seen == NULL || s.z == NULL
                              ? GONIO_ERROR_MEMORY
                              : draw_noise(context, folds);
    for (size_t k = 0; k <= GONIO_I_FOLDS && status == GONIO_OK; k++) {
        status = fill_fold(context, folds, k, &s);
        if (status == GONIO_OK && k < GONIO_I_FOLDS && folds->sites->n <= x->components) {
            status = fill_left_out(context, folds, k);
        }
    }
    free(s.share);
    free(s.seen);
    free(s.z);
    return status;
}

gonio_status gonio_i_folds_create(gonio_context *context, const gonio_i_learned_error *learned,
                                  const gonio_i_sites *sites, gonio_i_folds **folds)
{
    *folds = NULL;
    gonio_i_folds *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->of = learned;
    made->sites = sites;
    const gonio_status status = fill_folds(context, made);
    if (status != GONIO_OK) {
        gonio_i_folds_free(&made);
    }
    *folds = made;
    return status;
}

void gonio_i_folds_free(gonio_i_folds **folds)
{
    if (folds == NULL || *folds == NULL) {
        return;
    }
    for (size_t k = 0; k <= GONIO_I_FOLDS; k++) {
        free((*folds)->fold[k].mean_seen);
        free((*folds)->fold[k].mean);
        free((*folds)->fold[k].covariance);
        free((*folds)->fold[k].cross);
        free((*folds)->fold[k].square);
        free((*folds)->fold[k].mixed);
        free((*folds)->fold[k].cross_square);
    }
    free((*folds)->noise);
    free(*folds);
    *folds = NULL;
}
