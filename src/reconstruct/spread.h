/* From the readings of a column to all rows of the basis: the field and its deviation. */
#ifndef GONIO_SPREAD_H
#define GONIO_SPREAD_H

#include "equations.h"

typedef struct gonio_i_spread_target {
    const double *c;   /* [K], in units of the prior */
    double *field;     /* [rows]: g */
    double *deviation; /* [rows], or NULL */
} gonio_i_spread_target;

/* Adds to `error` the expected square of the field's error over the bins of the grid, and to
 * `square` that of g itself: from every row if the deviation is wanted, otherwise from a sample. */
gonio_status gonio_i_spread(const gonio_i_gaussian *gaussian, const gonio_i_spread_target *target,
                            double *error, double *square);

#endif
