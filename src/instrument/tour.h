/* Short paths through points of which only distances are known. */
#ifndef GONIO_TOUR_H
#define GONIO_TOUR_H

#include "../core/core.h"

/* A short path through all nodes that begins at node 0 and ends anywhere: path[nodes], path[0] = 0.
 * distance[nodes][nodes] is symmetric. The search begins with the order 0, 1, 2 ... The same
 * distances give the same path. Errors: _MEMORY, _CANCELLED. */
gonio_status gonio_i_shorten_path(gonio_context *context, const double *distance, size_t nodes,
                                  size_t *path);

#endif
