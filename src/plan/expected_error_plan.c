/* Plans of least expected error: see expected_error_plan.h. */
#include "expected_error_plan.h"

#include <math.h>
#include <stdlib.h>

#include "../linalg/linalg.h"
#include "azimuth_choices.h"
#include "expected_error_choices.h"
#include "expected_error_scale.h"
#include "expected_error_search.h"
#include "instrument_plan.h"
#include "method.h"
#include "plan.h"

enum { MOST_CANDIDATES = 100000 };

static void fill_entry(const gonio_i_choices *p, const gonio_plan_options *options, size_t row,
                       gonio_plan_entry *entry)
{
    const gonio_basis_view *view = p->prior->view;
    if (p->pair != NULL || options->candidates != NULL) {
        const gonio_bin bin = gonio_bin_of(p->at[row]);
        *entry =
            (gonio_plan_entry){gonio_cell_of_bin(view->representation, bin), GONIO_ALL_CHANNELS,
                               p->pair != NULL ? p->pair[row] : options->candidates[row]};
        return;
    }
    *entry = gonio_i_plan_entry(view, row, options->phi_d);
}

/* How many readings to choose: those asked for, or all that there are if that many were only
 * allowed. */
static gonio_status choose_count(gonio_context *context, const gonio_i_choices *p,
                                 const gonio_plan_options *options, size_t *count)
{
    const size_t allowed = gonio_i_choices_count(p);
    const bool usual = options->count == GONIO_USUAL_COUNT;
    const size_t asked = usual ? GONIO_I_USUAL_NEXT : options->count;
    const bool all_of_file = options->candidates != NULL && asked == options->candidate_count;
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
static gonio_status cut(const gonio_i_choices *p, const gonio_plan_options *options,
                        gonio_plan *plan)
{
    gonio_context *context = p->context;
    size_t n = 0;
    while (options->target > 0.0 && n < plan->count && plan->expected[n] > options->target) {
        n++;
    }
    if (options->target > 0.0 && n == plan->count && plan->count == gonio_i_choices_count(p)) {
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

static void fill_expected(const gonio_i_error_of_loss *e, const double *remaining, gonio_plan *plan)
{
    for (size_t k = 0; k < plan->count; k++) {
        plan->expected[k] = gonio_i_expected_error_of(e, remaining[k + 1]);
    }
}

static gonio_status fill_plan(const gonio_i_choices *p, const gonio_plan_options *options,
                              gonio_plan *plan)
{
    size_t *chosen = gonio_i_allocate(p->context, plan->count, sizeof *chosen);
    double *remaining = gonio_i_allocate(p->context, plan->count + 1, sizeof *remaining);
    plan->expected = gonio_i_allocate(p->context, plan->count, sizeof *plan->expected);
    gonio_i_error_of_loss error = {0};
    gonio_status status = chosen != NULL && remaining != NULL && plan->expected != NULL
                              ? gonio_i_find_error_of_loss(p, &error)
                              : GONIO_ERROR_MEMORY;
    const gonio_i_expected_error_problem problem = {
        .context = p->context,
        .f = p->f,
        .rows = p->rows,
        .components = p->components,
        .covariance = p->covariance,
        .loss = p->loss,
        .allowed = p->allowed,
        .variance = p->noise * p->noise,
        .count = plan->count,
        .enough = p->known == NULL ? gonio_i_enough_for(&error, options->target) : 0.0};
    if (status == GONIO_OK) {
        status = gonio_i_expected_error_search(&problem, chosen, remaining, &plan->count);
    }
    if (status == GONIO_OK && p->known != NULL) {
        gonio_i_scale_to_known(p->known, remaining[0], &error);
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
    if (options->anisotropic && options->instrument != NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "plans for an instrument take the sample for isotropic; list what it "
                            "reaches as candidates");
    }
    if (options->anisotropic && options->metric != GONIO_E6) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "plans for anisotropic materials are of the metric e6, not %s",
                            metric->name);
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

static gonio_status list_choices(gonio_i_choices *p, const gonio_plan_options *options)
{
    if (options->anisotropic) {
        return gonio_i_choices_of_azimuths(p, options);
    }
    return options->candidates != NULL ? gonio_i_choices_of_candidates(p, options)
                                       : gonio_i_choices_of_rows(p, options->metric);
}

static gonio_status make_plan(gonio_context *context, const gonio_basis *basis,
                              const gonio_plan_options *options, const gonio_i_known *known,
                              gonio_plan **plan)
{
    gonio_i_choices p = {
        .context = context, .known = known, .covariance = known != NULL ? known->covariance : NULL};
    gonio_plan *made = NULL;
    size_t count = 0;
    gonio_status status = check_options(context, basis, options);
    if (status == GONIO_OK && options->instrument != NULL) {
        return gonio_i_instrument_plan(context, basis, options, known, plan);
    }
    if (status == GONIO_OK) {
        status = gonio_i_prior_create(context, basis, &p.prior);
    }
    if (status == GONIO_OK) {
        status = list_choices(&p, options);
    }
    if (status == GONIO_OK && known != NULL && !options->anisotropic) {
        status = gonio_i_choices_leave_out_read(&p);
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
    gonio_i_choices_free(&p);
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
    .name = GONIO_I_EXPECTED_ERROR,
    .summary = "the readings that leave the least expected error",
    .reconstruction = "posterior",
    .basis = {.representation = GONIO_SECTORED, .channels = GONIO_SEPARATE, .mixtures = true},
    .needs = GONIO_I_NEEDS_A_BASIS,
    .plan = plan_least_error,
};
