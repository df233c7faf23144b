/* Sums of variances over the grid: see grid_sums.h. */
#include "grid_sums.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "fit_inverse.h"

struct gonio_i_grid_sums {
    size_t n;
    size_t components;
    size_t samples; /* 0 if h is 1 */
    double h;
    double trace;   /* tr R_ff */
    double *seen;   /* [n][n]: M */
    double *cross;  /* [K][n]: N */
    double *gram;   /* [K][K]: R_ff */
    double *turned; /* [samples][K]: z_j R_ff */
    double *mixed;  /* [samples][n]: z_j N */
    double *square; /* [samples]: z_j R_ff z_j' */
};

void gonio_i_grid_sums_free(gonio_i_grid_sums **sums)
{
    if (sums == NULL || *sums == NULL) {
        return;
    }
    free((*sums)->seen);
    free((*sums)->cross);
    free((*sums)->gram);
    free((*sums)->turned);
    free((*sums)->mixed);
    free((*sums)->square);
    free(*sums);
    *sums = NULL;
}

/* R w, [size][n], from R [size][size]. */
static gonio_status multiply_readings(gonio_context *context, const gonio_i_sites *sites,
                                      const gonio_i_model *model, const double *gram, size_t size,
                                      double *product)
{
    const size_t k = sites->components;
    const size_t n = sites->n;
    const gonio_status status =
        gonio_i_product_rows(context, gram, size, k, size, sites->f, n, product);
    const double remainder = size > k ? model->alpha * model->alpha : 0.0;
    for (size_t i = 0; i < size && status == GONIO_OK; i++) {
        for (size_t j = 0; j < n; j++) {
            const double smooth = size > k ? gram[i * size + k + j] : 0.0;
            product[i * n + j] = model->h * model->h * product[i * n + j] + remainder * smooth;
        }
    }
    return status;
}

/* M = w' (R w), and N, the first K rows of R w. */
static gonio_status fill_readings(gonio_context *context, const gonio_i_sites *sites,
                                  const gonio_i_model *model, const double *gram, size_t size,
                                  gonio_i_grid_sums *s)
{
    const size_t k = s->components;
    const size_t n = s->n;
    double *product = gonio_i_allocate(context, size * n, sizeof *product);
    gonio_status status = product == NULL
                              ? GONIO_ERROR_MEMORY
                              : multiply_readings(context, sites, model, gram, size, product);
    if (status == GONIO_OK) {
        status = gonio_i_product(context, sites->f, n, k, product, n, s->seen);
    }
    for (size_t i = 0; i < n * n && status == GONIO_OK; i++) {
        s->seen[i] *= model->h * model->h;
        s->seen[i] += size > k ? model->alpha * model->alpha * product[k * n + i] : 0.0;
    }
    if (status == GONIO_OK) {
        memcpy(s->cross, product, k * n * sizeof *product);
    }
    free(product);
    return status;
}

static gonio_status fill_samples(gonio_context *context, const gonio_i_prior *prior,
                                 gonio_i_grid_sums *s)
{
    const size_t k = s->components;
    gonio_status status =
        gonio_i_product(context, prior->sample, s->samples, k, s->gram, k, s->turned);
    if (status == GONIO_OK) {
        status = gonio_i_product(context, prior->sample, s->samples, k, s->cross, s->n, s->mixed);
    }
    for (size_t j = 0; j < s->samples && status == GONIO_OK; j++) {
        s->square[j] = gonio_i_dot(prior->sample + j * k, s->turned + j * k, k);
    }
    return status;
}

static gonio_status fill(gonio_context *context, const gonio_i_sites *sites,
                         const gonio_i_model *model, const double *gram, size_t size,
                         gonio_i_grid_sums *s)
{
    const size_t k = s->components;
    for (size_t i = 0; i < k; i++) {
        memcpy(s->gram + i * k, gram + i * size, k * sizeof *gram);
        s->trace += gram[i * size + i];
    }
    gonio_status status = fill_readings(context, sites, model, gram, size, s);
    if (status == GONIO_OK && s->samples > 0) {
        status = fill_samples(context, sites->prior, s);
    }
    return status;
}

