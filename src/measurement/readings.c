/* Readings as numbers: see measurement.h. */
#include "readings.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/options.h"
#include "../core/number.h"
#include "../plan/plan_file.h"
#include "rules.h"

enum { FIRST_ROOM = 64 };

void gonio_readings_options_default_of(gonio_readings_options *options, size_t size)
{
    const gonio_readings_options usual = {.values_needed = true};
    gonio_i_give(&usual, sizeof usual, options, size);
}

gonio_status gonio_i_readings_new(gonio_context *context, const char *path,
                                  const gonio_readings_options *options, gonio_readings **readings)
{
    gonio_readings_options how;
    const gonio_status status = GONIO_I_TAKE(context, gonio_readings_options, options, &how);
    gonio_readings *made = status == GONIO_OK ? gonio_i_allocate(context, 1, sizeof *made) : NULL;
    if (made == NULL) {
        return status != GONIO_OK ? status : GONIO_ERROR_MEMORY;
    }
    made->options = how;
    made->method = "";
    made->path = strdup(path);
    if (made->path == NULL) {
        gonio_readings_free(&made);
        gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
        return GONIO_ERROR_MEMORY;
    }
    *readings = made;
    return GONIO_OK;
}

void gonio_readings_free(gonio_readings **readings)
{
    if (readings == NULL || *readings == NULL) {
        return;
    }
    gonio_readings *old = *readings;
    if (old->attachment.release != NULL) {
        old->attachment.release(old->attachment.data);
    }
    gonio_i_comments_free(&old->comment);
    gonio_i_comments_free(&old->note);
    free(old->path);
    free(old->pair);
    free(old->planned);
    free(old->line);
    free(old->value);
    free(old->deviation);
    free(old->wavelength);
    free(old->given);
    free(old->first_same);
    free(old);
    *readings = NULL;
}

static double to_degrees(double radians)
{
    return radians * 180.0 / M_PI;
}

/* ---- what is in them ---- */

void gonio_i_readings_update_view(gonio_readings *readings)
{
    readings->view = (gonio_readings_view){.count = readings->count,
                                           .channels = readings->channels,
                                           .pair = readings->pair,
                                           .planned = readings->planned,
                                           .wavelength = readings->wavelength,
                                           .value = readings->value,
                                           .deviation = readings->deviation,
                                           .line = readings->line,
                                           .path = readings->path,
                                           .basis = readings->basis,
                                           .components = readings->components,
                                           .method = readings->method,
                                           .below_zero = readings->below_zero,
                                           .notes = readings->note.count,
                                           .note = (const char *const *)readings->note.line};
}

const gonio_readings_view *gonio_readings_describe(const gonio_readings *readings)
{
    return &readings->view;
}

bool gonio_readings_are_colours(const gonio_readings *readings)
{
    return readings->wavelength == NULL && readings->channels == GONIO_CHANNELS;
}

double gonio_readings_value(const gonio_readings *readings, size_t reading, size_t channel)
{
    const bool held = reading < readings->count && channel < readings->channels;
    return held ? readings->value[reading * readings->channels + channel] : NAN;
}

double gonio_readings_scale(const gonio_readings *readings, size_t channel)
{
    return gonio_log_scale(gonio_readings_are_colours(readings) ? (int)channel : GONIO_CHANNELS);
}

double gonio_i_readings_degrees(const gonio_readings *readings, size_t reading, size_t which)
{
    const gonio_pair *pair = &readings->pair[reading];
    const double radians[4] = {pair->incident.theta, pair->incident.phi, pair->outgoing.theta,
                               pair->outgoing.phi};
    return readings->given != NULL ? readings->given[reading][which] : to_degrees(radians[which]);
}

void gonio_i_value_name(const gonio_readings *readings, size_t channel, bool deviation,
                        char name[GONIO_I_NAME_ROOM])
{
    const char *end = deviation ? "_deviation_per_sr" : "_per_sr";
    if (readings->wavelength != NULL) {
        gonio_i_print(name, GONIO_I_NAME_ROOM, "%.10gnm%s", readings->wavelength[channel], end);
    } else if (gonio_readings_are_colours(readings)) {
        snprintf(name, GONIO_I_NAME_ROOM, "%c%s", "RGB"[channel], end);
    } else if (readings->channels == 1) {
        snprintf(name, GONIO_I_NAME_ROOM, "value%s", end);
    } else {
        snprintf(name, GONIO_I_NAME_ROOM, "value%zu%s", channel + 1, end);
    }
}

