/* What readings contain, before anything is done with them: see evaluate.h. */
#include "survey.h"

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"

enum {
    MOST_INTEGRATED = 64, /* incidences: more are no scans of hemispheres */
    LEAST_READINGS = 20   /* of an incidence whose albedo is integrated */
};

static const double SAME_INCIDENCE = 0.1 * M_PI / 180.0;
static const double IN_PLANE = 1.0 * M_PI / 180.0;

/* ---- values ---- */

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* sorted: room for the channel's values. */
static void survey_channel(const gonio_readings *readings, size_t channel, double *sorted,
                           gonio_channel_survey *c)
{
    *c = (gonio_channel_survey){.least = NAN, .median = NAN, .most = NAN};
    for (size_t k = 0; k < gonio_readings_describe(readings)->count; k++) {
        const double value = gonio_readings_value(readings, k, channel);
        if (!isnan(value)) {
            sorted[c->read++] = value;
            c->zero += value == 0.0;
        }
    }
    qsort(sorted, c->read, sizeof *sorted, compare_numbers);
    if (c->read > 0) {
        c->least = sorted[c->zero < c->read ? c->zero : 0];
        c->median = sorted[c->read / 2];
        c->most = sorted[c->read - 1];
    }
}

static gonio_status survey_values(gonio_context *context, const gonio_readings *readings,
                                  gonio_survey *s)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    double *sorted = gonio_i_allocate(context, view->count, sizeof *sorted);
    if (sorted == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t c = 0; c < view->channels; c++) {
        survey_channel(readings, c, sorted, &s->channel[c]);
        s->empty += view->count - s->channel[c].read;
    }
    free(sorted);
    return GONIO_OK;
}

static bool is_measured(const gonio_readings *readings, size_t reading)
{
    bool any = false;
    for (size_t c = 0; c < gonio_readings_describe(readings)->channels && !any; c++) {
        any = !isnan(gonio_readings_value(readings, reading, c));
    }
    return any;
}

/* ---- directions ---- */

static void widen(double range[2], double value)
{
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

static void add_direction(gonio_pair pair, gonio_survey *s)
{
    const double turn = fabs(remainder(pair.outgoing.phi - pair.incident.phi, M_PI));
    const double sine = sin(fmin(pair.incident.theta, pair.outgoing.theta));
    widen(s->theta_i, pair.incident.theta);
    widen(s->theta_o, pair.outgoing.theta);
    widen(s->theta_h, gonio_half_difference_from_pair(pair).theta_h);
    s->in_plane += turn * sine <= IN_PLANE;
}

static void survey_directions(const gonio_readings *readings, gonio_survey *s)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    for (int k = 0; k < 2; k++) {
        s->theta_i[k] = s->theta_o[k] = s->theta_h[k] = k == 0 ? INFINITY : -INFINITY;
    }
    for (size_t k = 0; k < view->count; k++) {
        add_direction(view->pair[k], s);
        s->measured += is_measured(readings, k);
    }
}

/* ---- incidences ---- */

typedef struct member {
    double theta;
    size_t reading;
} member;

static int compare_members(const void *a, const void *b)
{
    const member *x = a;
    const member *y = b;
    const int order = (x->theta > y->theta) - (x->theta < y->theta);
    return order != 0 ? order : (x->reading > y->reading) - (x->reading < y->reading);
}

/* Measured readings, by the polar angle of the light. Returns how many. */
static size_t sort_members(const gonio_readings *readings, member *sorted)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    size_t count = 0;
    for (size_t k = 0; k < view->count; k++) {
        if (is_measured(readings, k)) {
            sorted[count++] = (member){view->pair[k].incident.theta, k};
        }
    }
    qsort(sorted, count, sizeof *sorted, compare_members);
    return count;
}

/* Where the incidence that begins at `first` ends. */
static size_t end_of(const member *sorted, size_t count, size_t first)
{
    size_t end = first;
    while (end < count && sorted[end].theta - sorted[first].theta <= SAME_INCIDENCE) {
        end++;
    }
    return end;
}

