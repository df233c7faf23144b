/* Slabs of a material: as its source reads them, or by evaluation: see slab.h. */
#include "slab.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "anisotropic_table.h"
#include "azimuth_mean.h"
#include "inside.h"

/* A row of bins along phi_d, of which the first of each run is evaluated. */
typedef struct row {
    const gonio_material_source *source;
    const double *weight;
    size_t channels;
    gonio_pair *pair; /* [GONIO_PHI_D_BINS] */
    double *mean;     /* [GONIO_PHI_D_BINS][channels] */
    double *table;    /* the same, of an anisotropic table; NULL for others */
} row;

static bool has_data(const row *r, const double *mean)
{
    bool any = false;
    for (size_t c = 0; c < r->channels; c++) {
        any = any || !isnan(mean[c]);
    }
    return any;
}

static double or_zero(double value)
{
    return isnan(value) ? 0.0 : value;
}

static double colour_of(const row *r, const double *mean, size_t channel)
{
    if (r->weight == NULL) {
        return or_zero(mean[r->channels == 1 ? 0 : channel]);
    }
    double sum = 0.0;
    for (size_t k = 0; k < r->channels; k++) {
        sum += r->weight[channel * r->channels + k] * or_zero(mean[k]);
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

/* Evaluates runs of the bins first .. last - 1, each at its middle: r->mean[runs]. */
static gonio_status evaluate_runs(gonio_context *context, const row *r, gonio_bin at, int first,
                                  int last, int run)
{
    const gonio_i_averaged averaged = {.evaluate = r->source->evaluate,
                                       .self = r->source->self,
                                       .channels = r->channels,
                                       .anisotropic = r->source->anisotropic,
                                       .both_sides = true};
    size_t runs = 0;
    for (int k = first; k < last; k += run) {
        const int length = run < last - k ? run : last - k;
        at.phi_d = k + length / 2;
        r->pair[runs++] = gonio_pair_from_half_difference(gonio_bin_centre(at));
    }
    return gonio_i_azimuth_mean(context, &averaged, r->pair, runs, r->mean);
}

/* The same of an anisotropic table, which averages its series. */
static gonio_status average_runs(gonio_context *context, const row *r, gonio_bin at, int first,
                                 int last, int run)
{
    const gonio_anisotropic_table *table = gonio_i_anisotropic_of_source(r->source);
    const gonio_status status =
        gonio_i_anisotropic_means(context, table, at.theta_h, at.theta_d, r->table);
    size_t runs = 0;
    for (int k = first; k < last && status == GONIO_OK; k += run) {
        const int length = run < last - k ? run : last - k;
        const double *bin = r->table + (size_t)(k + length / 2) * r->channels;
        memcpy(r->mean + runs++ * r->channels, bin, r->channels * sizeof *bin);
    }
    return status;
}

/* The bins first .. 179 - first are inside; the others have no data. */
static gonio_status fill_row(gonio_context *context, row *r, int theta_h, int theta_d, int run,
                             double *rho)
{
    int first = 0;
    while (first < GONIO_PHI_D_BINS / 2 && !is_inside(r, (gonio_bin){theta_h, theta_d, first})) {
        first++;
    }
    const int last = GONIO_PHI_D_BINS - first;
    gonio_status status = GONIO_OK;
    if (first < last) {
        const gonio_bin at = {theta_h, theta_d, first};
        status = r->table != NULL ? average_runs(context, r, at, first, last, run)
                                  : evaluate_runs(context, r, at, first, last, run);
    }
    for (int k = 0; k < GONIO_PHI_D_BINS && status == GONIO_OK; k++) {
        const bool inside = k >= first && k < last;
        const double *mean = r->mean + (inside ? (size_t)((k - first) / run) * r->channels : 0);
        const bool data = inside && has_data(r, mean);
        double *bin = rho + (size_t)theta_d * GONIO_PHI_D_BINS + (size_t)k;
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            bin[c * GONIO_SLAB_BINS] = data ? colour_of(r, mean, c) : -1.0;
        }
    }
    return status;
}

static gonio_status evaluate(gonio_context *context, const gonio_material_source *source,
                             const double *weight, int theta_h, int run, double *rho)
{
    row r = {.source = source, .weight = weight, .channels = source->channels};
    r.pair = gonio_i_allocate(context, GONIO_PHI_D_BINS, sizeof *r.pair);
    r.mean = gonio_i_allocate(context, GONIO_PHI_D_BINS * r.channels, sizeof *r.mean);
    const bool table = gonio_i_anisotropic_of_source(source) != NULL;
    r.table =
        table ? gonio_i_allocate(context, GONIO_PHI_D_BINS * r.channels, sizeof *r.table) : NULL;
    gonio_status status = r.pair != NULL && r.mean != NULL && (r.table != NULL || !table)
                              ? GONIO_OK
                              : GONIO_ERROR_MEMORY;
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS && status == GONIO_OK; theta_d++) {
        status = fill_row(context, &r, theta_h, theta_d, run, rho);
    }
    free(r.pair);
    free(r.mean);
    free(r.table);
    return status;
}

gonio_status gonio_i_slab_read(gonio_context *context, const gonio_material *material, int theta_h,
                               int run, double *rho)
{
    const gonio_material_source *source = &material->source;
    return source->read_slab != NULL
               ? source->read_slab(source->self, context, theta_h, rho)
               : evaluate(context, source, material->weight, theta_h, run, rho);
}

gonio_status gonio_material_read_slab(gonio_context *context, const gonio_material *material,
                                      int theta_h, double *rho)
{
    if (theta_h < 0 || theta_h >= GONIO_THETA_H_BINS) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "theta_h index %d outside 0 .. 89",
                            theta_h);
    }
    return gonio_i_slab_read(context, material, theta_h, 1, rho);
}
