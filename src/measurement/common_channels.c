/* Readings in other channels: only the channels that were read, or channels that two readings have
 * in common. See measurement.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../material/colour.h"
#include "readings.h"
#include "../core/memory_stream.h"

/* ---- as colours ---- */

/* Fills R, G and B with the one value. */
static gonio_status fill_grey(const gonio_readings *readings, double *rgb)
{
    for (size_t k = 0; k < readings->count; k++) {
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            rgb[k * GONIO_CHANNELS + c] = readings->value[k];
        }
    }
    return GONIO_OK;
}

/* The sum of the weighted values. A value of weight 0 may be missing. */
static double weighted_sum(const double *weight, const double *value, size_t count)
{
    double sum = 0.0;
    for (size_t j = 0; j < count; j++) {
        sum += weight[j] != 0.0 ? weight[j] * value[j] : 0.0;
    }
    return isnan(sum) ? sum : fmax(sum, 0.0);
}

static gonio_status fill_colours(gonio_context *context, const gonio_readings *readings,
                                 double *rgb)
{
    const size_t channels = readings->channels;
    double *weight = gonio_i_allocate(context, GONIO_CHANNELS * channels, sizeof *weight);
    const gonio_status status = weight != NULL
                                    ? gonio_i_colour_weights(context, readings->wavelength,
                                                             channels, GONIO_ILLUMINANT_E, weight)
                                    : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < readings->count && status == GONIO_OK; k++) {
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            rgb[k * GONIO_CHANNELS + c] =
                weighted_sum(weight + c * channels, readings->value + k * channels, channels);
        }
    }
    free(weight);
    return status;
}

/* ---- at other wavelengths ---- */

/* A wavelength between two channels: value = (1 - fraction) low + fraction high. */
typedef struct between {
    bool within;
    size_t low, high;
    double fraction;
} between;

static between find_wavelength(const gonio_readings *readings, double at)
{
    between b = {false, 0, 0, 0.0};
    double below = -INFINITY;
    double above = INFINITY;
    for (size_t k = 0; k < readings->channels; k++) {
        const double here = readings->wavelength[k];
        if (here <= at && here > below) {
            below = here;
            b.low = k;
        }
        if (here >= at && here < above) {
            above = here;
            b.high = k;
        }
    }
    b.within = isfinite(below) && isfinite(above);
    b.fraction = b.within && above > below ? (at - below) / (above - below) : 0.0;
    return b;
}

/* Interpolates the readings at the wavelengths of others. Returns how many of these wavelengths lie
 * within the range of the readings. */
static size_t interpolate(const gonio_readings *readings, const gonio_readings *others,
                          double *value)
{
    size_t within = 0;
    for (size_t c = 0; c < others->channels; c++) {
        const between b = find_wavelength(readings, others->wavelength[c]);
        within += b.within;
        for (size_t k = 0; k < readings->count; k++) {
            const double *from = readings->value + k * readings->channels;
            value[k * others->channels + c] =
                !b.within           ? NAN
                : b.fraction == 0.0 ? from[b.low]
                                    : from[b.low] + b.fraction * (from[b.high] - from[b.low]);
        }
    }
    return within;
}

static gonio_status fill_wavelengths(gonio_context *context, const gonio_readings *readings,
                                     const gonio_readings *others, double *value)
{
    return interpolate(readings, others, value) > 0
               ? GONIO_OK
               : gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                              "no wavelength of %s is within those of the other", others->path);
}

/* ---- channels without a value ---- */

static bool is_empty(const gonio_readings *readings, size_t channel)
{
    bool empty = true;
    for (size_t k = 0; k < readings->count && empty; k++) {
        empty = isnan(readings->value[k * readings->channels + channel]);
    }
    return empty;
}

/* Lists the channels with values, in order: kept[channels]. Returns their number. */
static size_t find_kept(const gonio_readings *readings, size_t *kept)
{
    size_t count = 0;
    for (size_t c = 0; c < readings->channels; c++) {
        if (!is_empty(readings, c)) {
            kept[count++] = c;
        }
    }
    return count;
}

/* Notes the dropped channels: "nothing was read in R_per_sr, B_per_sr: left out". kept[count] is in
 * order. */
static gonio_status note_dropped(gonio_context *context, gonio_readings *readings,
                                 const size_t *kept, size_t count)
{
    char *text = NULL;
    size_t size = 0;
    size_t next = 0;
    const char *separator = "";
    FILE *stream = gonio_i_memory_stream(&text, &size);
    if (stream == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", readings->path);
    }
    for (size_t c = 0; c < readings->channels; c++) {
        char name[GONIO_I_NAME_ROOM];
        if (next < count && kept[next] == c) {
            next++;
            continue;
        }
        gonio_i_value_name(readings, c, false, name);
        fprintf(stream, "%s%s", separator, name);
        separator = ", ";
    }
    if (fclose(stream) != 0) {
        free(text);
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", readings->path);
    }
    const bool grey = gonio_readings_are_colours(readings) && count == 1;
    gonio_i_note(context, "%s: nothing was read in %s: left out%s", readings->path, text,
                 grey ? "; what was read becomes a single channel, grey in tables of colours" : "");
    free(text);
    return GONIO_OK;
}

