/* The field and its deviation: see spread.h.
 *
 * With t(x) = (f(x), k(x, .)) the variance of g(x) is alpha^2 + t Q t', where
 *
 *     Q = diag(h^2 I, 0) - w S^-1 w' + sum_j q_j d_j d_j',   w = (h^2 F', alpha^2 I),
 *     d_j = a ((z_j - z) - h^2 F' S^-1 F (z_j - z), -alpha^2 S^-1 F (z_j - z)):
 *
 * what the readings leave of the prior, and how far the columns that explain them differ. */
#include "spread.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

enum { BLOCK = 512, SAMPLE = 4096 /* rows that the predicted error is taken from */ };

/* Weights below this do not count among the samples. */
static const double NEGLIGIBLE = 1e-7;

/* What the variances of the prior are multiplied by, so that of the true values of materials that
 * were left out 95 % lie within 1.96 deviations: docs/accuracy.md. */
static const double CALIBRATION = 1.0;

typedef struct spreader {
    const gonio_i_gaussian *e;
    const gonio_i_spread_target *target;
    size_t n; /* readings whose smoothness counts: none if alpha is 0 */
    size_t size;     /* of t */
    double *q;       /* [size][size] */
} spreader;

static void fill_t(const spreader *s, size_t row, double *t)
{
    int channel = 0;
    gonio_i_prior_row(s->e->prior, row, t);
    if (s->n > 0) {
        const gonio_i_place place =
            gonio_i_place_of(gonio_i_row_coordinates(&s->e->prior->view, row, &channel));
        for (size_t i = 0; i < s->n; i++) {
            t[s->e->components + i] = gonio_i_smoothness(&place, &s->e->place[i]);
        }
    }
}

/* m + f c + alpha^2 k S^-1 (y - F z). */
static double value_of(const spreader *s, size_t row, const double *t)
{
    const gonio_i_gaussian *e = s->e;
    double g = e->prior->view.mean[row];
    for (size_t k = 0; k < e->components; k++) {
        g += t[k] * s->target->c[k];
    }
    for (size_t i = 0; i < s->n; i++) {
        g += e->alpha * e->alpha * t[e->components + i] * e->solved[i];
    }
    return g;
}

/* Q less w S^-1 w', by rows w L'^-1. */
static gonio_status take_out_readings(const spreader *s, double *q)
{
    const gonio_i_gaussian *e = s->e;
    const size_t n = e->n;
    double *w = gonio_i_allocate(e->context, s->size * n, sizeof *w);
    double *product = gonio_i_allocate(e->context, s->size * s->size, sizeof *product);
    gonio_status status = w == NULL || product == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        for (size_t i = 0; i < n; i++) {
            for (size_t k = 0; k < e->components; k++) {
                w[k * n + i] = e->h * e->h * e->f[i * e->components + k];
            }
            if (s->n > 0) {
                w[(e->components + i) * n + i] = e->alpha * e->alpha;
            }
        }
        gonio_i_divide_triangle(w, s->size, n, e->lower);
        status = gonio_i_product_transposed(e->context, w, s->size, n, w, s->size, product,
                                            s->size);
    }
    for (size_t k = 0; k < s->size * s->size && status == GONIO_OK; k++) {
        q[k] -= product[k];
    }
    free(w);
    free(product);
    return status;
}

/* d_j q_j^(1/2) of one sample; seen: scratch of n values. */
static void fill_difference(const spreader *s, size_t sample, double *seen, double *d)
{
    const gonio_i_gaussian *e = s->e;
    const double a = sqrt(1.0 - e->h * e->h);
    const double root = sqrt(e->weight[sample]);
    for (size_t k = 0; k < e->components; k++) {
        d[k] = root * (a * e->prior->sample[sample * e->components + k] - e->centre[k]);
    }
    for (size_t i = 0; i < e->n; i++) {
        seen[i] = 0.0;
        for (size_t k = 0; k < e->components; k++) {
            seen[i] += e->f[i * e->components + k] * d[k];
        }
    }
    gonio_i_divide_triangle(seen, 1, e->n, e->lower);
    gonio_i_divide_lower(seen, 1, e->n, e->lower);
    for (size_t i = 0; i < e->n; i++) {
        for (size_t k = 0; k < e->components; k++) {
            d[k] -= e->h * e->h * e->f[i * e->components + k] * seen[i];
        }
        if (s->n > 0) {
            d[e->components + i] = -e->alpha * e->alpha * seen[i];
        }
    }
}

