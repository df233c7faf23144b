/* Plans of least expected error: see expected_error_plan.h. */
#include "expected_error_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "../metric/metric.h"
#include "expected_error_search.h"
#include "method.h"
#include "plan.h"

/* Standard deviation of a reading, log units: noise and the error of the model near the reading.
 * Chosen by errors of left-out materials: with 0.03 or 0.05 plans trust single readings too much.
 * Smaller where the covariance includes a remainder. */
static const double NOISE = 0.08;
static const double NOISE_BESIDE_REMAINDER = 0.05;

/* alpha and peak of the remainder between candidates, log units (prior.h). */
static const double SMOOTHNESS = 0.2;
static const double PEAK = 8.0;

/* Variance that the factor of the candidates' covariance may omit. */
static const double LEFT = 1e-4;

/* Square of the distance (prior.h) up to which directions are the same. */
static const double SAME = 1e-6;

/* Nearer to the normal a direction has no azimuth, radians. */
static const double POLE = 1e-6;

enum { MOST_CANDIDATES = 100000, MOST_RANK = 500 };

/* Standard deviation, log units, of the error that remains whatever is read. Chosen so that the
 * expected error is that of left-out materials (docs/experiments.md). */
static const double LEFT_OPEN = 0.05;

typedef struct place_list {
    gonio_context *context;
    gonio_i_prior *prior;
    size_t rows;
    size_t components; /* of f below: K, or the rank of the candidates' covariance */
    float *f;
    double *mean; /* [rows] */
    double *loss;
    bool *allowed;
    gonio_half_difference *at;
    const gonio_i_known *known; /* NULL: nothing */
    double noise;
} place_list;

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

static void free_places(place_list *p)
{
    gonio_i_prior_free(&p->prior);
    free(p->f);
    free(p->mean);
    free(p->loss);
    free(p->allowed);
    free(p->at);
}

static gonio_status allocate_places(place_list *p)
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
static void list_row(place_list *p, gonio_metric metric, size_t row, double *f)
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
static gonio_status list_rows(place_list *p, gonio_metric metric)
{
    bool failed = false;
    p->rows = p->prior->view->rows;
    p->components = p->prior->components;
    const gonio_status status = allocate_places(p);
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

/* Given    f[rows][K] and places of candidates, whose covariance is C = f f' + alpha^2 k
 * Returned p->f[rows][p->components], p->f p->f' = C to within LEFT of every variance
 * Method   Cholesky with pivoting on the largest variance left (Higham 2002, sec. 10.3); columns of
 *          C are computed when they are needed */
static void factorise(place_list *p, const float *f, const gonio_i_place *place, double *left)
{
    const size_t most = p->components;
    const size_t k = p->prior->components;
    for (size_t i = 0; i < p->rows; i++) {
        left[i] = dot(f + i * k, f + i * k, k) +
                  SMOOTHNESS * SMOOTHNESS * gonio_i_remainder(&place[i], &place[i], PEAK);
    }
    size_t rank = 0;
    for (; rank < most; rank++) {
        size_t pivot = 0;
        for (size_t i = 1; i < p->rows; i++) {
            pivot = left[i] > left[pivot] ? i : pivot;
        }
        if (left[pivot] < LEFT) {
            break;
        }
        const double root = sqrt(left[pivot]);
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(p->context))
        for (size_t i = 0; i < p->rows; i++) {
            const double c =
                dot(f + i * k, f + pivot * k, k) +
                SMOOTHNESS * SMOOTHNESS * gonio_i_remainder(&place[i], &place[pivot], PEAK);
            const double known = dot(p->f + i * most, p->f + pivot * most, rank);
            const float entry = (float)((c - known) / root);
            p->f[i * most + rank] = entry;
            left[i] -= (double)entry * (double)entry;
        }
        left[pivot] = 0.0;
    }
}

