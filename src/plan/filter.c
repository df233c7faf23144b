/* The filter of the condition-number search: see filter.h. */
#include "filter.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

enum { CHUNK = 64 }; /* panels worked on at a time by one thread */

static const double unit = FLT_EPSILON / 2.0; /* of rounding */

bool gonio_i_filter_allocate(const gonio_i_selection_problem *problem, const gonio_i_panels *panels,
                             int threads, gonio_i_filter *f)
{
    gonio_context *context = problem->context;
    const size_t k = problem->components;
    const size_t padded = panels->components;
    *f = (gonio_i_filter){.problem = problem, .panels = panels, .threads = threads};
    f->rows = panels->count * GONIO_I_PANEL;
    f->resolvent = gonio_i_allocate(context, k * k, sizeof *f->resolvent);
    f->factor = gonio_i_allocate(context, k * k, sizeof *f->factor);
    f->gain = gonio_i_allocate(context, f->rows, sizeof *f->gain);
    f->w = gonio_i_allocate(context, GONIO_I_COLUMNS * f->rows, sizeof *f->w);
    f->columns = gonio_i_allocate(context, padded * padded, sizeof *f->columns);
    f->pass = gonio_i_allocate(context, f->rows, 1);
    return f->resolvent != NULL && f->factor != NULL && f->gain != NULL && f->w != NULL &&
           f->columns != NULL && f->pass != NULL;
}

void gonio_i_filter_free(gonio_i_filter *f)
{
    free(f->resolvent);
    free(f->factor);
    free(f->gain);
    free(f->w);
    free(f->columns);
    free(f->pass);
}

static size_t chunk_count(const gonio_i_filter *f)
{
    return (f->panels->count + CHUNK - 1) / CHUNK;
}

static size_t chunk_end(const gonio_i_filter *f, size_t chunk)
{
    const size_t end = (chunk + 1) * CHUNK;
    return end < f->panels->count ? end : f->panels->count;
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* B = Q diag(1/(d - mu)) Q' */
GONIO_I_VECTORISED static void fill_resolvent(size_t k, const double *restrict q, const double *d,
                                              double mu, double *restrict resolvent)
{
    memset(resolvent, 0, k * k * sizeof *resolvent);
    for (size_t j = 0; j < k; j++) {
        const double weight = 1.0 / (d[j] - mu);
        for (size_t a = 0; a < k; a++) {
            const double scaled = weight * q[j * k + a];
            for (size_t b = 0; b < k; b++) {
                resolvent[a * k + b] += scaled * q[j * k + b];
            }
        }
    }
}

void gonio_i_filter_set(gonio_i_filter *f, const double *q, const double *d, double mu)
{
    const size_t k = f->problem->components;
    const size_t padded = f->panels->components;
    /* Close to the pole single precision would decide little; a smaller mu only lets more pass. */
    fill_resolvent(k, q, d, fmin(mu, d[0] * (1.0 - 1e-3)), f->resolvent);
    memcpy(f->factor, f->resolvent, k * k * sizeof *f->factor);
    f->batch = 0;
    f->blind = gonio_i_cholesky(NULL, f->factor, k) != GONIO_OK;
    if (f->blind) {
        return;
    }
    memset(f->columns, 0, padded * padded * sizeof *f->columns);
    for (size_t a = 0; a < k; a++) {
        for (size_t b = 0; b <= a; b++) {
            f->columns[a * padded + b] = (float)f->factor[a * k + b];
        }
    }
    f->gain_margin = ((double)padded + 4.0) * unit * sqrt(dot(f->factor, f->factor, k * k));
#pragma omp parallel for schedule(static) num_threads(f->threads)
    for (size_t chunk = 0; chunk < chunk_count(f); chunk++) {
        gonio_i_panels_gain(f->panels, chunk * CHUNK, chunk_end(f, chunk), f->columns, f->gain);
    }
}

/* Bv of a batch of positions as padded single-precision columns, with what goes with each. */
static void fill_columns(gonio_i_filter *f, const double *x)
{
    const size_t k = f->problem->components;
    memset(f->columns, 0, f->panels->components * GONIO_I_COLUMNS * sizeof *f->columns);
    for (size_t j = 0; j < f->batch; j++) {
        const double *v = x + (f->first + j) * k;
        double squares = 0.0;
        f->loss[j] = 1.0;
        for (size_t a = 0; a < k; a++) {
            const double bv = dot(f->resolvent + a * k, v, k);
            f->columns[a * GONIO_I_COLUMNS + j] = (float)bv;
            f->loss[j] -= v[a] * bv;
            squares += bv * bv;
        }
        const double product = ((double)f->panels->components + 4.0) * unit * sqrt(squares);
        f->margins[j] = (gonio_i_margins){(float)(f->gain_margin * (1.0 + 1e-6)),
                                          (float)(product * (1.0 + 1e-6))};
    }
}

/* Computes the w of some positions from this one on. */
static void load_batch(gonio_i_filter *f, const double *x, size_t position)
{
    const gonio_i_selection_problem *p = f->problem;
    f->first = position;
    f->batch = p->count - position < GONIO_I_COLUMNS ? p->count - position : GONIO_I_COLUMNS;
    fill_columns(f, x);
#pragma omp parallel for schedule(static) num_threads(f->threads)
    for (size_t chunk = 0; chunk < chunk_count(f); chunk++) {
        gonio_i_panels_products(f->panels, chunk * CHUNK, chunk_end(f, chunk), f->columns, f->rows,
                                f->w);
    }
}

size_t gonio_i_filter_survivors(gonio_i_filter *f, const double *x, size_t position,
                                size_t *survivors)
{
    const gonio_i_selection_problem *p = f->problem;
    if (!f->blind && (position < f->first || position >= f->first + f->batch)) {
        load_batch(f, x, position);
    }
    const size_t j = position - f->first;
    if (f->blind || f->loss[j] > -1e-6) { /* all pass */
        for (size_t u = 0; u < p->rows; u++) {
            survivors[u] = u;
        }
        return p->rows;
    }
    gonio_i_mark(f->rows, f->gain, f->w + j * f->rows, f->panels->length, (float)f->loss[j],
                 f->margins[j], f->pass);
    size_t count = 0;
    for (size_t u = 0; u < p->rows; u++) {
        survivors[count] = u;
        count += f->pass[u];
    }
    return count;
}