/* Q plus sum_j q_j d_j d_j'. */
static gonio_status add_samples(const spreader *s, double *q)
{
    const gonio_i_gaussian *e = s->e;
    size_t count = 0;
    for (size_t j = 0; j < e->prior->samples; j++) {
        count += e->weight[j] > NEGLIGIBLE;
    }
    if (count == 0) {
        return GONIO_OK;
    }
    double *d = gonio_i_allocate(e->context, count * s->size, sizeof *d);
    double *seen = gonio_i_allocate(e->context, e->n, sizeof *seen);
    gonio_status status = d == NULL || seen == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    count = 0;
    for (size_t j = 0; j < e->prior->samples && status == GONIO_OK; j++) {
        if (e->weight[j] > NEGLIGIBLE) {
            fill_difference(s, j, seen, d + count++ * s->size);
        }
    }
    if (status == GONIO_OK) {
        status = gonio_i_add_gram_rows(e->context, d, count, s->size, q);
        gonio_i_mirror(q, s->size);
    }
    free(d);
    free(seen);
    return status;
}

static gonio_status find_q(spreader *s)
{
    s->q = gonio_i_allocate(s->e->context, s->size * s->size, sizeof *s->q);
    if (s->q == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < s->e->components; k++) {
        s->q[k * s->size + k] = s->e->h * s->e->h;
    }
    const gonio_status status = take_out_readings(s, s->q);
    return status == GONIO_OK ? add_samples(s, s->q) : status;
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* Rows first, first + step, ... of which `count` make a block; t, product: [count][size]. */
static gonio_status spread_variances(const spreader *s, size_t first, size_t step, size_t count,
                                     const double *t, double *product, double *error,
                                     double *square)
{
    const gonio_i_gaussian *e = s->e;
    const gonio_status status = gonio_i_product_transposed(e->context, t, count, s->size, s->q,
                                                           s->size, product, s->size);
    const gonio_basis_view *view = &e->prior->view;
    const size_t each = view->channels == GONIO_JOINT ? GONIO_CHANNELS : 1;
    for (size_t b = 0; b < count && status == GONIO_OK; b++) {
        const size_t row = first + b * step;
        const double prior = e->alpha * e->alpha;
        const double variance =
            CALIBRATION * fmax(prior + dot(t + b * s->size, product + b * s->size, s->size), 0.0);
        const double bins = gonio_i_cell_bins(view->representation, view->cell[row / each]);
        const double g = fmax(s->target->field[row], 0.0);
        if (s->target->deviation != NULL) {
            s->target->deviation[row] = sqrt(variance);
        }
        *error += bins * variance;
        *square += bins * (g * g + variance);
    }
    return status;
}

/* Every step-th row: values (if wanted) and variances (if wanted). */
static gonio_status spread_rows(const spreader *s, size_t step, bool values, bool variances,
                                double *error, double *square)
{
    const size_t rows = s->e->prior->view.rows;
    double *t = gonio_i_allocate(s->e->context, BLOCK * s->size, sizeof *t);
    double *product = gonio_i_allocate(s->e->context, BLOCK * s->size, sizeof *product);
    gonio_status status = t == NULL || product == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t first = 0; first < rows && status == GONIO_OK; first += BLOCK * step) {
        const size_t left = (rows - first + step - 1) / step;
        const size_t count = left < BLOCK ? left : BLOCK;
#pragma omp parallel for num_threads(gonio_context_threads(s->e->context))
        for (size_t b = 0; b < count; b++) {
            const size_t row = first + b * step;
            fill_t(s, row, t + b * s->size);
            if (values) {
                s->target->field[row] = value_of(s, row, t + b * s->size);
            }
        }
        if (variances) {
            status = spread_variances(s, first, step, count, t, product, error, square);
        }
    }
    free(t);
    free(product);
    return status;
}

gonio_status gonio_i_spread(const gonio_i_gaussian *gaussian, const gonio_i_spread_target *target,
                            double *error, double *square)
{
    spreader s = {.e = gaussian, .target = target, .n = gaussian->alpha > 0.0 ? gaussian->n : 0};
    s.size = gaussian->components + s.n;
    const size_t rows = gaussian->prior->view.rows;
    const bool all = target->deviation != NULL;
    gonio_status status = find_q(&s);
    if (status == GONIO_OK) {
        status = spread_rows(&s, 1, true, all, error, square);
    }
    if (status == GONIO_OK && !all) {
        status = spread_rows(&s, rows / SAMPLE + 1, false, true, error, square);
    }
    free(s.q);
    return status;
}
