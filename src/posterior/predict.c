/* The field and its deviation: see predict.h.
 *
 * With t(x) = (f(x), k(x, .)) the variance of g(x) is alpha^2 k(x, x) + t Q t', where
 *
 *     Q = diag(h^2 I, 0) - w S^-1 w' + sum_j q_j d_j d_j',   w = (h^2 F', alpha^2 I),
 *     d_j = a ((z_j - z) - h^2 F' S^-1 F (z_j - z), -alpha^2 S^-1 F (z_j - z)):
 *
 * what the readings leave of the prior, and how far the columns that explain them differ. */
#include "predict.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

enum { BLOCK = 128 };

/* Weights below this do not count among the samples. */
static const double NEGLIGIBLE = 1e-7;

/* From the model's variances to those of materials that were left out (docs/accuracy.md).
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

typedef struct spreader {
    const gonio_i_fit *e;
    const double *c;
    double *deviation; /* [rows], or NULL */
    size_t n;          /* readings whose smoothness counts: none if alpha is 0 */
    size_t size;       /* of t */
    double *q;         /* [size][size] */
} spreader;

static void fill_t(const gonio_i_prior *prior, const gonio_i_place *place, double peak, size_t n,
                   size_t row, double *t)
{
    int channel = 0;
    gonio_i_prior_row(prior, row, t);
    if (n > 0) {
        const gonio_i_place here =
            gonio_i_place_of(gonio_i_row_coordinates(&prior->view, row, &channel));
        for (size_t i = 0; i < n; i++) {
            t[prior->components + i] = gonio_i_remainder(&here, &place[i], peak);
        }
    }
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* m + f c + alpha^2 k S^-1 (y - F z). */
static double value_of(const spreader *s, size_t row, const double *t)
{
    const gonio_i_fit *e = s->e;
    return e->prior->view.mean[row] + dot(t, s->c, e->components) +
           e->model.alpha * e->model.alpha * dot(t + e->components, e->solved, s->n);
}

/* Q less w S^-1 w', by rows w L'^-1. */
static gonio_status take_out_readings(const spreader *s, double *q)
{
    const gonio_i_fit *e = s->e;
    const size_t n = e->n;
    double *w = gonio_i_allocate(e->context, s->size * n, sizeof *w);
    double *product = gonio_i_allocate(e->context, s->size * s->size, sizeof *product);
    gonio_status status = w == NULL || product == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        for (size_t i = 0; i < n; i++) {
            for (size_t k = 0; k < e->components; k++) {
                w[k * n + i] = e->model.h * e->model.h * e->f[i * e->components + k];
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
static gonio_status fill_differences(const spreader *s, const size_t *listed, size_t count,
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
        gonio_i_product_rows(e->context, d, count, e->components, s->size, e->f, e->n, seen);
    gonio_i_divide_triangle(seen, count, e->n, e->lower);
    gonio_i_divide_lower(seen, count, e->n, e->lower);
    if (status == GONIO_OK) {
        status = gonio_i_product(e->context, seen, count, e->n, e->f, e->components, move);
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
static gonio_status add_samples(const spreader *s, double *q)
{
    const gonio_i_fit *e = s->e;
    const size_t samples = e->prior->samples;
    size_t *listed = gonio_i_allocate(e->context, samples, sizeof *listed);
    size_t count = 0;
    for (size_t j = 0; listed != NULL && j < samples; j++) {
        listed[count] = j;
        count += e->weight[j] > NEGLIGIBLE;
    }
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
        gonio_i_mirror(q, s->size);
    }
    free(listed);
    free(d);
    free(seen);
    free(move);
    return status;
}

static gonio_status find_q(spreader *s)
{
    s->q = gonio_i_allocate(s->e->context, s->size * s->size, sizeof *s->q);
    if (s->q == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < s->e->components; k++) {
        s->q[k * s->size + k] = s->e->model.h * s->e->model.h;
    }
    const gonio_status status = take_out_readings(s, s->q);
    return status == GONIO_OK ? add_samples(s, s->q) : status;
}

/* k(x, x) of a row. */
static double remainder_at(const spreader *s, size_t row)
{
    int channel = 0;
    const gonio_i_place here =
        gonio_i_place_of(gonio_i_row_coordinates(&s->e->prior->view, row, &channel));
    return gonio_i_remainder(&here, &here, s->e->model.peak);
}

/* What a thread works on: t and product, [BLOCK][size] each. */
typedef struct workspace {
    double *t;
    double *product;
} workspace;

static void spread_row(const spreader *s, size_t row, const double *t, const double *product,
                       gonio_i_predicted_sums *sums)
{
    const gonio_basis_view *view = &s->e->prior->view;
    const size_t each = view->channels == GONIO_JOINT ? GONIO_CHANNELS : 1;
    const double prior =
        s->n > 0 ? s->e->model.alpha * s->e->model.alpha * remainder_at(s, row) : 0.0;
    const double g = fmax(value_of(s, row, t), 0.0);
    const double model = s->e->misfit * fmax(prior + dot(t, product, s->size), 0.0);
    const double square = calibrated(model, &FOR_SQUARES);
    const double bins = gonio_i_cell_bins(view->representation, view->cell[row / each]);
    if (s->deviation != NULL) {
        s->deviation[row] = sqrt(calibrated(model, &FOR_BANDS));
    }
    sums->bins += bins;
    sums->error += bins * square;
    sums->square += bins * g * g;
}

/* Rows first, first + step, ... of which `count` make a block. */
static gonio_status spread_block(const spreader *s, size_t first, size_t step, size_t count,
                                 const workspace *w, gonio_i_predicted_sums *sums)
{
    for (size_t b = 0; b < count; b++) {
        fill_t(s->e->prior, s->e->place, s->e->model.peak, s->n, first + b * step,
               w->t + b * s->size);
    }
    const gonio_status status = gonio_i_product_transposed(s->e->context, w->t, count, s->size,
                                                           s->q, s->size, w->product, s->size);
    for (size_t b = 0; b < count && status == GONIO_OK; b++) {
        spread_row(s, first + b * step, w->t + b * s->size, w->product + b * s->size, sums);
    }
    return status;
}

/* All blocks, by several threads; the sums of each block for themselves, so that they add up to the
 * same whatever the threads. */
static gonio_status spread_blocks(const spreader *s, size_t step, size_t blocks,
                                  gonio_i_predicted_sums *sums)
{
    const size_t rows = s->e->prior->view.rows;
    gonio_status result = GONIO_OK;
#pragma omp parallel num_threads(gonio_context_threads(s->e->context))
    {
        workspace w = {gonio_i_allocate(s->e->context, BLOCK * s->size, sizeof *w.t),
                       gonio_i_allocate(s->e->context, BLOCK * s->size, sizeof *w.product)};
        gonio_status mine = w.t == NULL || w.product == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
#pragma omp for schedule(dynamic, 1)
        for (size_t k = 0; k < blocks; k++) {
            const size_t first = k * BLOCK * step;
            const size_t left = (rows - first + step - 1) / step;
            if (mine == GONIO_OK) {
                mine = spread_block(s, first, step, left < BLOCK ? left : BLOCK, &w, &sums[k]);
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

gonio_status gonio_i_predict_variance(const gonio_i_fit *gaussian, const double *c,
                                      double *deviation, double *covariance,
                                      gonio_i_predicted_sums *sums)
{
    spreader s = {.e = gaussian, .c = c, .deviation = deviation};
    s.n = gaussian->model.alpha > 0.0 ? gaussian->n : 0;
    s.size = gaussian->components + s.n;
    const size_t rows = gaussian->prior->view.rows;
    const size_t step = deviation != NULL ? 1 : gonio_i_sample_step(rows);
    const size_t blocks = (rows + BLOCK * step - 1) / (BLOCK * step);
    gonio_i_predicted_sums *part = gonio_i_allocate(gaussian->context, blocks, sizeof *part);
    gonio_status status = part == NULL ? GONIO_ERROR_MEMORY : find_q(&s);
    if (status == GONIO_OK) {
        status = spread_blocks(&s, step, blocks, part);
    }
    for (size_t k = 0; covariance != NULL && k < gaussian->components && status == GONIO_OK; k++) {
        for (size_t j = 0; j < gaussian->components; j++) {
            covariance[k * gaussian->components + j] += s.q[k * s.size + j];
        }
    }
    for (size_t k = 0; k < blocks && status == GONIO_OK; k++) {
        sums->bins += (double)step * part[k].bins;
        sums->error += (double)step * part[k].error;
        sums->square += (double)step * part[k].square;
    }
    free(s.q);
    free(part);
    return status;
}

/* ---- fields ---- */

/* Whether a column was read where the one before it was: then k is the same. */
static bool same_places(const gonio_i_predicted_column *a, const gonio_i_predicted_column *b)
{
    return a->n == b->n && (a->n == 0 || memcmp(a->place, b->place, a->n * sizeof *a->place) == 0);
}

/* What all columns read at the same places have in common in a row. */
typedef struct row_terms {
    double *f;      /* [K] */
    double *smooth; /* [n] */
    double *peaked; /* [n] */
} row_terms;

static void fill_terms(const gonio_i_prior *prior, const gonio_i_predicted_column *c, size_t row,
                       const row_terms *t)
{
    int channel = 0;
    const gonio_i_place here =
        gonio_i_place_of(gonio_i_row_coordinates(&prior->view, row, &channel));
    gonio_i_prior_row(prior, row, t->f);
    for (size_t i = 0; i < c->n; i++) {
        t->smooth[i] = gonio_i_smooth(&here, &c->place[i]);
        t->peaked[i] = gonio_i_peaked(&here, &c->place[i]);
    }
}

static void fill_row(const gonio_i_prior *prior, const gonio_i_predicted_column *columns,
                     size_t count, size_t row, const row_terms *t)
{
    for (size_t j = 0; j < count; j++) {
        const gonio_i_predicted_column *c = &columns[j];
        if (j == 0 || !same_places(c, c - 1)) {
            fill_terms(prior, c, row, t);
        }
        c->field[row] = prior->view.mean[row] + dot(t->f, c->c, prior->components) +
                        dot(t->smooth, c->smooth, c->n) + dot(t->peaked, c->peaked, c->n);
    }
}

gonio_status gonio_i_predict_fields(gonio_context *context, const gonio_i_prior *prior,
                                    const gonio_i_predicted_column *columns, size_t count)
{
    size_t most = 0;
    bool failed = false;
    for (size_t j = 0; j < count; j++) {
        most = columns[j].n > most ? columns[j].n : most;
    }
#pragma omp parallel num_threads(gonio_context_threads(context))
    {
        double *values = gonio_i_allocate(context, prior->components + 2 * most, sizeof *values);
        if (values == NULL) {
#pragma omp atomic write
            failed = true;
        }
#pragma omp for schedule(static)
        for (size_t row = 0; row < prior->view.rows; row++) {
            if (values != NULL) {
                const row_terms t = {values, values + prior->components,
                                     values + prior->components + most};
                fill_row(prior, columns, count, row, &t);
            }
        }
        free(values);
    }
    return failed ? GONIO_ERROR_MEMORY : GONIO_OK;
}
