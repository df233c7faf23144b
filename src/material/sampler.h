/* Repeated look-ups of a material at any directions, for writers of formats. */
#ifndef GONIO_SAMPLER_H
#define GONIO_SAMPLER_H

#include <gonio/material.h>

typedef struct gonio_i_sampler {
    const gonio_material *material;
    const gonio_material_view *view;
    gonio_table *table; /* of a material that cannot be evaluated */
    bool average;       /* over azimuths, if the material is anisotropic */
} gonio_i_sampler;

/* Begins a sampler; after success, end it. With `average`, an anisotropic material is averaged over
 * azimuths of the sample, with a note. The material must outlive the sampler. Errors: those of
 * gonio_table_load. */
gonio_status gonio_i_sampler_begin(gonio_context *context, const gonio_material *material,
                                   bool average, gonio_i_sampler *sampler);
void gonio_i_sampler_end(gonio_i_sampler *sampler);

/* values[count][view.channels], 1/sr, NaN for no data. Errors: _MEMORY, those of the source. */
gonio_status gonio_i_sampler_values(gonio_context *context, const gonio_i_sampler *sampler,
                                    const gonio_pair *pairs, size_t count, double *values);

/* The same as R, G, B, rgb[count][GONIO_CHANNELS]. The three values of a single channel are equal.
 * A channel without data is 0 where others have data. */
gonio_status gonio_i_sampler_colours(gonio_context *context, const gonio_i_sampler *sampler,
                                     const gonio_pair *pairs, size_t count, double *rgb);

#endif
