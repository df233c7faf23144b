/* The albedo of a fit: how much of the light from a few incidences its material reflects. */
#ifndef GONIO_POSTERIOR_ALBEDO_H
#define GONIO_POSTERIOR_ALBEDO_H

#include "fit.h"

enum { GONIO_I_ALBEDO_INCIDENCES = 3 };

/* The outgoing directions over which albedos are integrated, and the prior there. Does not change
 * once it is made; any number of threads may use it. */
typedef struct gonio_i_hemisphere {
    const gonio_i_prior *prior;
    size_t first[GONIO_I_ALBEDO_INCIDENCES + 1]; /* node of each incidence */
    double *weight;                              /* [nodes]: cos theta_o d omega_o */
    gonio_i_place *place;                        /* [nodes] */
    double *mean;                                /* [nodes]: m */
    double *f;                                   /* [nodes][K] */
} gonio_i_hemisphere;

/* The prior, of separate channels, must outlive it. To be released in any case. Errors: _MEMORY. */
gonio_status gonio_i_hemisphere_create(gonio_context *context, const gonio_i_prior *prior,
                                       gonio_i_hemisphere *hemisphere);
void gonio_i_hemisphere_release(gonio_i_hemisphere *hemisphere);

/* The albedos of a solved fit of a channel with scale s. Errors: _MEMORY. */
gonio_status gonio_i_fit_albedo(const gonio_i_fit *fit, const gonio_i_hemisphere *hemisphere,
                                double s, double albedo[GONIO_I_ALBEDO_INCIDENCES]);

#endif
