/* The readings that a plan may choose from: see expected_error_choices.h. */
#include "expected_error_choices.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../metric/metric.h"
#include "../prior/after_readings.h"

/* Standard deviation of a reading, log units: noise and the error of the model near the reading.
 * Chosen by errors of left-out materials: with 0.03 or 0.05 plans trust single readings too much.
 * Smaller where the covariance includes a remainder. */
const double gonio_i_noise_of_readings = 0.08;
static const double NOISE_BESIDE_REMAINDER = 0.05;

/* alpha and peak of the remainder between candidates, log units (prior/prior.h). Peaks are less
 * likely than in the models of a posterior, which the readings choose: with a peak of 4 or 8 plans
 * spend too many readings near the mirror direction (docs/experiments.md). */
static const double ALPHA = 0.2;
static const double PEAK = 2.5;

/* Variance that the factor of the candidates' covariance may omit, and that of a remainder beside
 * what is known. */
static const double LEFT = 1e-4;
static const double LEFT_OF_REMAINDER = 5e-4;

/* Square of the distance (prior.h) up to which directions are the same. */
static const double SAME = 1e-6;

/* Nearer to the normal a direction has no azimuth, radians. */
static const double POLE = 1e-6;

/* The least alpha and the share of the peak that further readings expect of what others chose. */
static const double LEAST_ALPHA = 0.03;
static const double SHARE_OF_PEAK = 2.5 / 8.0;

enum { MOST_RANK = 500, MOST_RANK_OF_REMAINDER = 200 };

double gonio_i_planned_remainder(const gonio_i_place *a, const gonio_i_place *b)
{
    return ALPHA * ALPHA * gonio_i_remainder(a, b, PEAK, 0.0);
}

static double remainder_of(const gonio_i_choices *p, const gonio_i_place *a, const gonio_i_place *b)
{
    if (p->known == NULL) {
        return gonio_i_planned_remainder(a, b);
    }
    const double alpha = fmax(p->known->alpha, LEAST_ALPHA);
    return alpha * alpha * gonio_i_remainder(a, b, SHARE_OF_PEAK * p->known->peak, 0.0);
}

static void to_float(const double *from, size_t count, float *to)
{
    for (size_t k = 0; k < count; k++) {
        to[k] = (float)from[k];
    }
}

GONIO_I_VECTORISED static double dot(const float *a, const float *b, size_t n)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++) {
        sum += (double)a[i] * (double)b[i];
    }
    return sum;
}

void gonio_i_choices_free(gonio_i_choices *p)
{
    gonio_i_prior_free(&p->prior);
    free(p->f);
    free(p->mean);
    free(p->loss);
    free(p->allowed);
    free(p->at);
    free(p->pair);
    free(p->own_covariance);
}

gonio_status gonio_i_choices_allocate(gonio_i_choices *p)
{
    gonio_context *c = p->context;
    p->f = gonio_i_allocate(c, p->rows * p->components, sizeof *p->f);
    p->mean = gonio_i_allocate(c, p->rows, sizeof *p->mean);
    p->loss = gonio_i_allocate(c, p->rows, sizeof *p->loss);
    p->allowed = gonio_i_allocate(c, p->rows, sizeof *p->allowed);
    p->at = gonio_i_allocate(c, p->rows, sizeof *p->at);
    const bool done = p->f && p->mean && p->loss && p->allowed && p->at;
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* The squared slope of a metric in g, at the mean of the prior. */
static double metric_weight(gonio_metric metric, gonio_half_difference at, double mean, int channel)
{
    double incident = 0.0;
    double outgoing = 0.0;
    gonio_cosines(at, &incident, &outgoing);
    const double s = gonio_log_scale(channel);
    const double rho = s * expm1(fmax(mean, 0.0));
    return gonio_i_metric_at((int)metric)->loss(rho, s, fmax(incident * outgoing, 0.0));
}

/* f: scratch, [components] */
static void list_row(gonio_i_choices *p, gonio_metric metric, size_t row, double *f)
{
    const gonio_basis_view *view = p->prior->view;
    int channel = 0;
    const double bins = gonio_i_row_bins(view, row);
    p->at[row] = gonio_i_row_coordinates(view, row, &channel);
    gonio_i_prior_row(p->prior, row, f);
    to_float(f, p->components, p->f + row * p->components);
    p->mean[row] = view->mean[row];
    p->allowed[row] = bins > 0.0;
    p->loss[row] = bins * metric_weight(metric, p->at[row], p->mean[row], channel);
}

/* All rows of the basis. */
gonio_status gonio_i_choices_of_rows(gonio_i_choices *p, gonio_metric metric)
{
    bool failed = false;
    p->rows = p->prior->view->rows;
    p->components = p->prior->components;
    p->noise = gonio_i_noise_of_readings;
    const gonio_status status = gonio_i_choices_allocate(p);
    if (status != GONIO_OK) {
        return status;
    }
#pragma omp parallel num_threads(gonio_context_threads(p->context))
    {
        double *f = gonio_i_allocate(p->context, p->components, sizeof *f);
        if (f == NULL) {
#pragma omp atomic write
            failed = true;
        }
#pragma omp for schedule(static)
        for (size_t row = 0; row < p->rows; row++) {
            if (f != NULL) {
                list_row(p, metric, row, f);
            }
        }
        free(f);
    }
    return failed ? GONIO_ERROR_MEMORY : GONIO_OK;
}

/* Given    rows of f[rows][k] and places of candidates, whose covariance is C = f f' + alpha^2 r
 * Returned factor[rows][most], the columns of which up to the rank that is returned are g with
 *          g g' = C to within `enough` of every variance
 * Method   Cholesky with pivoting on the largest variance left (Higham 2002, sec. 10.3); columns of
 *          C are computed when they are needed */
static size_t factorise(const gonio_i_choices *p, const float *f, size_t k,
                        const gonio_i_place *place, double *left, size_t most, double enough,
                        float *factor)
{
    for (size_t i = 0; i < p->rows; i++) {
        left[i] = dot(f + i * k, f + i * k, k) + remainder_of(p, &place[i], &place[i]);
    }
    size_t rank = 0;
    for (; rank < most; rank++) {
        size_t pivot = 0;
        for (size_t i = 1; i < p->rows; i++) {
            pivot = left[i] > left[pivot] ? i : pivot;
        }
        if (left[pivot] < enough) {
            break;
        }
        const double root = sqrt(left[pivot]);
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(p->context))
        for (size_t i = 0; i < p->rows; i++) {
            const double c =
                dot(f + i * k, f + pivot * k, k) + remainder_of(p, &place[i], &place[pivot]);
            const double known = dot(factor + i * most, factor + pivot * most, rank);
            const float entry = (float)((c - known) / root);
            factor[i * most + rank] = entry;
            left[i] -= (double)entry * (double)entry;
        }
        left[pivot] = 0.0;
    }
    return rank;
}

