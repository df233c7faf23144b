/* What readings say against each other: repeats, reciprocal pairs, and values that are far from
 * those around them. */
#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "../measurement/readings.h"
#include "../prior/prior.h"
#include "survey.h"

/* ---- pairs that should be equal ---- */

typedef struct difference {
    double square; /* sum of squared differences relative to the means */
    size_t values;
} difference;

static void add_pair(const gonio_readings *readings, size_t a, size_t b, difference *d)
{
    for (size_t c = 0; c < gonio_readings_describe(readings)->channels; c++) {
        const double x = gonio_readings_value(readings, a, c);
        const double y = gonio_readings_value(readings, b, c);
        if (x + y > 0.0) { /* not for NaN */
            const double relative = 2.0 * (x - y) / (x + y);
            d->square += relative * relative;
            d->values++;
        }
    }
}

static double percent_of(const difference *d)
{
    return d->values > 0 ? 100.0 * sqrt(d->square / (double)d->values) : 0.0;
}

void gonio_i_survey_repeats(const gonio_readings *readings, gonio_survey *survey)
{
    const size_t count = gonio_readings_describe(readings)->count;
    difference d = {0.0, 0};
    for (size_t k = 0; k < count; k++) {
        const size_t first = readings->first_same[k];
        if (first != k) {
            survey->repeats++;
            add_pair(readings, first, k, &d);
        }
    }
    survey->repeats_percent = percent_of(&d);
}

gonio_status gonio_i_survey_turned(gonio_context *context, const gonio_readings *readings,
                                   gonio_survey *survey)
{
    double median = 0.0;
    const gonio_status status =
        gonio_i_readings_compare_turned(context, readings, &survey->turned_pairs, &median);
    survey->turned_percent = 100.0 * expm1(median);
    return status;
}

/* Comparisons of a second or two. Only tens of thousands of readings at the same polar angles need
 * more; the first of them are looked at then. */
static const size_t MOST_COMPARED = 200000000;

gonio_status gonio_i_survey_reciprocity(gonio_context *context, const gonio_readings *readings,
                                        gonio_survey *survey)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    gonio_pair *exchanged = gonio_i_allocate(context, view->count, sizeof *exchanged);
    size_t *found = gonio_i_allocate(context, view->count, sizeof *found);
    gonio_status status = exchanged != NULL && found != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < view->count && status == GONIO_OK; k++) {
        exchanged[k] = (gonio_pair){view->pair[k].outgoing, view->pair[k].incident};
    }
    if (status == GONIO_OK) {
        status = gonio_i_find_readings(context, readings, false, exchanged, view->count,
                                       MOST_COMPARED, found);
    }
    difference d = {0.0, 0};
    for (size_t k = 0; k < view->count && status == GONIO_OK; k++) {
        if (found[k] < view->count && found[k] > k) {
            survey->reciprocal_pairs++;
            add_pair(readings, k, found[k], &d);
        }
    }
    survey->reciprocity_percent = percent_of(&d);
    free(exchanged);
    free(found);
    return status;
}

/* ---- outliers ---- */

enum { NEIGHBOURS = 5, LEAST_NEIGHBOURS = 3 };

/* |p - p'|^2 of neighbours; how far a value is from theirs, and they from each other, ln. */
static const double NEAR = 0.25;
static const double FAR_OFF = 2.0794415416798357; /* ln 8 */
static const double ALIKE = 1.0986122886681098;   /* ln 3 */
static const double COMPARISONS = 2e7;            /* at most, roughly */

typedef struct site {
    gonio_i_place place;
    size_t reading;
    double g; /* ln of the value and a little more, so that zeros have one */
} site;

static int compare_sites(const void *a, const void *b)
{
    const site *x = a;
    const site *y = b;
    const int order = (x->place.p[0] > y->place.p[0]) - (x->place.p[0] < y->place.p[0]);
    return order != 0 ? order : (x->reading > y->reading) - (x->reading < y->reading);
}