/* ---- channels ---- */

static gonio_status check_wavelength(gonio_context *context, const char *path, double wavelength)
{
    if (!(wavelength > 0.0 && wavelength <= gonio_i_most_wavelength)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "%s: %g is not a wavelength in nm", path,
                            wavelength);
    }
    return wavelength >= gonio_i_least_wavelength
               ? GONIO_OK
               : gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                              "%s: a wavelength of %g nm is no light; give nanometres", path,
                              wavelength);
}

static gonio_status check_wavelengths(gonio_context *context, const char *path, size_t channels,
                                      const double *wavelength)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < channels && status == GONIO_OK; k++) {
        status = check_wavelength(context, path, wavelength[k]);
    }
    if (status != GONIO_OK) {
        return status;
    }
    const double twice = gonio_i_wavelength_twice(wavelength, channels);
    return twice == 0.0 ? GONIO_OK
           : twice < 0.0
               ? gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path)
               : gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "%s: %g nm occurs twice", path, twice);
}

static gonio_status copy_wavelengths(gonio_context *context, const char *path, size_t channels,
                                     const double *wavelength, double **copy)
{
    *copy = NULL;
    if (channels == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "%s: no channels", path);
    }
    if (wavelength == NULL) {
        return GONIO_OK;
    }
    const gonio_status status = check_wavelengths(context, path, channels, wavelength);
    if (status != GONIO_OK) {
        return status;
    }
    *copy = gonio_i_allocate(context, channels, sizeof **copy);
    if (*copy == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(*copy, wavelength, channels * sizeof **copy);
    return GONIO_OK;
}

gonio_status gonio_i_readings_begin(gonio_context *context, gonio_readings *readings,
                                    size_t channels, const double *wavelength)
{
    readings->channels = channels;
    return copy_wavelengths(context, readings->path, channels, wavelength, &readings->wavelength);
}

/* Room for values of other channels: count * channels of them, all NaN; NULL when out of memory. */
static double *make_values(gonio_context *context, const gonio_readings *readings, size_t channels)
{
    const bool fits = channels == 0 || readings->count <= SIZE_MAX / channels;
    double *value =
        gonio_i_allocate(context, fits ? readings->count * channels : SIZE_MAX, sizeof *value);
    for (size_t k = 0; value != NULL && k < readings->count * channels; k++) {
        value[k] = NAN;
    }
    return value;
}

gonio_status gonio_i_readings_set_channels(gonio_context *context, gonio_readings *readings,
                                           size_t channels, const double *wavelength)
{
    double *kept = NULL;
    const gonio_status status =
        copy_wavelengths(context, readings->path, channels, wavelength, &kept);
    double *value = status == GONIO_OK ? make_values(context, readings, channels) : NULL;
    if (value == NULL) {
        free(kept);
        return status != GONIO_OK ? status : GONIO_ERROR_MEMORY;
    }
    free(readings->wavelength);
    free(readings->value);
    free(readings->deviation);
    readings->wavelength = kept;
    readings->value = value;
    readings->deviation = NULL;
    readings->channels = channels;
    gonio_i_readings_update_view(readings);
    return GONIO_OK;
}

/* ---- one reading after another ---- */

/* The block with room for more, or as it is and *done false. */
static void *enlarge(void *block, size_t room, size_t size, bool *done)
{
    void *more = reallocarray(block, room, size);
    if (more == NULL) {
        *done = false;
        return block;
    }
    return more;
}

