/* Readings from arrays and from plans, copies of readings, and other values for them: see
 * measurement.h. */
#include "readings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/options.h"
#include "../plan/plan_file.h"
#include "reading_numbers.h"
#include "rules.h"

static double within_a_turn(double phi)
{
    return phi >= 0.0 && phi < 2.0 * M_PI ? phi
                                          : fmod(phi < 0.0 ? phi + 2.0 * M_PI : phi, 2.0 * M_PI);
}

static gonio_status take_pair(gonio_context *context, gonio_readings *r, size_t k,
                              const gonio_pair *pair)
{
    double degrees[4];
    gonio_i_pair_to_degrees(pair, degrees);
    r->pair[k] = (gonio_pair){{pair->incident.theta, within_a_turn(pair->incident.phi)},
                              {pair->outgoing.theta, within_a_turn(pair->outgoing.phi)}};
    r->line[k] = k + 1;
    return gonio_i_check_angles(context, r, k + 1, degrees);
}

static gonio_status take_planned(gonio_context *context, gonio_readings *r, size_t k, int planned)
{
    r->planned[k] = planned;
    if (planned != GONIO_ALL_CHANNELS && !(planned >= 0 && (size_t)planned < r->channels)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%s:%zu: channel %d is outside %zu channels", r->path, k + 1, planned,
                            r->channels);
    }
    return GONIO_OK;
}

static gonio_status allocate_directions(gonio_context *context, gonio_readings *r, size_t count)
{
    r->count = count;
    r->room = count;
    r->pair = gonio_i_allocate(context, count, sizeof *r->pair);
    r->planned = gonio_i_allocate(context, count, sizeof *r->planned);
    r->line = gonio_i_allocate(context, count, sizeof *r->line);
    return r->pair && r->planned && r->line ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status take_directions(gonio_context *context, gonio_readings *r,
                                    const gonio_readings_arrays *a)
{
    gonio_status status = allocate_directions(context, r, a->count);
    for (size_t k = 0; k < a->count && status == GONIO_OK; k++) {
        status = take_pair(context, r, k, &a->pair[k]);
        if (status == GONIO_OK) {
            status = take_planned(context, r, k,
                                  a->planned != NULL ? a->planned[k] : GONIO_ALL_CHANNELS);
        }
    }
    return status;
}

/* Checks and copies values[count][channels]. */
static gonio_status copy_values(gonio_context *context, const gonio_readings *r,
                                const gonio_readings_options *options, const double *value,
                                double *to)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < r->count * r->channels && status == GONIO_OK; k++) {
        status = gonio_i_take_value(context, r, r->line[k / r->channels], k % r->channels, options,
                                    value[k], &to[k]);
    }
    return status;
}

static gonio_status fill(gonio_context *context, gonio_readings *r, const gonio_readings_arrays *a)
{
    if (a->count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "no readings given");
    }
    r->count = a->count;
    gonio_status status = gonio_i_readings_set_channels(context, r, a->channels, a->wavelength);
    if (status == GONIO_OK) {
        status = take_directions(context, r, a);
    }
    if (status == GONIO_OK && a->value != NULL) {
        status = copy_values(context, r, &r->options, a->value, r->value);
    }
    if (status == GONIO_OK) {
        status = gonio_readings_set_deviations(context, r, a->deviation);
    }
    return status == GONIO_OK ? gonio_i_readings_finish(context, r, a->value != NULL) : status;
}

gonio_status gonio_readings_create(gonio_context *context, const gonio_readings_arrays *arrays,
                                   const gonio_readings_options *options, gonio_readings **readings)
{
    gonio_readings_arrays taken;
    gonio_readings *made = NULL;
    gonio_status status = GONIO_I_TAKE_PLAIN(context, gonio_readings_arrays, arrays, &taken);
    if (status == GONIO_OK) {
        status = gonio_i_readings_new(context, "readings", options, &made);
    }
    if (status == GONIO_OK) {
        status = fill(context, made, &taken);
    }
    if (status != GONIO_OK) {
        gonio_readings_free(&made);
        return status;
    }
    *readings = made;
    return GONIO_OK;
}

static gonio_status fill_from_plan(gonio_context *context, gonio_readings *r,
                                   const gonio_plan *plan)
{
    if (plan->count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a plan without entries");
    }
    gonio_status status = allocate_directions(context, r, plan->count);
    if (status == GONIO_OK) {
        status = gonio_i_readings_set_channels(context, r, GONIO_CHANNELS, NULL);
    }
    for (size_t k = 0; k < plan->count && status == GONIO_OK; k++) {
        status = take_pair(context, r, k, &plan->entries[k].pair);
        if (status == GONIO_OK) {
            status = take_planned(context, r, k, plan->entries[k].channel);
        }
    }
    r->basis = plan->basis;
    r->components = plan->expected == NULL ? plan->components : 0;
    if (status == GONIO_OK && !gonio_i_plan_comments(plan, &r->comment)) {
        status = gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", r->path);
    }
    return status == GONIO_OK ? gonio_i_readings_finish(context, r, false) : status;
}

