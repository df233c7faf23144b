/* Plans for an instrument: see instrument_plan.h.
 *
 * Given     the readings that an instrument offers (instrument_choices.h), and the error over the
 *           whole grid that is to be least
 * Returned  readings, settings that make them, and the order of least time
 * Method    The search of expected_error_search.h chooses among what is offered. For a time, the
 *           first reading at an incidence has a price: what changing it costs, shared by several
 *           readings. Several prices are tried by the greedy choice alone; the best is searched
 *           again with exchanges, for as many readings as fit. */
#include "instrument_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "expected_error_scale.h"
#include "expected_error_search.h"
#include "instrument_choices.h"
#include "instrument_run.h"
#include "method.h"
#include "plan.h"

enum {
    MOST_OFFERED = 10000,
    MOST_IN_BUDGET = 800,
    FIRST_GUESS = 128,
    SWEEPS_IN_BUDGET = 2,
    MOST_EXCHANGED = 200, /* longer plans for a time are greedy */
    FREE_ROWS = 6000,
    SWEEPS_OF_FREE = 1
};

/* Prices of the first reading at an incidence that are tried for a time: shares of what changing
 * the incidence costs in readings. */
static const double prices[] = {0.0, 0.15, 0.6};
enum { PRICES = sizeof prices / sizeof *prices };

/* A run that is this much shorter than allowed is filled up. */
static const double NEARLY_FULL = 0.98;

typedef struct planner {
    gonio_context *context;
    const gonio_plan_options *options;
    const gonio_i_known *known;
    gonio_i_prior *prior;
    gonio_i_choices grid; /* what the error is over */
    gonio_i_instrument_choices offered;
    double *weights; /* [K][K]: W of the grid's loss */
    gonio_i_error_of_loss error;
    size_t *chosen;    /* [room]: rows of what is offered, in the order of choice */
    double *remaining; /* [room + 1] */
    size_t room;
    size_t count;
} planner;

/* ---- choosing ---- */

static gonio_i_expected_error_problem problem_of(const planner *p, size_t count, double price,
                                                 int sweeps)
{
    const gonio_i_choices *c = &p->offered.choices;
    return (gonio_i_expected_error_problem){.context = p->context,
                                            .f = c->f,
                                            .rows = c->rows,
                                            .components = c->components,
                                            .covariance =
                                                p->known != NULL ? p->known->covariance : NULL,
                                            .allowed = c->allowed,
                                            .variance = c->noise * c->noise,
                                            .count = count,
                                            .weights = p->weights,
                                            .row_variance = p->offered.variance,
                                            .group = p->offered.incidence,
                                            .groups = (size_t)p->offered.incidences,
                                            .price = price,
                                            .sweeps = sweeps};
}

