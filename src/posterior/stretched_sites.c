/* Sites under the prior of anisotropic materials: see stretched_sites.h. */
#include "stretched_sites.h"

#include <stdlib.h>

bool gonio_i_columns_are_same(const gonio_i_column *a, const gonio_i_column *b)
{
    bool same = a->count == b->count;
    for (size_t i = 0; i < a->count && same; i++) {
        same = a->observation[i].reading == b->observation[i].reading;
    }
    return same;
}

static gonio_i_observation stretched(const gonio_i_observation *o, const gonio_pair *pair,
                                     const gonio_i_stretch *stretch, double *slope)
{
    const gonio_i_oriented here = gonio_i_oriented_of(pair[o->reading]);
    gonio_i_observation there = *o;
    there.at = gonio_i_stretch_apply(stretch, here);
    there.g = gonio_i_multiplied(o->g, -gonio_i_stretch_log_factor(stretch, here), slope);
    there.variance = o->variance * *slope * *slope;
    return there;
}

double gonio_i_stretched_slope(const gonio_i_observation *observation, const gonio_pair *pair,
                               const gonio_i_stretch *stretch)
{
    double slope = 1.0;
    stretched(observation, pair, stretch, &slope);
    return slope;
}

gonio_status gonio_i_stretched_column(gonio_context *context, const gonio_i_column *column,
                                      const gonio_pair *pair, const gonio_i_stretch *stretch,
                                      gonio_i_column *there)
{
    double slope = 1.0;
    *there = (gonio_i_column){column->count,
                              gonio_i_allocate(context, column->count, sizeof *there->observation)};
    for (size_t i = 0; there->observation != NULL && i < column->count; i++) {
        there->observation[i] = stretched(&column->observation[i], pair, stretch, &slope);
    }
    return there->observation != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* Multiplies the covariances by what the azimuths leave in common. */
static void weigh(const gonio_i_stretch *stretch, const gonio_i_azimuth_point *azimuth,
                  gonio_i_sites *sites)
{
    const size_t n = sites->n;
    for (size_t i = 0; i < n && stretch->symmetry > 0; i++) {
        for (size_t j = 0; j < n; j++) {
            const double kernel = gonio_i_azimuth_kernel(azimuth[i], azimuth[j]);
            sites->gram[i * n + j] *= 1.0 - stretch->share + stretch->share * kernel;
            sites->smooth[i * n + j] = kernel * (stretch->fibres ? 1.0 : sites->smooth[i * n + j]);
            sites->peaked[i * n + j] *= kernel;
        }
    }
}

gonio_status gonio_i_stretched_sites_create(gonio_context *context, const gonio_i_prior *prior,
                                            const gonio_i_column *column, const gonio_pair *pair,
                                            const gonio_i_stretch *stretch, gonio_i_sites **sites)
{
    gonio_i_column there = {0};
    gonio_i_azimuth_point *azimuth = gonio_i_allocate(context, column->count, sizeof *azimuth);
    *sites = NULL;
    gonio_status status = azimuth == NULL
                              ? GONIO_ERROR_MEMORY
                              : gonio_i_stretched_column(context, column, pair, stretch, &there);
    for (size_t i = 0; i < column->count && status == GONIO_OK; i++) {
        azimuth[i] =
            gonio_i_azimuth_of(stretch, gonio_i_oriented_of(pair[column->observation[i].reading]));
    }
    if (status == GONIO_OK) {
        status = gonio_i_sites_create(context, prior, &there, sites);
    }
    if (status == GONIO_OK) {
        weigh(stretch, azimuth, *sites);
    }
    free(there.observation);
    free(azimuth);
    return status;
}
