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

/* Multiplies the covariances by what the azimuths leave in common. */
static void weigh(const gonio_i_stretch *stretch, const gonio_i_azimuth_point *azimuth,
                  gonio_i_sites *sites)
{
    const size_t n = sites->n;
    for (size_t i = 0; i < n && stretch->symmetry > 0; i++) {
        for (size_t j = 0; j < n; j++) {
            const double kernel = gonio_i_azimuth_kernel(azimuth[i], azimuth[j]);
            sites->gram[i * n + j] *= 1.0 - stretch->share + stretch->share * kernel;
            sites->smooth[i * n + j] *= kernel;
            sites->peaked[i * n + j] *= kernel;
        }
    }
}

gonio_status gonio_i_stretched_sites_create(gonio_context *context, const gonio_i_prior *prior,
                                            const gonio_i_column *column, const gonio_pair *pair,
                                            const gonio_i_stretch *stretch, gonio_i_sites **sites)
{
    const size_t n = column->count;
    gonio_i_column there = {n, gonio_i_allocate(context, n, sizeof *there.observation)};
    gonio_i_azimuth_point *azimuth = gonio_i_allocate(context, n, sizeof *azimuth);
    const bool done = there.observation != NULL && azimuth != NULL;
    *sites = NULL;
    for (size_t i = 0; i < n && done; i++) {
        const gonio_i_oriented here = gonio_i_oriented_of(pair[column->observation[i].reading]);
        there.observation[i] = column->observation[i];
        there.observation[i].at = gonio_i_stretch_apply(stretch, here);
        azimuth[i] = gonio_i_azimuth_of(stretch, here);
    }
    const gonio_status status =
        done ? gonio_i_sites_create(context, prior, &there, sites) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        weigh(stretch, azimuth, *sites);
    }
    free(there.observation);
    free(azimuth);
    return status;
}
