/* Values of an RGL .bsdf fitted to the material: rgl_fit.c says how. */
#ifndef GONIO_RGL_FIT_H
#define GONIO_RGL_FIT_H

#include "../sampler.h"
#include "../warp.h"

/* The file's values, and the data by which they are interpolated. */
typedef struct gonio_i_rgl_values {
    size_t thetas;
    const float *theta; /* [thetas], of incidence, radians */
    size_t channels;
    const size_t *order; /* [channels]: which of the material's each is */
    size_t side;
    float *value;             /* [thetas][channels][side][side] */
    const float *ndf;         /* [GONIO_I_RGL_NORMALS] */
    const float *sigma;       /* the same */
    const gonio_i_warp *warp; /* of one slice, that of all incidences */
} gonio_i_rgl_values;

/* Errors: _MEMORY, _CANCELLED, those of the material. */
gonio_status gonio_i_rgl_fit(gonio_context *context, const gonio_i_sampler *sampler,
                             const gonio_i_rgl_values *values);

#endif
