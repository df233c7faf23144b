/* Directions as an in-plane goniometer reads them: see incidences.h. */
#include "incidences.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "core/core.h"

enum { INCIDENCES_STREAM = 5000, ORDER_STREAM = 6000, LEAST_AT_INCIDENCE = 5 };

/* A theta_i that differs by less is the same incidence. */
static const double SAME_INCIDENCE = 0.1 * M_PI / 180.0;

static const double IN_PLANE = M_PI / 180.0;

bool benchmark_is_in_plane(const gonio_pair *pair)
{
    return fabs(sin(pair->outgoing.phi - pair->incident.phi)) < sin(IN_PLANE) ||
           pair->incident.theta < IN_PLANE || pair->outgoing.theta < IN_PLANE;
}

/* ---- the incidences of a file ---- */

typedef struct incidence {
    gonio_pair *pair; /* [count], in the order of the detector */
    size_t count;
} incidence;

/* theta_o, below 0 on the light's side. */
static double detector_of(const gonio_pair *pair)
{
    const double theta = pair->outgoing.theta;
    return cos(pair->outgoing.phi - pair->incident.phi) > 0.0 ? -theta : theta;
}

static int compare_incidences(const void *a, const void *b)
{
    const gonio_pair *x = a;
    const gonio_pair *y = b;
    return (x->incident.theta > y->incident.theta) - (x->incident.theta < y->incident.theta);
}

static int compare_detectors(const void *a, const void *b)
{
    const double x = detector_of(a);
    const double y = detector_of(b);
    return (x > y) - (x < y);
}

/* Those with enough readings; sorts pair[count]. list has room for `count`. */
static size_t find_incidences(gonio_pair *pair, size_t count, incidence *list)
{
    size_t found = 0;
    size_t begin = 0;
    qsort(pair, count, sizeof *pair, compare_incidences);
    for (size_t k = 1; k <= count; k++) {
        if (k < count && pair[k].incident.theta - pair[begin].incident.theta < SAME_INCIDENCE) {
            continue;
        }
        if (k - begin >= LEAST_AT_INCIDENCE) {
            qsort(pair + begin, k - begin, sizeof *pair, compare_detectors);
            list[found++] = (incidence){pair + begin, k - begin};
        }
        begin = k;
    }
    return found;
}

/* The draw-th pair of different numbers below `levels`, in a random order of all such pairs. */
static void choose_levels(const benchmark_choosing *with, size_t levels, size_t two[2])
{
    gonio_i_random random;
    const size_t pairs = levels * (levels - 1) / 2;
    gonio_i_random_seed(&random, with->setting->seed, ORDER_STREAM);
    size_t k = (with->draw + gonio_i_random_below(&random, pairs)) % pairs;
    for (two[0] = 0; k >= levels - 1 - two[0]; two[0]++) {
        k -= levels - 1 - two[0];
    }
    two[1] = two[0] + 1 + k;
}

/* ---- evenly spread ---- */

/* Appends n of an incidence; `at` of the first, in steps. */
static void spread(const incidence *from, size_t n, double at, benchmark_pairs *chosen)
{
    for (size_t k = 0; k < n; k++) {
        const double place = ((double)k + at) / (double)n * (double)from->count;
        chosen->pair[chosen->count++] = from->pair[(size_t)place];
    }
}

static void spread_over_two(const benchmark_choosing *with, const incidence *list, size_t levels,
                            size_t n, benchmark_pairs *chosen)
{
    size_t two[2];
    gonio_i_random random;
    gonio_i_random_seed(&random, with->setting->seed, INCIDENCES_STREAM + with->draw);
    choose_levels(with, levels, two);
    const double at = gonio_i_random_uniform(&random);
    if (list[two[0]].count >= n - n / 2 && list[two[1]].count >= n / 2) {
        spread(&list[two[0]], n - n / 2, at, chosen);
        spread(&list[two[1]], n / 2, at, chosen);
    }
}

static gonio_status choose_of_file(gonio_context *context, const benchmark_choosing *with, size_t n,
                                   benchmark_pairs *chosen)
{
    const benchmark_sample *sample = with->sample;
    size_t count = 0;
    gonio_pair *pair = gonio_i_allocate(context, sample->candidates + 1, sizeof *pair);
    incidence *list = gonio_i_allocate(context, sample->candidates + 1, sizeof *list);
    const bool done = pair != NULL && list != NULL;
    for (size_t k = 0; done && k < sample->candidates; k++) {
        pair[count] = sample->candidate[k];
        count += benchmark_is_in_plane(&pair[count]);
    }
    const size_t levels = done ? find_incidences(pair, count, list) : 0;
    if (levels >= 2) {
        spread_over_two(with, list, levels, n, chosen);
    }
    free(pair);
    free(list);
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* ---- of a table ---- */

/* Anything can be read; both incidences and the detector stay within the reach. */
static void choose_of_table(const benchmark_choosing *with, size_t n, benchmark_pairs *chosen)
{
    const double reach = with->setting->reach;
    gonio_i_random random;
    gonio_i_random_seed(&random, with->setting->seed, INCIDENCES_STREAM + with->draw);
    const double at = gonio_i_random_uniform(&random);
    for (size_t first = 0, half = n - n / 2; first < n; first += half, half = n - first) {
        const double theta = reach * gonio_i_random_uniform(&random);
        for (size_t k = 0; k < half; k++) {
            const double detector = reach * (2.0 * ((double)k + at) / (double)half - 1.0);
            chosen->pair[chosen->count++] =
                (gonio_pair){{theta, 0.0}, {fabs(detector), detector > 0.0 ? M_PI : 0.0}};
        }
    }
}

gonio_status benchmark_choose_two_incidences(gonio_context *context, const benchmark_choosing *with,
                                             size_t n, benchmark_pairs *chosen)
{
    gonio_pair *room = reallocarray(chosen->pair, n > 0 ? n : 1, sizeof *chosen->pair);
    if (room == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    *chosen = (benchmark_pairs){0, room};
    if (with->sample->known != NULL) {
        return choose_of_file(context, with, n, chosen);
    }
    choose_of_table(with, n, chosen);
    return GONIO_OK;
}
