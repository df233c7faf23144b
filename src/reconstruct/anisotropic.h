/* Anisotropic reconstructions inside the library. */
#ifndef GONIO_RECONSTRUCT_ANISOTROPIC_H
#define GONIO_RECONSTRUCT_ANISOTROPIC_H

#include <gonio/reconstruct.h>

#include "../posterior/anisotropic.h"

/* What weights of stretches say of a material's anisotropy: all but cannot_tell. */
gonio_anisotropy gonio_i_anisotropy_of(const gonio_i_stretches *stretches);

/* The stretches of a reconstruction, and the root of the mean square of g. */
typedef struct gonio_i_weighed_stretches {
    size_t count;
    gonio_i_stretch stretch[GONIO_I_MOST_HYPOTHESES];
    double weight[GONIO_I_MOST_HYPOTHESES];
    double norm;
} gonio_i_weighed_stretches;

void gonio_i_anisotropic_weighed(const gonio_anisotropic_reconstruction *made,
                                 gonio_i_weighed_stretches *weighed);

/* What a reconstruction predicts from; it belongs to the reconstruction. scale: [channels], s. */
const gonio_i_anisotropic *
gonio_i_anisotropic_estimate(const gonio_anisotropic_reconstruction *made, const double **scale);

/* As gonio_plan_next, of a material whose azimuths count. Errors: those of
 * gonio_reconstruct_anisotropic and gonio_plan_create. */
gonio_status gonio_i_next_anisotropic(gonio_context *context, const gonio_basis *basis,
                                      const gonio_readings *readings,
                                      const gonio_reconstruct_options *options,
                                      const gonio_plan_options *plan_options, double *expected_now,
                                      gonio_plan **plan);

#endif