static gonio_status factorise_candidates(place_list *p, const float *f)
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
    factorise(p, f, place, left);
    free(left);
    free(place);
    return GONIO_OK;
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
static gonio_status allow_once(place_list *p, const gonio_plan_options *options)
{
    named_pair *named = gonio_i_allocate(p->context, p->rows, sizeof *named);
    if (named == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < p->rows; k++) {
        const gonio_pair *pair = &options->candidates[k];
        named[k] = (named_pair){{pair->incident.theta, azimuth_of(pair->incident),
                                 pair->outgoing.theta, azimuth_of(pair->outgoing)},
                                k};
    }
    qsort(named, p->rows, sizeof *named, compare_named);
    for (size_t k = 0; k < p->rows; k++) {
        p->allowed[named[k].candidate] = k == 0 || compare_angles(&named[k], &named[k - 1]) != 0;
    }
    free(named);
    return GONIO_OK;
}

static gonio_status list_candidates(place_list *p, const gonio_plan_options *options)
{
    const size_t most = p->known != NULL ? p->prior->components : MOST_RANK;
    p->rows = options->candidate_count;
    p->components = p->known != NULL || p->rows > most ? most : p->rows;
    const size_t components = p->prior->components;
    float *f = gonio_i_allocate(p->context, p->rows * components, sizeof *f);
    double *exact = gonio_i_allocate(p->context, components, sizeof *exact);
    gonio_status status = f == NULL || exact == NULL ? GONIO_ERROR_MEMORY : allocate_places(p);
    for (size_t k = 0; k < p->rows && status == GONIO_OK; k++) {
        p->at[k] = gonio_half_difference_from_pair(options->candidates[k]);
        gonio_i_prior_at(p->prior, p->at[k], 0, &p->mean[k], exact);
        to_float(exact, components, f + k * components);
        p->loss[k] = metric_weight(options->metric, p->at[k], p->mean[k], 0);
    }
    if (status == GONIO_OK) {
        status = allow_once(p, options);
    }
    if (status == GONIO_OK && p->known != NULL) {
        memcpy(p->f, f, p->rows * p->components * sizeof *f);
    } else if (status == GONIO_OK) {
        p->noise = NOISE_BESIDE_REMAINDER;
        status = factorise_candidates(p, f);
    }
    free(f);
    free(exact);
    return status;
}

/* The mean of 1/|g| over the measured columns of the database; |g| with the weights of the rows. */
static gonio_status mean_reciprocal(const place_list *p, double *mean)
{
    const gonio_i_prior *prior = p->prior;
    const size_t measured = prior->view->columns - prior->view->mixtures;
    const size_t used = prior->samples > 0 ? measured : 0;
    double *f = gonio_i_allocate(p->context, prior->components, sizeof *f);
    double *square = gonio_i_allocate(p->context, used + 1, sizeof *square);
    if (f == NULL || square == NULL) {
        free(f);
        free(square);
        return GONIO_ERROR_MEMORY;
    }
    const size_t step = p->rows / 4096 + 1; /* a sample of the rows is enough */
    for (size_t row = 0; row < p->rows; row += step) {
        double m = 0.0;
        gonio_i_prior_at(prior, p->at[row], 0, &m, f);
        for (size_t j = 0; j < used; j++) {
            const double g =
                m + gonio_i_dot(f, prior->sample + j * prior->components, prior->components);
            square[j] += (double)step * p->loss[row] * g * g;
        }
        square[used] += (double)step * p->loss[row] * m * m;
    }
    *mean = used > 0 ? 0.0 : 1.0 / sqrt(square[used]);
    for (size_t j = 0; j < used; j++) {
        *mean += 1.0 / sqrt(fmax(square[j], 1e-300)) / (double)used;
    }
    free(f);
    free(square);
    return GONIO_OK;
}

static void fill_entry(const place_list *p, const gonio_plan_options *options, size_t row,
                       gonio_plan_entry *entry)
{
    const gonio_basis_view *view = p->prior->view;
    if (options->candidates != NULL) {
        const gonio_bin bin = gonio_bin_of(p->at[row]);
        *entry = (gonio_plan_entry){gonio_cell_of_bin(view->representation, bin),
                                    GONIO_ALL_CHANNELS, options->candidates[row]};
        return;
    }
    *entry = gonio_i_plan_entry(view, row, options->phi_d);
}

static size_t count_allowed(const place_list *p)
{
    size_t allowed = 0;
    for (size_t row = 0; row < p->rows; row++) {
        allowed += p->allowed[row];
    }
    return allowed;
}

/* How many readings to choose: those asked for, or all that there are if that many were only
 * allowed. */
