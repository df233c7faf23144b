/* What readings leave open: see variance.h.
 *
 * With t(x) = (f(x), k(x, .)) the variance of g(x) is alpha^2 k(x, x) + t Q t', where
 *
 *     Q = diag(h^2 I, 0) - w S^-1 w' + sum_j q_j d_j d_j',   w = (h^2 F', alpha^2 I),
 *     d_j = a ((z_j - z) - h^2 F' S^-1 F (z_j - z), -alpha^2 S^-1 F (z_j - z)):
 *
 * what the readings leave of the prior, and how far the columns that explain them differ. */
#include "variance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "grid_sums.h"

enum { BLOCK = 128 };

/* From the model's variances to those of materials that were left out (docs/experiments.md).
 * Deviations are widened so that 95 % of the true values lie within 1.96 of them, which takes more
 * than a Gaussian's, as errors come in all sizes. In the expected square of the error, which is
 * mostly that of the materials that are known worst, more is left open everywhere. */
typedef struct calibration {
    double factor;
    double left_open; /* deviation, log units */
} calibration;

static const calibration FOR_BANDS = {1.5, 0.01};
static const calibration FOR_SQUARES = {1.44, 0.05};

static double calibrated(double variance, const calibration *c)
{
    return c->factor * variance + c->left_open * c->left_open;
}

/* ---- rows ---- */

struct gonio_i_rows {
    const gonio_i_sites *sites;
    gonio_i_model model;
    size_t n;                /* readings whose smoothness counts: none if alpha is 0 */
    size_t size;             /* of t */
    size_t count;            /* rows looked at: */
    const size_t *row;       /* [count]: their numbers; NULL: all of the basis, in order */
    double *t;               /* [count][size], or NULL: made where it is needed */
    double *itself;          /* [count]: k(x, x), 0 if alpha is 0 */
    const double *bins;      /* [count]: how much each counts, on the grid the bins of its cell */
    double *gram;            /* [size][size]: sum of bins t' t, if t is there; or NULL */
    gonio_i_grid_sums *grid; /* the same for sums without Q (grid_sums.h); or NULL */
};

static size_t row_of(const gonio_i_rows *r, size_t number)
{
    return r->row != NULL ? r->row[number] : number;
}

static void fill_t(const gonio_i_rows *r, size_t number, double *t)
{
    const gonio_i_prior *prior = r->sites->prior;
    const size_t row = row_of(r, number);
    int channel = 0;
    gonio_i_prior_row(prior, row, t);
    if (r->n > 0) {
        const gonio_i_place here =
            gonio_i_place_of(gonio_i_row_coordinates(prior->view, row, &channel));
        for (size_t i = 0; i < r->n; i++) {
            t[prior->components + i] =
                gonio_i_remainder(&here, &r->sites->place[i], r->model.peak, r->model.retro);
        }
    }
}

static void fill_row(gonio_i_rows *r, size_t number)
{
    const gonio_basis_view *view = r->sites->prior->view;
    const size_t row = row_of(r, number);
    int channel = 0;
    if (r->n > 0) {
        const gonio_i_place here = gonio_i_place_of(gonio_i_row_coordinates(view, row, &channel));
        r->itself[number] = gonio_i_remainder(&here, &here, r->model.peak, r->model.retro);
    }
    if (r->t != NULL) {
        fill_t(r, number, r->t + number * r->size);
    }
}

/* Sum of bins t' t over the rows. */
static gonio_status find_gram(gonio_context *context, gonio_i_rows *r)
{
    double *scaled = gonio_i_allocate(context, r->count * r->size, sizeof *scaled);
    if (scaled == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < r->count * r->size; k++) {
        scaled[k] = sqrt(r->bins[k / r->size]) * r->t[k];
    }
    const gonio_status status =
        gonio_i_gram_rows(context, scaled, r->count, r->size, r->size, r->gram);
    free(scaled);
    return status;
}

