/* What the database has never seen, in a plan: the remainder of the prior (basis/prior.h) as
 * columns beside those of the basis. Without it a plan of many readings takes the database at its
 * word, and of a material that is unlike it leaves open what the database never varies in: mostly
 * the width of the peak. */
#ifndef GONIO_PLAN_REMAINDER_H
#define GONIO_PLAN_REMAINDER_H

#include "../basis/prior.h"

/* How much of it. */
typedef struct gonio_i_remainder_size {
    double deviation; /* log units */
    double peak;      /* how many times that near the mirror direction */
    size_t columns;
} gonio_i_remainder_size;

/* Fills g[row * leading + j], j < size->columns, of all rows: G G' is the covariance of the
 * remainder between the rows that are allowed, but for what takes more columns; rows that are not
 * allowed are 0. Cholesky with pivoting on the largest variance left (Higham 2002, sec. 10.3).
 * Errors: _MEMORY. */
gonio_status gonio_i_remainder_columns(gonio_context *context, const gonio_i_remainder_size *size,
                                       const gonio_half_difference *at, const bool *allowed,
                                       size_t rows, size_t leading, float *g);

#endif
