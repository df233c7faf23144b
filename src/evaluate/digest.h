/* A material digested to what the errors of a bivariate estimate need: such an estimate has one
 * value for all phi_d bins of a cell, and the errors are then sums over the cells, not over the
 * bins. A material is read once and compared with as many estimates as one likes. */
#ifndef GONIO_DIGEST_H
#define GONIO_DIGEST_H

#include <gonio/evaluate.h>

#include "../metric/metric.h"

/* What one metric needs. With x_0 = s (e^m - 1), m a cell's mean of g, let d_b = T(rho_b, c_b) -
 * T(x_0, c_b) be the terms of its bins and D(c) = T(x, c) - T(x_0, c) that of an estimate x. The
 * terms of the estimate are d_b - D(c_b). D is known at all bins from its values at the cell's
 * nodes: D(c_b) = sum of share_bj D(node_j). There is one node, c = 1, where terms are a(c) times
 * their value there (metric.h); otherwise Chebyshev interpolation in ln w stands for the bins, of D
 * and of D^2. */
typedef struct gonio_i_digest_metric {
    size_t *first;  /* [cells + 1]: a cell's nodes are first[i] .. first[i + 1] - 1 */
    double *node;   /* [first[cells]]: c */
    double *linear; /* sum over bins of what makes D(c_b) of D(node) */
    double *square; /* and of what makes D(c_b)^2 of D(node)^2 */
    double *moment[GONIO_CHANNELS]; /* sum of share_bj d_b */
} gonio_i_digest_metric;

/* Of the cells with data. */
typedef struct gonio_i_digest {
    char *name;
    uint64_t fingerprint; /* material.h */
    int64_t bins;
    size_t cells;
    int32_t *cell;                /* [cells], database.h */
    double *mean[GONIO_CHANNELS]; /* [cells] of g */
    double *own[GONIO_CHANNELS];  /* [cells]: x_0, 1/sr */
    gonio_i_digest_metric metric[GONIO_MOST_METRICS];
    gonio_i_error_sums constant; /* of d_b */
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
