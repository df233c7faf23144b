/* A material digested to what the errors of a bivariate estimate need: such an estimate has one
 * value for all phi_d bins of a cell, and the errors are then sums over the cells, not over the
 * bins. A material is read once and compared with as many estimates as one likes. */
#ifndef GONIO_DIGEST_H
#define GONIO_DIGEST_H

#include <gonio/evaluate.h>

#include "metrics.h"

/* Of the cells with data. E6 and the cube-root error are squares of the distance from a cell's
 * mean plus a scatter. The log-relative error is not, as its w differs from bin to bin: with d_b
 * the log ratio of bin b to the cell's mean x_0, and D(w) = ln((x w + e)/(x_0 w + e)) that of an
 * estimate x, the sum of (d_b - D(w_b))^2 is the sum of d_b^2 - 2 moment_j D(w_j) + weight_j
 * D(w_j)^2 over the cell's nodes w_j, at which Chebyshev interpolation in ln w stands for the bins.
 */
typedef struct gonio_i_digest {
    char *name;
    uint64_t fingerprint; /* material.h */
    int64_t bins;
    size_t cells;
    int32_t *cell;                /* [cells], database.h */
    double *count;                /* [cells]: bins with data */
    double *mean[GONIO_CHANNELS]; /* [cells] of g */
    double *area;                 /* [cells]: sum of (c_i c_o)^(2/3) */
    double *root[GONIO_CHANNELS]; /* [cells]: mean of cbrt(rho) weighted by that */
    size_t *first;                /* [cells + 1]: a cell's nodes are first[i] .. first[i + 1] - 1 */
    double *node;                 /* [first[cells]] */
    double *weight;
    double *moment[GONIO_CHANNELS];
    gonio_i_error_sums constant; /* the scatters, and the references */
} gonio_i_digest;

/* Errors: those of the material's source; _DATA if it has no data or is black; _MEMORY. */
gonio_status gonio_i_digest_create(gonio_context *context, const gonio_material *material,
                                   gonio_i_digest **digest);
void gonio_i_digest_free(gonio_i_digest **digest);

/* The errors of the estimate g[GONIO_CELLS][GONIO_CHANNELS] in log space, clamped as a table would
 * hold it: what gonio_compare finds for gonio_reconstruction_material, to 1e-8. Errors: _MEMORY. */
gonio_status gonio_i_digest_compare(gonio_context *context, const gonio_i_digest *digest,
                                    const double *g, gonio_error *error);

/* The mean of g in each cell, [GONIO_CELLS][GONIO_CHANNELS], NaN where there is no data. */
void gonio_i_digest_mean(const gonio_i_digest *digest, double *g);

#endif
