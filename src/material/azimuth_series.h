/* Fourier series of values at evenly spaced azimuths, as in anisotropic tables (material.h). */
#ifndef GONIO_AZIMUTH_SERIES_H
#define GONIO_AZIMUTH_SERIES_H

#include <stddef.h>

/* Most azimuths of a period. */
enum { GONIO_I_MOST_AZIMUTHS = 64 };

/* cos and sin of the azimuths of a period, [nodes]. */
typedef struct gonio_i_circle {
    size_t nodes;
    double cosine[GONIO_I_MOST_AZIMUTHS];
    double sine[GONIO_I_MOST_AZIMUTHS];
} gonio_i_circle;

/* nodes: at most GONIO_I_MOST_AZIMUTHS. */
gonio_i_circle gonio_i_circle_of(size_t nodes);

/* The coefficients of v[nodes], coefficient[1 + 2 orders]: the mean, then those of cos and sin of
 * each order. orders: less than half the nodes. */
void gonio_i_circle_series(const gonio_i_circle *circle, const double *v, int orders,
                           double *coefficient);

#endif
