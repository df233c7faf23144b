/* The albedo of readings that were made at one incidence.
 *
 * The albedo is the integral of f over the unit disc of x = sin(theta_o) cos(phi), y =
 * sin(theta_o) sin(phi), as cos(theta_o) d omega = dx dy. The disc is a grid of cells. A cell takes
 * the mean of the readings in it; one without any, that of the nearest cell with some if a reading
 * there is within CONE, and counts as not covered otherwise. A material that is isotropic has the
 * same values on both sides of the plane of incidence, so that half of the disc is enough. */
#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "survey.h"

enum { ACROSS = 64, UP = ACROSS / 2, CELLS = ACROSS * UP };

static const double CONE = 10.0 * M_PI / 180.0;

typedef struct vector {
    double x, y, z;
} vector;

/* The viewer's direction, turned so that the light comes from x > 0, and y >= 0. */
static vector direction_of(gonio_pair pair)
{
    const double phi = pair.outgoing.phi - pair.incident.phi;
    const double sine = sin(pair.outgoing.theta);
    return (vector){sine * cos(phi), fabs(sine * sin(phi)), cos(pair.outgoing.theta)};
}

static int cell_of(vector v)
{
    const int column = (int)fmin(fmax((v.x + 1.0) * UP, 0.0), ACROSS - 1.0);
    const int row = (int)fmin(v.y * UP, UP - 1.0);
    return row * ACROSS + column;
}

/* The direction at a cell's centre; false if that is outside of the disc. */
static bool centre_of(int cell, vector *v)
{
    const int column = cell % ACROSS;
    const int row = cell / ACROSS;
    v->x = (column + 0.5) / UP - 1.0;
    v->y = (row + 0.5) / UP;
    const double rest = 1.0 - v->x * v->x - v->y * v->y;
    v->z = sqrt(fmax(rest, 0.0));
    return rest > 0.0;
}

typedef struct disc {
    size_t readings[CELLS]; /* how many */
    vector first[CELLS];    /* of them */
    double share[CELLS];    /* of the disc, that a cell stands for */
    int occupied[CELLS];
    int occupied_count;
} disc;

static void fill(disc *d, const gonio_readings_view *view, const size_t *member, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        const vector v = direction_of(view->pair[member[k]]);
        const int cell = cell_of(v);
        if (d->readings[cell]++ == 0) {
            d->first[cell] = v;
            d->occupied[d->occupied_count++] = cell;
        }
    }
}

/* The cell with readings that a place takes its value from; -1 if none is near. */
static int nearest(const disc *d, vector at)
{
    double largest = cos(CONE);
    int found = -1;
    for (int k = 0; k < d->occupied_count; k++) {
        const vector *v = &d->first[d->occupied[k]];
        const double cosine = v->x * at.x + v->y * at.y + v->z * at.z;
        if (cosine > largest) {
            largest = cosine;
            found = d->occupied[k];
        }
    }
    return found;
}

/* Gives every place of the disc to a cell with readings. Returns the share that is covered. */
static double divide(disc *d)
{
    int inside = 0;
    int covered = 0;
    for (int cell = 0; cell < CELLS; cell++) {
        vector at;
        if (!centre_of(cell, &at)) {
            continue;
        }
        const int from = d->readings[cell] > 0 ? cell : nearest(d, at);
        inside++;
        if (from >= 0) {
            d->share[from] += 1.0;
            covered++;
        }
    }
    for (int cell = 0; cell < CELLS; cell++) {
        d->share[cell] /= inside;
    }
    return (double)covered / inside;
}

/* Values that are missing are taken to be like the others. *peak becomes the largest share of one
 * reading, if that is larger. */
static double integrate(const disc *d, const gonio_readings *readings, size_t channel,
                        const size_t *member, const gonio_incidence *incidence, double *peak)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    double sum = 0.0;
    double weights = 0.0;
    double largest = 0.0;
    for (size_t k = 0; k < incidence->count; k++) {
        const int cell = cell_of(direction_of(view->pair[member[k]]));
        const double weight = d->share[cell] / (double)d->readings[cell];
        const double value = gonio_readings_value(readings, member[k], channel);
        if (!isnan(value)) {
            sum += weight * value;
            weights += weight;
            largest = fmax(largest, weight * value);
        }
    }
    *peak = sum > 0.0 ? fmax(*peak, largest / sum) : *peak;
    return weights > 0.0 ? M_PI * sum * incidence->covered / weights : NAN;
}

gonio_status gonio_i_survey_albedo(gonio_context *context, const gonio_readings *readings,
                                   const size_t *member, gonio_incidence *incidence, double *albedo)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    disc *d = gonio_i_allocate(context, 1, sizeof *d);
    if (d == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    fill(d, view, member, incidence->count);
    incidence->covered = divide(d);
    incidence->peak = 0.0;
    for (size_t c = 0; c < view->channels; c++) {
        albedo[c] = integrate(d, readings, c, member, incidence, &incidence->peak);
    }
    free(d);
    return GONIO_OK;
}
