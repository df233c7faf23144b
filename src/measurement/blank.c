/* A blank run, subtracted: see gonio_readings_subtract_blank.
 *
 * Levels are subtracted in the unit of the files, in which what the sensor reads without light is
 * the same at all directions. Their uncertainty is that of the blank's own deviations; otherwise
 * that of its repeats; otherwise its scatter about its median. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "readings.h"

/* From a median of absolute differences to a standard deviation. */
static const double TO_DEVIATION = 1.4826;

/* What a blank says of a channel, in the unit of its file. */
typedef struct level {
    double median;
    double scatter; /* standard deviation of one value */
} level;

typedef struct blank {
    gonio_context *context;
    gonio_readings *readings;
    const gonio_readings *dark;
    double noise;
    double floor;
    level *level;      /* [channels] */
    size_t *found;     /* [count]: the blank's reading at the same directions */
    double *mean;      /* [blank's count][channels]: of repeats, at the first of them; its unit */
    double *square;    /* the same: squared deviation of that mean */
    double *deviation; /* [count][channels]: of the values that are left, 1/sr */
    size_t matched;    /* readings at directions of the blank */
    size_t brighter;   /* values that the blank clearly exceeds */
    size_t first_line; /* of the first of them */
    size_t values;
} blank;

static double unit_of(const gonio_readings *r, size_t reading)
{
    return gonio_i_value_factor(&r->unit, r->pair[reading].outgoing.theta);
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median_of(double *value, size_t count)
{
    qsort(value, count, sizeof *value, compare_numbers);
    return count % 2 == 1 ? value[count / 2] : 0.5 * (value[count / 2 - 1] + value[count / 2]);
}

/* The deviation of one value from its repeats; 0 without repeats. */
static double deviation_of_repeats(const gonio_readings *dark, size_t channel)
{
    double square = 0.0;
    size_t freedoms = 0;
    for (size_t k = 0; k < dark->count; k++) {
        const size_t first = dark->first_same[k];
        const double a = dark->value[k * dark->channels + channel] * unit_of(dark, k);
        const double b = dark->value[first * dark->channels + channel] * unit_of(dark, first);
        if (first != k && isfinite(a) && isfinite(b)) {
            square += (a - b) * (a - b) / 2.0;
            freedoms++;
        }
    }
    return freedoms > 0 ? sqrt(square / (double)freedoms) : 0.0;
}

/* The squared deviation of one value of the blank. */
static double square_of(const blank *b, size_t reading, size_t channel)
{
    const size_t k = reading * b->dark->channels + channel;
    const double own = b->dark->deviation != NULL ? b->dark->deviation[k] : NAN;
    const double one = isfinite(own) ? own * unit_of(b->dark, reading) : b->level[channel].scatter;
    return one * one;
}

/* The means of repeats. */
static void find_means(const blank *b, size_t channel)
{
    const gonio_readings *dark = b->dark;
    const size_t channels = dark->channels;
    for (size_t first = 0; first < dark->count; first++) {
        double sum = 0.0;
        double square = 0.0;
        double count = 0.0;
        for (size_t k = first; k < dark->count && dark->first_same[first] == first; k++) {
            const double value = dark->value[k * channels + channel] * unit_of(dark, k);
            if (dark->first_same[k] == first && isfinite(value)) {
                sum += value;
                square += square_of(b, k, channel);
                count += 1.0;
            }
        }
        b->mean[first * channels + channel] = count > 0.0 ? sum / count : NAN;
        b->square[first * channels + channel] = count > 0.0 ? square / (count * count) : NAN;
    }
}

static gonio_status find_level(const blank *b, size_t channel)
{
    const gonio_readings *dark = b->dark;
    double *value = gonio_i_allocate(b->context, dark->count, sizeof *value);
    size_t count = 0;
    if (value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < dark->count; k++) {
        const double one = dark->value[k * dark->channels + channel] * unit_of(dark, k);
        value[count] = one;
        count += isfinite(one);
    }
    level *l = &b->level[channel];
    l->median = count > 0 ? median_of(value, count) : NAN;
    for (size_t k = 0; k < count; k++) {
        value[k] = fabs(value[k] - l->median);
    }
    const double repeated = deviation_of_repeats(dark, channel);
    l->scatter = repeated > 0.0 ? repeated : count > 1 ? TO_DEVIATION * median_of(value, count) : 0;
    free(value);
    find_means(b, channel);
    return GONIO_OK;
}

/* The level of a channel at a reading, in the unit of the file, and its deviation. */
static double level_at(const blank *b, size_t reading, size_t channel, double *deviation)
{
    const gonio_readings *dark = b->dark;
    const size_t found = b->found[reading];
    const size_t k = found < dark->count ? dark->first_same[found] * dark->channels + channel : 0;
    if (found == dark->count || !isfinite(b->mean[k])) {
        *deviation = b->level[channel].scatter;
        return b->level[channel].median;
    }
    *deviation = sqrt(b->square[k]);
    return b->mean[k];
}

static void subtract(blank *b, size_t reading, size_t channel)
{
    gonio_readings *r = b->readings;
    const size_t k = reading * r->channels + channel;
    const double unit = unit_of(r, reading);
    const double own = r->deviation != NULL ? r->deviation[k] : NAN;
    const double noise = isfinite(own) ? own : hypot(b->noise * r->value[k], b->floor);
    double spread = 0.0;
    const double dark = level_at(b, reading, channel, &spread) / unit;
    if (!isfinite(r->value[k]) || !isfinite(dark)) {
        b->deviation[k] = own;
        return;
    }
    b->deviation[k] = hypot(noise, spread / unit);
    const double left = r->value[k] - dark;
    if (left < -2.0 * b->deviation[k]) {
        b->first_line = b->brighter == 0 ? r->line[reading] : b->first_line;
        b->brighter++;
    }
    b->values++;
    r->value[k] = fmax(left, 0.0);
}

static gonio_status check_channels(const blank *b)
{
    const gonio_readings *r = b->readings;
    const gonio_readings *dark = b->dark;
    bool same =
        r->channels == dark->channels && (r->wavelength == NULL) == (dark->wavelength == NULL);
    for (size_t k = 0; same && r->wavelength != NULL && k < r->channels; k++) {
        same = r->wavelength[k] == dark->wavelength[k];
    }
    return same ? GONIO_OK
                : gonio_i_fail(b->context, GONIO_ERROR_MISMATCH,
                               "%s: the blank has other channels than %s", dark->path, r->path);
}

static gonio_status prepare(blank *b)
{
    const gonio_readings *r = b->readings;
    gonio_status status = check_channels(b);
    if (status != GONIO_OK) {
        return status;
    }
    b->level = gonio_i_allocate(b->context, r->channels, sizeof *b->level);
    b->found = gonio_i_allocate(b->context, r->count, sizeof *b->found);
    b->deviation = gonio_i_make_values(b->context, r, r->channels);
    b->mean = gonio_i_make_values(b->context, b->dark, r->channels);
    b->square = gonio_i_make_values(b->context, b->dark, r->channels);
    if (b->mean == NULL || b->square == NULL || b->level == NULL || b->found == NULL ||
        b->deviation == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    status =
        gonio_i_find_readings(b->context, b->dark, true, r->pair, r->count, SIZE_MAX, b->found);
    for (size_t c = 0; c < r->channels && status == GONIO_OK; c++) {
        status = find_level(b, c);
    }
    for (size_t k = 0; k < r->count && status == GONIO_OK; k++) {
        b->matched += b->found[k] < b->dark->count;
    }
    return status;
}

static gonio_status note(const blank *b)
{
    gonio_readings *r = b->readings;
    const size_t others = r->count - b->matched;
    gonio_status status = gonio_i_readings_note(
        b->context, r,
        "a blank run of %zu reading%s is subtracted: at %zu the blank of the same directions, at "
        "%zu its median (%.3g, deviation %.2g, as in its file)",
        b->dark->count, b->dark->count > 1 ? "s" : "", b->matched, others, b->level[0].median,
        b->level[0].scatter);
    if (status == GONIO_OK && b->brighter > 0) {
        status = gonio_i_readings_note(
            b->context, r,
            "the blank is brighter than the sample in %zu of %zu values (first in line %zu), which "
            "are taken as 0%s",
            b->brighter, b->values, b->first_line,
            2 * b->brighter > b->values ? ": are the two files exchanged, or was the lamp on?"
                                        : "");
    }
    return status;
}

gonio_status gonio_readings_subtract_blank(gonio_context *context, gonio_readings *readings,
                                           const gonio_readings *dark, double noise, double floor)
{
    blank b = {
        .context = context, .readings = readings, .dark = dark, .noise = noise, .floor = floor};
    gonio_status status = prepare(&b);
    for (size_t k = 0; status == GONIO_OK && k < readings->count * readings->channels; k++) {
        subtract(&b, k / readings->channels, k % readings->channels);
    }
    if (status == GONIO_OK) {
        free(readings->deviation);
        readings->deviation = b.deviation;
        b.deviation = NULL;
        gonio_i_readings_update_view(readings);
        status = note(&b);
    }
    free(b.level);
    free(b.found);
    free(b.mean);
    free(b.square);
    free(b.deviation);
    return status;
}
