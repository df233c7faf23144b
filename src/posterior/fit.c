/* One column's Gaussian problem: see fit.h. */
#include "fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

/* Weights below this do not count among the samples. */
static const double NEGLIGIBLE = 1e-7;

/* Readings as expected to which the misfit is shrunk. */
static const double PRIOR_READINGS = 5.0;

/* The variance of a reading without weight. */
static const double NO_SAY = 1e6;

/* The number of readings at which h^2 is 1/2. */
static const double HALF_KEPT = 5.0;

double gonio_i_kernel_width(size_t n)
{
    return sqrt((double)n / ((double)n + HALF_KEPT));
}

double gonio_i_fit_noise(const gonio_i_fit *e, size_t reading)
{
    return e->left_out[reading] ? NO_SAY : e->variance[reading];
}

static gonio_status allocate(gonio_i_fit *e)
{
    gonio_context *c = e->context;
    const size_t n = e->n;
    e->y = gonio_i_allocate(c, n, sizeof *e->y);
    e->variance = gonio_i_allocate(c, n, sizeof *e->variance);
    e->bound = gonio_i_allocate(c, n, sizeof *e->bound);
    e->left_out = gonio_i_allocate(c, n, sizeof *e->left_out);
    e->lower = gonio_i_allocate(c, n * n, sizeof *e->lower);
    e->white = gonio_i_allocate(c, e->samples * n, sizeof *e->white);
    e->weight = gonio_i_allocate(c, e->samples, sizeof *e->weight);
    e->centre = gonio_i_allocate(c, e->components, sizeof *e->centre);
    e->rest = gonio_i_allocate(c, n, sizeof *e->rest);
    e->solved = gonio_i_allocate(c, n, sizeof *e->solved);
    const bool done = e->y && e->variance && e->bound && e->left_out && e->lower && e->white &&
                      e->weight && e->centre && e->rest && e->solved;
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

void gonio_i_fit_end(gonio_i_fit *e)
{
    free(e->y);
    free(e->variance);
    free(e->bound);
    free(e->left_out);
    free(e->lower);
    free(e->inverse);
    free(e->inverted);
    free(e->diagonal);
    free(e->white);
    free(e->weight);
    free(e->centre);
    free(e->rest);
    free(e->solved);
    *e = (gonio_i_fit){0};
}

void gonio_i_fit_read(gonio_i_fit *e, const gonio_i_column *column)
{
    for (size_t i = 0; i < e->n; i++) {
        const gonio_i_observation *o = &column->observation[i];
        e->y[i] = o->g - e->sites->mean[i];
        e->variance[i] = o->variance;
        e->bound[i] = o->bound;
        e->left_out[i] = false;
    }
    e->misfit = 1.0;
    e->is_inverted = false;
}

gonio_status gonio_i_fit_begin(gonio_context *context, const gonio_i_sites *sites, bool plain,
                               const gonio_i_column *column, gonio_i_fit *e)
{
    *e = (gonio_i_fit){.context = context,
                       .sites = sites,
                       .prior = sites->prior,
                       .n = sites->n,
                       .components = sites->components,
                       .samples = plain ? 0 : sites->prior->samples};
    const gonio_status status = allocate(e);
    if (status == GONIO_OK) {
        gonio_i_fit_read(e, column);
    }
    return status;
}

/* S between two readings, without noise; at: where they are in the matrices of the sites. */
static inline double covariance(const gonio_i_sites *s, const gonio_i_model *m, size_t at)
{
    double k = s->smooth[at] + m->peak * m->peak * s->peaked[at];
    k += m->retro > 0.0 && s->back != NULL ? m->retro * m->retro * s->back[at] : 0.0;
    return m->h * m->h * s->gram[at] + m->alpha * m->alpha * k;
}

/* L of S; the sum of the logarithms of its diagonal goes to `logarithm`. */
static gonio_status factorise(gonio_i_fit *e, double *logarithm)
{
    const size_t n = e->n;
    e->is_inverted = false;
    for (size_t i = 0; i < n; i++) {
        for (size_t at = i * n; at <= i * n + i; at++) {
            e->lower[at] = covariance(e->sites, &e->model, at);
        }
        e->lower[i * n + i] += gonio_i_fit_noise(e, i);
    }
    const gonio_status status = gonio_i_cholesky(e->context, e->lower, n);
    *logarithm = 0.0;
    for (size_t i = 0; i < n && status == GONIO_OK; i++) {
        *logarithm += log(e->lower[i * n + i]);
    }
    return status;
}

/* weight: from logarithms to numbers that add up to 1; returns the logarithm of their sum. */
static double normalise(double *weight, size_t count)
{
    double most = -INFINITY;
    double sum = 0.0;
    for (size_t j = 0; j < count; j++) {
        most = fmax(most, weight[j]);
    }
    for (size_t j = 0; j < count; j++) {
        weight[j] = exp(weight[j] - most);
        sum += weight[j];
    }
    for (size_t j = 0; j < count; j++) {
        weight[j] /= sum;
    }
    return most + log(sum);
}

static double square_sum(const double *a, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * a[i];
    }
    return sum;
}

