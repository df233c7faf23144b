/* A digest of a material: the sums that errors of bivariate estimates need. Such an estimate has
 * one value for all phi_d bins of a cell. So its errors are sums over cells instead of bins. The
 * material is read once and can be compared with any number of estimates. */
#ifndef GONIO_DIGEST_H
#define GONIO_DIGEST_H

#include <gonio/evaluate.h>

#include "../metric/metric.h"

/* The sums for one metric. With x_0 = s (e^m - 1), m a cell's mean of g, let d_b = T(rho_b, c_b) -
 * T(x_0, c_b) be the terms of its bins and D(c) = T(x, c) - T(x_0, c) that of an estimate x. The
 * terms of the estimate are d_b - D(c_b). D is known at all bins from its values at the cell's
 * nodes: D(c_b) = sum of share_bj D(node_j). There is one node, c = 1, where terms are a(c) times
 * their value there (metric.h). Otherwise D and D^2 are interpolated by Chebyshev polynomials in
 * ln w. */
typedef struct gonio_i_digest_metric {
    size_t *first;  /* [cells + 1]: a cell's nodes are first[i] .. first[i + 1] - 1 */
    double *node;   /* [first[cells]]: c */
    double *linear; /* sum over bins of the factors from D(node) to D(c_b) */
    double *square; /* and of those from D(node)^2 to D(c_b)^2 */
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

/* The errors of the estimate g[GONIO_CELLS][GONIO_CHANNELS] in log space, clamped as in a table.
 * They agree with gonio_compare of gonio_reconstruction_material to 1e-8. Errors: _MEMORY. */
gonio_status gonio_i_digest_compare(gonio_context *context, const gonio_i_digest *digest,
                                    const double *g, gonio_error *error);

/* The mean of g in each cell, [GONIO_CELLS][GONIO_CHANNELS], NaN where there is no data. */
void gonio_i_digest_mean(const gonio_i_digest *digest, double *g);

#endif
