/* The filter of the condition-number search: for one position of the choice, which rows could take
 * it and lift lambda_min above a bound mu < lambda_min(G). It never misses one; what passes is
 * decided exactly elsewhere.
 *
 * With G = X'X, B = (G - mu)^-1 = L L', v the row at the position and u a candidate, Sylvester's
 * law on G - vv' + uu' - mu (inertia.h) reads, in terms of gain b_u = 1 + u'Bu = 1 + |L'u|^2, loss
 * p_v = 1 - v'Bv,   w = u'Bv: u passes if and only if p_v b_u + w^2 > 0   (p_v > 0: all do). The
 * gains of all rows are computed once for each G, the w for some positions at a time.
 *
 * All this is done in single precision, with bounds of the rounding errors from
 *   |fl(x'y) - x'y| <= n eps |x| |y|                       (Higham 2002, section 3.1),
 * and the test lets pass whatever they leave undecided: rounding costs time, never a winner.
 * (Following a swap by rank-two updates of the gains was tried: a little faster a swap, but the
 * bounds grow tenfold with each, and soon everything passes.) */
#ifndef GONIO_FILTER_H
#define GONIO_FILTER_H

#include "method.h"
#include "panels.h"

typedef struct gonio_i_filter {
    const gonio_i_selection_problem *problem;
    const gonio_i_panels *panels;
    int threads;
    size_t rows;       /* padded to whole panels */
    double *resolvent; /* B, [K][K] */
    double *factor;    /* L, [K][K] */
    float *gain;       /* b_u, [rows] */
    float *w;          /* [GONIO_I_COLUMNS][rows] */
    float *columns;    /* scratch: L, or the columns of a product, padded */
    double loss[GONIO_I_COLUMNS];
    gonio_i_margins margins[GONIO_I_COLUMNS];
    double gain_margin;
    size_t first;        /* position of the first w */
    size_t batch;        /* positions whose w are there; 0 if none */
    unsigned char *pass; /* [rows] */
    bool blind;          /* G is too near singular for the filter: everything passes */
} gonio_i_filter;

/* The panels hold the problem's rows and must outlive the filter. */
bool gonio_i_filter_allocate(const gonio_i_selection_problem *problem, const gonio_i_panels *panels,
                             int threads, gonio_i_filter *filter);
void gonio_i_filter_free(gonio_i_filter *filter);

/* Sets G and mu, from the eigenvectors (rows of q) and eigenvalues d (ascending) of G. mu is
 * lowered if it is not clearly below d[0]. */
void gonio_i_filter_set(gonio_i_filter *filter, const double *q, const double *d, double mu);

/* Rows that pass at a position, ascending, into survivors[rows + 1]; returns how many. x: the
 * chosen rows, [count][K]. */
size_t gonio_i_filter_survivors(gonio_i_filter *filter, const double *x, size_t position,
                                size_t *survivors);

#endif
