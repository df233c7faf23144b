/* The simple method `lambert-ggx`: in each channel a Lambertian part and a GGX lobe (Walter et al.
 * 2007), fitted to the readings in log space.
 *
 *     f = d/pi + F(theta_d) D(theta_h) G(theta_i) G(theta_o) / (4 cos theta_i cos theta_o),
 *     D = a^2/(pi (cos^2 theta_h (a^2 - 1) + 1)^2),
 *     G(t) = 2 cos t/(cos t + sqrt(a^2 + (1 - a^2) cos^2 t)),
 *     F = F0 + (1 - F0)(1 - cos theta_d)^5    (Schlick 1994).
 *
 * d, F0 and a minimise the sum of (ln(1 + f/s) - ln(1 + reading/s))^2: the best of a grid, then a
 * pattern search in the logarithms of all three. */
#include "methods.h"

#include <math.h>
#include <stdlib.h>

#include "core/core.h"
#include "logs.h"

enum { PARAMETERS = 3, DIFFUSE = 0, FRESNEL = 1, WIDTH = 2 };

/* The logarithms of d, F0 and a: a grid of `steps` from `low` to `high`. */
static const struct {
    double low, high;
    int steps;
} grid[PARAMETERS] = {{-13.0, 0.1, 20}, {-7.0, 0.0, 14}, {-4.6, 0.0, 24}};

/* What f needs of a direction. */
typedef struct place {
    double incident, outgoing; /* cosines of the polar angles, */
    double half;               /* of theta_h, */
    double schlick;            /* (1 - cos theta_d)^5 */
} place;

typedef struct made {
    size_t channels;
    double (*fit)[PARAMETERS]; /* [channels], logarithms */
} made;

static void release(void *self)
{
    made *m = self;
    free(m->fit);
    free(m);
}

static place place_of(gonio_pair pair)
{
    const gonio_half_difference at = gonio_half_difference_from_pair(pair);
    return (place){fmax(cos(pair.incident.theta), 1e-4), fmax(cos(pair.outgoing.theta), 1e-4),
                   cos(at.theta_h), pow(1.0 - cos(at.theta_d), 5.0)};
}

/* G(t)/cos t. */
static double shadowing(double cosine, double a2)
{
    return 2.0 / (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine));
}

/* The lobe for F = 1. */
static double lobe(const place *p, double log_width)
{
    const double a2 = exp(2.0 * log_width);
    const double t = p->half * p->half * (a2 - 1.0) + 1.0;
    const double d = a2 / (M_PI * t * t);
    return 0.25 * d * shadowing(p->incident, a2) * shadowing(p->outgoing, a2);
}

static double value_of(const place *p, const double fit[PARAMETERS], double lobe)
{
    const double f0 = exp(fit[FRESNEL]);
    return exp(fit[DIFFUSE]) / M_PI + (f0 + (1.0 - f0) * p->schlick) * lobe;
}

/* ---- the fit of one channel ---- */

typedef struct readings {
    size_t count;
    place *place; /* [count] */
    double *log;  /* [count] */
    double *lobe; /* [count], of the width of the moment */
    double scale;
} readings;

static void set_width(const readings *r, double log_width)
{
    for (size_t k = 0; k < r->count; k++) {
        r->lobe[k] = lobe(&r->place[k], log_width);
    }
}

/* The sum of squares, given the lobes of the width. */
static double misfit(const readings *r, const double fit[PARAMETERS])
{
    double sum = 0.0;
    for (size_t k = 0; k < r->count; k++) {
        const double off = log1p(value_of(&r->place[k], fit, r->lobe[k]) / r->scale) - r->log[k];
        sum += off * off;
    }
    return sum;
}

static double step_of(int parameter)
{
    return (grid[parameter].high - grid[parameter].low) / (grid[parameter].steps - 1);
}

static double grid_value(int parameter, int step)
{
    return grid[parameter].low + step * step_of(parameter);
}

