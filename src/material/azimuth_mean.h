/* The mean of a material over azimuths of the sample. */
#ifndef GONIO_AZIMUTH_MEAN_H
#define GONIO_AZIMUTH_MEAN_H

#include <gonio/material.h>

/* What is averaged. */
typedef struct gonio_i_averaged {
    gonio_status (*evaluate)(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values); /* as in gonio_material_source */
    void *self;
    size_t channels;
    bool anisotropic; /* over azimuths, as many as are needed, up to 32; otherwise one */
    bool both_sides;  /* over the pair and its reciprocal */
} gonio_i_averaged;

/* mean[count][channels], 1/sr: of the values that are finite and not negative, NaN without any.
 * Errors: _MEMORY, those of evaluate. */
gonio_status gonio_i_azimuth_mean(gonio_context *context, const gonio_i_averaged *averaged,
                                  const gonio_pair *pairs, size_t count, double *mean);

#endif