static double shrink(const gonio_i_model *model)
{
    return sqrt(1.0 - model->h * model->h);
}

/* ln q_j, without the normalisation. */
static double log_weight(const gonio_i_fit *e, size_t j)
{
    return log(e->prior->share[j]) - 0.5 * square_sum(e->white + j * e->n, e->n);
}

/* q and z; and in e->evidence the logarithm of sum_j share_j exp(-|...|^2/2). */
static void weigh_samples(gonio_i_fit *e)
{
    const size_t n = e->n;
    const size_t samples = e->samples;
    const double a = shrink(&e->model);
    for (size_t j = 0; j < samples; j++) {
        for (size_t i = 0; i < n; i++) {
            e->white[j * n + i] = e->y[i] - a * e->sites->seen[j * n + i];
        }
    }
    gonio_i_divide_triangle(e->white, samples, n, e->lower);
    for (size_t j = 0; j < samples; j++) {
        e->weight[j] = log_weight(e, j);
    }
    e->evidence = normalise(e->weight, samples);
    for (size_t j = 0; j < samples; j++) {
        for (size_t k = 0; k < e->components; k++) {
            e->centre[k] += a * e->weight[j] * e->prior->sample[j * e->components + k];
        }
    }
}

gonio_status gonio_i_fit_solve(gonio_i_fit *e, const gonio_i_model *model)
{
    double logarithm = 0.0;
    e->model = *model;
    if (e->samples == 0) {
        e->model.h = 1.0;
    }
    const bool mixture = e->model.h < 1.0; /* otherwise the samples have no effect */
    const gonio_status status = factorise(e, &logarithm);
    if (status != GONIO_OK) {
        return status;
    }
    memset(e->centre, 0, e->components * sizeof *e->centre);
    if (mixture) {
        weigh_samples(e);
    }
    for (size_t i = 0; i < e->n; i++) {
        e->rest[i] = e->y[i];
        for (size_t k = 0; k < e->components; k++) {
            e->rest[i] -= e->sites->f[i * e->components + k] * e->centre[k];
        }
        e->solved[i] = e->rest[i];
    }
    gonio_i_divide_triangle(e->solved, 1, e->n, e->lower);
    const double square = square_sum(e->solved, e->n);
    gonio_i_divide_lower(e->solved, 1, e->n, e->lower);
    const double mixed = mixture ? e->evidence : -0.5 * square;
    e->evidence = mixed - logarithm - 0.5 * (double)e->n * log(2.0 * M_PI);
    for (size_t i = 0; i < e->n; i++) {
        /* That a bound holds is a probability: 1 if it is left out, and never more than 1. */
        e->evidence += e->bound[i] != 0 ? 0.5 * log(2.0 * M_PI * gonio_i_fit_noise(e, i)) : 0.0;
    }
    return GONIO_OK;
}

/* The readings that are not left out: kept[n]. Returns how many. */
static size_t list_kept(const gonio_i_fit *e, size_t *kept)
{
    size_t count = 0;
    for (size_t i = 0; i < e->n; i++) {
        kept[count] = i;
        count += !e->left_out[i];
    }
    return count;
}

/* S of the readings that are kept in place of L, and what they solve. value: [count]. */
static gonio_status solve_kept(gonio_i_fit *e, const size_t *kept, size_t count, double *value)
{
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j <= i; j++) {
            e->lower[i * count + j] = covariance(e->sites, &e->model, kept[i] * e->n + kept[j]);
        }
        e->lower[i * count + i] += e->variance[kept[i]];
        value[i] = e->y[kept[i]];
    }
    const gonio_status status = gonio_i_cholesky(e->context, e->lower, count);
    if (status == GONIO_OK) {
        gonio_i_divide_triangle(value, 1, count, e->lower);
        gonio_i_divide_lower(value, 1, count, e->lower);
    }
    return status;
}

gonio_status gonio_i_fit_solve_kept(gonio_i_fit *e, const gonio_i_model *model)
{
    size_t *kept = gonio_i_allocate(e->context, e->n, sizeof *kept);
    double *value = gonio_i_allocate(e->context, e->n, sizeof *value);
    gonio_status status = kept == NULL || value == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    e->model = *model;
    e->is_inverted = false;
    if (status == GONIO_OK) {
        const size_t count = list_kept(e, kept);
        status = solve_kept(e, kept, count, value);
        memset(e->solved, 0, e->n * sizeof *e->solved);
        for (size_t i = 0; i < count; i++) {
            e->solved[kept[i]] = value[i];
        }
    }
    free(kept);
    free(value);
    return status;
}

