/* The posterior of an anisotropic material at a place, and what is to be expected of it: see
 * anisotropic.h.
 *
 * Under a hypothesis, with f and k where the stretch takes the half vectors, and
 *     w_i = h^2 (1 - share + share kappa_i) f f_i' + alpha^2 kappa_i k_i,
 * the mean is m + f z + w S^-1 (y - F z), and the variance
 *     h^2 f f' + alpha^2 k - w S^-1 w' + sum_j q_j (a f (z_j - z) - w S^-1 a F (z_j - z))^2.
 * These are of the isotropic material; values of facets are then multiplied by their factor. */
#include "anisotropic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "anisotropic_parts.h"
#include "parallel_for.h"

enum { SAMPLE = 512 };

/* From the variances to those of materials that were left out, as in variance.c. */
static const double BAND_FACTOR = 1.5;
static const double BAND_LEFT_OPEN = 0.01;
static const double SQUARE_FACTOR = 1.44;
static const double SQUARE_LEFT_OPEN = 0.05;

/* ---- prediction ---- */

/* What a place is under a hypothesis; the arrays are scratch. */
typedef struct view_of_place {
    gonio_i_place place;
    gonio_i_azimuth_point azimuth;
    double mean;
    double *f; /* [K] */
    double *w; /* [n] */
} view_of_place;

size_t gonio_i_anisotropic_scratch(const gonio_i_anisotropic *a)
{
    return a->prior->components + a->most + 2 * a->columns;
}

/* f f_i' is known to be needed where the covariance depends on the azimuth, or for variances. */
static void see_readings(const gonio_i_stretch *stretch, const gonio_i_solution *s, bool variance,
                         view_of_place *v)
{
    const gonio_i_sites *sites = s->sites;
    const gonio_i_model *m = &s->fit.model;
    const double turning = m->h * m->h * stretch->share;
    const double common = variance ? m->h * m->h * (1.0 - stretch->share) : 0.0;
    for (size_t i = 0; i < sites->n; i++) {
        const double kernel = gonio_i_azimuth_kernel(v->azimuth, s->azimuth[i]);
        const double amount = turning * kernel + common;
        v->w[i] = amount > 1e-9 ? amount * gonio_i_dot(v->f, sites->f + i * sites->components,
                                                       sites->components)
                                : 0.0;
        v->w[i] += m->alpha > 0.0 ? m->alpha * m->alpha * kernel *
                                        gonio_i_stretch_remainder(
                                            stretch, &v->place, &sites->place[i], m->peak, m->retro)
                                  : 0.0;
    }
}

static double mean_of(const gonio_i_solution *s, const view_of_place *v)
{
    const gonio_i_fit *e = &s->fit;
    return v->mean + gonio_i_dot(v->f, s->linear, e->components) +
           gonio_i_dot(v->w, e->solved, e->n);
}

/* The mean again, from z alone: w has what `linear` has otherwise. */
static double mean_with_all(const gonio_i_solution *s, const view_of_place *v)
{
    const gonio_i_fit *e = &s->fit;
    return v->mean + gonio_i_dot(v->f, e->centre, e->components) +
           gonio_i_dot(v->w, e->solved, e->n);
}

/* Overwrites w. */
static double variance_of(const gonio_i_solution *s, view_of_place *v)
{
    const gonio_i_fit *e = &s->fit;
    const gonio_i_model *m = &e->model;
    double sum = m->h * m->h * gonio_i_dot(v->f, v->f, e->components) +
                 m->alpha * m->alpha * gonio_i_remainder(&v->place, &v->place, m->peak, m->retro);
    for (size_t j = 0; j < s->samples; j++) {
        const double apart = gonio_i_dot(v->f, s->move + j * e->components, e->components) -
                             gonio_i_dot(v->w, s->answered + j * e->n, e->n);
        sum += s->weight[j] * apart * apart;
    }
    gonio_i_divide_triangle(v->w, 1, e->n, e->lower);
    sum -= gonio_i_dot(v->w, v->w, e->n);
    return e->misfit * fmax(sum, 0.0);
}