static size_t list_sites(const gonio_readings *readings, size_t channel, double little, site *sites)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    size_t count = 0;
    for (size_t k = 0; k < view->count; k++) {
        const double value = gonio_readings_value(readings, k, channel);
        if (!isnan(value)) {
            sites[count++] =
                (site){gonio_i_place_of(gonio_half_difference_from_pair(view->pair[k])), k,
                       log(value + little)};
        }
    }
    qsort(sites, count, sizeof *sites, compare_sites);
    return count;
}

typedef struct neighbours {
    double square[NEIGHBOURS]; /* ascending */
    double g[NEIGHBOURS];
    int count;
} neighbours;

static void add_neighbour(double square, double g, neighbours *n)
{
    if (n->count == NEIGHBOURS && square >= n->square[NEIGHBOURS - 1]) {
        return;
    }
    int at = n->count < NEIGHBOURS ? n->count++ : NEIGHBOURS - 1;
    while (at > 0 && n->square[at - 1] > square) {
        n->square[at] = n->square[at - 1];
        n->g[at] = n->g[at - 1];
        at--;
    }
    n->square[at] = square;
    n->g[at] = g;
}

static bool is_outlier(const site *sites, size_t count, size_t k, size_t window)
{
    neighbours n = {.square = {0.0}};
    const size_t first = k > window ? k - window : 0;
    const size_t end = k + window < count ? k + window + 1 : count;
    for (size_t j = first; j < end; j++) {
        const double square = gonio_i_place_distance(&sites[j].place, &sites[k].place);
        if (j != k && square <= NEAR) {
            add_neighbour(square, sites[j].g, &n);
        }
    }
    double least = INFINITY;
    double most = -INFINITY;
    for (int j = 0; j < n.count; j++) {
        least = fmin(least, n.g[j]);
        most = fmax(most, n.g[j]);
    }
    return n.count >= LEAST_NEIGHBOURS && most - least < ALIKE &&
           (sites[k].g > most + FAR_OFF || sites[k].g < least - FAR_OFF);
}

/* Marks readings that are far off in a channel. */
static void mark(const gonio_readings *readings, size_t channel, double median, site *sites,
                 bool *marked)
{
    const size_t count = list_sites(readings, channel, 1e-3 * median, sites);
    const double most = COMPARISONS / fmax((double)count, 1.0);
    const size_t window = (size_t)fmin(fmax(most, 10.0), (double)count);
    for (size_t k = 0; k < count; k++) {
        if (is_outlier(sites, count, k, window)) {
            marked[sites[k].reading] = true;
        }
    }
}

/* The channels that are looked at, channel[3]: the first, the middle and the last of many. Returns
 * how many. */
static int choose_channels(size_t channels, size_t channel[3])
{
    channel[0] = 0;
    channel[1] = channels > 2 ? channels / 2 : channels - 1;
    channel[2] = channels - 1;
    return channels < 3 ? (int)channels : 3;
}

gonio_status gonio_i_survey_outliers(gonio_context *context, const gonio_readings *readings,
                                     gonio_survey *survey)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    site *sites = gonio_i_allocate(context, view->count, sizeof *sites);
    bool *marked = gonio_i_allocate(context, view->count, sizeof *marked);
    size_t channel[3];
    const int channels = choose_channels(view->channels, channel);
    const bool done = sites != NULL && marked != NULL;
    for (int c = 0; c < channels && done; c++) {
        const gonio_channel_survey *here = &survey->channel[channel[c]];
        if (here->median > 0.0) {
            mark(readings, channel[c], here->median, sites, marked);
        }
    }
    for (size_t k = 0; k < view->count && done; k++) {
        if (marked[k] && survey->outliers < GONIO_MOST_OUTLIERS) {
            survey->outlier[survey->outliers] = k;
        }
        survey->outliers += marked[k];
    }
    free(sites);
    free(marked);
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}
