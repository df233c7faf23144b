/* The run of a plan: see instrument_run.h. */
#include "instrument_run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../instrument/settings.h"
#include "../linalg/linalg.h"
#include "expected_error_search.h"
#include "instrument_choices.h"

/* Deviation in log units that remains whatever is read (as in expected_error_scale.c). */
static const double LEFT_OPEN = 0.05;

void gonio_i_run_free(gonio_i_run *run)
{
    free(run->order);
    free(run->setting);
    free(run->time);
}

/* ---- the settings of each reading ---- */

typedef struct alternatives {
    gonio_setting *setting;
    size_t *first; /* [count + 1] */
} alternatives;

/* All settings that tell the same. A reading that a step of an axis keeps from being found again
 * has the one that it was offered with. */
static gonio_status find_alternatives(gonio_context *context, const gonio_instrument *instrument,
                                      const gonio_setting *offered, const size_t *chosen,
                                      size_t count, alternatives *a)
{
    size_t room = 0;
    size_t used = 0;
    gonio_setting found[GONIO_MOST_SETTINGS];
    a->first = gonio_i_allocate(context, count + 1, sizeof *a->first);
    for (size_t k = 0; k < count && a->first != NULL; k++) {
        const gonio_setting *own = &offered[chosen[k]];
        size_t n = gonio_instrument_settings(instrument, own->pair, gonio_i_planned_freedom, found,
                                             GONIO_MOST_SETTINGS);
        if (n == 0) {
            found[n++] = *own;
        }
        if (used + n > room) {
            room = 2 * (used + n);
            gonio_setting *more = reallocarray(a->setting, room, sizeof *more);
            if (more == NULL) {
                return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory for settings");
            }
            a->setting = more;
        }
        memcpy(a->setting + used, found, n * sizeof *found);
        used += n;
        a->first[k + 1] = used;
    }
    return a->first != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* ---- the order ---- */

static gonio_status order_block(gonio_context *context, const gonio_instrument *instrument,
                                const alternatives *a, size_t begin, size_t end,
                                gonio_i_order_effort effort, gonio_i_run *run)
{
    const gonio_status status =
        gonio_i_order(context, instrument, a->setting, a->first + begin, end - begin,
                      begin > 0 ? &run->setting[begin - 1] : NULL, effort, run->order + begin,
                      run->setting + begin);
    for (size_t k = begin; k < end; k++) {
        run->order[k] += begin;
    }
    return status;
}

static gonio_status order_all(gonio_context *context, const gonio_instrument *instrument,
                              const alternatives *a, bool nested, gonio_i_order_effort effort,
                              gonio_i_run *run)
{
    gonio_status status = GONIO_OK;
    size_t begin = 0;
    size_t end = nested ? GONIO_I_FIRST_BLOCK : run->count;
    while (begin < run->count && status == GONIO_OK) {
        end = end < run->count ? end : run->count;
        status = order_block(context, instrument, a, begin, end, effort, run);
        begin = end;
        end *= 2;
    }
    return status;
}

/* The time of the readings in the order of choice, each at its first setting. */
static gonio_status find_unordered(gonio_context *context, const gonio_instrument *instrument,
                                   const alternatives *a, gonio_i_run *run)
{
    gonio_setting *plain = gonio_i_allocate(context, run->count, sizeof *plain);
    if (plain == NULL || a->setting == NULL) {
        free(plain);
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < run->count; k++) {
        plain[k] = a->setting[a->first[k]];
    }
    run->unordered = gonio_instrument_schedule(instrument, plain, run->count, NULL);
    free(plain);
    return GONIO_OK;
}

gonio_status gonio_i_run_create(gonio_context *context, const gonio_instrument *instrument,
                                const gonio_setting *offered, const size_t *chosen, size_t count,
                                bool nested, gonio_i_order_effort effort, gonio_i_run *run)
{
    alternatives a = {NULL, NULL};
    *run = (gonio_i_run){.count = count,
                         .order = gonio_i_allocate(context, count, sizeof *run->order),
                         .setting = gonio_i_allocate(context, count, sizeof *run->setting),
                         .time = gonio_i_allocate(context, count, sizeof *run->time)};
    gonio_status status = run->order && run->setting && run->time ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = find_alternatives(context, instrument, offered, chosen, count, &a);
    }
    if (status == GONIO_OK) {
        status = order_all(context, instrument, &a, nested, effort, run);
    }
    if (status == GONIO_OK) {
        run->duration = gonio_instrument_schedule(instrument, run->setting, count, run->time);
        status = find_unordered(context, instrument, &a, run);
    }
    free(a.setting);
    free(a.first);
    return status;
}