static gonio_status choose_count(gonio_context *context, const place_list *p,
                                 const gonio_plan_options *options, size_t *count)
{
    const size_t allowed = count_allowed(p);
    const bool usual = options->count == GONIO_USUAL_COUNT;
    const size_t asked = usual ? GONIO_I_USUAL_NEXT : options->count;
    const bool all_of_file = options->candidates != NULL && asked == p->rows;
    *count = asked < allowed ? asked : allowed;
    if (*count == 0 || (asked > allowed && options->target == 0.0 && !all_of_file && !usual)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu readings asked for, but there are only %zu directions to choose "
                            "from",
                            asked, allowed);
    }
    return GONIO_OK;
}

/* The fewest readings that reach the target, if there is one. */
static gonio_status cut(const place_list *p, const gonio_plan_options *options, gonio_plan *plan)
{
    gonio_context *context = p->context;
    size_t n = 0;
    while (options->target > 0.0 && n < plan->count && plan->expected[n] > options->target) {
        n++;
    }
    if (options->target > 0.0 && n == plan->count && plan->count == count_allowed(p)) {
        gonio_i_warn(context,
                     "all %zu directions leave an expected error of %.2f %%, above the target of "
                     "%.2f %%: all are planned",
                     plan->count, plan->expected[plan->count - 1], options->target);
        return GONIO_OK;
    }
    if (options->target > 0.0 && n == plan->count) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu readings leave an expected error of %.2f %%, above the target of "
                            "%.2f %%; allow more readings (-n), or learn from more materials",
                            plan->count, plan->expected[plan->count - 1], options->target);
    }
    plan->count = options->target > 0.0 ? n + 1 : plan->count;
    return GONIO_OK;
}

/* The part of E6, per cent, that remains whatever is read; `reciprocal`: 1/|g|. */
static double open_part(const place_list *p, double reciprocal)
{
    double all = 0.0;
    for (size_t row = 0; row < p->rows; row++) {
        all += p->loss[row];
    }
    return 100.0 * LEFT_OPEN * sqrt(all) * reciprocal;
}

/* From the loss that is left to E6, per cent: factor (scale loss + open^2)^(1/2). */
typedef struct error_of_loss {
    double factor;
    double scale;
    double open;
} error_of_loss;

/* Before anything was read. */
static gonio_status find_error_of_loss(const place_list *p, error_of_loss *e)
{
    double reciprocal = 0.0;
    gonio_status status = GONIO_OK;
    if (p->known != NULL) {
        reciprocal = 1.0 / p->known->norm;
    } else {
        status = mean_reciprocal(p, &reciprocal);
    }
    e->factor = 1.0;
    e->scale = 100.0 * 100.0 * reciprocal * reciprocal;
    e->open = open_part(p, reciprocal);
    return status;
}

/* Of a material that was read, what its covariance lets expect shrinks with the loss, down to what
 * the model leaves open; and what is expected, in proportion. */
static void scale_to_known(const gonio_i_known *known, double loss, error_of_loss *e)
{
    e->scale = fmax(known->variance * known->variance - e->open * e->open, 0.0) / loss;
    e->factor = known->expected / known->variance;
}

/* The loss that leaves the target; 0 if there is no target, or none that can be reached. */
static double enough_for(const error_of_loss *e, double target)
{
    return target > e->open ? (target * target - e->open * e->open) / e->scale : 0.0;
}

static void fill_expected(const error_of_loss *e, const double *remaining, gonio_plan *plan)
{
    for (size_t k = 0; k < plan->count; k++) {
        plan->expected[k] =
            e->factor * sqrt(e->scale * fmax(remaining[k + 1], 0.0) + e->open * e->open);
    }
}

