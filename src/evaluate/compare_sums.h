/* Sums of errors between two materials over the directions of a slab, for the files that compare.
 */
#ifndef GONIO_COMPARE_SUMS_H
#define GONIO_COMPARE_SUMS_H

#include <gonio/material.h>

#include "../metric/metric.h"

typedef struct gonio_i_slab_sums {
    gonio_i_error_sums channel[GONIO_CHANNELS];
    int64_t bins;    /* directions with data in both */
    int64_t missing; /* with data in the reference alone */
} gonio_i_slab_sums;

/* Fills in the sums of all slabs for materials of which one is anisotropic: at every fifth bin of
 * phi_d, at 12 azimuths phi_h of the half vector, which are others in each bin. Errors: _MEMORY,
 * _CANCELLED, those of the materials. */
gonio_status gonio_i_compare_turned(gonio_context *context, const gonio_material *reference,
                                    const gonio_material *other,
                                    gonio_i_slab_sums slabs[GONIO_THETA_H_BINS]);

#endif