gonio_status gonio_i_rows_create(gonio_context *context, const gonio_i_sites *sites,
                                 const gonio_i_model *model, const gonio_i_targets *targets,
                                 bool all, gonio_i_rows **rows)
{
    *rows = NULL;
    gonio_i_rows *r = gonio_i_allocate(context, 1, sizeof *r);
    if (r == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *r = (gonio_i_rows){.sites = sites, .model = *model};
    r->n = model->alpha > 0.0 ? sites->n : 0;
    r->size = sites->components + r->n;
    r->count = all ? sites->prior->view->rows : targets->count;
    r->row = all ? NULL : targets->row;
    r->bins = all ? targets->all : targets->weight;
    r->itself = gonio_i_allocate(context, r->count, sizeof *r->itself);
    r->t = all ? NULL : gonio_i_allocate(context, r->count * r->size, sizeof *r->t);
    r->gram = all ? NULL : gonio_i_allocate(context, r->size * r->size, sizeof *r->gram);
    if (r->itself == NULL || (!all && (r->t == NULL || r->gram == NULL))) {
        gonio_i_rows_free(&r);
        return GONIO_ERROR_MEMORY;
    }
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(context))
    for (size_t k = 0; k < r->count; k++) {
        fill_row(r, k);
    }
    gonio_status status = all ? GONIO_OK : find_gram(context, r);
    if (status == GONIO_OK && !all) {
        status = gonio_i_grid_sums_create(context, sites, &r->model, r->n > 0, r->gram, &r->grid);
    }
    if (status != GONIO_OK) {
        gonio_i_rows_free(&r);
    }
    *rows = r;
    return status;
}

void gonio_i_rows_free(gonio_i_rows **rows)
{
    if (rows == NULL || *rows == NULL) {
        return;
    }
    free((*rows)->t);
    free((*rows)->itself);
    free((*rows)->gram);
    gonio_i_grid_sums_free(&(*rows)->grid);
    free(*rows);
    *rows = NULL;
}

/* ---- a column ---- */

typedef struct variance {
    const gonio_i_fit *e;
    const gonio_i_rows *rows;
    const double *c;
    double *deviation; /* [rows], or NULL */
    size_t n;          /* as in rows */
    size_t size;
    double *q; /* [size][size] */
} variance;

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* m + f c + alpha^2 k S^-1 (y - F z). */
static double value_of(const variance *s, size_t row, const double *t)
{
    const gonio_i_fit *e = s->e;
    return e->prior->view->mean[row] + dot(t, s->c, e->components) +
           e->model.alpha * e->model.alpha * dot(t + e->components, e->solved, s->n);
}

/* Q less w S^-1 w', by rows w L'^-1. */
static gonio_status take_out_readings(const variance *s, double *q)
{
    const gonio_i_fit *e = s->e;
    const size_t n = e->n;
    double *w = gonio_i_allocate(e->context, s->size * n, sizeof *w);
    double *product = gonio_i_allocate(e->context, s->size * s->size, sizeof *product);
    gonio_status status = w == NULL || product == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        for (size_t i = 0; i < n; i++) {
            for (size_t k = 0; k < e->components; k++) {
                w[k * n + i] = e->model.h * e->model.h * e->sites->f[i * e->components + k];
            }
            if (s->n > 0) {
                w[(e->components + i) * n + i] = e->model.alpha * e->model.alpha;
            }
        }
        gonio_i_divide_triangle(w, s->size, n, e->lower);
        status =
            gonio_i_product_transposed(e->context, w, s->size, n, w, s->size, product, s->size);
    }
    for (size_t k = 0; k < s->size * s->size && status == GONIO_OK; k++) {
        q[k] -= product[k];
    }
    free(w);
    free(product);
    return status;
}

