/* The most telling readings that fit into a time: see instrument_budget.h.
 *
 * Method    The first reading at an incidence has a price: what changing it costs, shared by
 *           several readings. Several prices are tried by the greedy choice alone; the best is
 *           searched again with exchanges, for as many readings as fit. Times are those of rough
 *           orders (order.h) until the last step. */
#include "instrument_budget.h"

#include <math.h>

#include "method.h"

enum {
    FIRST_GUESS = 128,
    SWEEPS = 2,
    MOST_EXCHANGED = 200, /* longer plans for a time are greedy */
    MOST_ROUNDS = 3,
    MOST_FITTED = 12
};

/* Prices of the first reading at an incidence that are tried for a time: shares of what changing
 * the incidence costs in readings. */
static const double prices[] = {0.0, 0.15, 0.6};
enum { PRICES = sizeof prices / sizeof *prices };

/* A run that is this much shorter than allowed is filled up, */
static const double NEARLY_FULL = 0.98;
/* and this one is not made longer by trying. */
static const double FULL = 0.995;

/* Rough orders take this much more time at most. */
static const double ROUGH = 1.02;

/* How long the first `count` chosen readings take. */
static gonio_status time_of(const gonio_i_planner *p, size_t count, gonio_i_order_effort effort,
                            double *time)
{
    gonio_i_run run = {0};
    const gonio_status status = gonio_i_planner_run(p, count, effort, &run);
    *time = run.duration;
    gonio_i_run_free(&run);
    return status;
}

/* ---- how many fit ---- */

/* `low` readings fit, `high` do not. */
typedef struct bracket {
    size_t low, high;
    double low_time, high_time; /* INFINITY: not known */
} bracket;

/* Where the time would be used up if it grew evenly, between the two. */
static size_t next_of(const bracket *b, double budget)
{
    const double slope = isfinite(b->high_time)
                             ? (b->high_time - b->low_time) / (double)(b->high - b->low)
                             : b->low_time / (double)b->low;
    const double more = (budget - b->low_time) / fmax(slope, 1e-9);
    const size_t next = b->low + (more < (double)(b->high - b->low) ? (size_t)more : b->high);
    return next <= b->low ? b->low + 1 : next >= b->high ? b->high - 1 : next;
}

/* The most readings of those chosen that fit into the time, near `guess`. */
static gonio_status fit(const gonio_i_planner *p, gonio_i_order_effort effort, size_t guess,
                        size_t *fits)
{
    const double budget = p->options->budget;
    bracket b = {0, p->count + 1, 0.0, INFINITY};
    size_t tried = guess < 1 ? 1 : guess > p->count ? p->count : guess;
    gonio_status status = GONIO_OK;
    for (int step = 0; step < MOST_FITTED && b.high > b.low + 1 && b.low_time < FULL * budget;
         step++) {
        double time = 0.0;
        status = time_of(p, tried, effort, &time);
        if (status != GONIO_OK) {
            break;
        }
        if (time <= budget) {
            b.low = tried;
            b.low_time = time;
        } else {
            b.high = tried;
            b.high_time = time;
        }
        tried = next_of(&b, budget);
    }
    *fits = b.low;
    return status;
}

/* ---- prices ---- */

/* What changing the incidence costs, in readings. */
static double cost_of_change(const gonio_i_planner *p)
{
    const gonio_instrument_view *view = gonio_instrument_describe(p->options->instrument);
    double settling = 0.0;
    for (size_t k = 0; k < view->axes; k++) {
        settling = fmax(settling, view->axis[k].settling);
    }
    return view->incidence_change / fmax(view->exposure + settling, 1e-3);
}

static size_t most_in_budget(const gonio_i_planner *p)
{
    const gonio_instrument_view *view = gonio_instrument_describe(p->options->instrument);
    const size_t offered = gonio_i_choices_count(&p->offered.choices);
    const size_t asked = p->options->count;
    const double in_time = p->options->budget / fmax(view->exposure, 1e-3);
    const size_t most = asked != GONIO_USUAL_COUNT && asked < offered ? asked : offered;
    return in_time < (double)most ? (size_t)in_time : most;
}

/* The greedy choice at a price, for as many readings as fit; *fits: a guess of it, and the result.
 */
static gonio_status try_price(gonio_i_planner *p, double price, size_t most, size_t *fits)
{
    const double budget = p->options->budget;
    double time = 0.0;
    size_t count = *fits < most ? *fits : most;
    gonio_status status = GONIO_OK;
    while (status == GONIO_OK) {
        status = gonio_i_planner_choose(p, count, price, -1);
        if (status == GONIO_OK) {
            status = time_of(p, count, GONIO_I_ROUGH_ORDER, &time);
        }
        if (time > budget || count == most) {
            break;
        }
        const double more = 1.3 * (double)count * budget / time;
        count = more < (double)most ? (size_t)more + 1 : most;
    }
    const double share = fmin(1.0, budget / fmax(time, 1e-9));
    return status == GONIO_OK
               ? fit(p, GONIO_I_ROUGH_ORDER, (size_t)(share * (double)p->count), fits)
               : status;
}

