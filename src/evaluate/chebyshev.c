/* Interpolation at Chebyshev points: see chebyshev.h. */
#include "chebyshev.h"

#include <math.h>
#include <string.h>

#include "../core/core.h"

void gonio_i_place_nodes(double low, double high, gonio_i_nodes *n)
{
    const double half = 0.5 * (high - low);
    n->count = half > 1e-9 ? 2 + (size_t)ceil(21.0 / asinh(M_PI / half)) : 1;
    for (size_t j = 0; j < n->count; j++) {
        const double angle = M_PI * (2.0 * (double)j + 1.0) / (2.0 * (double)n->count);
        n->t[j] = low + half * (1.0 + cos(angle));
        n->factor[j] = (j % 2 == 0 ? 1.0 : -1.0) * sin(angle);
    }
}

/* The index of the node at t, or 0 if there is only one; the number of nodes if none is at t. */
static size_t node_at(const gonio_i_nodes *n, double t)
{
    size_t j = 0;
    while (j < n->count && n->count > 1 && t != n->t[j]) {
        j++;
    }
    return j;
}

GONIO_I_VECTORISED static void divide_by_distance(const gonio_i_nodes *n, double t, double *share)
{
    for (size_t j = 0; j < n->count; j++) {
        share[j] = n->factor[j] / (t - n->t[j]);
    }
}

void gonio_i_interpolate_nodes(const gonio_i_nodes *n, double t, double *share)
{
    const size_t at = node_at(n, t);
    if (at < n->count) {
        memset(share, 0, n->count * sizeof *share);
        share[at] = 1.0;
        return;
    }
    double sum = 0.0;
    divide_by_distance(n, t, share);
    for (size_t j = 0; j < n->count; j++) {
        sum += share[j];
    }
    for (size_t j = 0; j < n->count; j++) {
        share[j] /= sum;
    }
}
