/* Many materials solved side by side. */
#ifndef GONIO_SOLVE_MANY_H
#define GONIO_SOLVE_MANY_H

#include <gonio/reconstruct.h>

/* Solves for `count` materials, one on each thread, or one after the other on all threads where
 * there are fewer than threads. Results and messages are those of solving them in order: made[k] is
 * NULL from the first that failed on, messages are told in order and none of those behind it.
 * *solved: their number before it. Each thread needs the memory of a single reconstruction. Errors:
 * those of gonio_reconstruct for the first that failed; _MEMORY; _CANCELLED. */
gonio_status gonio_i_solve_many(gonio_context *context, const gonio_basis *basis,
                                const gonio_readings *const *readings, size_t count,
                                const gonio_reconstruct_options *options,
                                gonio_reconstruction **made, size_t *solved);

#endif
