/* Slabs of a material: as its source reads them, or by evaluation: see slab.h. */
#include "slab.h"

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "inside.h"

enum { AZIMUTHS = 8 /* of the half vector of an anisotropic material */ };

/* A row of bins along phi_d, with the directions of each bin and their values. */
typedef struct row {
    const gonio_material_source *source;
    const double *weight;
    size_t channels;
    size_t directions; /* of each bin */
    gonio_pair *pair;  /* [GONIO_PHI_D_BINS][directions] */
    double *value;     /* [GONIO_PHI_D_BINS][directions][channels] */
    double *mean;      /* [channels] */
} row;

static gonio_pair rotate(gonio_pair pair, double angle)
{
    pair.incident.phi += angle;
    pair.outgoing.phi += angle;
    return pair;
}

static void set_directions(row *r, gonio_bin bin)
{
    const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
    const gonio_pair back = {pair.outgoing, pair.incident};
    gonio_pair *at = r->pair + (size_t)bin.phi_d * r->directions;
    for (size_t k = 0; k < r->directions / 2; k++) {
        const double angle = 4.0 * M_PI * (double)k / (double)r->directions;
        at[2 * k] = rotate(pair, angle);
        at[2 * k + 1] = rotate(back, angle);
    }
}

/* The mean over a bin's directions in each channel, 0 without data. False if no channel has data.
 */
static bool average(const row *r, int phi_d)
{
    const double *value = r->value + (size_t)phi_d * r->directions * r->channels;
    bool any = false;
    for (size_t c = 0; c < r->channels; c++) {
        double sum = 0.0;
        size_t count = 0;
        for (size_t k = 0; k < r->directions; k++) {
            const double here = value[k * r->channels + c];
            const bool data = here >= 0.0 && isfinite(here);
            sum += data ? here : 0.0;
            count += data ? 1 : 0;
        }
        r->mean[c] = count > 0 ? sum / (double)count : 0.0;
        any = any || count > 0;
    }
    return any;
}

static double colour_of(const row *r, size_t channel)
{
    if (r->weight == NULL) {
        return r->mean[r->channels == 1 ? 0 : channel];
    }
    double sum = 0.0;
    for (size_t k = 0; k < r->channels; k++) {
        sum += r->weight[channel * r->channels + k] * r->mean[k];
    }
    return fmax(sum, 0.0);
}

static bool is_inside(const row *r, gonio_bin bin)
{
    const double limit = r->source->theta_limit;
    const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
    return gonio_bin_is_valid(bin) &&
           (limit <= 0.0 || fmax(pair.incident.theta, pair.outgoing.theta) <= limit);
}

/* Evaluates the bins first .. 179 - first, which are inside; the others have no data. */
static gonio_status fill_row(gonio_context *context, row *r, int theta_h, int theta_d, double *rho)
{
    int first = 0;
    while (first < GONIO_PHI_D_BINS / 2 && !is_inside(r, (gonio_bin){theta_h, theta_d, first})) {
        first++;
    }
    const int last = GONIO_PHI_D_BINS - first;
    for (int k = first; k < last; k++) {
        set_directions(r, (gonio_bin){theta_h, theta_d, k});
    }
    const size_t start = (size_t)first * r->directions;
    gonio_status status = GONIO_OK;
    if (first < last) {
        status = r->source->evaluate(r->source->self, context, r->pair + start,
                                     (size_t)(last - first) * r->directions,
                                     r->value + start * r->channels);
    }
    for (int k = 0; k < GONIO_PHI_D_BINS && status == GONIO_OK; k++) {
        const bool data = k >= first && k < last && average(r, k);
        double *bin = rho + (size_t)theta_d * GONIO_PHI_D_BINS + (size_t)k;
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            bin[c * GONIO_SLAB_BINS] = data ? colour_of(r, c) : -1.0;
        }
    }
    return status;
}

gonio_status gonio_i_slab_evaluate(gonio_context *context, const gonio_material_source *source,
                                   const double *weight, int theta_h, double *rho)
{
    row r = {.source = source,
             .weight = weight,
             .channels = source->channels,
             .directions = source->anisotropic ? 2 * AZIMUTHS : 2};
    const size_t most = GONIO_PHI_D_BINS * r.directions;
    r.pair = gonio_i_allocate(context, most, sizeof *r.pair);
    r.value = gonio_i_allocate(context, most * r.channels, sizeof *r.value);
    r.mean = gonio_i_allocate(context, r.channels, sizeof *r.mean);
    gonio_status status =
        r.pair != NULL && r.value != NULL && r.mean != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS && status == GONIO_OK; theta_d++) {
        status = fill_row(context, &r, theta_h, theta_d, rho);
    }
    free(r.pair);
    free(r.value);
    free(r.mean);
    return status;
}

gonio_status gonio_material_read_slab(gonio_context *context, const gonio_material *material,
                                      int theta_h, double *rho)
{
    if (theta_h < 0 || theta_h >= GONIO_THETA_H_BINS) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "theta_h index %d outside 0 .. 89",
                            theta_h);
    }
    const gonio_material_source *source = &material->source;
    return source->read_slab != NULL
               ? source->read_slab(source->self, context, theta_h, rho)
               : gonio_i_slab_evaluate(context, source, material->weight, theta_h, rho);
}