gonio_status gonio_i_run_to_plan(gonio_context *context, const gonio_instrument *instrument,
                                 gonio_i_run *run, gonio_plan *plan)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    gonio_plan_run *to = gonio_i_allocate(context, 1, sizeof *to);
    if (to == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    plan->run = to;
    snprintf(to->instrument, sizeof to->instrument, "%s", view->name);
    for (size_t k = 0; k < view->axes; k++) {
        snprintf(to->axis[k], sizeof to->axis[k], "%s", view->axis[k].name);
        to->shown[k] = view->axis[k].present;
    }
    to->axes = view->axes;
    to->setting = run->setting;
    to->time = run->time;
    to->duration = run->duration;
    to->unordered = run->unordered;
    run->setting = NULL;
    run->time = NULL;
    return GONIO_OK;
}

/* ---- what is left unseen ---- */

enum { POLAR = 16, AZIMUTHS = 12 };

static double ring(int k)
{
    return asin(sqrt((k + 0.5) / POLAR));
}

/* The part with an obstacle ("": none); a new one if there is room. */
static gonio_plan_part *part_of(gonio_plan_run *run, const char *obstacle)
{
    for (size_t k = 0; k < run->parts; k++) {
        if (strncmp(run->part[k].obstacle, obstacle, sizeof run->part[k].obstacle - 1) == 0) {
            return &run->part[k];
        }
    }
    gonio_plan_part *part =
        &run->part[run->parts < GONIO_MOST_PARTS ? run->parts++ : GONIO_MOST_PARTS - 1];
    snprintf(part->obstacle, sizeof part->obstacle, "%s", obstacle);
    return part;
}

/* The variance of g at a pair; f: scratch, [2][K]. */
static double variance_at(const gonio_i_prior *prior, const double *covariance, gonio_pair pair,
                          double *f)
{
    const size_t k = prior->components;
    double mean = 0.0;
    gonio_i_prior_at(prior, gonio_half_difference_from_pair(pair), 0, &mean, f);
    for (size_t i = 0; i < k; i++) {
        f[k + i] = gonio_i_dot(covariance + i * k, f, k);
    }
    return fmax(gonio_i_dot(f, f + k, k), 0.0) + LEFT_OPEN * LEFT_OPEN;
}

gonio_status gonio_i_find_parts(gonio_context *context, const gonio_instrument *instrument,
                                const gonio_i_prior *prior, const double *covariance,
                                gonio_plan_run *run)
{
    const double share = 1.0 / ((double)POLAR * POLAR * AZIMUTHS);
    double *f = gonio_i_allocate(context, 2 * prior->components, sizeof *f);
    if (f == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    part_of(run, "");
    for (int k = 0; k < POLAR * POLAR * AZIMUTHS; k++) {
        const int azimuth = k / (POLAR * POLAR);
        const gonio_pair pair = {{ring(k % POLAR), 0.0},
                                 {ring(k / POLAR % POLAR), M_PI * (azimuth + 0.5) / AZIMUTHS}};
        const char *obstacle =
            gonio_instrument_region_obstacle(instrument, pair, gonio_i_planned_freedom);
        gonio_plan_part *part = part_of(run, obstacle != NULL ? obstacle : "");
        part->share += share;
        part->deviation += share * variance_at(prior, covariance, pair, f);
    }
    for (size_t k = 0; k < run->parts; k++) {
        gonio_plan_part *part = &run->part[k];
        part->deviation = part->share > 0.0 ? sqrt(part->deviation / part->share) : 0.0;
    }
    free(f);
    return GONIO_OK;
}