/* d_j q_j^(1/2) of the samples listed: d[count][size]; seen, solved: scratch of count x n. */
static gonio_status fill_differences(const variance *s, const size_t *listed, size_t count,
                                     double *d, double *seen, double *move)
{
    const gonio_i_fit *e = s->e;
    const double a = sqrt(1.0 - e->model.h * e->model.h);
    for (size_t j = 0; j < count; j++) {
        const double root = sqrt(e->weight[listed[j]]);
        for (size_t k = 0; k < e->components; k++) {
            d[j * s->size + k] =
                root * (a * e->prior->sample[listed[j] * e->components + k] - e->centre[k]);
        }
    }
    gonio_status status =
        gonio_i_product_rows(e->context, d, count, e->components, s->size, e->sites->f, e->n, seen);
    gonio_i_divide_triangle(seen, count, e->n, e->lower);
    gonio_i_divide_lower(seen, count, e->n, e->lower);
    if (status == GONIO_OK) {
        status = gonio_i_product(e->context, seen, count, e->n, e->sites->f, e->components, move);
    }
    for (size_t j = 0; j < count && status == GONIO_OK; j++) {
        for (size_t k = 0; k < e->components; k++) {
            d[j * s->size + k] -= e->model.h * e->model.h * move[j * e->components + k];
        }
        for (size_t i = 0; i < s->n; i++) {
            d[j * s->size + e->components + i] =
                -e->model.alpha * e->model.alpha * seen[j * e->n + i];
        }
    }
    return status;
}

/* Q plus sum_j q_j d_j d_j'. */
static gonio_status add_samples(const variance *s, double *q)
{
    const gonio_i_fit *e = s->e;
    const size_t samples = e->samples;
    if (!(e->model.h < 1.0)) {
        return GONIO_OK; /* all at the same place */
    }
    size_t *listed = gonio_i_allocate(e->context, samples, sizeof *listed);
    const size_t count = listed != NULL ? gonio_i_fit_samples(e, listed) : 0;
    double *d = gonio_i_allocate(e->context, count * s->size, sizeof *d);
    double *seen = gonio_i_allocate(e->context, count * e->n, sizeof *seen);
    double *move = gonio_i_allocate(e->context, count * e->components, sizeof *move);
    const bool done = listed != NULL && d != NULL && seen != NULL && move != NULL;
    gonio_status status = done ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK && count > 0) {
        status = fill_differences(s, listed, count, d, seen, move);
    }
    if (status == GONIO_OK && count > 0) {
        status = gonio_i_add_gram_rows(e->context, d, count, s->size, q);
    }
    free(listed);
    free(d);
    free(seen);
    free(move);
    return status;
}

static gonio_status find_q(variance *s)
{
    s->q = gonio_i_allocate(s->e->context, s->size * s->size, sizeof *s->q);
    if (s->q == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < s->e->components; k++) {
        s->q[k * s->size + k] = s->e->model.h * s->e->model.h;
    }
    gonio_status status = take_out_readings(s, s->q);
    if (status == GONIO_OK) {
        status = add_samples(s, s->q);
    }
    gonio_i_mirror(s->q, s->size);
    return status;
}

/* What a thread works on: t and product, [BLOCK][size] each. */
typedef struct workspace {
    double *t;
    double *product;
} workspace;

static void find_row(const variance *s, size_t number, const double *t, const double *product,
                     gonio_i_variance_sums *sums)
{
    const double alpha = s->e->model.alpha;
    const size_t row = row_of(s->rows, number);
    const double prior = s->n > 0 ? alpha * alpha * s->rows->itself[number] : 0.0;
    const double g = fmax(value_of(s, row, t), 0.0);
    const double model = s->e->misfit * fmax(prior + dot(t, product, s->size), 0.0);
    const double square = calibrated(model, &FOR_SQUARES);
    const double bins = s->rows->bins[number];
    s->deviation[row] = sqrt(calibrated(model, &FOR_BANDS));
    sums->bins += bins;
    sums->error += bins * square;
    sums->square += bins * g * g;
}

/* Without deviations, only sums over the rows are wanted. model: the sum of bins t Q t'. */
static void find_sums(const variance *s, double model, gonio_i_variance_sums *sums)
{
    const gonio_i_rows *rows = s->rows;
    const double alpha = s->e->model.alpha;
    for (size_t k = 0; k < rows->count; k++) {
        const double *t = rows->t + k * s->size;
        const double g = fmax(value_of(s, row_of(rows, k), t), 0.0);
        model += s->n > 0 ? rows->bins[k] * alpha * alpha * rows->itself[k] : 0.0;
        sums->bins += rows->bins[k];
        sums->square += rows->bins[k] * g * g;
    }
    sums->error = FOR_SQUARES.factor * s->e->misfit * fmax(model, 0.0) +
                  FOR_SQUARES.left_open * FOR_SQUARES.left_open * sums->bins;
}

