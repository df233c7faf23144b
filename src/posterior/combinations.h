/* Many vectors as combinations of a few: the columns of a spectrum have few shapes.
 *
 * By Gram and Schmidt's method with pivoting: of what is left of all vectors the longest becomes
 * the next of the few, until none is longer than a tolerance. So what is left is known of each
 * vector, not estimated. */
#ifndef GONIO_COMBINATIONS_H
#define GONIO_COMBINATIONS_H

#include "../core/core.h"

typedef struct gonio_i_combinations {
    size_t count;   /* of the few; 0: they would be too many to be of use */
    double *few;    /* [count][size]: orthonormal */
    double *weight; /* [vectors][count] */
} gonio_i_combinations;

/* vector: [vectors][size], overwritten with what is left of each, whose length is at most the
 * tolerance. most: of the few. To be released in any case. Errors: _MEMORY. */
gonio_status gonio_i_combinations_find(gonio_context *context, double *vector, size_t vectors,
                                       size_t size, double tolerance, size_t most,
                                       gonio_i_combinations *combinations);
void gonio_i_combinations_release(gonio_i_combinations *combinations);

#endif
