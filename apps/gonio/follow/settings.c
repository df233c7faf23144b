/* The settings at which a run's directions are read: see settings.h. */
#include "settings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../nearest_setting.h"
#include "measurement/readings.h"
#include "say.h"

static const double DEGREE = M_PI / 180.0;

static gonio_pair pair_of(const double degrees[4])
{
    return (gonio_pair){{degrees[0] * DEGREE, degrees[1] * DEGREE},
                        {degrees[2] * DEGREE, degrees[3] * DEGREE}};
}

/* ---- settings ---- */

bool follow_setting(const follower *f, const double degrees[4], const gonio_setting *from,
                    gonio_setting *setting)
{
    return nearest_setting(f->inputs.instrument, pair_of(degrees), from, setting);
}

void follow_place(follower *f, gonio_setting *place)
{
    const run *r = &f->run;
    if (f->placed == 0) {
        gonio_instrument_home(f->inputs.instrument, &f->place);
    }
    for (; f->placed < r->rows; f->placed++) {
        const run_row *row = &r->row[f->placed];
        if (row->of_sample) {
            const gonio_setting from = f->place;
            nearest_setting(f->inputs.instrument, row->pair, &from, &f->place);
        }
    }
    *place = f->place;
}

size_t follow_positions(follower *f, const double degrees[4], double *position)
{
    gonio_setting at;
    size_t count = 0;
    if (f->inputs.instrument == NULL) {
        return 0;
    }
    const gonio_instrument_view *view = gonio_instrument_describe(f->inputs.instrument);
    follow_place(f, &at);
    if (!follow_setting(f, degrees, &at, &at)) {
        return 0;
    }
    for (size_t k = 0; k < view->axes; k++) {
        if (view->axis[k].present) {
            position[count++] = at.axis[k] / DEGREE;
        }
    }
    return count;
}

/* ---- time ---- */

/* Seconds to read a direction; *at moves there. */
static double time_of(const follower *f, const run_wanted *w, gonio_setting *at)
{
    const gonio_instrument *instrument = f->inputs.instrument;
    const gonio_setting from = *at;
    const double travel = follow_setting(f, w->degrees, &from, at)
                              ? gonio_instrument_travel(instrument, &from, at)
                              : 0.0;
    return travel + gonio_instrument_describe(instrument)->exposure;
}

double follow_time_of_next(follower *f)
{
    const size_t next = run_next(&f->run);
    gonio_setting at;
    if (f->inputs.instrument == NULL) {
        return NAN;
    }
    follow_place(f, &at);
    return next != RUN_NOWHERE ? time_of(f, &f->run.wanted[next], &at) : 0.0;
}

double follow_time_left(follower *f)
{
    gonio_setting at;
    double time = 0.0;
    if (f->inputs.instrument == NULL) {
        return NAN;
    }
    size_t *open = calloc(f->run.wanted_count + 1, sizeof *open);
    if (open == NULL) {
        return NAN;
    }
    follow_place(f, &at);
    const size_t count = run_list_open(&f->run, open);
    for (size_t k = 0; k < count; k++) {
        time += time_of(f, &f->run.wanted[open[k]], &at);
    }
    free(open);
    const gonio_instrument_view *view = gonio_instrument_describe(f->inputs.instrument);
    if (view->reference_every > 0.0 && count > 0) {
        const double first = f->run.rows == 0 ? 1.0 : 0.0;
        time += view->reference_time * (first + floor(time / view->reference_every));
    }
    return time;
}

/* ---- reach ---- */

void follow_note_instrument(follower *f, const gonio_readings *plan)
{
    if (f->inputs.instrument == NULL) {
        return;
    }
    const char *name = gonio_instrument_describe(f->inputs.instrument)->name;
    const char *stated = gonio_i_comments_value(&plan->comment, "instrument");
    if (stated != NULL && strcmp(stated, name) != 0) {
        follow_say(f, GONIO_MESSAGE_WARNING,
                   "%s: planned for another instrument: %s, not %s; its axes, order and times do "
                   "not hold",
                   plan->path, stated, name);
    }
}