static gonio_status make_room(gonio_context *context, gonio_readings *r, bool deviations)
{
    if (r->count < r->room) {
        return GONIO_OK;
    }
    const size_t first = r->expected > FIRST_ROOM ? r->expected : FIRST_ROOM;
    const size_t room = r->room > 0 ? 2 * r->room : first;
    const size_t values = r->channels * sizeof(double);
    bool done = true;
    r->pair = enlarge(r->pair, room, sizeof *r->pair, &done);
    r->planned = enlarge(r->planned, room, sizeof *r->planned, &done);
    r->line = enlarge(r->line, room, sizeof *r->line, &done);
    r->value = enlarge(r->value, room, values, &done);
    if (deviations) {
        r->deviation = enlarge(r->deviation, room, values, &done);
    }
    if (r->keep_angles) {
        r->given = enlarge(r->given, room, sizeof *r->given, &done);
    }
    if (!done) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", r->path);
    }
    r->room = room;
    return GONIO_OK;
}

static gonio_status bad_number(gonio_context *context, const gonio_readings *r, size_t line,
                               const char *name, double number, const char *problem,
                               gonio_status status)
{
    return gonio_i_fail(context, status, "%s:%zu: %s '%.9g' %s", r->path, line, name, number,
                        problem);
}

static gonio_status check_angles(gonio_context *context, const gonio_readings *r, size_t line,
                                 const double degrees[4])
{
    for (int k = 0; k < 4; k++) {
        gonio_status status = GONIO_OK;
        const char *problem = gonio_i_angle_problem(k, degrees[k], &status);
        if (problem != NULL) {
            return bad_number(context, r, line, gonio_i_angle_names[k], degrees[k], problem,
                              status);
        }
    }
    return GONIO_OK;
}

/* Checks a value and takes it as 0 where it is below and may be. */
static gonio_status take_value(gonio_context *context, const gonio_readings *r, size_t line,
                               size_t channel, const gonio_readings_options *options, double value,
                               double *to)
{
    gonio_status status = GONIO_OK;
    const char *problem = isnan(value) ? NULL : gonio_i_value_problem(value, options, &status);
    if (problem != NULL) {
        char name[GONIO_I_NAME_ROOM];
        gonio_i_value_name(r, channel, false, name);
        return bad_number(context, r, line, name, value, problem, status);
    }
    *to = isnan(value) ? value : fmax(value, 0.0);
    return GONIO_OK;
}

static gonio_status take_deviation(gonio_context *context, const gonio_readings *r, size_t line,
                                   size_t channel, double deviation, double *to)
{
    gonio_status status = GONIO_OK;
    const char *problem = isnan(deviation) ? NULL : gonio_i_deviation_problem(deviation, &status);
    if (problem != NULL) {
        char name[GONIO_I_NAME_ROOM];
        gonio_i_value_name(r, channel, true, name);
        return bad_number(context, r, line, name, deviation, problem, status);
    }
    *to = deviation;
    return GONIO_OK;
}

gonio_status gonio_i_readings_add(gonio_context *context, gonio_readings *r,
                                  const gonio_i_reading *reading)
{
    gonio_status status = make_room(context, r, reading->deviation != NULL);
    if (status == GONIO_OK) {
        status = check_angles(context, r, reading->line, reading->degrees);
    }
    const size_t first = r->count * r->channels;
    for (size_t k = 0; k < r->channels && status == GONIO_OK; k++) {
        r->below_zero += reading->value[k] < 0.0;
        status = take_value(context, r, reading->line, k, &r->options, reading->value[k],
                            &r->value[first + k]);
        if (status == GONIO_OK && reading->deviation != NULL) {
            status = take_deviation(context, r, reading->line, k, reading->deviation[k],
                                    &r->deviation[first + k]);
        }
    }
    if (status != GONIO_OK) {
        return status;
    }
    const double *d = reading->degrees;
    r->pair[r->count] = (gonio_pair){gonio_i_angles_from_degrees(d[0], d[1]),
                                     gonio_i_angles_from_degrees(d[2], d[3])};
    r->planned[r->count] = reading->planned;
    r->line[r->count] = reading->line;
    if (r->keep_angles) {
        memcpy(r->given[r->count], d, sizeof *r->given);
    }
    r->count++;
    return GONIO_OK;
}

