/* Readings as numbers: the object, what it shows of itself, and its channels. See measurement.h. */
#include "readings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/options.h"
#include "../core/number.h"
#include "rules.h"

void gonio_readings_options_default_of(gonio_readings_options *options, size_t size)
{
    const gonio_readings_options usual = {.values_needed = true};
    gonio_i_give(&usual, sizeof usual, options, size);
}

/* Copies what the readings need of the instrument that made them. False when out of memory. */
static bool take_instrument(gonio_readings *r)
{
    const gonio_instrument *instrument = r->options.instrument;
    r->options.instrument = NULL;
    if (instrument == NULL) {
        return true;
    }
    r->unit = gonio_i_value_unit_of(instrument);
    r->usual_values = r->unit.kind;
    r->unit.kind = 0;
    if (r->unit.rows == 0) {
        return true;
    }
    const size_t bytes = r->unit.rows * sizeof *r->reference;
    r->reference = malloc(bytes);
    if (r->reference != NULL) {
        memcpy(r->reference, r->unit.row, bytes);
    }
    r->unit.row = r->reference;
    return r->reference != NULL;
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
    if (made->path == NULL || !take_instrument(made)) {
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
    free(old->time);
    free(old->wavelength);
    free(old->given);
    free(old->first_same);
    free(old->reference);
    free(old);
    *readings = NULL;
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
                                           .time = readings->time,
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

/* Levels are whole numbers up to 255; a bright BRDF of whole numbers only has not been seen. */
static const double LARGEST_LEVEL = 255.0;
static const double BRIGHT_LEVEL = 100.0;
enum { FEW_LEVELS = 5 };

bool gonio_i_readings_are_levels(const gonio_readings *readings)
{
    size_t count = 0;
    double largest = 0.0;
    for (size_t k = 0; k < readings->count * readings->channels; k++) {
        const double value = readings->value[k];
        if (isnan(value)) {
            continue;
        }
        if (value != floor(value) || value > LARGEST_LEVEL) {
            return false;
        }
        largest = fmax(largest, value);
        count++;
    }
    return readings->wavelength == NULL && count >= FEW_LEVELS && largest > BRIGHT_LEVEL;
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
    static const double highest =
        89.9999999999; /* that twelve digits do not round to the horizon */
    double degrees[4];
    gonio_i_pair_to_degrees(&readings->pair[reading], degrees);
    const double angle = readings->given != NULL ? readings->given[reading][which] : degrees[which];
    return which % 2 == 0 ? fmin(angle, highest) : angle;
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
                              "%s: a wavelength of %g nm is not light; give nanometres", path,
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

double *gonio_i_make_values(gonio_context *context, const gonio_readings *readings, size_t channels)
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
    double *value = status == GONIO_OK ? gonio_i_make_values(context, readings, channels) : NULL;
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