/* Under one hypothesis: adds to g, and to the variance its own plus the square of the mean. */
static void add_part(const gonio_i_anisotropic *a, const gonio_i_part *p, gonio_i_oriented here,
                     view_of_place *v, double *g, double *variance)
{
    const gonio_i_stretch *stretch = &p->hypothesis.stretch;
    const double weight = p->hypothesis.weight;
    const gonio_half_difference there = gonio_i_stretch_apply(stretch, here);
    const double factor = gonio_i_stretch_log_factor(stretch, here);
    v->place = gonio_i_place_of(there);
    v->azimuth = gonio_i_azimuth_of(stretch, here);
    gonio_i_prior_at(a->prior, there, 0, &v->mean, v->f);
    for (size_t c = 0; c < a->columns; c++) {
        const gonio_i_solution *s = &p->solution[c];
        if (variance != NULL || c == 0 || s->sites != p->solution[c - 1].sites) {
            see_readings(stretch, s, variance != NULL, v);
        }
        double slope = 1.0;
        const double mean = gonio_i_multiplied(
            variance != NULL ? mean_with_all(s, v) : mean_of(s, v), factor, &slope);
        g[c] += weight * mean;
        if (variance != NULL) {
            variance[c] += weight * (slope * slope * variance_of(s, v) + mean * mean);
        }
    }
}

void gonio_i_anisotropic_at(const gonio_i_anisotropic *a, gonio_i_oriented here, double *scratch,
                            double *g, double *variance)
{
    view_of_place v = {.f = scratch, .w = scratch + a->prior->components};
    memset(g, 0, a->columns * sizeof *g);
    if (variance != NULL) {
        memset(variance, 0, a->columns * sizeof *variance);
    }
    for (size_t p = 0; p < a->parts; p++) {
        add_part(a, &a->part[p], here, &v, g, variance);
    }
    for (size_t c = 0; variance != NULL && c < a->columns; c++) {
        variance[c] = fmax(variance[c] - g[c] * g[c], 0.0);
    }
}

double gonio_i_anisotropic_band(double variance)
{
    return sqrt(BAND_FACTOR * variance + BAND_LEFT_OPEN * BAND_LEFT_OPEN);
}

double gonio_i_anisotropic_square(double variance)
{
    return SQUARE_FACTOR * variance + SQUARE_LEFT_OPEN * SQUARE_LEFT_OPEN;
}

/* ---- the error to expect ---- */

typedef struct expectation {
    const gonio_i_anisotropic *a;
    const gonio_i_oriented *place;
    double *error;  /* [SAMPLE] */
    double *square; /* [SAMPLE] */
} expectation;

static gonio_status expect_at(void *data, gonio_context *context, size_t k)
{
    const expectation *x = data;
    const size_t columns = x->a->columns;
    const size_t size = gonio_i_anisotropic_scratch(x->a);
    double *scratch = gonio_i_allocate(context, size + 2 * columns, sizeof *scratch);
    if (scratch == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double *g = scratch + size;
    double *variance = g + columns;
    gonio_i_anisotropic_at(x->a, x->place[k], scratch, g, variance);
    for (size_t c = 0; c < columns; c++) {
        x->error[k] += gonio_i_anisotropic_square(variance[c]);
        x->square[k] += fmax(g[c], 0.0) * fmax(g[c], 0.0);
    }
    free(scratch);
    return GONIO_OK;
}

gonio_status gonio_i_anisotropic_expect(gonio_context *context, const gonio_i_anisotropic *a,
                                        double *e6, double *norm)
{
    gonio_i_steps steps = {.task = NULL};
    gonio_i_oriented *place = gonio_i_allocate(context, SAMPLE, sizeof *place);
    double *sums = gonio_i_allocate(context, 2 * (size_t)SAMPLE, sizeof *sums);
    gonio_status status = place == NULL || sums == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        expectation x = {a, place, sums, sums + SAMPLE};
        gonio_i_oriented_sample(0, SAMPLE, place);
        status = gonio_i_parallel_for(context, &steps, SAMPLE, expect_at, &x);
    }
    double error = 0.0;
    double square = 0.0;
    for (size_t k = 0; k < SAMPLE && status == GONIO_OK; k++) {
        error += sums[k];
        square += sums[SAMPLE + k];
    }
    *e6 = status == GONIO_OK ? 100.0 * sqrt(error / (square + error)) : 0.0;
    *norm = sqrt((square + error) / (SAMPLE * fmax((double)a->columns, 1.0)));
    free(place);
    free(sums);
    return status;
}
