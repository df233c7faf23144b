/* Errors between materials that depend on phi_h too: see compare_sums.h. */
#include <gonio/database.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../material/sampler.h"
#include "compare_sums.h"

enum {
    EVERY = 5, /* bins of phi_d */
    AZIMUTHS = 12,
    MOST = GONIO_THETA_D_BINS * (GONIO_PHI_D_BINS / EVERY) * AZIMUTHS /* pairs of a slab */
};

static const double GOLDEN = 0.6180339887498949;

/* Two materials, and the pairs of a slab. */
typedef struct turning {
    gonio_context *context;
    gonio_i_sampler reference;
    gonio_i_sampler other;
    gonio_pair *pair;  /* [MOST] */
    double *rgb[2];    /* [MOST][GONIO_CHANNELS] of either */
    double *values[2]; /* [MOST] of a channel */
    double *cosines;   /* [MOST] */
    double *terms;     /* [2][MOST] */
} turning;

static bool allocate(turning *t)
{
    bool done = true;
    t->pair = gonio_i_allocate(t->context, MOST, sizeof *t->pair);
    t->cosines = gonio_i_allocate(t->context, MOST, sizeof *t->cosines);
    t->terms = gonio_i_allocate(t->context, (size_t)2 * MOST, sizeof *t->terms);
    for (int k = 0; k < 2; k++) {
        t->rgb[k] = gonio_i_allocate(t->context, (size_t)MOST * GONIO_CHANNELS, sizeof(double));
        t->values[k] = gonio_i_allocate(t->context, MOST, sizeof(double));
        done = done && t->rgb[k] != NULL && t->values[k] != NULL;
    }
    return done && t->pair != NULL && t->cosines != NULL && t->terms != NULL;
}

static void release(turning *t)
{
    gonio_i_sampler_end(&t->reference);
    gonio_i_sampler_end(&t->other);
    free(t->pair);
    free(t->cosines);
    free(t->terms);
    for (int k = 0; k < 2; k++) {
        free(t->rgb[k]);
        free(t->values[k]);
    }
}

/* The pairs of a slab; returns their number. */
static size_t set_pairs(const turning *t, int theta_h)
{
    size_t count = 0;
    for (int k = EVERY / 2; k < GONIO_SLAB_BINS; k += EVERY) {
        const gonio_bin bin = {theta_h, k / GONIO_PHI_D_BINS, k % GONIO_PHI_D_BINS};
        const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
        const double first = fmod(GOLDEN * gonio_bin_index(bin), 1.0);
        for (int a = 0; a < AZIMUTHS && gonio_bin_is_valid(bin); a++) {
            const double phi_h = 2.0 * M_PI * (a + first) / AZIMUTHS;
            t->pair[count] = pair;
            t->pair[count].incident.phi += phi_h;
            t->pair[count++].outgoing.phi += phi_h;
        }
    }
    return count;
}

/* Moves the pairs with data in both to the front. Returns how many there are. */
static size_t keep_common(const turning *t, size_t count, gonio_i_slab_sums *sums)
{
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) {
        const bool data = !isnan(t->rgb[0][k * GONIO_CHANNELS]);
        const bool both = data && !isnan(t->rgb[1][k * GONIO_CHANNELS]);
        sums->bins += both;
        sums->missing += data && !both;
        if (both) {
            const gonio_pair *pair = &t->pair[k];
            t->cosines[kept] = fmax(cos(pair->incident.theta) * cos(pair->outgoing.theta), 0.0);
            for (int m = 0; m < 2; m++) {
                memmove(t->rgb[m] + kept * GONIO_CHANNELS, t->rgb[m] + k * GONIO_CHANNELS,
                        GONIO_CHANNELS * sizeof(double));
            }
            kept++;
        }
    }
    return kept;
}

static void sum_channels(const turning *t, size_t count, gonio_i_slab_sums *sums)
{
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        for (size_t k = 0; k < count; k++) {
            t->values[0][k] = t->rgb[0][k * GONIO_CHANNELS + (size_t)channel];
            t->values[1][k] = t->rgb[1][k * GONIO_CHANNELS + (size_t)channel];
        }
        const gonio_i_compared values = {.count = count,
                                         .reference = t->values[0],
                                         .other = t->values[1],
                                         .cosines = t->cosines,
                                         .scale = gonio_log_scale(channel)};
        gonio_i_error_add_values(&values, t->terms, &sums->channel[channel]);
    }
}

static gonio_status sum_slab(turning *t, int theta_h, gonio_i_slab_sums *sums)
{
    const size_t count = set_pairs(t, theta_h);
    gonio_status status =
        gonio_i_sampler_colours(t->context, &t->reference, t->pair, count, t->rgb[0]);
    if (status == GONIO_OK) {
        status = gonio_i_sampler_colours(t->context, &t->other, t->pair, count, t->rgb[1]);
    }
    if (status == GONIO_OK) {
        sum_channels(t, keep_common(t, count, sums), sums);
    }
    return status;
}

gonio_status gonio_i_compare_turned(gonio_context *context, const gonio_material *reference,
                                    const gonio_material *other,
                                    gonio_i_slab_sums slabs[GONIO_THETA_H_BINS])
{
    turning t = {.context = context};
    gonio_status status = gonio_i_sampler_begin(context, reference, false, &t.reference);
    if (status == GONIO_OK) {
        status = gonio_i_sampler_begin(context, other, false, &t.other);
    }
    if (status == GONIO_OK && !allocate(&t)) {
        status = GONIO_ERROR_MEMORY;
    }
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS && status == GONIO_OK; theta_h++) {
        status = sum_slab(&t, theta_h, &slabs[theta_h]);
    }
    release(&t);
    return status;
}
