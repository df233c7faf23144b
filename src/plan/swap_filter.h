/* The filter of the condition-number search. For one position of the choice it finds the rows that
 * could raise lambda_min above a bound mu < lambda_min(G). It never rejects such a row. Rows that
 * pass are decided exactly elsewhere.
 *
 * With G = X'X, B = (G - mu)^-1 = T'T, v the row at the position and u a candidate, Sylvester's
 * law on G - vv' + uu' - mu (exchange_eigenvalues.h) reads, in terms of gain b_u = 1 + u'Bu = 1 +
 * |T u|^2, loss p_v = v'Bv - 1,   w = u'Bv: u passes if and only if w^2 > p_v b_u   (p_v < 0: all
 * do). Rows are tested a chunk at a time, when the search reaches them. The gains of a chunk are
 * computed once for each G. The w are computed for one position after a swap, and for more
 * positions at a time the more have failed.
 *
 * All this is done in single precision, with bounds of the rounding errors from
 *   |fl(x'y) - x'y| <= n eps |x| |y|                       (Higham 2002, section 3.1),
 * and the test passes what they leave undecided: rounding costs time and never loses a row. B
 * itself has errors too: the Cholesky factor of G - mu is that of G - mu + E, |E| <= r |G - mu|/
 * cond(G - mu) with r of some K eps cond(G - mu) (section 10.1). As (Bu)'E(Bv) then is at most
 * r |Tu| |Tv|, b_u is off by at most r b_u, p_v by r (1 + p_v), and w by
 * r sqrt(b_u (1 + p_v)).
 * (Following a swap by rank-two updates of the gains was tried: a little faster a swap, but the
 * bounds grow tenfold with each, and soon everything passes.) */
#ifndef GONIO_SWAP_FILTER_H
#define GONIO_SWAP_FILTER_H

#include "method.h"
#include "packed_rows.h"

/* Positions that are tested together, and the tests that this needs. */
enum { GONIO_I_TESTS = 4, GONIO_I_BATCH = GONIO_I_TESTS * GONIO_I_COLUMNS };

typedef struct gonio_i_swap_filter {
    const gonio_i_selection_problem *problem;
    const gonio_i_packed_rows *packed;
    int threads;
    float **scratch;                   /* [threads]: a chunk's panels, where these are not kept */
    double *root;                      /* T, [K][K] */
    float *t;                          /* T as packed_rows.h wants it */
    double *image;                     /* scratch, [2][K] */
    float *columns;                    /* Bv of the batch, padded */
    float *gain;                       /* lower bounds of b_u, [rows] */
    float gain_margin;                 /* packed_rows.h */
    double relative;                   /* error of B, above */
    unsigned char *pass;               /* [GONIO_I_BATCH][rows] */
    gonio_i_test tests[GONIO_I_TESTS]; /* of the batch */
    bool all_pass[GONIO_I_BATCH];
    size_t first;       /* position that the batch begins with */
    size_t batch;       /* positions in it; 0 if there is none */
    size_t next;        /* positions of the next batch */
    bool *gain_is_set;  /* [chunks]: for this G */
    bool *batch_is_set; /* [chunks]: for this batch */
    bool blind;         /* G is too near singular for the filter: everything passes */
} gonio_i_swap_filter;

/* The panels hold the problem's rows and must outlive the filter. Up to `threads` threads, which
 * call themselves 0 .. threads - 1, may then use it at a time, on different chunks. */
bool gonio_i_swap_filter_allocate(const gonio_i_selection_problem *problem,
                                  const gonio_i_packed_rows *packed, int threads,
                                  gonio_i_swap_filter *filter);
void gonio_i_swap_filter_free(gonio_i_swap_filter *filter);

/* Sets G [K][K] and mu < lambda_min(G). A smaller mu only passes more rows. condition: of G - mu.
 */
void gonio_i_swap_filter_set(gonio_i_swap_filter *filter, const double *gram, double mu,
                             double condition);

/* Computes the gains of a chunk before they are needed. */
void gonio_i_swap_filter_prepare(gonio_i_swap_filter *filter, size_t chunk, int thread);

/* Sets the position to test. x: the chosen rows, [count][K]. */
void gonio_i_swap_filter_set_position(gonio_i_swap_filter *filter, const double *x,
                                      size_t position);

/* Of the rows first .. last - 1 of a chunk, those that pass, ascending, into
 * survivors[last - first + 1]; returns how many. */
size_t gonio_i_swap_filter_survivors(gonio_i_swap_filter *filter, size_t position, size_t first,
                                     size_t last, int thread, size_t *survivors);

#endif
