/* The filter of the condition-number search: see filter.h. */
#include "filter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

enum { CHUNK = 512 }; /* rows worked on at a time */

bool gonio_i_filter_allocate(const gonio_i_selection_problem *problem, gonio_i_filter *f)
{
    gonio_context *context = problem->context;
    const size_t k = problem->components;
    *f = (gonio_i_filter){
        .problem = problem,
        .resolvent = gonio_i_allocate(context, k * k, sizeof(double)),
        .gain = gonio_i_allocate(context, problem->rows, sizeof(double)),
        .w = gonio_i_allocate(context, GONIO_I_BATCH * problem->rows, sizeof(double)),
        .w_in = gonio_i_allocate(context, problem->rows, sizeof(double)),
        .bv = gonio_i_allocate(context, GONIO_I_BATCH * k, sizeof(double)),
        .pass = gonio_i_allocate(context, problem->rows, 1),
    };
    return f->resolvent != NULL && f->gain != NULL && f->w != NULL && f->w_in != NULL &&
           f->bv != NULL && f->pass != NULL;
}

void gonio_i_filter_free(gonio_i_filter *f)
{
    free(f->resolvent);
    free(f->gain);
    free(f->w);
    free(f->w_in);
    free(f->bv);
    free(f->pass);
}

static size_t chunk_count(size_t rows)
{
    return (rows + CHUNK - 1) / CHUNK;
}

static size_t chunk_rows(size_t rows, size_t chunk)
{
    return rows - chunk * CHUNK < CHUNK ? rows - chunk * CHUNK : CHUNK;
}

GONIO_I_VECTORISED static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = 0; k < n; k++) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* B = Q diag(1/(d - mu)) Q' */
static void fill_resolvent(gonio_i_filter *f, const double *q, const double *d)
{
    const size_t k = f->problem->components;
    memset(f->resolvent, 0, k * k * sizeof *f->resolvent);
    f->below = 0;
    for (size_t j = 0; j < k; j++) {
        const double weight = 1.0 / (d[j] - f->mu);
        f->below += d[j] < f->mu;
        for (size_t a = 0; a < k; a++) {
            const double scaled = weight * q[j * k + a];
            for (size_t b = 0; b < k; b++) {
                f->resolvent[a * k + b] += scaled * q[j * k + b];
            }
        }
    }
}

/* b_u = 1 + u'Bu for a chunk of rows. */
static gonio_status fill_gains(gonio_i_filter *f, size_t chunk, double *product)
{
    const size_t k = f->problem->components;
    const size_t first = chunk * CHUNK;
    const size_t rows = chunk_rows(f->problem->rows, chunk);
    const double *u = f->problem->vectors + first * k;
    const gonio_status status =
        gonio_i_product_transposed(f->problem->context, u, rows, k, f->resolvent, k, product, k);
    for (size_t i = 0; i < rows && status == GONIO_OK; i++) {
        f->gain[first + i] = 1.0 + dot(u + i * k, product + i * k, k);
    }
    return status;
}

gonio_status gonio_i_filter_refresh(gonio_i_filter *f, const double *q, const double *d, double mu)
{
    const size_t k = f->problem->components;
    gonio_context *context = f->problem->context;
    f->mu = mu;
    for (size_t j = 0; j < k; j++) {
        if (fabs(f->mu - d[j]) < 1e-10 * d[j]) {
            f->mu = d[j] * (1.0 - 1e-10); /* off the pole; a smaller mu only lets more pass */
        }
    }
    fill_resolvent(f, q, d);
    f->batch = 0;
    f->updates = 0;
    gonio_status result = GONIO_OK;
#pragma omp parallel num_threads(gonio_context_threads(context))
    {
        double *product = gonio_i_allocate(context, CHUNK * k, sizeof *product);
        gonio_status mine = product != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
#pragma omp for schedule(static)
        for (size_t chunk = 0; chunk < chunk_count(f->problem->rows); chunk++) {
            mine = mine == GONIO_OK ? fill_gains(f, chunk, product) : mine;
        }
        free(product);
        if (mine != GONIO_OK) {
#pragma omp atomic write
            result = mine;
        }
    }
    return result;
}

gonio_status gonio_i_filter_load(gonio_i_filter *f, const double *x, size_t position)
{
    const gonio_i_selection_problem *p = f->problem;
    const size_t k = p->components;
    if (position >= f->first && position < f->first + f->batch) {
        return GONIO_OK;
    }
    f->first = position;
    f->batch = p->count - position < GONIO_I_BATCH ? p->count - position : GONIO_I_BATCH;
    gonio_status result = gonio_i_product_transposed(p->context, x + position * k, f->batch, k,
                                                     f->resolvent, k, f->bv, k);
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(p->context))
    for (size_t chunk = 0; chunk < chunk_count(p->rows); chunk++) {
        const gonio_status mine = gonio_i_product_transposed(
            p->context, f->bv, f->batch, k, p->vectors + chunk * CHUNK * k,
            chunk_rows(p->rows, chunk), f->w + chunk * CHUNK, p->rows);
        if (mine != GONIO_OK) {
#pragma omp atomic write
            result = mine;
        }
    }
    return result;
}

static const double *w_of(const gonio_i_filter *f, size_t position)
{
    return f->w + (position - f->first) * f->problem->rows;
}

