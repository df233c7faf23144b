/* S^-1 of a fit, kept while it settles: see fit_inverse.h. */
#include "fit_inverse.h"

#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

gonio_status gonio_i_fit_inverse_keep(gonio_i_fit *e)
{
    e->inverse = gonio_i_allocate(e->context, e->n * e->n, sizeof *e->inverse);
    e->diagonal = gonio_i_allocate(e->context, e->n, sizeof *e->diagonal);
    e->inverted = gonio_i_allocate(e->context, e->n, sizeof *e->inverted);
    return e->inverse && e->diagonal && e->inverted ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* Readings whose variances have grown since S was inverted. */
typedef struct changes {
    size_t count;
    size_t *reading; /* [n]; count are used */
    double *column;  /* [n][count]: T L'^-1 */
    double *core;    /* [count][count]: L of D^-1 + A_changed */
} changes;

static void fill_changes(const gonio_i_fit *e, const changes *c)
{
    for (size_t i = 0; i < e->n; i++) {
        for (size_t k = 0; k < c->count; k++) {
            c->column[i * c->count + k] = e->inverse[i * e->n + c->reading[k]];
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        const size_t i = c->reading[k];
        memcpy(c->core + k * c->count, c->column + i * c->count, c->count * sizeof *c->core);
        c->core[k * c->count + k] += 1.0 / (gonio_i_fit_noise(e, i) - e->inverted[i]);
    }
}

static gonio_status find_changes(const gonio_i_fit *e, changes *c)
{
    *c = (changes){.reading = gonio_i_allocate(e->context, e->n, sizeof *c->reading)};
    for (size_t i = 0; c->reading != NULL && i < e->n; i++) {
        c->reading[c->count] = i;
        c->count += gonio_i_fit_noise(e, i) > e->inverted[i];
    }
    c->column = gonio_i_allocate(e->context, e->n * c->count, sizeof *c->column);
    c->core = gonio_i_allocate(e->context, c->count * c->count, sizeof *c->core);
    if (c->reading == NULL || c->column == NULL || c->core == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    fill_changes(e, c);
    const gonio_status status = gonio_i_cholesky(e->context, c->core, c->count);
    if (status == GONIO_OK && c->count > 0) {
        gonio_i_divide_triangle(c->column, e->n, c->count, c->core);
    }
    return status;
}

static void free_changes(changes *c)
{
    free(c->reading);
    free(c->column);
    free(c->core);
}

/* A b less what the changes take out, and the diagonal. along: scratch of count. */
static void solve_changed(gonio_i_fit *e, const changes *c, double *along)
{
    const size_t count = c->count;
    gonio_i_multiply_symmetric(e->inverse, e->n, e->rest, e->solved);
    for (size_t i = 0; i < e->n; i++) {
        for (size_t k = 0; k < count; k++) {
            along[k] += c->column[i * count + k] * e->rest[i];
        }
    }
    for (size_t i = 0; i < e->n; i++) {
        const double *row = c->column + i * count;
        e->solved[i] -= gonio_i_dot(row, along, count);
        e->diagonal[i] = e->inverse[i * e->n + i] - gonio_i_dot(row, row, count);
    }
}

static bool has_grown(const gonio_i_fit *e)
{
    bool grown = e->is_inverted;
    for (size_t i = 0; i < e->n && grown; i++) {
        grown = gonio_i_fit_noise(e, i) >= e->inverted[i];
    }
    return grown;
}

gonio_status gonio_i_fit_inverse_solve(gonio_i_fit *e)
{
    changes c = {0};
    if (!has_grown(e)) {
        return gonio_i_fit_solve(e, &e->model);
    }
    gonio_status status = find_changes(e, &c);
    double *along = gonio_i_allocate(e->context, c.count, sizeof *along);
    status = along == NULL ? GONIO_ERROR_MEMORY : status;
    if (status == GONIO_OK) {
        solve_changed(e, &c, along);
    }
    free(along);
    free_changes(&c);
    return status;
}

gonio_status gonio_i_fit_inverse_complete(gonio_i_fit *e)
{
    changes c = {0};
    gonio_status status = find_changes(e, &c);
    if (status == GONIO_OK && c.count > 0) {
        status = gonio_i_subtract_gram(e->context, c.column, e->n, c.count, e->inverse);
    }
    free_changes(&c);
    return status;
}

double gonio_i_fit_inverse_trace(const gonio_i_fit *e, const double *m)
{
    double trace = 0.0;
    for (size_t i = 0; i < e->n; i++) {
        const double *a = e->inverse + i * e->n;
        trace += 2.0 * gonio_i_dot(a, m + i * e->n, i) + a[i] * m[i * e->n + i];
    }
    return trace;
}
