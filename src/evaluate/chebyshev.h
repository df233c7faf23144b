/* Interpolation at Chebyshev points: the nodes on an interval, and the weight of each node's value
 * at a point in between. */
#ifndef GONIO_CHEBYSHEV_H
#define GONIO_CHEBYSHEV_H

#include <stddef.h>

enum { GONIO_I_MOST_NODES = 24 };

/* Chebyshev points of the first kind for functions of t = ln w on [low, high]. D(e^t) is analytic
 * up to a distance of pi from the real line, so that the error of n points is (r + sqrt(1 +
 * r^2))^-n, r = pi / half the interval: n is chosen for 1e-9. */
typedef struct gonio_i_nodes {
    size_t count;
    double t[GONIO_I_MOST_NODES];
    double factor[GONIO_I_MOST_NODES]; /* of the barycentric formula */
} gonio_i_nodes;

void gonio_i_place_nodes(double low, double high, gonio_i_nodes *n);

/* share[n->count]: the weight of each node's value at t. */
void gonio_i_interpolate_nodes(const gonio_i_nodes *n, double t, double *share);

#endif