gonio_status gonio_readings_create_from_plan(gonio_context *context, const gonio_plan *plan,
                                             gonio_readings **readings)
{
    const gonio_readings_options any = {.size = sizeof any, .average_repeats = true};
    gonio_readings *made = NULL;
    gonio_status status = gonio_i_readings_new(context, "plan", &any, &made);
    if (status == GONIO_OK) {
        status = fill_from_plan(context, made, plan);
    }
    if (status != GONIO_OK) {
        gonio_readings_free(&made);
        return status;
    }
    *readings = made;
    return GONIO_OK;
}

/* ---- a copy ---- */

/* A copy of an array; NULL for NULL. *done becomes false when out of memory. */
static void *copy_array(gonio_context *context, const void *from, size_t count, size_t size,
                        bool *done)
{
    void *to = from != NULL ? gonio_i_allocate(context, count, size) : NULL;
    if (to != NULL) {
        memcpy(to, from, count * size);
    }
    *done = *done && (from == NULL || to != NULL);
    return to;
}

gonio_status gonio_readings_copy(gonio_context *context, const gonio_readings *readings,
                                 gonio_readings **copy)
{
    const gonio_readings *r = readings;
    const size_t values = r->count * r->channels;
    gonio_readings *made = NULL;
    bool done = true;
    const gonio_status status = gonio_i_readings_new(context, r->path, &r->options, &made);
    if (status != GONIO_OK) {
        return status;
    }
    made->count = r->count;
    made->room = r->count;
    made->channels = r->channels;
    made->pair = copy_array(context, r->pair, r->count, sizeof *r->pair, &done);
    made->planned = copy_array(context, r->planned, r->count, sizeof *r->planned, &done);
    made->line = copy_array(context, r->line, r->count, sizeof *r->line, &done);
    made->value = copy_array(context, r->value, values, sizeof *r->value, &done);
    made->deviation = copy_array(context, r->deviation, values, sizeof *r->deviation, &done);
    made->time = copy_array(context, r->time, r->count, sizeof *r->time, &done);
    made->wavelength =
        copy_array(context, r->wavelength, r->channels, sizeof *r->wavelength, &done);
    made->reference = copy_array(context, r->reference, r->unit.rows, sizeof *r->reference, &done);
    made->first_same = copy_array(context, r->first_same, r->count, sizeof *r->first_same, &done);
    if (!done) {
        gonio_readings_free(&made);
        return GONIO_ERROR_MEMORY;
    }
    made->below_zero = r->below_zero;
    made->unit = r->unit;
    made->unit.row = made->reference;
    made->basis = r->basis;
    made->components = r->components;
    gonio_i_readings_update_view(made);
    *copy = made;
    return GONIO_OK;
}

/* ---- changing them ---- */

gonio_status gonio_readings_set_values(gonio_context *context, gonio_readings *readings,
                                       size_t channels, const double *wavelength,
                                       const double *value, const gonio_readings_options *options)
{
    gonio_readings_options how;
    gonio_status status = GONIO_I_TAKE(context, gonio_readings_options, options, &how);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_readings changed = *readings; /* a failure leaves the readings unchanged */
    changed.value = NULL;
    changed.deviation = NULL;
    changed.wavelength = NULL;
    status = gonio_i_readings_set_channels(context, &changed, channels, wavelength);
    if (status == GONIO_OK && value != NULL) {
        status = copy_values(context, &changed, &how, value, changed.value);
    }
    gonio_readings *dropped = status == GONIO_OK ? readings : &changed;
    free(dropped->value);
    free(dropped->deviation);
    free(dropped->wavelength);
    if (status == GONIO_OK) {
        *readings = changed;
    }
    return status;
}

gonio_status gonio_readings_set_value(gonio_context *context, gonio_readings *readings,
                                      size_t reading, size_t channel, double value)
{
    if (reading >= readings->count || channel >= readings->channels) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%s: reading %zu, channel %zu is outside %zu readings in %zu channels",
                            readings->path, reading, channel, readings->count, readings->channels);
    }
    gonio_readings_options strict;
    gonio_readings_options_default(&strict);
    return gonio_i_take_value(context, readings, readings->line[reading], channel, &strict, value,
                              &gonio_i_readings_values(readings, reading)[channel]);
}

gonio_status gonio_readings_set_deviations(gonio_context *context, gonio_readings *readings,
                                           const double *deviation)
{
    double *made =
        deviation != NULL ? gonio_i_make_values(context, readings, readings->channels) : NULL;
    gonio_status status = deviation != NULL && made == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    const size_t channels = readings->channels;
    for (size_t k = 0; made != NULL && k < readings->count * channels && status == GONIO_OK; k++) {
        status = gonio_i_take_deviation(context, readings, readings->line[k / channels],
                                        k % channels, deviation[k], &made[k]);
    }
    if (status != GONIO_OK) {
        free(made);
        return status;
    }
    free(readings->deviation);
    readings->deviation = made;
    gonio_i_readings_update_view(readings);
    return GONIO_OK;
}
