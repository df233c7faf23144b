/* Readings taken out of others of the same material: see measurement.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "readings.h"

static const double SAME = 1e-4; /* radians */

/* How far apart two directions are, for an isotropic and reciprocal material. */
static double distance(gonio_half_difference a, gonio_half_difference b)
{
    const double turn = fabs(a.phi_d - b.phi_d);
    const double phi = fmin(turn, M_PI - turn) * sin(a.theta_d) * fmin(1.0, a.theta_h / SAME);
    return fmax(fmax(fabs(a.theta_h - b.theta_h), fabs(a.theta_d - b.theta_d)), phi);
}

/* The nearest reading; `count` if none is near. */
static size_t find(const gonio_half_difference *known, size_t count, gonio_half_difference at)
{
    size_t nearest = count;
    double least = SAME;
    for (size_t k = 0; k < count; k++) {
        const double here = distance(known[k], at);
        if (here <= least) {
            least = here;
            nearest = k;
        }
    }
    return nearest;
}

/* Of readings with the same channels. */
static void copy(gonio_readings *plan, size_t row, const gonio_readings *known, size_t from)
{
    const size_t channels = known->channels;
    const size_t size = channels * sizeof *known->value;
    memcpy(plan->value + row * channels, known->value + from * channels, size);
    if (known->deviation != NULL) {
        memcpy(plan->deviation + row * channels, known->deviation + from * channels, size);
    }
}

/* Room for values, and deviations if they are known, in the channels of other readings. */
static gonio_status take_channels(gonio_context *context, gonio_readings *plan,
                                  const gonio_readings *known)
{
    const gonio_status status =
        gonio_i_readings_set_channels(context, plan, known->channels, known->wavelength);
    if (status != GONIO_OK || known->deviation == NULL) {
        return status;
    }
    plan->deviation = gonio_i_allocate(context, plan->count * plan->channels, sizeof(double));
    gonio_i_readings_update_view(plan);
    return plan->deviation != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_half_difference *coordinates(gonio_context *context, const gonio_readings *readings)
{
    gonio_half_difference *at = gonio_i_allocate(context, readings->count, sizeof *at);
    for (size_t k = 0; at != NULL && k < readings->count; k++) {
        at[k] = gonio_half_difference_from_pair(readings->pair[k]);
    }
    return at;
}

gonio_status gonio_readings_find(gonio_context *context, const gonio_readings *readings,
                                 const gonio_readings *others, bool *same)
{
    gonio_half_difference *at = coordinates(context, others);
    for (size_t k = 0; at != NULL && k < readings->count; k++) {
        const gonio_half_difference here = gonio_half_difference_from_pair(readings->pair[k]);
        same[k] = find(at, others->count, here) < others->count;
    }
    const gonio_status status = at != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    free(at);
    return status;
}

gonio_status gonio_readings_look_up(gonio_context *context, gonio_readings *plan,
                                    const gonio_readings *known)
{
    gonio_half_difference *at = coordinates(context, known);
    gonio_status status = at == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = take_channels(context, plan, known);
    }
    for (size_t k = 0; k < plan->count && status == GONIO_OK; k++) {
        const size_t from = find(at, known->count, gonio_half_difference_from_pair(plan->pair[k]));
        if (from == known->count) {
            status = gonio_i_fail(context, GONIO_ERROR_DATA,
                                  "%s:%zu: %s has no reading at these directions; plan with "
                                  "--candidates to choose among those it has",
                                  plan->path, plan->line[k], known->path);
        } else {
            copy(plan, k, known, from);
        }
    }
    free(at);
    return status;
}
