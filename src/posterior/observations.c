/* Readings as columns of observations: see observations.h. */
#include "observations.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../measurement/readings.h"

double gonio_i_dark_level_missing(const double *dark, size_t channel, double theta_i)
{
    return dark != NULL ? dark[channel] / fmax(cos(theta_i), 1e-3) : 0.0;
}

/* The variance of a value, in squares of 1/sr: of its own deviation where that is known (not NaN).
 */
static double noise_of(double value, double deviation, const gonio_i_noise *noise)
{
    const double relative = noise->relative * value;
    return isnan(deviation) ? relative * relative + noise->floor * noise->floor
                            : deviation * deviation;
}

/* The variance of g = ln(1 + v/s) for noise of the value v. */
static double variance_of(double value, double deviation, double s, const gonio_i_noise *noise)
{
    return noise_of(value, deviation, noise) / ((value + s) * (value + s)) +
           GONIO_I_MODEL_DEVIATION * GONIO_I_MODEL_DEVIATION;
}

/* The factor of a value. */
static double factor_of(gonio_pair pair, double s, const gonio_i_transform *transform)
{
    const double outgoing = transform->by_cosine ? cos(pair.outgoing.theta) : 1.0;
    const double incident = transform->by_cosine_i ? cos(pair.incident.theta) : 1.0;
    return transform->factor * (transform->merl ? s : 1.0) /
           (fmax(outgoing, 1e-3) * fmax(incident, 1e-3));
}

static double true_value(gonio_pair pair, size_t channel, double value, double s,
                         const gonio_i_transform *transform)
{
    return value * factor_of(pair, s, transform) +
           gonio_i_dark_level_missing(transform->dark, channel, pair.incident.theta);
}

/* The standard deviation of a value that a transform makes; NaN where it is not known. */
static double true_deviation(const gonio_readings_view *view, size_t index, size_t channel,
                             double s, const gonio_i_transform *transform)
{
    if (view->deviation == NULL) {
        return NAN;
    }
    const double deviation = view->deviation[index * view->channels + channel];
    return transform != NULL ? deviation * factor_of(view->pair[index], s, transform) : deviation;
}

/* Of a value as it was read. */
static int bound_of(double read, const gonio_i_noise *noise)
{
    const bool saturated = noise->saturation > 0.0 && read >= noise->saturation;
    return saturated ? 1 : read <= 0.0 ? -1 : 0;
}

/* The observation of a value in log space; deviation: that of the value, or NaN. */
static void set_value(gonio_i_observation *o, double value, double deviation, double s,
                      const gonio_i_noise *noise)
{
    o->g = log1p(value / s);
    o->variance = variance_of(value, deviation, s, noise);
}

static gonio_i_observation observe(const gonio_readings *readings, size_t index, size_t channel,
                                   const gonio_i_noise *noise)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    const double s = gonio_readings_scale(readings, channel);
    const double read = gonio_readings_value(readings, index, channel);
    gonio_i_observation o = {.at = gonio_half_difference_from_pair(view->pair[index]),
                             .channel = (int)channel,
                             .bound = bound_of(read, noise),
                             .reading = index};
    set_value(&o, read, true_deviation(view, index, channel, s, NULL), s, noise);
    return o;
}

void gonio_i_column_transform(const gonio_readings *readings, const gonio_i_noise *noise,
                              const gonio_i_transform *transform, gonio_i_column *column)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    for (size_t i = 0; i < column->count; i++) {
        gonio_i_observation *o = &column->observation[i];
        const gonio_pair pair = view->pair[o->reading];
        const size_t channel = (size_t)o->channel;
        const double s = gonio_readings_scale(readings, channel);
        const double read = gonio_readings_value(readings, o->reading, channel);
        set_value(o, true_value(pair, channel, read, s, transform),
                  true_deviation(view, o->reading, channel, s, transform), s, noise);
        if (transform->change != NULL) {
            o->at = gonio_half_difference_from_pair(transform->change(pair));
        }
    }
}

static void add_channel(const gonio_readings *readings, size_t channel, const gonio_i_noise *noise,
                        gonio_i_column *column)
{
    for (size_t k = 0; k < gonio_readings_describe(readings)->count; k++) {
        if (!isnan(gonio_readings_value(readings, k, channel))) {
            column->observation[column->count++] = observe(readings, k, channel, noise);
        }
    }
}

gonio_status gonio_i_columns_create(gonio_context *context, const gonio_basis_view *view,
                                    const gonio_readings *readings, const gonio_i_noise *noise,
                                    gonio_i_columns *columns)
{
    const bool joint = view->channels == GONIO_JOINT;
    const size_t channels = gonio_readings_describe(readings)->channels;
    const size_t each = gonio_readings_describe(readings)->count * (joint ? channels : 1);
    *columns = (gonio_i_columns){.count = joint ? 1 : channels};
    columns->column = gonio_i_allocate(context, columns->count, sizeof *columns->column);
    gonio_status status = columns->column == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t k = 0; k < columns->count && status == GONIO_OK; k++) {
        columns->column[k].observation =
            gonio_i_allocate(context, each, sizeof *columns->column[k].observation);
        status = columns->column[k].observation == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    }
    for (size_t k = 0; k < channels && status == GONIO_OK; k++) {
        add_channel(readings, k, noise, &columns->column[joint ? 0 : k]);
    }
    return status;
}

void gonio_i_columns_free(gonio_i_columns *columns)
{
    for (size_t k = 0; columns->column != NULL && k < columns->count; k++) {
        free(columns->column[k].observation);
    }
    free(columns->column);
    *columns = (gonio_i_columns){0};
}

/* The channel of a column for messages: the name of the readings' values if there are any. */
static void name_of(const gonio_readings *readings, size_t channel, char name[GONIO_I_NAME_ROOM])
{
    if (readings != NULL) {
        gonio_i_value_name(readings, channel, false, name);
    } else {
        snprintf(name, GONIO_I_NAME_ROOM, "channel %zu", channel + 1);
    }
}

gonio_status gonio_i_columns_check(gonio_context *context, const gonio_i_columns *columns,
                                   const gonio_readings *readings)
{
    const char *origin = readings != NULL ? gonio_readings_describe(readings)->path : "readings";
    for (size_t k = 0; k < columns->count; k++) {
        if (columns->column[k].count == 0) {
            char name[GONIO_I_NAME_ROOM];
            name_of(columns->count > 1 ? readings : NULL, k, name);
            return gonio_i_fail(context, GONIO_ERROR_UNDETERMINED,
                                "%s: no reading in %s: are its cells empty?", origin, name);
        }
    }
    return GONIO_OK;
}

double gonio_i_transform_slope(const gonio_readings *readings, size_t reading, size_t channel,
                               const gonio_i_transform *transform)
{
    const gonio_pair pair = gonio_readings_describe(readings)->pair[reading];
    const double s = gonio_readings_scale(readings, channel);
    const double value = gonio_readings_value(readings, reading, channel);
    return log(factor_of(pair, s, transform)) -
           log(s + true_value(pair, channel, value, s, transform));
}