static gonio_status find_price(gonio_i_planner *p, size_t most, double *price, size_t *count)
{
    double least = INFINITY;
    gonio_status status = GONIO_OK;
    size_t fits = FIRST_GUESS;
    *count = 0;
    for (size_t k = 0; k < PRICES && status == GONIO_OK; k++) {
        const double tried = prices[k] * cost_of_change(p);
        fits = fits > 0 ? fits + fits / 8 + 1 : FIRST_GUESS;
        status = try_price(p, tried, most, &fits);
        if (status == GONIO_OK && fits > 0 && p->remaining[fits] < least) {
            least = p->remaining[fits];
            *price = tried;
            *count = fits;
        }
    }
    return status;
}

/* ---- all that is offered ---- */

static gonio_status take_all(gonio_i_planner *p)
{
    const gonio_i_choices *c = &p->offered.choices;
    const gonio_status status = gonio_i_planner_make_room(p, gonio_i_choices_count(c));
    p->count = 0;
    for (size_t row = 0; row < c->rows && status == GONIO_OK; row++) {
        if (c->allowed[row]) {
            p->chosen[p->count++] = row;
        }
    }
    return status;
}

static void note_all(const gonio_i_planner *p, double time)
{
    if (time < NEARLY_FULL * p->options->budget) {
        gonio_i_note(p->context,
                     "all directions that the plan chooses from, %zu, take %.1f min of %.1f",
                     p->count, time / 60.0, p->options->budget / 60.0);
    }
}

/* Whether the time is enough for all that is offered, which are then taken. Their order of choice
 * does not matter, but for nested blocks. */
static gonio_status take_all_if_they_fit(gonio_i_planner *p, bool *fit)
{
    double time = 0.0;
    gonio_status status = take_all(p);
    if (status == GONIO_OK) {
        status = time_of(p, p->count, GONIO_I_ROUGH_ORDER, &time);
    }
    *fit = status == GONIO_OK && time <= p->options->budget;
    if (*fit && p->options->nested) {
        status = gonio_i_planner_choose(p, p->count, 0.0, -1);
    }
    if (*fit && status == GONIO_OK) {
        note_all(p, time);
    }
    return status;
}

/* ---- all ---- */

static gonio_status refuse_budget(const gonio_i_planner *p)
{
    return gonio_i_fail(p->context, GONIO_ERROR_ARGUMENT,
                        "no reading fits into %.3g min; the first one takes longer",
                        p->options->budget / 60.0);
}

/* The search with exchanges at a price, for a number of readings that uses the time up. */
static gonio_status choose_at_price(gonio_i_planner *p, double price, size_t count, size_t most)
{
    const double budget = p->options->budget;
    gonio_status status = GONIO_OK;
    size_t fits = 0;
    for (int round = 0; round < MOST_ROUNDS && status == GONIO_OK; round++) {
        double time = 0.0;
        status = gonio_i_planner_choose(p, count, price, count <= MOST_EXCHANGED ? SWEEPS : -1);
        if (status == GONIO_OK) {
            status = time_of(p, count, GONIO_I_ROUGH_ORDER, &time);
        }
        fits = (size_t)((double)count * budget / fmax(time, 1e-9));
        if (time > ROUGH * budget || count == most) {
            break;
        }
        const size_t more = (size_t)(ROUGH * (double)fits) + 1;
        count = more > count ? more : count + 1;
        count = count < most ? count : most;
    }
    return status == GONIO_OK ? fit(p, GONIO_I_FINE_ORDER, fits, &p->count) : status;
}

gonio_status gonio_i_choose_in_budget(gonio_i_planner *p)
{
    const size_t most = most_in_budget(p);
    double price = 0.0;
    size_t count = 0;
    bool all = false;
    gonio_status status = GONIO_OK;
    if (most == gonio_i_choices_count(&p->offered.choices)) {
        status = take_all_if_they_fit(p, &all);
    }
    if (all || status != GONIO_OK) {
        return status;
    }
    status = most > 0 ? find_price(p, most, &price, &count) : GONIO_OK;
    if (status == GONIO_OK && count == 0) {
        return refuse_budget(p);
    }
    if (status == GONIO_OK) {
        status = choose_at_price(p, price, count, most);
    }
    return status == GONIO_OK && p->count == 0 ? refuse_budget(p) : status;
}
