/* A material looked up at any directions, many times: what writers ask. */
#ifndef GONIO_SAMPLER_H
#define GONIO_SAMPLER_H

#include <gonio/material.h>

typedef struct gonio_i_sampler {
    const gonio_material *material;
    const gonio_material_view *view;
    gonio_table *table; /* of a material that cannot be evaluated */
    bool average;       /* an anisotropic one is averaged over its azimuths */
    size_t azimuths;    /* how many of them */
} gonio_i_sampler;

/* `average`: whether an anisotropic material is looked up as an isotropic one, the mean over 8
 * azimuths of the sample, which a message says. The material must outlive it. To be ended after
 * success. Errors: those of gonio_table_load. */
gonio_status gonio_i_sampler_begin(gonio_context *context, const gonio_material *material,
                                   bool average, gonio_i_sampler *sampler);
void gonio_i_sampler_end(gonio_i_sampler *sampler);

/* values[count][view.channels], 1/sr, NaN for no data. Errors: _MEMORY, those of the source. */
gonio_status gonio_i_sampler_values(gonio_context *context, const gonio_i_sampler *sampler,
                                    const gonio_pair *pairs, size_t count, double *values);

/* The same as R, G, B (of a single channel three times the same); a channel without data where
 * others have some is 0. rgb[count][GONIO_CHANNELS]. */
gonio_status gonio_i_sampler_colours(gonio_context *context, const gonio_i_sampler *sampler,
                                     const gonio_pair *pairs, size_t count, double *rgb);

#endif