/* Removes channels from an array [count][channels], in place. */
static void narrow(double *value, size_t count, size_t channels, const size_t *kept, size_t fewer)
{
    for (size_t k = 0; k < count && value != NULL; k++) {
        for (size_t j = 0; j < fewer; j++) {
            value[k * fewer + j] = value[k * channels + kept[j]];
        }
    }
}

/* The new number of a planned channel. A dropped channel has none. */
static int renumbered(int planned, const size_t *kept, size_t count)
{
    for (size_t j = 0; j < count; j++) {
        if (planned >= 0 && kept[j] == (size_t)planned) {
            return (int)j;
        }
    }
    return GONIO_ALL_CHANNELS;
}

static void keep_channels(gonio_readings *r, const size_t *kept, size_t count)
{
    narrow(r->value, r->count, r->channels, kept, count);
    narrow(r->deviation, r->count, r->channels, kept, count);
    narrow(r->wavelength, 1, r->channels, kept, count);
    for (size_t k = 0; k < r->count; k++) {
        r->planned[k] = renumbered(r->planned[k], kept, count);
    }
    r->channels = count;
    gonio_i_readings_update_view(r);
}

gonio_status gonio_readings_drop_empty_channels(gonio_context *context, gonio_readings *readings)
{
    size_t *kept = gonio_i_allocate(context, readings->channels, sizeof *kept);
    if (kept == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const size_t count = find_kept(readings, kept);
    gonio_status status = GONIO_OK;
    if (count > 0 && count < readings->channels) {
        status = note_dropped(context, readings, kept, count);
        if (status == GONIO_OK) {
            keep_channels(readings, kept, count);
        }
    }
    free(kept);
    return status;
}

/* ---- common channels ---- */

static bool same_channels(const gonio_readings *a, const gonio_readings *b)
{
    bool same = a->channels == b->channels && (a->wavelength == NULL) == (b->wavelength == NULL);
    for (size_t k = 0; same && a->wavelength != NULL && k < a->channels; k++) {
        same = a->wavelength[k] == b->wavelength[k];
    }
    return same;
}

static bool can_be_colours(const gonio_readings *readings)
{
    return readings->wavelength != NULL || readings->channels == 1 ||
           gonio_readings_are_colours(readings);
}

/* Replaces channels and values. Deviations are dropped. */
static gonio_status replace(gonio_context *context, gonio_readings *readings, size_t channels,
                            const double *wavelength, const double *value)
{
    const gonio_status status =
        gonio_i_readings_set_channels(context, readings, channels, wavelength);
    if (status == GONIO_OK) {
        memcpy(readings->value, value, readings->count * channels * sizeof *value);
    }
    return status;
}

static gonio_status make_colours(gonio_context *context, gonio_readings *readings)
{
    if (gonio_readings_are_colours(readings)) {
        return GONIO_OK;
    }
    double *rgb = gonio_i_allocate(context, readings->count * GONIO_CHANNELS, sizeof *rgb);
    gonio_status status = rgb == NULL                    ? GONIO_ERROR_MEMORY
                          : readings->wavelength != NULL ? fill_colours(context, readings, rgb)
                                                         : fill_grey(readings, rgb);
    if (status == GONIO_OK) {
        status = replace(context, readings, GONIO_CHANNELS, NULL, rgb);
    }
    free(rgb);
    return status;
}

static gonio_status make_wavelengths(gonio_context *context, gonio_readings *readings,
                                     const gonio_readings *like)
{
    double *value = gonio_i_allocate(context, readings->count * like->channels, sizeof *value);
    gonio_status status =
        value == NULL ? GONIO_ERROR_MEMORY : fill_wavelengths(context, readings, like, value);
    if (status == GONIO_OK) {
        status = replace(context, readings, like->channels, like->wavelength, value);
    }
    free(value);
    return status;
}

gonio_status gonio_readings_share_channels(gonio_context *context, gonio_readings *a,
                                           gonio_readings *b)
{
    if (same_channels(a, b)) {
        return GONIO_OK;
    }
    if (a->wavelength != NULL && b->wavelength != NULL) {
        return make_wavelengths(context, b, a);
    }
    if (!can_be_colours(a) || !can_be_colours(b)) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                            "%s has %zu channels, %s has %zu; without wavelengths they cannot be "
                            "matched",
                            a->path, a->channels, b->path, b->channels);
    }
    const gonio_status status = make_colours(context, a);
    return status == GONIO_OK ? make_colours(context, b) : status;
}