gonio_status gonio_i_readings_note(gonio_context *context, gonio_readings *readings,
                                   const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    const int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    const bool kept =
        length >= 0 && gonio_i_comments_add_text(&readings->note, text, (size_t)length);
    if (kept) {
        gonio_i_readings_update_view(readings);
        gonio_i_note(context, "%s: %s", readings->path, text);
    }
    free(length >= 0 ? text : NULL);
    return kept ? GONIO_OK
                : gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", readings->path);
}

static gonio_status note_poles(gonio_context *context, gonio_readings *readings)
{
    size_t turned = 0;
    const gonio_status status = gonio_i_readings_count_turned(context, readings, &turned);
    if (status != GONIO_OK || turned == 0) {
        return status;
    }
    return gonio_i_readings_note(context, readings,
                                 "theta = 0 is one direction at any azimuth: %zu reading%s another",
                                 turned, turned > 1 ? "s repeat" : " repeats");
}

gonio_status gonio_i_readings_finish(gonio_context *context, gonio_readings *readings,
                                     bool measured)
{
    if (readings->count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "%s: no lines below the column names",
                            readings->path);
    }
    const char *method = gonio_i_comments_value(&readings->comment, "method");
    readings->method = method != NULL ? method : "";
    gonio_i_readings_update_view(readings);
    gonio_status status = gonio_i_readings_group(context, readings);
    if (status == GONIO_OK) {
        status = note_poles(context, readings);
    }
    return status == GONIO_OK && !readings->options.average_repeats
               ? gonio_i_readings_refuse_repeats(context, readings, measured)
               : status;
}

/* ---- from arrays ---- */

static double within_a_turn(double phi)
{
    return phi >= 0.0 && phi < 2.0 * M_PI ? phi
                                          : fmod(phi < 0.0 ? phi + 2.0 * M_PI : phi, 2.0 * M_PI);
}

static gonio_status take_pair(gonio_context *context, gonio_readings *r, size_t k,
                              const gonio_pair *pair)
{
    const double degrees[4] = {to_degrees(pair->incident.theta), to_degrees(pair->incident.phi),
                               to_degrees(pair->outgoing.theta), to_degrees(pair->outgoing.phi)};
    r->pair[k] = (gonio_pair){{pair->incident.theta, within_a_turn(pair->incident.phi)},
                              {pair->outgoing.theta, within_a_turn(pair->outgoing.phi)}};
    r->line[k] = k + 1;
    return check_angles(context, r, k + 1, degrees);
}

static gonio_status take_planned(gonio_context *context, gonio_readings *r, size_t k, int planned)
{
    r->planned[k] = planned;
    if (planned != GONIO_ALL_CHANNELS && !(planned >= 0 && (size_t)planned < r->channels)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "%s:%zu: channel %d of %zu channels",
                            r->path, k + 1, planned, r->channels);
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
        status = take_value(context, r, r->line[k / r->channels], k % r->channels, options,
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

/* NULL for NULL; *done becomes false when out of memory. */
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
    made->wavelength =
        copy_array(context, r->wavelength, r->channels, sizeof *r->wavelength, &done);
    made->first_same = copy_array(context, r->first_same, r->count, sizeof *r->first_same, &done);
    if (!done) {
        gonio_readings_free(&made);
        return GONIO_ERROR_MEMORY;
    }
    made->below_zero = r->below_zero;
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
    gonio_readings changed = *readings; /* what fails leaves the readings as they are */
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
                            "%s: reading %zu, channel %zu of %zu readings in %zu channels",
                            readings->path, reading, channel, readings->count, readings->channels);
    }
    gonio_readings_options strict;
    gonio_readings_options_default(&strict);
    return take_value(context, readings, readings->line[reading], channel, &strict, value,
                      &gonio_i_readings_values(readings, reading)[channel]);
}

gonio_status gonio_readings_set_deviations(gonio_context *context, gonio_readings *readings,
                                           const double *deviation)
{
    double *made = deviation != NULL ? make_values(context, readings, readings->channels) : NULL;
    gonio_status status = deviation != NULL && made == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    const size_t channels = readings->channels;
    for (size_t k = 0; made != NULL && k < readings->count * channels && status == GONIO_OK; k++) {
        status = take_deviation(context, readings, readings->line[k / channels], k % channels,
                                deviation[k], &made[k]);
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
