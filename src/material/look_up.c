/* Looking up tables: see look_up.h. */
#include "look_up.h"

static const double *bin_values(const double *const *slab, gonio_bin bin)
{
    return slab[bin.theta_h] + (size_t)bin.theta_d * GONIO_PHI_D_BINS + (size_t)bin.phi_d;
}

void gonio_i_stencil_slabs(const gonio_i_stencil *stencil, int *first, int *last)
{
    *first = stencil[0].bin.theta_h;
    *last = stencil[0].bin.theta_h;
    for (int k = 1; k < GONIO_I_TRILINEAR; k++) {
        const int slab = stencil[k].bin.theta_h;
        *first = slab < *first ? slab : *first;
        *last = slab > *last ? slab : *last;
    }
}

bool gonio_i_look_up(const double *const slab[GONIO_THETA_H_BINS],
                     gonio_half_difference coordinates, double rho[GONIO_CHANNELS])
{
    rho[0] = rho[1] = rho[2] = 0.0;
    double cosine_i = 0.0;
    double cosine_o = 0.0;
    gonio_cosines(coordinates, &cosine_i, &cosine_o);
    if (cosine_i <= 0.0 || cosine_o <= 0.0) {
        return false;
    }
    gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
    const int points = gonio_i_trilinear(coordinates, stencil);
    double total = 0.0;
    for (int k = 0; k < points; k++) {
        const double *value = bin_values(slab, stencil[k].bin);
        if (value[0] >= 0.0) {
            total += stencil[k].weight;
            for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
                rho[channel] += stencil[k].weight * value[(size_t)channel * GONIO_SLAB_BINS];
            }
        }
    }
    for (int channel = 0; channel < GONIO_CHANNELS && total > 0.0; channel++) {
        rho[channel] /= total;
    }
    return total > 0.0;
}
