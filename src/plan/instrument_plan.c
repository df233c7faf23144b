/* Plans for an instrument: see instrument_plan.h.
 *
 * Given     the readings that an instrument offers (instrument_choices.h), and the error over the
 *           whole grid that is to be least
 * Returned  readings, settings that make them, and the order of least time
 * Method    The search of expected_error_search.h chooses among what is offered; for a time see
 *           instrument_budget.c. */
#include "instrument_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "instrument_budget.h"
#include "instrument_planner.h"
#include "method.h"
#include "plan.h"

enum {
    USUALLY_OFFERED = 10000,
    MOST_OFFERED = 40000,
    MOST_EXCHANGED = 2000, /* longer plans are greedy */
    FREE_ROWS = 6000,
    SWEEPS_OF_FREE = 1,
    MOST_EXCHANGED_OF_FREE = 400 /* longer plans are greedy */
};

/* ---- a number of readings, or an error ---- */

/* The fewest readings that reach the target. */
static gonio_status cut_to_target(gonio_i_planner *p)
{
    size_t n = 1;
    while (n < p->count &&
           gonio_i_expected_error_of(&p->error, p->remaining[n]) > p->options->target) {
        n++;
    }
    const double error = gonio_i_expected_error_of(&p->error, p->remaining[n]);
    p->count = n;
    return error <= p->options->target
               ? GONIO_OK
               : gonio_i_fail(p->context, GONIO_ERROR_ARGUMENT,
                              "%zu readings of the instrument leave an expected error of %.2f %%, "
                              "above the target of %.2f %%; allow more readings (-n)",
                              n, error, p->options->target);
}

static gonio_status choose_number(gonio_i_planner *p)
{
    const size_t offered = gonio_i_choices_count(&p->offered.choices);
    const bool usual = p->options->count == GONIO_USUAL_COUNT;
    const size_t asked = usual ? GONIO_I_USUAL_NEXT : p->options->count;
    if (asked > offered && !usual && p->options->target == 0.0) {
        return gonio_i_fail(p->context, GONIO_ERROR_ARGUMENT,
                            "%zu readings asked for, but a plan for this instrument chooses from "
                            "%zu direction%s; ask for at most as many",
                            asked, offered, offered == 1 ? "" : "s");
    }
    const gonio_status status =
        gonio_i_planner_choose(p, asked < offered ? asked : offered, 0.0, 0);
    return status == GONIO_OK && p->options->target > 0.0 ? cut_to_target(p) : status;
}

/* ---- what the limits cost ---- */

/* The expected error of as many readings without an instrument, of a sample of the grid's rows. */
static gonio_status find_free_error(const gonio_i_planner *p, size_t count, double *expected)
{
    const gonio_i_choices *c = &p->grid;
    const size_t k = c->components;
    const size_t step = c->rows / FREE_ROWS + 1;
    const size_t rows = (c->rows + step - 1) / step;
    float *f = gonio_i_allocate(p->context, rows * k, sizeof *f);
    bool *allowed = gonio_i_allocate(p->context, rows, sizeof *allowed);
    size_t *chosen = gonio_i_allocate(p->context, count, sizeof *chosen);
    double *remaining = gonio_i_allocate(p->context, count + 1, sizeof *remaining);
    gonio_status status = f && allowed && chosen && remaining ? GONIO_OK : GONIO_ERROR_MEMORY;
    const int sweeps = count <= MOST_EXCHANGED_OF_FREE ? SWEEPS_OF_FREE : -1;
    size_t all = 0;
    for (size_t row = 0; row < rows && status == GONIO_OK; row++) {
        memcpy(f + row * k, c->f + row * step * k, k * sizeof *f);
        allowed[row] = c->allowed[row * step];
        all += allowed[row];
    }
    const gonio_i_expected_error_problem problem = {.context = p->context,
                                                    .f = f,
                                                    .rows = rows,
                                                    .components = k,
                                                    .allowed = allowed,
                                                    .variance = c->noise * c->noise,
                                                    .count = count < all ? count : all,
                                                    .weights = p->weights,
                                                    .sweeps = sweeps};
    size_t found = 0;
    if (status == GONIO_OK) {
        status = gonio_i_expected_error_search(&problem, chosen, remaining, &found);
    }
    if (status == GONIO_OK) {
        *expected = gonio_i_expected_error_of(&p->error, remaining[found]);
    }
    free(f);
    free(allowed);
    free(chosen);
    free(remaining);
    return status;
}

/* ---- the plan ---- */

/* The expected error after each reading in the order of the run, and the covariance at the end. */
static gonio_status fill_expected(gonio_i_planner *p, const gonio_i_run *run, gonio_plan *plan,
                                  double *covariance)
{
    const gonio_i_expected_error_problem problem = gonio_i_planner_problem(p, plan->count, 0.0, 0);
    size_t *rows = gonio_i_allocate(p->context, plan->count, sizeof *rows);
    plan->expected = gonio_i_allocate(p->context, plan->count, sizeof *plan->expected);
    gonio_status status = rows && plan->expected ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < plan->count && status == GONIO_OK; k++) {
        rows[k] = p->chosen[run->order[k]];
    }
    if (status == GONIO_OK) {
        status =
            gonio_i_expected_error_remaining(&problem, rows, plan->count, p->remaining, covariance);
    }
    if (status == GONIO_OK && p->known != NULL) {
        gonio_i_scale_to_known(p->known, p->remaining[0], &p->error);
    }
    for (size_t k = 0; k < plan->count && status == GONIO_OK; k++) {
        plan->expected[k] = gonio_i_expected_error_of(&p->error, p->remaining[k + 1]);
    }
    free(rows);
    return status;
}