gonio_status gonio_i_grid_sums_create(gonio_context *context, const gonio_i_sites *sites,
                                      const gonio_i_model *model, bool remainder,
                                      const double *gram, gonio_i_grid_sums **sums)
{
    const size_t k = sites->components;
    const size_t n = sites->n;
    gonio_i_model used = *model;
    used.h = sites->prior->samples == 0 ? 1.0 : model->h;
    gonio_i_grid_sums *s = gonio_i_allocate(context, 1, sizeof *s);
    if (s == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *s = (gonio_i_grid_sums){.n = n, .components = k, .h = used.h};
    s->samples = used.h < 1.0 ? sites->prior->samples : 0;
    s->seen = gonio_i_allocate(context, n * n, sizeof *s->seen);
    s->cross = gonio_i_allocate(context, k * n, sizeof *s->cross);
    s->gram = gonio_i_allocate(context, k * k, sizeof *s->gram);
    s->turned = gonio_i_allocate(context, s->samples * k, sizeof *s->turned);
    s->mixed = gonio_i_allocate(context, s->samples * n, sizeof *s->mixed);
    s->square = gonio_i_allocate(context, s->samples, sizeof *s->square);
    const bool done = s->seen && s->cross && s->gram && s->turned && s->mixed && s->square;
    const gonio_status status =
        done ? fill(context, sites, &used, gram, remainder ? k + n : k, s) : GONIO_ERROR_MEMORY;
    if (status != GONIO_OK) {
        gonio_i_grid_sums_free(&s);
    }
    *sums = s;
    return status;
}

/* ---- a column ---- */

/* tr(S^-1 M). */
static gonio_status taken_out(const gonio_i_grid_sums *s, const gonio_i_fit *e, double *sum)
{
    const size_t n = s->n;
    if (e->is_inverted) {
        *sum = gonio_i_fit_inverse_trace(e, s->seen);
        return GONIO_OK;
    }
    double *m = gonio_i_allocate(e->context, n * n, sizeof *m);
    if (m == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(m, s->seen, n * n * sizeof *m);
    gonio_i_divide_triangle(m, n, n, e->lower);
    gonio_i_divide_lower(m, n, n, e->lower);
    *sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        *sum += m[i * n + i];
    }
    free(m);
    return GONIO_OK;
}

/* What one sample adds. turned, mixed: R_ff z and N' z of the centre z; seen, solved: F (a z_j - z)
 * and S^-1 of it; moved: M times that. */
static double of_sample(const gonio_i_grid_sums *s, const gonio_i_fit *e, size_t j,
                        const double *turned, const double *mixed, const double *solved,
                        const double *moved)
{
    const double a = sqrt(1.0 - s->h * s->h);
    const double *sample = e->prior->sample + j * s->components;
    const double centre = gonio_i_dot(e->centre, turned, s->components);
    const double both = gonio_i_dot(sample, turned, s->components);
    const double square = a * a * s->square[j] - 2.0 * a * both + centre;
    const double cross =
        a * gonio_i_dot(s->mixed + j * s->n, solved, s->n) - gonio_i_dot(mixed, solved, s->n);
    return e->weight[j] * (square - 2.0 * cross + gonio_i_dot(moved, solved, s->n));
}

/* Scratch of a column. */
typedef struct sample_scratch {
    size_t *listed; /* [samples] */
    double *solved; /* [samples][n] */
    double *moved;  /* [samples][n] */
    double *turned; /* [K] */
    double *mixed;  /* [n] */
} sample_scratch;

static gonio_status add_samples(const gonio_i_grid_sums *s, const gonio_i_fit *e,
                                const sample_scratch *w, double *sum)
{
    const double a = sqrt(1.0 - s->h * s->h);
    const size_t n = s->n;
    const size_t count = gonio_i_fit_samples(e, w->listed);
    for (size_t j = 0; j < count; j++) {
        for (size_t i = 0; i < n; i++) {
            w->solved[j * n + i] =
                a * e->sites->seen[w->listed[j] * n + i] - (e->y[i] - e->rest[i]);
        }
    }
    gonio_i_divide_triangle(w->solved, count, n, e->lower);
    gonio_i_divide_lower(w->solved, count, n, e->lower);
    gonio_status status = gonio_i_product(e->context, w->solved, count, n, s->seen, n, w->moved);
    if (status == GONIO_OK) {
        status = gonio_i_product(e->context, e->centre, 1, s->components, s->gram, s->components,
                                 w->turned);
    }
    if (status == GONIO_OK) {
        status = gonio_i_product(e->context, e->centre, 1, s->components, s->cross, n, w->mixed);
    }
    for (size_t j = 0; j < count && status == GONIO_OK; j++) {
        *sum +=
            of_sample(s, e, w->listed[j], w->turned, w->mixed, w->solved + j * n, w->moved + j * n);
    }
    return status;
}

/* sum_j q_j d_j R d_j'. */
static gonio_status of_samples(const gonio_i_grid_sums *s, const gonio_i_fit *e, double *sum)
{
    sample_scratch w = {gonio_i_allocate(e->context, s->samples, sizeof *w.listed),
                        gonio_i_allocate(e->context, s->samples * s->n, sizeof *w.solved),
                        gonio_i_allocate(e->context, s->samples * s->n, sizeof *w.moved),
                        gonio_i_allocate(e->context, s->components, sizeof *w.turned),
                        gonio_i_allocate(e->context, s->n, sizeof *w.mixed)};
    const bool done = w.listed && w.solved && w.moved && w.turned && w.mixed;
    const gonio_status status = done ? add_samples(s, e, &w, sum) : GONIO_ERROR_MEMORY;
    free(w.listed);
    free(w.solved);
    free(w.moved);
    free(w.turned);
    free(w.mixed);
    return status;
}

gonio_status gonio_i_grid_sums_of(const gonio_i_grid_sums *s, const gonio_i_fit *e, double *sum)
{
    double out = 0.0;
    gonio_status status = taken_out(s, e, &out);
    *sum = s->h * s->h * s->trace - out;
    return status == GONIO_OK && s->samples > 0 ? of_samples(s, e, sum) : status;
}
