/* Rows in the eigenbasis of G, z = Q'u, for the condition-number search: made when asked for and
 * kept as long as G is the same. Most candidates are refused by a part of z, the lowest components
 * and the last, which is made first, of two rows together. */
#ifndef GONIO_ROTATED_ROWS_H
#define GONIO_ROTATED_ROWS_H

#include "method.h"

enum { GONIO_I_ROTATED_TOGETHER = 2 };

typedef struct gonio_i_rotated_rows {
    const gonio_i_selection_problem *problem;
    size_t stride;         /* K, rounded up so that rows begin with a vector */
    double *columns;       /* [K][stride]: the eigenvectors of G as columns, then zeros */
    double *leading;       /* [K]: the last of them */
    double *kept;          /* [rows][stride]; NULL if they are too many */
    struct rotated *state; /* [rows] of what is kept */
    uint64_t bases;        /* so far */
} gonio_i_rotated_rows;

/* A row of which the first `part` values of z and the last are there: all if part = K. */
typedef struct gonio_i_rotated_rows_candidate {
    size_t row;
    size_t part;
    double *z;
} gonio_i_rotated_rows_candidate;

/* False when out of memory, after a message. */
bool gonio_i_rotated_rows_allocate(const gonio_i_selection_problem *problem,
                                   gonio_i_rotated_rows *rotated);
void gonio_i_rotated_rows_free(gonio_i_rotated_rows *rotated);

/* Scratch for what is not kept, of one thread; for the caller to free. NULL as above. */
double *gonio_i_rotated_rows_scratch(const gonio_i_selection_problem *problem);

/* A new G: its eigenvectors as rows of q[K][K], by ascending eigenvalues. */
void gonio_i_rotated_rows_set(gonio_i_rotated_rows *rotated, const double *q);

/* A part of each of up to GONIO_I_ROTATED_TOGETHER rows. Several threads may do this at a time, for
 * different rows. */
void gonio_i_rotated_rows_begin(const gonio_i_rotated_rows *rotated, const size_t *rows,
                                size_t count, double *scratch,
                                gonio_i_rotated_rows_candidate *candidates);

/* All of a row, in `z` if it is not kept: [K]. */
const double *gonio_i_rotated_row(const gonio_i_rotated_rows *rotated, size_t row, double *z);

#endif