/* The variances are linear in Q, so that the sum over the rows is that of the elements of Q times
 * those of the rows' gram matrix. Where Q is not wanted, it is not made (grid_sums.h). */
static gonio_status add_sums(const variance *s, gonio_i_variance_sums *sums)
{
    double model = 0.0;
    gonio_status status = GONIO_OK;
    if (s->q != NULL) {
        model = dot(s->q, s->rows->gram, s->size * s->size);
    } else {
        status = gonio_i_grid_sums_of(s->rows->grid, s->e, &model);
    }
    if (status == GONIO_OK) {
        find_sums(s, model, sums);
    }
    return status;
}

static gonio_status find_block(const variance *s, size_t first, size_t count, const workspace *w,
                               gonio_i_variance_sums *sums)
{
    const gonio_i_rows *rows = s->rows;
    for (size_t b = 0; b < count; b++) {
        fill_t(rows, first + b, w->t + b * s->size);
    }
    const gonio_status status = gonio_i_product_transposed(s->e->context, w->t, count, s->size,
                                                           s->q, s->size, w->product, s->size);
    for (size_t b = 0; b < count && status == GONIO_OK; b++) {
        find_row(s, first + b, w->t + b * s->size, w->product + b * s->size, sums);
    }
    return status;
}

/* All blocks, by several threads; the sums of each block for themselves, so that they add up to the
 * same whatever the threads. */
static gonio_status find_blocks(const variance *s, size_t blocks, gonio_i_variance_sums *sums)
{
    const size_t rows = s->rows->count;
    gonio_status result = GONIO_OK;
#pragma omp parallel num_threads(gonio_context_threads(s->e->context))
    {
        workspace w = {gonio_i_allocate(s->e->context, BLOCK * s->size, sizeof *w.t),
                       gonio_i_allocate(s->e->context, BLOCK * s->size, sizeof *w.product)};
        gonio_status mine = w.t == NULL || w.product == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
#pragma omp for schedule(dynamic, 1)
        for (size_t k = 0; k < blocks; k++) {
            const size_t left = rows - k * BLOCK;
            if (mine == GONIO_OK) {
                mine = find_block(s, k * BLOCK, left < BLOCK ? left : BLOCK, &w, &sums[k]);
            }
        }
        if (mine != GONIO_OK) {
#pragma omp atomic write
            result = mine;
        }
        free(w.t);
        free(w.product);
    }
    return result;
}

/* Deviations of all rows, and the sums over them. */
static gonio_status find_deviations(const variance *s, gonio_i_variance_sums *sums)
{
    const size_t blocks = (s->rows->count + BLOCK - 1) / BLOCK;
    gonio_i_variance_sums *part = gonio_i_allocate(s->e->context, blocks, sizeof *part);
    const gonio_status status = part == NULL ? GONIO_ERROR_MEMORY : find_blocks(s, blocks, part);
    for (size_t k = 0; k < blocks && status == GONIO_OK; k++) {
        sums->bins += part[k].bins;
        sums->error += part[k].error;
        sums->square += part[k].square;
    }
    free(part);
    return status;
}

gonio_status gonio_i_variance_find(const gonio_i_fit *fit, const gonio_i_rows *rows,
                                   const double *c, double *deviation, double *covariance,
                                   gonio_i_variance_sums *sums)
{
    variance s = {
        .e = fit, .rows = rows, .c = c, .deviation = deviation, .n = rows->n, .size = rows->size};
    const size_t components = fit->components;
    gonio_i_variance_sums found = {0};
    gonio_status status = GONIO_OK;
    if (deviation != NULL || covariance != NULL) {
        status = find_q(&s);
    }
    if (status == GONIO_OK) {
        status = deviation != NULL ? find_deviations(&s, &found) : add_sums(&s, &found);
    }
    for (size_t k = 0; covariance != NULL && k < components * components && status == GONIO_OK;
         k++) {
        covariance[k] = s.q[k / components * s.size + k % components];
    }
    if (status == GONIO_OK) {
        sums->bins += found.bins;
        sums->error += found.error;
        sums->square += found.square;
    }
    free(s.q);
    return status;
}