static gonio_status make_room(planner *p, size_t count)
{
    if (count <= p->room) {
        return GONIO_OK;
    }
    free(p->chosen);
    free(p->remaining);
    p->chosen = gonio_i_allocate(p->context, count, sizeof *p->chosen);
    p->remaining = gonio_i_allocate(p->context, count + 1, sizeof *p->remaining);
    p->room = p->chosen != NULL && p->remaining != NULL ? count : 0;
    return p->room > 0 ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status choose(planner *p, size_t count, double price, int sweeps)
{
    gonio_i_expected_error_problem problem = problem_of(p, count, price, sweeps);
    problem.enough = p->known == NULL ? gonio_i_enough_for(&p->error, p->options->target) : 0.0;
    gonio_status status = make_room(p, count);
    if (status == GONIO_OK) {
        status = gonio_i_expected_error_search(&problem, p->chosen, p->remaining, &p->count);
    }
    return status;
}

static gonio_status run_of(const planner *p, size_t count, gonio_i_run *run)
{
    return gonio_i_run_create(p->context, p->options->instrument, p->offered.setting, p->chosen,
                              count, p->options->nested, run);
}

/* ---- a number of readings, or an error ---- */

/* The fewest readings that reach the target. */
static gonio_status cut_to_target(planner *p)
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

static gonio_status choose_number(planner *p)
{
    const size_t offered = gonio_i_choices_count(&p->offered.choices);
    const bool usual = p->options->count == GONIO_USUAL_COUNT;
    const size_t asked = usual ? GONIO_I_USUAL_NEXT : p->options->count;
    if (asked > offered && !usual && p->options->target == 0.0) {
        return gonio_i_fail(p->context, GONIO_ERROR_ARGUMENT,
                            "%zu readings asked for, but the instrument offers only %zu", asked,
                            offered);
    }
    const gonio_status status = choose(p, asked < offered ? asked : offered, 0.0, 0);
    return status == GONIO_OK && p->options->target > 0.0 ? cut_to_target(p) : status;
}

/* ---- a time ---- */

/* How long the first `count` chosen readings take. */
static gonio_status time_of(const planner *p, size_t count, double *time)
{
    gonio_i_run run = {0};
    const gonio_status status = run_of(p, count, &run);
    *time = run.duration;
    gonio_i_run_free(&run);
    return status;
}

/* The most readings of those chosen that fit into the time, by regula falsi on their number;
 * `longest`: the time of all. */
static gonio_status fit(const planner *p, double longest, size_t *fits)
{
    const double budget = p->options->budget;
    size_t low = 0;
    size_t high = p->count;
    double low_time = 0.0;
    double high_time = longest;
    gonio_status status = GONIO_OK;
    if (longest <= budget) {
        low = high;
    }
    for (int step = 0; step < 12 && high > low + 1 && status == GONIO_OK; step++) {
        const double share = (budget - low_time) / fmax(high_time - low_time, 1e-9);
        size_t middle = low + (size_t)(share * (double)(high - low));
        middle = middle <= low ? low + 1 : middle >= high ? high - 1 : middle;
        double time = 0.0;
        status = time_of(p, middle, &time);
        if (time <= budget) {
            low = middle;
            low_time = time;
        } else {
            high = middle;
            high_time = time;
        }
        if (low_time > 0.995 * budget) {
            break;
        }
    }
    *fits = low;
    return status;
}

/* What changing the incidence costs, in readings. */
static double cost_of_change(const planner *p)
{
    const gonio_instrument_view *view = gonio_instrument_describe(p->options->instrument);
    double settling = 0.0;
    for (size_t k = 0; k < view->axes; k++) {
        settling = fmax(settling, view->axis[k].settling);
    }
    return view->incidence_change / fmax(view->exposure + settling, 1e-3);
}

static size_t most_in_budget(const planner *p)
{
    const gonio_instrument_view *view = gonio_instrument_describe(p->options->instrument);
    const size_t offered = gonio_i_choices_count(&p->offered.choices);
    const size_t asked =
        p->options->count != GONIO_USUAL_COUNT ? p->options->count : MOST_IN_BUDGET;
    const double in_time = p->options->budget / fmax(view->exposure, 1e-3);
    size_t most = asked < offered ? asked : offered;
    most = in_time < (double)most ? (size_t)in_time : most;
    return most;
}

/* The greedy choice at a price, for as many readings as fit. */
static gonio_status try_price(planner *p, double price, size_t most, size_t *fits)
{
    const double budget = p->options->budget;
    double time = 0.0;
    size_t count = FIRST_GUESS < most ? FIRST_GUESS : most;
    gonio_status status = GONIO_OK;
    while (status == GONIO_OK) {
        status = choose(p, count, price, -1);
        if (status == GONIO_OK) {
            status = time_of(p, count, &time);
        }
        if (time > budget || count == most) {
            break;
        }
        const double more = 1.3 * (double)count * budget / time;
        count = more < (double)most ? (size_t)more + 1 : most;
    }
    return status == GONIO_OK ? fit(p, time, fits) : status;
}

static gonio_status find_price(planner *p, size_t most, double *price, size_t *count)
{
    double least = INFINITY;
    gonio_status status = GONIO_OK;
    *count = 0;
    for (size_t k = 0; k < PRICES && status == GONIO_OK; k++) {
        const double tried = prices[k] * cost_of_change(p);
        size_t fits = 0;
        status = try_price(p, tried, most, &fits);
        if (status == GONIO_OK && fits > 0 && p->remaining[fits] < least) {
            least = p->remaining[fits];
            *price = tried;
            *count = fits;
        }
    }
    return status;
}

static gonio_status refuse_budget(const planner *p)
{
    return gonio_i_fail(p->context, GONIO_ERROR_ARGUMENT,
                        "no reading fits into %.3g min; the first one takes longer",
                        p->options->budget / 60.0);
}

/* Says so where the usual limit on the readings ends the run, and not the time. */
static void note_limit(const planner *p)
{
    double time = 0.0;
    if (p->options->count == GONIO_USUAL_COUNT && p->count == MOST_IN_BUDGET &&
        time_of(p, p->count, &time) == GONIO_OK && time < NEARLY_FULL * p->options->budget) {
        gonio_i_note(
            p->context,
            "%d readings take %.1f min of %.1f; a larger number (-n) uses more of the time",
            MOST_IN_BUDGET, time / 60.0, p->options->budget / 60.0);
    }
}

/* The search with exchanges at a price; once more for a number of readings that fits better. */
static gonio_status choose_in_budget(planner *p)
{
    double price = 0.0;
    size_t count = 0;
    const size_t most = most_in_budget(p);
    gonio_status status = most > 0 ? find_price(p, most, &price, &count) : GONIO_OK;
    if (status == GONIO_OK && count == 0) {
        return refuse_budget(p);
    }
    for (int round = 0; round < 3 && status == GONIO_OK; round++) {
        double time = 0.0;
        status = choose(p, count, price, count <= MOST_EXCHANGED ? SWEEPS_IN_BUDGET : -1);
        if (status == GONIO_OK) {
            status = time_of(p, p->count, &time);
        }
        const bool full = time > NEARLY_FULL * p->options->budget || count == most;
        if (time > p->options->budget || full || round == 2) {
            size_t fits = 0;
            status = status == GONIO_OK ? fit(p, time, &fits) : status;
            p->count = fits;
            break;
        }
        const size_t more = (size_t)((double)count * p->options->budget / time);
        count = more > count ? more : count + 1;
        count = count < most ? count : most;
    }
    if (status == GONIO_OK) {
        note_limit(p);
    }
    return status == GONIO_OK && p->count == 0 ? refuse_budget(p) : status;
}

/* ---- what the limits cost ---- */

/* The expected error of as many readings without an instrument, of a sample of the grid's rows. */
static gonio_status find_free_error(const planner *p, size_t count, double *expected)
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
                                                    .sweeps = SWEEPS_OF_FREE};
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
static gonio_status fill_expected(planner *p, const gonio_i_run *run, gonio_plan *plan,
                                  double *covariance)
{
    const gonio_i_expected_error_problem problem = problem_of(p, plan->count, 0.0, 0);
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

static void fill_entries(const planner *p, gonio_plan *plan)
{
    for (size_t k = 0; k < plan->count; k++) {
        const gonio_pair pair = plan->run->setting[k].pair;
        const gonio_bin bin = gonio_bin_of(gonio_half_difference_from_pair(pair));
        plan->entries[k] = (gonio_plan_entry){
            gonio_cell_of_bin(p->prior->view->representation, bin), GONIO_ALL_CHANNELS, pair};
    }
    plan->condition_number = INFINITY;
}

static gonio_status fill_plan(planner *p, gonio_i_run *run, gonio_plan *plan)
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

static gonio_status make_plan(planner *p, gonio_plan **plan)
{
    gonio_i_run run = {0};
    gonio_plan *made = NULL;
    gonio_status status = run_of(p, p->count, &run);
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

static gonio_status prepare(planner *p, const gonio_basis *basis)
{
    gonio_status status = gonio_i_prior_create(p->context, basis, &p->prior);
    p->grid = (gonio_i_choices){.context = p->context, .prior = p->prior, .known = p->known};
    p->offered.choices = p->grid;
    if (status == GONIO_OK) {
        status = gonio_i_choices_of_rows(&p->grid, p->options->metric);
    }
    if (status == GONIO_OK) {
        status = gonio_i_choices_of_instrument(&p->offered, p->options->instrument, MOST_OFFERED);
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
    planner p = {.context = context, .options = options, .known = known};
    gonio_status status = check(context, options);
    if (status == GONIO_OK) {
        status = prepare(&p, basis);
    }
    if (status == GONIO_OK) {
        status = options->budget > 0.0 ? choose_in_budget(&p) : choose_number(&p);
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