gonio_status follow_check_reach(follower *f)
{
    const run *r = &f->run;
    gonio_setting found[GONIO_MOST_SETTINGS];
    const double *first = NULL;
    size_t missing = 0;
    for (size_t k = 0; k < r->wanted_count && f->inputs.instrument != NULL; k++) {
        const double *degrees = r->wanted[k].degrees;
        if (nearest_candidates(f->inputs.instrument, pair_of(degrees), found) == 0) {
            first = missing++ == 0 ? degrees : first;
        }
    }
    if (missing == 0) {
        return GONIO_OK;
    }
    follow_say(f, GONIO_MESSAGE_ERROR,
               "the instrument %s cannot read theta_i %.4g, phi_i %.4g, theta_o %.4g, phi_o %.4g "
               "of the plan (%s), nor %zu others of %zu: plan with --instrument %s, or take these "
               "lines out of the plan",
               f->o->instrument, first[0], first[1], first[2], first[3],
               nearest_obstacle(f->inputs.instrument, pair_of(first)), missing - 1, r->wanted_count,
               f->o->instrument);
    return GONIO_ERROR_MISMATCH;
}

/* ---- order ---- */

/* The settings of directions, one after another, and where each begins: begin[count + 1]. */
static gonio_status list_settings(const follower *f, double (*degrees)[4], size_t count,
                                  gonio_setting **all, size_t *begin)
{
    gonio_setting found[GONIO_MOST_SETTINGS];
    size_t used = 0;
    *all = NULL;
    for (size_t k = 0; k < count; k++) {
        const size_t n = nearest_candidates(f->inputs.instrument, pair_of(degrees[k]), found);
        gonio_setting *more = reallocarray(*all, used + n + 1, sizeof *more);
        if (more == NULL) {
            return GONIO_ERROR_MEMORY;
        }
        *all = more;
        memcpy(*all + used, found, n * sizeof *found);
        begin[k] = used;
        used += n;
        begin[k + 1] = used;
        if (n == 0) {
            return GONIO_ERROR_MISMATCH;
        }
    }
    return GONIO_OK;
}

static gonio_status order_by(follower *f, double (*degrees)[4], size_t count, size_t *begin,
                             size_t *order, gonio_setting *chosen, double (*copy)[4])
{
    gonio_setting *all = NULL;
    gonio_setting at;
    follow_place(f, &at);
    gonio_status status = list_settings(f, degrees, count, &all, begin);
    if (status == GONIO_OK) {
        status = gonio_instrument_order(f->t->context, f->inputs.instrument, all, begin, count, &at,
                                        order, chosen);
    }
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        memcpy(copy[k], degrees[order[k]], sizeof *copy);
    }
    if (status == GONIO_OK) {
        memcpy(degrees, copy, count * sizeof *copy);
    }
    free(all);
    /* A direction without a setting leaves the order as it is. */
    return status == GONIO_ERROR_MISMATCH ? GONIO_OK : status;
}

gonio_status follow_order(follower *f, double (*degrees)[4], size_t count)
{
    if (f->inputs.instrument == NULL || count == 0) {
        return GONIO_OK;
    }
    size_t *begin = calloc(count + 1, sizeof *begin);
    size_t *order = calloc(count, sizeof *order);
    gonio_setting *chosen = calloc(count, sizeof *chosen);
    double(*copy)[4] = calloc(count, sizeof *copy);
    const gonio_status status = begin != NULL && order != NULL && chosen != NULL && copy != NULL
                                    ? order_by(f, degrees, count, begin, order, chosen, copy)
                                    : GONIO_ERROR_MEMORY;
    free(begin);
    free(order);
    free(chosen);
    free(copy);
    return status;
}
