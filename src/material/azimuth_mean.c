/* The mean of a material over azimuths of the sample: see azimuth_mean.h.
 *
 * A pair has 8 evenly spaced azimuths first, then 8 between them, then 16 between those, and so on,
 * until the mean of the new ones is close to that of the others: of a mean over a whole turn, two
 * halves that differ by a relative t have a common error of t^2/2 or so. The two sides of a pair
 * take turns, because they are alike. */
#include "azimuth_mean.h"

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"

enum { FIRST = 8, MOST = 32 };

/* Half the relative difference of two means from which more azimuths are needed. */
static const double APART = 0.1;

/* Sums over the azimuths that were looked at before, and over the new ones. */
typedef struct sums {
    double sum[2];
    double count[2];
} sums;

typedef struct averaging {
    gonio_context *context;
    const gonio_i_averaged *of;
    const gonio_pair *pairs;
    size_t open;        /* pairs that need more azimuths */
    size_t *index;      /* of them, [open] */
    gonio_pair *turned; /* [open] */
    double *value;      /* [open][channels] */
    sums *sums;         /* [count][channels] */
} averaging;

static gonio_pair turn(gonio_pair pair, double angle, bool back)
{
    gonio_pair to = back ? (gonio_pair){pair.outgoing, pair.incident} : pair;
    to.incident.phi += angle;
    to.outgoing.phi += angle;
    return to;
}

/* Adds the open pairs at an azimuth to the sums before (0) or the new ones (1). */
static gonio_status add_azimuth(averaging *a, double angle, bool back, int to)
{
    const size_t channels = a->of->channels;
    for (size_t k = 0; k < a->open; k++) {
        a->turned[k] = turn(a->pairs[a->index[k]], angle, back);
    }
    const gonio_status status =
        a->of->evaluate(a->of->self, a->context, a->turned, a->open, a->value);
    for (size_t k = 0; k < a->open * channels && status == GONIO_OK; k++) {
        const double value = a->value[k];
        sums *s = &a->sums[a->index[k / channels] * channels + k % channels];
        const bool data = value >= 0.0 && isfinite(value);
        s->sum[to] += data ? value : 0.0;
        s->count[to] += data ? 1.0 : 0.0;
    }
    return status;
}

/* Puts the new azimuths of a pair to the others. Returns whether more are needed. */
static bool settle(sums *s, size_t channels)
{
    bool more = false;
    for (size_t c = 0; c < channels; c++, s++) {
        const double before = s->sum[0] * s->count[1];
        const double new = s->sum[1] * s->count[0];
        more = more || fabs(before - new) > APART * (before + new);
        s->sum[0] += s->sum[1];
        s->count[0] += s->count[1];
        s->sum[1] = s->count[1] = 0.0;
    }
    return more;
}

static void settle_open(averaging *a)
{
    const size_t channels = a->of->channels;
    size_t open = 0;
    for (size_t k = 0; k < a->open; k++) {
        const size_t index = a->index[k];
        if (settle(&a->sums[index * channels], channels)) {
            a->index[open++] = index;
        }
    }
    a->open = open;
}

/* Adds `count` azimuths, the first of them at `start` of their spacing. */
static gonio_status add_azimuths(averaging *a, int count, double start, int to)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < count && a->open > 0 && status == GONIO_OK; k++) {
        const bool back = a->of->both_sides && k % 2 == 1;
        status = add_azimuth(a, 2.0 * M_PI * (k + start) / count, back, to);
    }
    return status;
}

static gonio_status add_all(averaging *a)
{
    gonio_status status = GONIO_OK;
    if (!a->of->anisotropic) {
        status = add_azimuth(a, 0.0, false, 0);
        return status == GONIO_OK && a->of->both_sides ? add_azimuth(a, 0.0, true, 0) : status;
    }
    status = add_azimuths(a, FIRST, 0.0, 0);
    for (int count = FIRST; count < MOST && status == GONIO_OK; count *= 2) {
        status = add_azimuths(a, count, 0.5, 1);
        settle_open(a);
    }
    return status;
}

gonio_status gonio_i_azimuth_mean(gonio_context *context, const gonio_i_averaged *averaged,
                                  const gonio_pair *pairs, size_t count, double *mean)
{
    const size_t numbers = count * averaged->channels;
    averaging a = {.context = context, .of = averaged, .pairs = pairs, .open = count};
    a.index = gonio_i_allocate(context, count, sizeof *a.index);
    a.turned = gonio_i_allocate(context, count, sizeof *a.turned);
    a.value = gonio_i_allocate(context, numbers, sizeof *a.value);
    a.sums = gonio_i_allocate(context, numbers, sizeof *a.sums);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (a.index != NULL && a.turned != NULL && a.value != NULL && a.sums != NULL) {
        for (size_t k = 0; k < count; k++) {
            a.index[k] = k;
        }
        status = add_all(&a);
    }
    for (size_t k = 0; k < numbers && status == GONIO_OK; k++) {
        const sums *s = &a.sums[k];
        mean[k] = s->count[0] > 0.0 ? s->sum[0] / s->count[0] : NAN;
    }
    free(a.index);
    free(a.turned);
    free(a.value);
    free(a.sums);
    return status;
}