static gonio_status integrate(gonio_context *context, const gonio_readings *readings,
                              const size_t *reading, gonio_survey *s)
{
    const size_t channels = gonio_readings_describe(readings)->channels;
    gonio_status status = GONIO_OK;
    size_t first = 0;
    for (size_t n = 0; n < s->incidences && status == GONIO_OK; n++) {
        gonio_incidence *incidence = &s->incidence[n];
        if (s->incidences <= MOST_INTEGRATED && incidence->count >= LEAST_READINGS) {
            status = gonio_i_survey_albedo(context, readings, reading + first, incidence,
                                           s->albedos + n * channels);
        }
        first += incidence->count;
    }
    return status;
}

static gonio_status allocate_incidences(gonio_context *context, size_t channels, gonio_survey *s)
{
    s->incidence = gonio_i_allocate(context, s->incidences, sizeof *s->incidence);
    const size_t values = s->incidences <= MOST_INTEGRATED ? s->incidences * channels : 1;
    s->albedos = gonio_i_allocate(context, values, sizeof *s->albedos);
    return s->incidence != NULL && s->albedos != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status list_incidences(gonio_context *context, const gonio_readings *readings,
                                    const member *sorted, size_t count, gonio_survey *s)
{
    const size_t channels = gonio_readings_describe(readings)->channels;
    for (size_t first = 0; first < count; first = end_of(sorted, count, first)) {
        s->incidences++;
    }
    const gonio_status status = allocate_incidences(context, channels, s);
    const bool integrated = s->incidences <= MOST_INTEGRATED;
    size_t first = 0;
    for (size_t n = 0; n < s->incidences && status == GONIO_OK; n++) {
        const size_t end = end_of(sorted, count, first);
        s->incidence[n] = (gonio_incidence){.theta_i = sorted[first].theta,
                                            .count = end - first,
                                            .albedo = integrated && end - first >= LEAST_READINGS
                                                          ? s->albedos + n * channels
                                                          : NULL};
        first = end;
    }
    return status;
}

static gonio_status survey_incidences(gonio_context *context, const gonio_readings *readings,
                                      gonio_survey *s)
{
    const size_t all = gonio_readings_describe(readings)->count;
    member *sorted = gonio_i_allocate(context, all, sizeof *sorted);
    size_t *reading = gonio_i_allocate(context, all, sizeof *reading);
    gonio_status status = sorted != NULL && reading != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        const size_t count = sort_members(readings, sorted);
        for (size_t k = 0; k < count; k++) {
            reading[k] = sorted[k].reading;
        }
        status = list_incidences(context, readings, sorted, count, s);
    }
    if (status == GONIO_OK) {
        status = integrate(context, readings, reading, s);
    }
    free(sorted);
    free(reading);
    return status;
}

/* ---- all of it ---- */

static gonio_status survey_all(gonio_context *context, const gonio_readings *readings,
                               gonio_survey *s)
{
    gonio_status status = survey_values(context, readings, s);
    survey_directions(readings, s);
    gonio_i_survey_repeats(readings, s);
    if (status == GONIO_OK) {
        status = gonio_i_survey_turned(context, readings, s);
    }
    if (status == GONIO_OK) {
        status = survey_incidences(context, readings, s);
    }
    if (status == GONIO_OK) {
        status = gonio_i_survey_reciprocity(context, readings, s);
    }
    return status == GONIO_OK ? gonio_i_survey_outliers(context, readings, s) : status;
}

gonio_status gonio_readings_survey(gonio_context *context, const gonio_readings *readings,
                                   gonio_survey **survey)
{
    const size_t channels = gonio_readings_describe(readings)->channels;
    gonio_survey *s = gonio_i_allocate(context, 1, sizeof *s);
    if (s == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *s = (gonio_survey){.channel = gonio_i_allocate(context, channels, sizeof *s->channel)};
    const gonio_status status =
        s->channel != NULL ? survey_all(context, readings, s) : GONIO_ERROR_MEMORY;
    if (status != GONIO_OK) {
        gonio_survey_free(&s);
        return status;
    }
    *survey = s;
    return GONIO_OK;
}

void gonio_survey_free(gonio_survey **survey)
{
    if (survey == NULL || *survey == NULL) {
        return;
    }
    free((*survey)->channel);
    free((*survey)->incidence);
    free((*survey)->albedos);
    free(*survey);
    *survey = NULL;
}