size_t gonio_i_fit_samples(const gonio_i_fit *e, size_t *listed)
{
    size_t count = 0;
    for (size_t j = 0; j < e->samples; j++) {
        listed[count] = j;
        count += e->weight[j] > NEGLIGIBLE;
    }
    return count;
}

void gonio_i_fit_coefficients(const gonio_i_fit *e, double *c)
{
    memcpy(c, e->centre, e->components * sizeof *c);
    for (size_t i = 0; i < e->n; i++) {
        for (size_t k = 0; k < e->components; k++) {
            c[k] += e->model.h * e->model.h * e->solved[i] * e->sites->f[i * e->components + k];
        }
    }
}

/* Sample j's difference at reading i is d_j = (S^-1 (y - a F z_j))_i v, v = 1/(S^-1)_ii; without
 * that reading its weight would be q_j / N(d_j; 0, v), but for what makes them add up to 1. */
static gonio_status mix_differences(const gonio_i_fit *e, double *difference, double *variance)
{
    const size_t n = e->n;
    const size_t samples = e->samples;
    double *solved = gonio_i_allocate(e->context, samples * n, sizeof *solved);
    double *whole = gonio_i_allocate(e->context, samples, sizeof *whole);
    double *weight = gonio_i_allocate(e->context, samples, sizeof *weight);
    const bool done = solved != NULL && whole != NULL && weight != NULL;
    if (done) {
        memcpy(solved, e->white, samples * n * sizeof *solved);
        gonio_i_divide_lower(solved, samples, n, e->lower);
    }
    for (size_t j = 0; j < samples && done; j++) {
        whole[j] = log_weight(e, j);
    }
    for (size_t i = 0; i < n && done; i++) {
        const double v = variance[i];
        double mean = 0.0;
        double square = 0.0;
        for (size_t j = 0; j < samples; j++) {
            const double d = solved[j * n + i] * v;
            weight[j] = whole[j] + 0.5 * d * d / v;
        }
        normalise(weight, samples);
        for (size_t j = 0; j < samples; j++) {
            const double d = solved[j * n + i] * v;
            mean += weight[j] * d;
            square += weight[j] * d * d;
        }
        difference[i] = mean;
        variance[i] = v + fmax(square - mean * mean, 0.0);
    }
    free(solved);
    free(whole);
    free(weight);
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* Of a fit that keeps its inverse, which is made of L unless it is there. */
static gonio_status find_kept_diagonal(gonio_i_fit *e, double *diagonal)
{
    gonio_status status = GONIO_OK;
    if (!e->is_inverted) {
        status = gonio_i_inverse_of_factor(e->context, e->lower, e->n, e->inverse);
    }
    for (size_t i = 0; i < e->n && !e->is_inverted && status == GONIO_OK; i++) {
        e->inverted[i] = gonio_i_fit_noise(e, i);
        e->diagonal[i] = e->inverse[i * e->n + i];
    }
    e->is_inverted = status == GONIO_OK;
    memcpy(diagonal, e->diagonal, e->n * sizeof *diagonal);
    return status;
}

/* Of a Gaussian without one of its values: the difference (S^-1 r)_i / (S^-1)_ii of variance
 * 1/(S^-1)_ii (Sundararajan and Keerthi 2001). */
gonio_status gonio_i_fit_leave_one_out(gonio_i_fit *e, double *difference, double *variance)
{
    const gonio_status status =
        e->inverse != NULL ? find_kept_diagonal(e, variance)
                           : gonio_i_inverse_diagonal(e->context, e->lower, e->n, variance);
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        variance[i] = 1.0 / variance[i];
        difference[i] = e->solved[i] * variance[i];
    }
    return status == GONIO_OK && e->model.h < 1.0 ? mix_differences(e, difference, variance)
                                                  : status;
}

gonio_status gonio_i_fit_surprise(gonio_i_fit *e, double *sum)
{
    double *difference = gonio_i_allocate(e->context, 2 * e->n, sizeof *difference);
    gonio_status status = difference == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    *sum = 0.0;
    if (status == GONIO_OK) {
        status = gonio_i_fit_leave_one_out(e, difference, difference + e->n);
    }
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        *sum += difference[i] * difference[i] / difference[e->n + i];
    }
    e->misfit = (*sum + PRIOR_READINGS) / ((double)e->n + PRIOR_READINGS);
    free(difference);
    return status;
}
