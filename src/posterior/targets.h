/* Where an error is to be expected: rows of the basis, and how much each of them counts. */
#ifndef GONIO_TARGETS_H
#define GONIO_TARGETS_H

#include "../prior/prior.h"

typedef struct gonio_i_targets {
    double *all;    /* [rows of the basis]: the weight of each of them; 0: it does not count */
    size_t count;   /* of a sample of those that count, of at most some 4,096 rows */
    size_t *row;    /* [count] */
    double *weight; /* [count]: these add up to as much as all */
} gonio_i_targets;

/* The rows around the directions at[count], of all channels; without directions every row, which
 * counts by the bins of its cell. To be freed in any case. Errors: _MEMORY. */
gonio_status gonio_i_targets_create(gonio_context *context, const gonio_i_prior *prior,
                                    const gonio_half_difference *at, size_t count,
                                    gonio_i_targets *targets);
void gonio_i_targets_free(gonio_i_targets *targets);

#endif