/* As factorise, over all candidates; factor is zero before. */
static gonio_status factorise_candidates(const gonio_i_choices *p, const float *f, size_t k,
                                         size_t most, float *factor, size_t *rank)
{
    double *left = gonio_i_allocate(p->context, p->rows, sizeof *left);
    gonio_i_place *place = gonio_i_allocate(p->context, p->rows, sizeof *place);
    if (left == NULL || place == NULL) {
        free(left);
        free(place);
        return GONIO_ERROR_MEMORY;
    }
    for (size_t i = 0; i < p->rows; i++) {
        place[i] = gonio_i_place_of(p->at[i]);
    }
    *rank = factorise(p, f, k, place, left, most, k > 0 ? LEFT : LEFT_OF_REMAINDER, factor);
    free(left);
    free(place);
    return GONIO_OK;
}

/* p->f = (f, g), g g' the covariance of the remainder: less work than a factor of the sum, and a
 * few more columns. */
static gonio_status append_remainder(gonio_i_choices *p, const float *f)
{
    const size_t k = p->components;
    const size_t most = p->rows > MOST_RANK_OF_REMAINDER ? MOST_RANK_OF_REMAINDER : p->rows;
    size_t rank = 0;
    float *joined = NULL;
    float *g = gonio_i_allocate(p->context, p->rows * most, sizeof *g);
    gonio_status status =
        g == NULL ? GONIO_ERROR_MEMORY : factorise_candidates(p, f, 0, most, g, &rank);
    if (status == GONIO_OK) {
        joined = gonio_i_allocate(p->context, p->rows * (k + rank), sizeof *joined);
        status = joined == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    }
    for (size_t row = 0; row < p->rows && status == GONIO_OK; row++) {
        float *to = joined + row * (k + rank);
        memcpy(to, f + row * k, k * sizeof *to);
        memcpy(to + k, g + row * most, rank * sizeof *to);
    }
    free(g);
    if (status == GONIO_OK) {
        free(p->f);
        p->f = joined;
        p->components = k + rank;
    }
    return status;
}

/* ---- candidates that are the same ---- */

/* A candidate with azimuths that count: 0 about the normal. */
typedef struct named_pair {
    double angle[4]; /* theta_i, phi_i, theta_o, phi_o */
    size_t candidate;
} named_pair;

static double azimuth_of(gonio_angles a)
{
    const double phi = fmod(a.phi, 2.0 * M_PI);
    return a.theta < POLE ? 0.0 : phi < 0.0 ? phi + 2.0 * M_PI : phi + 0.0; /* no -0 */
}

static int compare_angles(const named_pair *a, const named_pair *b)
{
    int order = 0;
    for (int k = 0; k < 4 && order == 0; k++) {
        order = (a->angle[k] > b->angle[k]) - (a->angle[k] < b->angle[k]);
    }
    return order;
}

static int compare_named(const void *a, const void *b)
{
    const named_pair *x = a;
    const named_pair *y = b;
    const int order = compare_angles(x, y);
    return order != 0 ? order : (x->candidate > y->candidate) - (x->candidate < y->candidate);
}

/* Allows the first of candidates that are the same directions: repeats, and any azimuths about the
 * normal. */