static gonio_status fill_plan(const place_list *p, const gonio_plan_options *options,
                              gonio_plan *plan)
{
    size_t *chosen = gonio_i_allocate(p->context, plan->count, sizeof *chosen);
    double *remaining = gonio_i_allocate(p->context, plan->count + 1, sizeof *remaining);
    plan->expected = gonio_i_allocate(p->context, plan->count, sizeof *plan->expected);
    error_of_loss error = {0};
    gonio_status status = chosen != NULL && remaining != NULL && plan->expected != NULL
                              ? find_error_of_loss(p, &error)
                              : GONIO_ERROR_MEMORY;
    const gonio_i_expected_error_problem problem = {
        .context = p->context,
        .f = p->f,
        .rows = p->rows,
        .components = p->components,
        .covariance = p->known != NULL ? p->known->covariance : NULL,
        .loss = p->loss,
        .allowed = p->allowed,
        .variance = p->noise * p->noise,
        .count = plan->count,
        .enough = p->known == NULL ? enough_for(&error, options->target) : 0.0};
    if (status == GONIO_OK) {
        status = gonio_i_expected_error_search(&problem, chosen, remaining, &plan->count);
    }
    if (status == GONIO_OK && p->known != NULL) {
        scale_to_known(p->known, remaining[0], &error);
    }
    if (status == GONIO_OK) {
        fill_expected(&error, remaining, plan);
    }
    for (size_t k = 0; k < plan->count && status == GONIO_OK; k++) {
        fill_entry(p, options, chosen[k], &plan->entries[k]);
    }
    free(chosen);
    free(remaining);
    return status == GONIO_OK ? cut(p, options, plan) : status;
}

static gonio_status check_options(gonio_context *context, const gonio_basis *basis,
                                  const gonio_plan_options *options)
{
    const size_t all = gonio_basis_describe(basis)->components;
    const gonio_metric_view *metric = gonio_metric_describe((int)options->metric);
    if (metric == NULL || !metric->plannable) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "no plan can be made for the metric %s",
                            metric != NULL ? metric->name : "asked for");
    }
    if (options->count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a plan needs at least 1 reading");
    }
    if (options->components != 0 && options->components != all) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "expected-error uses all %zu components of the basis, not %zu; learn "
                            "one of fewer, or plan by --method condition",
                            all, options->components);
    }
    if (options->candidates != NULL && options->candidate_count > MOST_CANDIDATES) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu candidates are more than %d; leave some out",
                            options->candidate_count, MOST_CANDIDATES);
    }
    return GONIO_OK;
}

/* Excludes directions that were read. */
static gonio_status leave_out_read(place_list *p)
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

static gonio_status make_plan(gonio_context *context, const gonio_basis *basis,
                              const gonio_plan_options *options, const gonio_i_known *known,
                              gonio_plan **plan)
{
    place_list p = {.context = context, .known = known, .noise = NOISE};
    gonio_plan *made = NULL;
    size_t count = 0;
    gonio_status status = check_options(context, basis, options);
    if (status == GONIO_OK) {
        status = gonio_i_prior_create(context, basis, &p.prior);
    }
    if (status == GONIO_OK) {
        status = options->candidates != NULL ? list_candidates(&p, options)
                                             : list_rows(&p, options->metric);
    }
    if (status == GONIO_OK && known != NULL) {
        status = leave_out_read(&p);
    }
    if (status == GONIO_OK) {
        status = choose_count(context, &p, options, &count);
    }
    if (status == GONIO_OK) {
        made = gonio_i_allocate_plan(context, p.prior->view, gonio_i_expected_error_method.name,
                                     p.prior->components, count);
        status = made == NULL ? GONIO_ERROR_MEMORY : fill_plan(&p, options, made);
    }
    if (status == GONIO_OK) {
        made->condition_number = INFINITY;
        *plan = made;
    } else {
        gonio_plan_free(&made);
    }
    free_places(&p);
    return status;
}

gonio_status gonio_i_expected_error_next(gonio_context *context, const gonio_basis *basis,
                                         const gonio_plan_options *options,
                                         const gonio_i_known *known, gonio_plan **plan)
{
    return make_plan(context, basis, options, known, plan);
}

static gonio_status plan_least_error(gonio_context *context, const gonio_basis *basis,
                                     const gonio_plan_options *options, gonio_plan **plan)
{
    return make_plan(context, basis, options, NULL, plan);
}

const gonio_i_method gonio_i_expected_error_method = {
    .name = "expected-error",
    .summary = "the readings that leave the least expected error",
    .reconstruction = "posterior",
    .basis = {.representation = GONIO_SECTORED, .channels = GONIO_SEPARATE, .mixtures = true},
    .needs = GONIO_I_NEEDS_A_BASIS,
    .plan = plan_least_error,
};
