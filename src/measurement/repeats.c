/* Readings at equal directions: grouped, counted, refused. See readings.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "readings.h"

typedef struct indexed_pair {
    const gonio_pair *pair;
    size_t index;
} indexed_pair;

static int compare_numbers(double a, double b)
{
    return (a > b) - (a < b);
}

static int compare_pairs(const gonio_pair *a, const gonio_pair *b)
{
    int order = compare_numbers(a->incident.theta, b->incident.theta);
    order = order != 0 ? order : compare_numbers(a->incident.phi, b->incident.phi);
    order = order != 0 ? order : compare_numbers(a->outgoing.theta, b->outgoing.theta);
    return order != 0 ? order : compare_numbers(a->outgoing.phi, b->outgoing.phi);
}

static int compare_indexed(const void *a, const void *b)
{
    const indexed_pair *x = a;
    const indexed_pair *y = b;
    const int order = compare_pairs(x->pair, y->pair);
    return order != 0 ? order : (x->index > y->index) - (x->index < y->index);
}

gonio_status gonio_i_readings_group(gonio_context *context, gonio_readings *readings)
{
    const size_t count = readings->count;
    size_t *first_same = gonio_i_allocate(context, count, sizeof *first_same);
    indexed_pair *sorted = gonio_i_allocate(context, count, sizeof *sorted);
    if (sorted == NULL || first_same == NULL) {
        free(sorted);
        free(first_same);
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < count; k++) {
        sorted[k] = (indexed_pair){&readings->pair[k], k};
    }
    qsort(sorted, count, sizeof *sorted, compare_indexed);
    for (size_t k = 0; k < count; k++) {
        const bool same = k > 0 && compare_pairs(sorted[k - 1].pair, sorted[k].pair) == 0;
        first_same[sorted[k].index] = same ? first_same[sorted[k - 1].index] : sorted[k].index;
    }
    free(sorted);
    free(readings->first_same);
    readings->first_same = first_same;
    return GONIO_OK;
}

/* ---- at the normal, where azimuths have no meaning ---- */

/* theta, radians, below which a direction has no azimuth. */
static const double POLE = 1e-6;

static bool has_pole(const gonio_pair *pair)
{
    return pair->incident.theta < POLE || pair->outgoing.theta < POLE;
}

static bool has_value(const gonio_readings *readings, size_t reading)
{
    bool any = false;
    for (size_t c = 0; c < readings->channels; c++) {
        any = any || !isnan(readings->value[reading * readings->channels + c]);
    }
    return any;
}

/* Counts the readings in `sorted` that have the directions of the one before, but other azimuths in
 * the file. Azimuths at the normal are 0 in `sorted`. */
static size_t count_repeats(const gonio_readings *readings, const indexed_pair *sorted,
                            size_t count)
{
    size_t repeats = 0;
    for (size_t k = 1; k < count; k++) {
        const bool same = compare_pairs(sorted[k - 1].pair, sorted[k].pair) == 0;
        repeats += same && readings->first_same[sorted[k].index] == sorted[k].index;
    }
    return repeats;
}

/* Lists the readings with a direction at the normal; its azimuth in pair[] is 0. Returns their
 * number. */
static size_t find_poles(const gonio_readings *readings, gonio_pair *pair, indexed_pair *sorted)
{
    size_t count = 0;
    for (size_t k = 0; k < readings->count; k++) {
        if (has_pole(&readings->pair[k]) && has_value(readings, k)) {
            pair[count] = readings->pair[k];
            pair[count].incident.phi =
                pair[count].incident.theta < POLE ? 0.0 : pair[count].incident.phi;
            pair[count].outgoing.phi =
                pair[count].outgoing.theta < POLE ? 0.0 : pair[count].outgoing.phi;
            sorted[count] = (indexed_pair){&pair[count], k};
            count++;
        }
    }
    return count;
}

gonio_status gonio_i_readings_count_pole_repeats(gonio_context *context,
                                                 const gonio_readings *readings, size_t *repeats)
{
    gonio_pair *pair = gonio_i_allocate(context, readings->count, sizeof *pair);
    indexed_pair *sorted = gonio_i_allocate(context, readings->count, sizeof *sorted);
    const bool done = pair != NULL && sorted != NULL;
    if (done) {
        const size_t count = find_poles(readings, pair, sorted);
        qsort(sorted, count, sizeof *sorted, compare_indexed);
        *repeats = count_repeats(readings, sorted, count);
    }
    free(pair);
    free(sorted);
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* ---- refusing repeats ---- */

static bool channels_overlap(int a, int b)
{
    return a == b || a == GONIO_ALL_CHANNELS || b == GONIO_ALL_CHANNELS;
}

/* The earlier reading that a reading repeats, plus 1; 0 if there is none. latest[reading]: the
 * previous reading of the same directions, plus 1. */
static size_t find_repeated(const gonio_readings *readings, const size_t *latest, size_t reading)
{
    const int channel = readings->planned[reading];
    size_t found = 0;
    for (size_t k = latest[reading]; k > 0; k = latest[k - 1]) {
        const int other = readings->planned[k - 1];
        const bool first = found == 0 || other < readings->planned[found - 1];
        found = channels_overlap(channel, other) && first ? k : found;
    }
    return found;
}

gonio_status gonio_i_readings_refuse_repeats(gonio_context *context, const gonio_readings *readings,
                                             bool measured)
{
    /* [count] each: the last reading of the directions that first occur here; the previous one. */
    size_t *last = gonio_i_allocate(context, readings->count, sizeof *last);
    size_t *before = gonio_i_allocate(context, readings->count, sizeof *before);
    gonio_status status = last != NULL && before != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < readings->count && status == GONIO_OK; k++) {
        before[k] = last[readings->first_same[k]];
        last[readings->first_same[k]] = k + 1;
        const size_t repeated = find_repeated(readings, before, k);
        if (repeated > 0) {
            status = gonio_i_fail(context, GONIO_ERROR_DATA,
                                  "%s:%zu: the same directions and channel as line %zu; delete "
                                  "one%s",
                                  readings->path, readings->line[k], readings->line[repeated - 1],
                                  measured ? ", or accept repeats with --average-repeats" : "");
        }
    }
    free(last);
    free(before);
    return status;
}
