/* The samples of an RGL .bsdf: what was measured, before anything is interpolated. */
#ifndef GONIO_RGL_SAMPLES_H
#define GONIO_RGL_SAMPLES_H

#include "rgl.h"

/* One sample: a node of the grid over s at an incidence, mapped through the density of visible
 * normals to a half vector, and by it to the outgoing direction. */
typedef struct gonio_i_rgl_sample {
    gonio_pair pair; /* outgoing theta above pi/2 below the horizon */
    bool flag;       /* the file's field `valid`; true where it has none */
} gonio_i_rgl_sample;

/* Whether the flag of a measured sample is true: of some files it is false, and true below the
 * horizon. */
bool gonio_i_rgl_flag_of_measured(const gonio_i_rgl *rgl);

/* How many samples there are: incidences times nodes. */
size_t gonio_i_rgl_sample_count(const gonio_i_rgl *rgl);

/* Sample k, incidences slowest, and its values in 1/sr, value[channels]; NaN where one is negative
 * (a colour outside sRGB) or the direction is below the horizon. */
gonio_i_rgl_sample gonio_i_rgl_sample_of(const gonio_i_rgl *rgl, size_t k, double *value);

#endif