static double search_grid(const readings *r, double best[PARAMETERS])
{
    double least = HUGE_VAL;
    for (int w = 0; w < grid[WIDTH].steps; w++) {
        set_width(r, grid_value(WIDTH, w));
        for (int k = 0; k < grid[DIFFUSE].steps * grid[FRESNEL].steps; k++) {
            const double fit[PARAMETERS] = {grid_value(DIFFUSE, k % grid[DIFFUSE].steps),
                                            grid_value(FRESNEL, k / grid[DIFFUSE].steps),
                                            grid_value(WIDTH, w)};
            const double sum = misfit(r, fit);
            if (sum < least) {
                least = sum;
                best[0] = fit[0];
                best[1] = fit[1];
                best[2] = fit[2];
            }
        }
    }
    return least;
}

/* A step of one parameter either way, if that is better. */
static bool try_steps(const readings *r, int parameter, double step, double fit[PARAMETERS],
                      double *least)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        const double kept = fit[parameter];
        fit[parameter] = fmin(fmax(kept + sign * step, grid[parameter].low), grid[parameter].high);
        set_width(r, fit[WIDTH]);
        const double sum = misfit(r, fit);
        if (sum < *least) {
            *least = sum;
            return true;
        }
        fit[parameter] = kept;
    }
    return false;
}

static void refine(const readings *r, double fit[PARAMETERS], double least)
{
    enum { MOST_ROUNDS = 200 };
    double share = 0.5;
    for (int round = 0; round < MOST_ROUNDS && share > 1e-4; round++) {
        bool better = false;
        for (int p = 0; p < PARAMETERS; p++) {
            better = try_steps(r, p, share * step_of(p), fit, &least) || better;
        }
        share = better ? share : 0.5 * share;
    }
}

static void fit_channel(const gonio_readings *given, const double *logs, size_t channel,
                        readings *r, double fit[PARAMETERS])
{
    const gonio_readings_view *view = gonio_readings_describe(given);
    r->count = 0;
    r->scale = gonio_readings_scale(given, channel);
    for (size_t k = 0; k < view->count; k++) {
        const double g = logs[k * view->channels + channel];
        if (!isnan(g)) {
            r->place[r->count] = place_of(view->pair[k]);
            r->log[r->count++] = g;
        }
    }
    const double least = search_grid(r, fit);
    refine(r, fit, least);
}

static gonio_status fit_all(gonio_context *context, const gonio_readings *given, made *m)
{
    const gonio_readings_view *view = gonio_readings_describe(given);
    readings r = {.place = gonio_i_allocate(context, view->count, sizeof *r.place),
                  .log = gonio_i_allocate(context, view->count, sizeof *r.log),
                  .lobe = gonio_i_allocate(context, view->count, sizeof *r.lobe)};
    double *logs = NULL;
    m->channels = view->channels;
    m->fit = gonio_i_allocate(context, m->channels, sizeof *m->fit);
    const bool room = r.place != NULL && r.log != NULL && r.lobe != NULL && m->fit != NULL;
    const gonio_status status = room ? benchmark_logs(context, given, &logs) : GONIO_ERROR_MEMORY;
    for (size_t c = 0; c < m->channels && status == GONIO_OK; c++) {
        fit_channel(given, logs, c, &r, m->fit[c]);
    }
    free(r.place);
    free(r.log);
    free(r.lobe);
    free(logs);
    return status;
}

/* ---- the method ---- */

static gonio_status predict(void *self, gonio_context *context, const gonio_pair *pair,
                            size_t count, double *values, double *deviations)
{
    const made *m = self;
    (void)context;
    (void)deviations;
    for (size_t k = 0; k < count; k++) {
        const place p = place_of(pair[k]);
        for (size_t c = 0; c < m->channels; c++) {
            values[k * m->channels + c] = value_of(&p, m->fit[c], lobe(&p, m->fit[c][WIDTH]));
        }
    }
    return GONIO_OK;
}

static gonio_status complete(gonio_context *context, const benchmark_task *task,
                             benchmark_completion *completion)
{
    made *m = gonio_i_allocate(context, 1, sizeof *m);
    const gonio_status status =
        m != NULL ? fit_all(context, task->readings, m) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        *completion = (benchmark_completion){
            .self = m, .release = release, .predict = predict, .expected = NAN};
    } else if (m != NULL) {
        release(m);
    }
    return status;
}

const benchmark_method benchmark_lambert_ggx = {
    .name = "lambert-ggx",
    .summary = "a Lambertian part and a GGX lobe fitted in log space, in each channel",
    .simple = true,
    .complete = complete};
