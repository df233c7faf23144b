/* The filter of the condition-number search: for one position of the choice, which rows could take
 * it and lift lambda_min above a bound mu. It never misses one; what passes is decided exactly
 * elsewhere.
 *
 * With G = X'X, B = (G - mu)^-1, v the row at the position and u a candidate, Sylvester's law on
 * G - vv' + uu' - mu (inertia.h) reads, in terms of
 *   gain b_u = 1 + u'Bu,   loss p_v = 1 - v'Bv,   w = u'Bv:
 *   no eigenvalue of G below mu:  u passes if and only if p_v b_u + w^2 > 0   (p_v > 0: all do)
 *   one eigenvalue below mu:      u passes if and only if p_v > 0 and p_v b_u + w^2 < 0
 *   two or more:                  none passes
 * The gains of all rows and the w of a batch of positions are kept, and follow a swap by a rank-two
 * update of B (Woodbury), so that most of the work is one matrix product a batch. */
#ifndef GONIO_FILTER_H
#define GONIO_FILTER_H

#include "method.h"

enum {
    GONIO_I_BATCH = 16
}; /* positions whose w are kept: a product this wide is not memory-bound */

typedef struct gonio_i_filter {
    const gonio_i_selection_problem *problem;
    double mu;
    double *resolvent;   /* B, [K][K] */
    double *gain;        /* b_u, [rows] */
    double *w;           /* [GONIO_I_BATCH][rows] */
    double *w_in;        /* [rows], scratch of an update */
    double *bv;          /* [GONIO_I_BATCH][K]: B v of the batch */
    size_t first;        /* position of the batch's first */
    size_t batch;        /* positions in the batch; 0 if none is loaded */
    int below;           /* eigenvalues of G below mu */
    int updates;         /* since the last refresh */
    unsigned char *pass; /* [rows] */
} gonio_i_filter;

bool gonio_i_filter_allocate(const gonio_i_selection_problem *problem, gonio_i_filter *filter);
void gonio_i_filter_free(gonio_i_filter *filter);

/* Sets mu anew, from the eigenvectors (rows of q) and eigenvalues d (ascending) of G. */
gonio_status gonio_i_filter_refresh(gonio_i_filter *filter, const double *q, const double *d,
                                    double mu);

/* Makes sure that a position is in the batch; x: the chosen rows, [count][K]. */
gonio_status gonio_i_filter_load(gonio_i_filter *filter, const double *x, size_t position);

/* Rows that pass at a position of the batch, ascending; returns how many. */
size_t gonio_i_filter_survivors(gonio_i_filter *filter, const double *x, size_t position,
                                size_t *survivors);

/* Follows a swap at a position of the batch: row `in` of the matrix for the row v = x[position]
 * that was there. To be called before x is changed; the swap must be one that passed. Within a
 * batch, positions must come in rising order. */
gonio_status gonio_i_filter_swap(gonio_i_filter *filter, const double *x, size_t position,
                                 size_t in);

#endif
