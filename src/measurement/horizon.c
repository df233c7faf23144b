/* Readings near the horizon: see horizon.h. */
#include "horizon.h"

#include <math.h>
#include <stdlib.h>

static const double NEAR = 75.0 * M_PI / 180.0;
static const double TOO_MUCH = 20.0; /* times less or more than the median */
static const double LESS = 3.0;      /* than the median, and */
static const double FALL = 10.0;     /* than the reading before */

enum { LEAST = 10 }; /* readings of an incidence for a median to be useful */

typedef struct place {
    gonio_pair pair;
    double value; /* mean over the channels that were read */
    size_t index;
} place;

static double mean_of(const gonio_readings *r, size_t k)
{
    double sum = 0.0;
    double count = 0.0;
    for (size_t c = 0; c < r->channels; c++) {
        const double value = r->value[k * r->channels + c];
        sum += isnan(value) ? 0.0 : value;
        count += isnan(value) ? 0.0 : 1.0;
    }
    return count > 0.0 ? sum / count : NAN;
}

static int compare(double a, double b)
{
    return (a > b) - (a < b);
}

static int compare_incidences(const place *a, const place *b)
{
    const int order = compare(a->pair.incident.theta, b->pair.incident.theta);
    return order != 0 ? order : compare(a->pair.incident.phi, b->pair.incident.phi);
}

/* By incidence, then azimuth, then from the normal on. */
static int compare_places(const void *x, const void *y)
{
    const place *a = x;
    const place *b = y;
    int order = compare_incidences(a, b);
    order = order != 0 ? order : compare(a->pair.outgoing.phi, b->pair.outgoing.phi);
    order = order != 0 ? order : compare(a->pair.outgoing.theta, b->pair.outgoing.theta);
    return order != 0 ? order : (a->index > b->index) - (a->index < b->index);
}

static int compare_values(const void *a, const void *b)
{
    return compare(*(const double *)a, *(const double *)b);
}

static double median_of(const place *places, size_t count, double *scratch)
{
    for (size_t k = 0; k < count; k++) {
        scratch[k] = places[k].value;
    }
    qsort(scratch, count, sizeof *scratch, compare_values);
    return scratch[count / 2];
}

static bool is_on_lights_side(const gonio_pair *p)
{
    return cos(p->outgoing.phi - p->incident.phi) > 0.0;
}

/* Whether a reading cannot be the material's. before: the reading before it in the same half-plane;
 * NULL if it is the first. */
static bool is_lost(const place *p, const place *before, double median)
{
    if (p->pair.outgoing.theta < NEAR) {
        return false;
    }
    const bool stray = is_on_lights_side(&p->pair) && before != NULL &&
                       p->value > TOO_MUCH * median && p->value > TOO_MUCH * before->value;
    const bool fallen =
        before != NULL && p->value < median / LESS && p->value < before->value / FALL;
    return p->value < median / TOO_MUCH || fallen || stray;
}

static void judge_incidence(const place *places, size_t count, double *scratch, bool *lost)
{
    const double median = median_of(places, count, scratch);
    for (size_t k = 0; k < count && count >= LEAST; k++) {
        const bool same = k > 0 && places[k - 1].pair.outgoing.phi == places[k].pair.outgoing.phi;
        lost[places[k].index] = is_lost(&places[k], same ? &places[k - 1] : NULL, median);
    }
}

gonio_status gonio_i_horizon_find(gonio_context *context, const gonio_readings *readings,
                                  bool *lost)
{
    const size_t count = readings->count;
    place *places = gonio_i_allocate(context, count, sizeof *places);
    double *scratch = gonio_i_allocate(context, count, sizeof *scratch);
    if (places == NULL || scratch == NULL) {
        free(places);
        free(scratch);
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < count; k++) {
        places[k] = (place){readings->pair[k], mean_of(readings, k), k};
        lost[k] = false;
    }
    qsort(places, count, sizeof *places, compare_places);
    for (size_t first = 0, k = 1; k <= count; k++) {
        if (k == count || compare_incidences(&places[first], &places[k]) != 0) {
            judge_incidence(places + first, k - first, scratch, lost);
            first = k;
        }
    }
    free(places);
    free(scratch);
    return GONIO_OK;
}