static gonio_status allow_once(gonio_i_choices *p, const gonio_plan_options *options)
{
    named_pair *named = gonio_i_allocate(p->context, options->candidate_count, sizeof *named);
    if (named == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < options->candidate_count; k++) {
        const gonio_pair *pair = &options->candidates[k];
        named[k] = (named_pair){{pair->incident.theta, azimuth_of(pair->incident),
                                 pair->outgoing.theta, azimuth_of(pair->outgoing)},
                                k};
    }
    qsort(named, options->candidate_count, sizeof *named, compare_named);
    for (size_t k = 0; k < options->candidate_count; k++) {
        p->allowed[named[k].candidate] = k == 0 || compare_angles(&named[k], &named[k - 1]) != 0;
    }
    free(named);
    return GONIO_OK;
}

/* Row `row`, a candidate or, after them, a direction that was read. f: scratch, [K]. */
static void list_candidate(gonio_i_choices *p, const gonio_plan_options *options, size_t row,
                           double *f, float *to)
{
    const size_t candidates = options->candidate_count;
    const bool candidate = row < candidates;
    p->at[row] = candidate ? gonio_half_difference_from_pair(options->candidates[row])
                           : p->known->read[row - candidates];
    gonio_i_prior_at(p->prior, p->at[row], 0, &p->mean[row], f);
    to_float(f, p->prior->components, to);
    p->loss[row] = candidate ? metric_weight(options->metric, p->at[row], p->mean[row], 0) : 0.0;
}

static gonio_status list_candidates(gonio_i_choices *p, const gonio_plan_options *options)
{
    const size_t k = p->prior->components;
    float *f = gonio_i_allocate(p->context, p->rows * k, sizeof *f);
    double *exact = gonio_i_allocate(p->context, k, sizeof *exact);
    gonio_status status =
        f == NULL || exact == NULL ? GONIO_ERROR_MEMORY : gonio_i_choices_allocate(p);
    for (size_t row = 0; row < p->rows && status == GONIO_OK; row++) {
        list_candidate(p, options, row, exact, f + row * k);
    }
    if (status == GONIO_OK && p->known == NULL) {
        size_t rank = 0;
        status = factorise_candidates(p, f, k, p->components, p->f, &rank);
    } else if (status == GONIO_OK && p->known->goes_on) {
        status = append_remainder(p, f);
    } else if (status == GONIO_OK) {
        memcpy(p->f, f, p->rows * k * sizeof *f);
    }
    free(f);
    free(exact);
    return status;
}

gonio_status gonio_i_choices_of_candidates(gonio_i_choices *p, const gonio_plan_options *options)
{
    const bool goes_on = p->known != NULL && p->known->goes_on;
    p->rows = options->candidate_count + (goes_on ? p->known->count : 0);
    p->noise = p->known == NULL || goes_on ? NOISE_BESIDE_REMAINDER : gonio_i_noise_of_readings;
    p->components = p->known != NULL      ? p->prior->components
                    : p->rows > MOST_RANK ? MOST_RANK
                                          : p->rows;
    gonio_status status = list_candidates(p, options);
    if (status == GONIO_OK) {
        status = allow_once(p, options);
    }
    if (status == GONIO_OK && goes_on) {
        status = gonio_i_choices_after_readings(p);
    }
    return status;
}

gonio_status gonio_i_choices_after_readings(gonio_i_choices *p)
{
    const size_t k = p->components;
    const size_t n = p->known->count;
    const float *read = p->f + (p->rows - n) * k;
    double *f = gonio_i_allocate(p->context, n * k, sizeof *f);
    p->own_covariance = gonio_i_allocate(p->context, k * k, sizeof *p->own_covariance);
    const bool done = f != NULL && p->own_covariance != NULL;
    for (size_t i = 0; done && i < n * k; i++) {
        f[i] = (double)read[i];
    }
    const gonio_status status =
        done ? gonio_i_covariance_after(p->context, f, n, k, p->noise * p->noise, p->own_covariance)
             : GONIO_ERROR_MEMORY;
    p->covariance = p->own_covariance;
    free(f);
    return status;
}

/* Excludes directions that were read. */
gonio_status gonio_i_choices_leave_out_read(gonio_i_choices *p)
{
    const size_t count = p->known->count;
    gonio_i_place *read = gonio_i_allocate(p->context, count, sizeof *read);
    if (read == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count; i++) {
        read[i] = gonio_i_place_of(p->known->read[i]);
    }
    for (size_t row = 0; row < p->rows; row++) {
        const gonio_i_place here = gonio_i_place_of(p->at[row]);
        for (size_t i = 0; i < count && p->allowed[row]; i++) {
            p->allowed[row] = gonio_i_place_distance(&here, &read[i]) > SAME;
        }
    }
    free(read);
    return GONIO_OK;
}

size_t gonio_i_choices_count(const gonio_i_choices *p)
{
    size_t allowed = 0;
    for (size_t row = 0; row < p->rows; row++) {
        allowed += p->allowed[row];
    }
    return allowed;
}
