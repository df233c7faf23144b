/* The next readings: see gonio_plan_next.
 *
 * The posterior covariance of a Gaussian does not depend on the values that were read. So adaptive
 * readings would not be better than a plan. The posterior covariance of the mixture does depend on
 * them: the readings show which of the database's columns the material resembles.
 *
 * Of a material that resembles none, which needs a large remainder, they show little of that.
 * Directions chosen by what they seem to show were worse than those of a plan made before
 * (docs/experiments.md). So among candidates the plan made before goes on from what was read, with
 * the remainder and the narrow peaks that the readings ask for. */
#include <stdlib.h>

#include "../core/options.h"
#include "../measurement/readings.h"
#include "../plan/expected_error_plan.h"
#include "../posterior/interpret.h"
#include "../prior/after_readings.h"
#include "anisotropic.h"
#include "method.h"
#include "posterior_method.h"

/* alpha of the remainder from which on a material is unlike the database. */
static const double UNLIKE = 0.25;

/* The standard deviation of a reading in a plan, log units. */
static const double PLANNED_DEVIATION = 0.08;

/* More readings have been planned for long enough. */
enum { MOST_PLANNED = 2000 };

typedef struct next {
    gonio_context *context;
    const gonio_basis *basis;
    const gonio_readings *readings;
    const gonio_basis_view *view;
    gonio_i_prior *prior;
    gonio_i_columns columns;
    gonio_i_posterior posterior;
    gonio_half_difference *read;
    gonio_interpretation interpretation;
} next;