static void fill_entries(const gonio_i_planner *p, gonio_plan *plan)
{
    for (size_t k = 0; k < plan->count; k++) {
        const gonio_pair pair = plan->run->setting[k].pair;
        const gonio_bin bin = gonio_bin_of(gonio_half_difference_from_pair(pair));
        plan->entries[k] = (gonio_plan_entry){
            gonio_cell_of_bin(p->prior->view->representation, bin), GONIO_ALL_CHANNELS, pair};
    }
    plan->condition_number = INFINITY;
}

static gonio_status fill_plan(gonio_i_planner *p, gonio_i_run *run, gonio_plan *plan)
{
    const size_t k = p->prior->components;
    double *covariance = gonio_i_allocate(p->context, k * k, sizeof *covariance);
    gonio_status status = covariance != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = gonio_i_run_to_plan(p->context, p->options->instrument, run, plan);
    }
    if (status == GONIO_OK) {
        fill_entries(p, plan);
        status = fill_expected(p, run, plan, covariance);
    }
    if (status == GONIO_OK) {
        status =
            gonio_i_find_parts(p->context, p->options->instrument, p->prior, covariance, plan->run);
    }
    plan->run->free_expected = NAN;
    if (status == GONIO_OK && p->known == NULL) {
        status = find_free_error(p, plan->count, &plan->run->free_expected);
    }
    free(covariance);
    return status;
}

static gonio_status make_plan(gonio_i_planner *p, gonio_plan **plan)
{
    gonio_i_run run = {0};
    gonio_plan *made = NULL;
    gonio_status status = gonio_i_planner_run(p, p->count, GONIO_I_FINE_ORDER, &run);
    if (status == GONIO_OK) {
        made = gonio_i_allocate_plan(p->context, p->prior->view, GONIO_I_EXPECTED_ERROR,
                                     p->prior->components, p->count);
        status = made != NULL ? fill_plan(p, &run, made) : GONIO_ERROR_MEMORY;
    }
    if (status == GONIO_OK) {
        *plan = made;
    } else {
        gonio_plan_free(&made);
    }
    gonio_i_run_free(&run);
    return status;
}

/* ---- all ---- */

static gonio_status check(gonio_context *context, const gonio_plan_options *options)
{
    if (options->candidates != NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "an instrument offers its own directions; give candidates or an "
                            "instrument, not both");
    }
    if (!(options->budget >= 0.0 && isfinite(options->budget))) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a budget is a time above 0");
    }
    if (options->budget > 0.0 && options->target > 0.0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "give a budget or a target error, not both");
    }
    return GONIO_OK;
}

/* How many directions a plan chooses from: of axes without steps there are any number. */
static size_t most_offered(const gonio_plan_options *options)
{
    const size_t asked = options->count != GONIO_USUAL_COUNT ? options->count : 0;
    return asked > MOST_OFFERED / 2      ? MOST_OFFERED
           : 2 * asked > USUALLY_OFFERED ? 2 * asked
                                         : USUALLY_OFFERED;
}

static gonio_status prepare(gonio_i_planner *p, const gonio_basis *basis)
{
    gonio_status status = gonio_i_prior_create(p->context, basis, &p->prior);
    p->grid = (gonio_i_choices){.context = p->context, .prior = p->prior, .known = p->known};
    p->offered.choices = p->grid;
    if (status == GONIO_OK) {
        status = gonio_i_choices_of_rows(&p->grid, p->options->metric);
    }
    if (status == GONIO_OK) {
        status = gonio_i_choices_of_instrument(&p->offered, p->options->instrument,
                                               most_offered(p->options));
    }
    if (status == GONIO_OK) {
        status = gonio_i_find_error_of_loss(&p->grid, &p->error);
    }
    const size_t k = status == GONIO_OK ? p->grid.components : 0;
    if (status == GONIO_OK) {
        p->weights = gonio_i_allocate(p->context, k * k, sizeof *p->weights);
        status = p->weights != NULL
                     ? gonio_i_expected_error_weights(p->context, p->grid.f, p->grid.rows, k,
                                                      p->grid.loss, p->weights)
                     : GONIO_ERROR_MEMORY;
    }
    return status;
}

gonio_status gonio_i_instrument_plan(gonio_context *context, const gonio_basis *basis,
                                     const gonio_plan_options *options, const gonio_i_known *known,
                                     gonio_plan **plan)
{
    gonio_i_planner p = {.context = context, .options = options, .known = known};
    gonio_status status = check(context, options);
    if (status == GONIO_OK) {
        status = prepare(&p, basis);
    }
    if (status == GONIO_OK) {
        status = options->budget > 0.0 ? gonio_i_choose_in_budget(&p) : choose_number(&p);
    }
    if (status == GONIO_OK) {
        status = make_plan(&p, plan);
    }
    gonio_i_instrument_choices_free(&p.offered);
    gonio_i_choices_free(&p.grid);
    free(p.weights);
    free(p.chosen);
    free(p.remaining);
    return status;
}
