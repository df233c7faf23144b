/* Short paths through points of which only distances are known. */
#ifndef GONIO_TOUR_H
#define GONIO_TOUR_H

#include "../core/core.h"

/* Distances, the same either way. */
typedef struct gonio_i_distances {
    size_t nodes;
    const double *matrix; /* [nodes][nodes]; NULL: they are computed */
    double (*compute)(const void *data, size_t a, size_t b);
    const void *data;
} gonio_i_distances;

/* A short path through all nodes that begins at node 0 and ends anywhere: path[nodes], path[0] = 0.
 * The search begins with the order 0, 1, 2 ... The same distances give the same path. `kicks`: how
 * often at most the search goes on from a disturbed path. Errors: _MEMORY, _CANCELLED. */
gonio_status gonio_i_shorten_path(gonio_context *context, const gonio_i_distances *distances,
                                  size_t kicks, size_t *path);

#endif