static gonio_status allocate(next *n)
{
    const size_t k = n->view->components;
    const size_t columns = n->columns.count;
    gonio_i_posterior *p = &n->posterior;
    p->coefficients = gonio_i_allocate(n->context, columns * k, sizeof *p->coefficients);
    p->field = gonio_i_allocate(n->context, columns * n->view->rows, sizeof *p->field);
    p->covariance = gonio_i_allocate(n->context, k * k, sizeof *p->covariance);
    n->read = gonio_i_allocate(n->context, n->readings->count, sizeof *n->read);
    for (size_t i = 0; n->read != NULL && i < n->readings->count; i++) {
        n->read[i] = gonio_half_difference_from_pair(n->readings->pair[i]);
    }
    const bool done = p->coefficients && p->field && p->covariance && n->read;
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static void release(next *n)
{
    gonio_i_prior_free(&n->prior);
    gonio_i_columns_free(&n->columns);
    free(n->posterior.coefficients);
    free(n->posterior.field);
    free(n->posterior.covariance);
    free(n->read);
}

/* The posterior of what was read; apertures: NULL of single directions. */
static gonio_status find_posterior(void *data, const gonio_i_apertures *apertures)
{
    next *n = data;
    const gonio_i_posterior_options how = {.smoothness = -1.0,
                                           .wavelength = n->readings->wavelength};
    gonio_i_spread_out(apertures, n->readings->channels, &n->columns);
    return gonio_i_posterior_find(n->context, n->prior, n->columns.column, n->columns.count, &how,
                                  &n->posterior);
}

static gonio_status find_through_apertures(next *n, const gonio_reconstruct_options *options)
{
    const gonio_i_reconstruct_task task = {
        n->context, &gonio_i_posterior_method, n->basis, options, 0.0, NULL};
    return gonio_i_find_apertures(&task, n->readings, find_posterior, n);
}

/* Through apertures usual mistakes are not looked for, as in a reconstruction. */
static gonio_status interpret(next *n, const gonio_reconstruct_options *options,
                              const gonio_i_noise *noise)
{
    double *dark = NULL;
    const gonio_status status = options->no_checks || gonio_i_has_apertures(options)
                                    ? GONIO_OK
                                    : gonio_i_interpret(n->context, n->prior, n->readings, noise,
                                                        &n->columns, &n->interpretation, &dark);
    free(dark);
    return status;
}

static gonio_status know(next *n, const gonio_reconstruct_options *options)
{
    const gonio_i_noise noise = gonio_i_posterior_noise(options);
    gonio_status status = gonio_i_reconstruct_check(n->context, &gonio_i_posterior_method, n->basis,
                                                    n->readings, options);
    if (status == GONIO_OK) {
        status = gonio_i_check_half_angles(n->context, options);
    }
    if (status == GONIO_OK) {
        status = gonio_i_columns_create(n->context, n->view, n->readings, &noise, &n->columns);
    }
    if (status == GONIO_OK) {
        status = gonio_i_columns_check(n->context, &n->columns, n->readings);
    }
    if (status == GONIO_OK) {
        status = gonio_i_prior_create(n->context, n->basis, &n->prior);
    }
    if (status == GONIO_OK) {
        status = interpret(n, options, &noise);
    }
    if (status == GONIO_OK) {
        status = allocate(n);
    }
    if (status == GONIO_OK) {
        status = gonio_i_has_apertures(options) ? find_through_apertures(n, options)
                                                : find_posterior(n, NULL);
    }
    return status;
}

/* The covariance of z after what was read, whatever its values are. */
static gonio_status forget_values(next *n)
{
    const size_t k = n->view->components;
    const size_t count = n->readings->count;
    double *f = gonio_i_allocate(n->context, count * k, sizeof *f);
    for (size_t i = 0; i < count && f != NULL; i++) {
        double mean = 0.0;
        gonio_i_prior_at(n->prior, n->read[i], 0, &mean, f + i * k);
    }
    const gonio_status status =
        f == NULL ? GONIO_ERROR_MEMORY
                  : gonio_i_covariance_after(n->context, f, count, k,
                                             PLANNED_DEVIATION * PLANNED_DEVIATION,
                                             n->posterior.covariance);
    free(f);
    return status;
}

static bool is_unlike(const next *n)
{
    return n->posterior.smoothness >= UNLIKE && n->readings->count <= MOST_PLANNED;
}

static gonio_status plan_more(const next *n, const gonio_plan_options *options, gonio_plan **plan)
{
    const gonio_i_known known = {.covariance = n->posterior.covariance,
                                 .read = n->read,
                                 .count = n->readings->count,
                                 .goes_on = n->readings->count <= MOST_PLANNED,
                                 .alpha = n->posterior.remainder,
                                 .peak = n->posterior.peak,
                                 .expected = n->posterior.predicted,
                                 .variance = n->posterior.predicted_by_variance,
                                 .norm = n->posterior.norm};
    gonio_plan_options all = *options;
    all.target = 0.0; /* what was read counts; the plan is as long as asked for */
    return gonio_i_expected_error_next(n->context, n->basis, &all, &known, plan);
}

static void hand_out(const next *n, gonio_plan *made, double *expected_now,
                     gonio_interpretation *interpretation, gonio_plan **plan)
{
    *plan = made;
    if (expected_now != NULL) {
        *expected_now = n->posterior.predicted;
    }
    if (interpretation != NULL) {
        *interpretation = n->interpretation;
    }
}

/* Nothing is interpreted: the checks take the material for isotropic. */
static gonio_status plan_anisotropic(const next *n, const gonio_reconstruct_options *how,
                                     const gonio_plan_options *wanted, double *expected_now,
                                     gonio_interpretation *interpretation, gonio_plan **plan)
{
    double now = 0.0;
    const gonio_status status =
        gonio_i_next_anisotropic(n->context, n->basis, n->readings, how, wanted, &now, plan);
    if (status == GONIO_OK && expected_now != NULL) {
        *expected_now = now;
    }
    if (status == GONIO_OK && interpretation != NULL) {
        *interpretation = n->interpretation;
    }
    return status;
}

gonio_status gonio_plan_next(gonio_context *context, const gonio_basis *basis,
                             const gonio_readings *readings,
                             const gonio_reconstruct_options *options,
                             const gonio_plan_options *plan_options, double *expected_now,
                             gonio_interpretation *interpretation, gonio_plan **plan)
{
    next n = {.context = context,
              .basis = basis,
              .readings = readings,
              .view = gonio_basis_describe(basis)};
    gonio_reconstruct_options how;
    gonio_plan_options wanted;
    gonio_plan *made = NULL;
    gonio_status status = GONIO_I_TAKE(context, gonio_reconstruct_options, options, &how);
    if (status == GONIO_OK) {
        status = GONIO_I_TAKE(context, gonio_plan_options, plan_options, &wanted);
    }
    if (status == GONIO_OK && wanted.anisotropic) {
        return plan_anisotropic(&n, &how, &wanted, expected_now, interpretation, plan);
    }
    if (status == GONIO_OK) {
        status = know(&n, &how);
    }
    if (status == GONIO_OK && is_unlike(&n)) {
        status = forget_values(&n);
    }
    if (status == GONIO_OK && !(wanted.target > 0.0 && n.posterior.predicted <= wanted.target)) {
        status = plan_more(&n, &wanted, &made);
    }
    if (status == GONIO_OK) {
        hand_out(&n, made, expected_now, interpretation, plan);
    }
    release(&n);
    return status;
}