static double loss_of(const gonio_i_filter *f, const double *x, size_t position)
{
    const size_t k = f->problem->components;
    return 1.0 - dot(x + position * k, f->bv + (position - f->first) * k, k);
}

/* pass[u]: p_v b_u + w^2 on the right side of 0, up to rounding (`slack`). */
GONIO_I_VECTORISED static void mark(const double *gain, const double *w, double loss, double sign,
                                    size_t n, unsigned char *pass)
{
    const double slack = 1e-7;
    for (size_t u = 0; u < n; u++) {
        const double kept = sign * loss * gain[u];
        const double square = sign * w[u] * w[u];
        pass[u] = kept + square + slack * (fabs(kept) + fabs(square)) > 0.0;
    }
}

size_t gonio_i_filter_survivors(gonio_i_filter *f, const double *x, size_t position,
                                size_t *survivors)
{
    const size_t rows = f->problem->rows;
    const double loss = loss_of(f, x, position);
    if (f->below > 1 || (f->below == 1 && loss < -1e-7)) {
        return 0;
    }
    mark(f->gain, w_of(f, position), loss, f->below == 0 ? 1.0 : -1.0, rows, f->pass);
    size_t count = 0;
    for (size_t u = 0; u < rows; u++) {
        survivors[count] = u;
        count += f->pass[u];
    }
    return count;
}

/* C = (diag(-1, 1) + P'BP)^-1 for P = [v u]: B becomes B - [Bv Bu] C [Bv Bu]'. */
typedef struct woodbury {
    double vv, vu, uu;
} woodbury;

static woodbury woodbury_of(double v_b_v, double v_b_u, double u_b_u)
{
    const double a = v_b_v - 1.0;
    const double c = u_b_u + 1.0;
    const double determinant = a * c - v_b_u * v_b_u;
    return (woodbury){c / determinant, -v_b_u / determinant, a / determinant};
}

GONIO_I_VECTORISED static void update_gains(const double *w_out, const double *w_in, woodbury c,
                                            size_t n, double *gain)
{
    for (size_t u = 0; u < n; u++) {
        gain[u] -= w_out[u] * (c.vv * w_out[u] + 2.0 * c.vu * w_in[u]) + c.uu * w_in[u] * w_in[u];
    }
}

/* w -= out w_out + in w_in */
GONIO_I_VECTORISED static void update_w(const double *w_out, const double *w_in, double out,
                                        double in, size_t n, double *w)
{
    for (size_t u = 0; u < n; u++) {
        w[u] -= out * w_out[u] + in * w_in[u];
    }
}

static void update_matrix(gonio_i_filter *f, const double *bv, const double *bu, woodbury c)
{
    const size_t k = f->problem->components;
    for (size_t a = 0; a < k; a++) {
        for (size_t b = 0; b < k; b++) {
            f->resolvent[a * k + b] -=
                bv[a] * (c.vv * bv[b] + c.vu * bu[b]) + bu[a] * (c.vu * bv[b] + c.uu * bu[b]);
        }
    }
}

gonio_status gonio_i_filter_swap(gonio_i_filter *f, const double *x, size_t position, size_t in)
{
    const gonio_i_selection_problem *p = f->problem;
    const size_t k = p->components;
    const double *u = p->vectors + in * k;
    const double *v = x + position * k;
    double *bu = gonio_i_allocate(p->context, 2 * k, sizeof *bu);
    if (bu == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double *bv = bu + k;
    memcpy(bv, f->bv + (position - f->first) * k, k * sizeof *bv);
    gonio_status status = gonio_i_product_transposed(p->context, u, 1, k, f->resolvent, k, bu, k);
    const woodbury c = woodbury_of(dot(v, bv, k), dot(u, bv, k), dot(u, bu, k));
    /* Later positions of the batch only: the search does not go back within one. */
    const size_t last = f->first + f->batch;
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(p->context))
    for (size_t chunk = 0; chunk < chunk_count(p->rows); chunk++) {
        const size_t first = chunk * CHUNK;
        const size_t rows = chunk_rows(p->rows, chunk);
        const double *w_out = w_of(f, position) + first;
        double *w_in = f->w_in + first;
        const gonio_status mine = gonio_i_product_transposed(
            p->context, bu, 1, k, p->vectors + first * k, rows, w_in, p->rows);
        update_gains(w_out, w_in, c, rows, f->gain + first);
        for (size_t j = position + 1; j < last; j++) {
            const double bv_x = dot(bv, x + j * k, k);
            const double bu_x = dot(bu, x + j * k, k);
            update_w(w_out, w_in, c.vv * bv_x + c.vu * bu_x, c.vu * bv_x + c.uu * bu_x, rows,
                     f->w + (j - f->first) * p->rows + first);
        }
        if (mine != GONIO_OK) {
#pragma omp atomic write
            status = mine;
        }
    }
    update_matrix(f, bv, bu, c);
    for (size_t j = position + 1; j < last && status == GONIO_OK; j++) {
        status = gonio_i_product_transposed(p->context, x + j * k, 1, k, f->resolvent, k,
                                            f->bv + (j - f->first) * k, k);
    }
    f->below = 0; /* that is what passing means */
    f->updates++;
    free(bu);
    return status;
}
