/* Rows in the eigenbasis of G, z = Q'u, for the condition-number search. They are computed on
 * demand and kept until G changes. The lowest components and the last of z reject most candidates.
 * So this part is computed first, for two rows together. */
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

/* A row with the first `part` values of z and the last one; all values if part = K. */
typedef struct gonio_i_rotated_rows_candidate {
    size_t row;
    size_t part;
    double *z;
} gonio_i_rotated_rows_candidate;

/* False when out of memory, after a message. */
bool gonio_i_rotated_rows_allocate(const gonio_i_selection_problem *problem,
                                   gonio_i_rotated_rows *rotated);
void gonio_i_rotated_rows_free(gonio_i_rotated_rows *rotated);

/* Scratch of one thread for rows that are not kept; the caller frees it. NULL as above. */
double *gonio_i_rotated_rows_scratch(const gonio_i_selection_problem *problem);

/* A new G: its eigenvectors as rows of q[K][K], by ascending eigenvalues. */
void gonio_i_rotated_rows_set(gonio_i_rotated_rows *rotated, const double *q);

/* Computes a part of each of up to GONIO_I_ROTATED_TOGETHER rows. Several threads may call this for
 * different rows. */
void gonio_i_rotated_rows_begin(const gonio_i_rotated_rows *rotated, const size_t *rows,
                                size_t count, double *scratch,
                                gonio_i_rotated_rows_candidate *candidates);

/* Computes all values of a row, in z[K] if the row is not kept. */
const double *gonio_i_rotated_row(const gonio_i_rotated_rows *rotated, size_t row, double *z);

#endif
