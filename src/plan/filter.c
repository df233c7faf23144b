/* The filter of the condition-number search: see filter.h. */
#include "filter.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include "../linalg/linalg.h"

static const double unit = FLT_EPSILON / 2.0; /* of rounding */

static bool allocate_scratch(gonio_i_filter *f)
{
    f->scratch = gonio_i_allocate(f->problem->context, (size_t)f->threads, sizeof *f->scratch);
    bool failed = f->scratch == NULL;
    for (int t = 0; t < f->threads && !failed; t++) {
        f->scratch[t] = gonio_i_panels_scratch(f->panels, &failed);
    }
    return !failed;
}

bool gonio_i_filter_allocate(const gonio_i_selection_problem *problem, const gonio_i_panels *panels,
                             int threads, gonio_i_filter *f)
{
    gonio_context *context = problem->context;
    const size_t k = problem->components;
    const size_t padded = panels->components;
    const size_t chunks = gonio_i_panels_chunks(panels);
    *f = (gonio_i_filter){.problem = problem, .panels = panels, .threads = threads};
    f->resolvent = gonio_i_allocate(context, k * k, sizeof *f->resolvent);
    f->factor = gonio_i_allocate(context, k * k, sizeof *f->factor);
    f->l = gonio_i_allocate(context, padded * padded, sizeof *f->l);
    f->columns = gonio_i_allocate(context, padded * GONIO_I_COLUMNS, sizeof *f->columns);
    f->gain = gonio_i_allocate(context, panels->rows, sizeof *f->gain);
    f->pass = gonio_i_allocate(context, GONIO_I_COLUMNS * panels->rows, 1);
    f->gain_is_set = gonio_i_allocate(context, chunks, sizeof *f->gain_is_set);
    f->batch_is_set = gonio_i_allocate(context, chunks, sizeof *f->batch_is_set);
    return allocate_scratch(f) && f->resolvent != NULL && f->factor != NULL && f->l != NULL &&
           f->columns != NULL && f->gain != NULL && f->pass != NULL && f->gain_is_set != NULL &&
           f->batch_is_set != NULL;
}

void gonio_i_filter_free(gonio_i_filter *f)
{
    for (int t = 0; f->scratch != NULL && t < f->threads; t++) {
        free(f->scratch[t]);
    }
    free(f->scratch);
    free(f->resolvent);
    free(f->factor);
    free(f->l);
    free(f->columns);
    free(f->gain);
    free(f->pass);
    free(f->gain_is_set);
    free(f->batch_is_set);
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
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
    f->blind = gonio_i_cholesky(NULL, f->factor, k) != GONIO_OK;
    for (size_t a = 0; a < k; a++) {
        for (size_t b = 0; b <= a; b++) {
            f->l[a * padded + b] = (float)f->factor[a * k + b];
        }
    }
    f->gain_margin =
        (float)(((double)padded + 4.0) * unit * sqrt(dot(f->factor, f->factor, k * k)) * 1.001);
    memset(f->gain_is_set, 0, gonio_i_panels_chunks(f->panels) * sizeof *f->gain_is_set);
    f->batch = 0;
    f->fresh = true;
}

/* Bv of one position as a column in single precision, with what goes with it. */
static void fill_column(gonio_i_filter *f, const double *v, size_t j)
{
    const size_t k = f->problem->components;
    double squares = 0.0;
    double loss = -1.0;
    for (size_t a = 0; a < k; a++) {
        const double bv = dot(f->resolvent + a * k, v, k);
        f->columns[a * f->test.columns + j] = (float)bv;
        loss += v[a] * bv;
        squares += bv * bv;
    }
    f->all_pass[j] = f->blind || loss < 1e-6;
    f->test.loss[j] = (float)(loss * (1.0 - 1e-6));
    f->test.margin[j] =
        (float)(((double)f->panels->components + 4.0) * unit * sqrt(squares) * 1.001);
}

void gonio_i_filter_turn_to(gonio_i_filter *f, const double *x, size_t position)
{
    const size_t k = f->problem->components;
    if (position >= f->first && position < f->first + f->batch) {
        return;
    }
    const size_t columns = f->fresh ? 1 : GONIO_I_COLUMNS;
    const size_t rest = f->problem->count - position;
    f->fresh = false;
    f->first = position;
    f->batch = rest < columns ? rest : columns;
    f->test = (gonio_i_test){.columns = columns, .c = f->columns};
    memset(f->columns, 0, f->panels->components * columns * sizeof *f->columns);
    for (size_t j = 0; j < f->batch; j++) {
        fill_column(f, x + (position + j) * k, j);
    }
    memset(f->batch_is_set, 0, gonio_i_panels_chunks(f->panels) * sizeof *f->batch_is_set);
}

static void look_at(gonio_i_filter *f, size_t index, float *scratch)
{
    const gonio_i_chunk chunk = gonio_i_panels_chunk(f->panels, index, scratch);
    if (!f->gain_is_set[index]) {
        gonio_i_chunk_gain(&chunk, f->l, f->gain_margin, f->gain + chunk.first);
        f->gain_is_set[index] = true;
    }
    gonio_i_test test = f->test;
    test.gain = f->gain + chunk.first;
    gonio_i_chunk_mark(&chunk, &test, f->pass + chunk.first, f->panels->rows);
    f->batch_is_set[index] = true;
}

void gonio_i_filter_look(gonio_i_filter *f, size_t chunk, size_t count)
{
    const size_t chunks = gonio_i_panels_chunks(f->panels);
    size_t missing = 0;
    for (size_t step = 0; step < count; step++) {
        missing += !f->batch_is_set[(chunk + step) % chunks];
    }
    if (f->blind || missing == 0) {
        return;
    }
#pragma omp parallel for schedule(dynamic) num_threads(f->threads) if (missing > 1)
    for (size_t step = 0; step < count; step++) {
        const size_t index = (chunk + step) % chunks;
        if (!f->batch_is_set[index]) {
            look_at(f, index, f->scratch[omp_get_thread_num()]);
        }
    }
}

size_t gonio_i_filter_survivors(const gonio_i_filter *f, size_t position, size_t first, size_t last,
                                size_t *survivors)
{
    const size_t j = position - f->first;
    const unsigned char *pass = f->pass + j * f->panels->rows;
    size_t count = 0;
    for (size_t u = first; u < last; u++) {
        survivors[count] = u;
        count += f->all_pass[j] || pass[u];
    }
    return count;
}
