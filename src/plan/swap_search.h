/* The swaps of the condition-number search (Ali et al., section 3.8), from one start to a local
 * optimum.
 *
 * The search sweeps over the positions of the choice. At each position it tries the other rows in
 * cyclic order, from a random one on, and takes the first that lowers kappa. (On ten bases of 35
 * components, 80 rows and one start, this ends at kappa 4.2 on average. The best row of each
 * position ends at 5.2, the best of all swaps at over 6: greedy choices get stuck early.)
 *
 * After row v is removed, the largest eigenvalue is at least d_{K-1}, the second largest of G, and
 * at least d_K - |v|^2. So a swap that lowers kappa must have lambda_min > mu. mu is the larger of
 * these two bounds, for the longest chosen row, over kappa. The filter (swap_filter.h) finds all
 * rows that may have it. Those are decided exactly (exchange_eigenvalues.h). Nothing is
 * approximated: the search makes the same swaps as if it computed every kappa. A sweep without a
 * swap proves a local optimum. */
#ifndef GONIO_SWAP_SEARCH_H
#define GONIO_SWAP_SEARCH_H

#include <time.h>

#include "../core/random.h"
#include "swap_filter.h"
#include "method.h"
#include "rotated_rows.h"

/* Scratch of one thread. */
typedef struct gonio_i_swap_search_worker {
    double *z;         /* gonio_i_rotated_rows_scratch */
    size_t *survivors; /* [GONIO_I_CHUNK + 1] */
} gonio_i_swap_search_worker;

typedef struct gonio_i_swap_search {
    const gonio_i_selection_problem *problem;
    size_t *chosen;
    unsigned char *taken;         /* [rows] */
    double *x;                    /* [count][K]: the chosen rows */
    double *y;                    /* [count][K]: the chosen rows in the eigenbasis of G */
    double *gram;                 /* G, [K][K] */
    double *q;                    /* [K][K]: the eigenvectors of G as rows */
    double *d;                    /* [K] eigenvalues, ascending */
    gonio_i_rotated_rows rotated; /* rows in the eigenbasis of G */
    uint64_t decompositions;
    double *old_d; /* [K] before a swap */
    double *old_y; /* [K] of the row that was removed */
    double condition_number;
    gonio_i_swap_filter filter;
    gonio_i_swap_search_worker *workers; /* [threads] */
    size_t *winners;                     /* [chunks + 1]: scratch */
    int threads;
    double began;   /* s: when the descent began */
    uint64_t waits; /* for other threads */
    double worked;  /* s: the offset from the thread's clock to the time that it worked */
    size_t from;    /* the row that the next position begins with */
    gonio_i_random random;
    uint64_t tests;   /* that a search without the filter would have made */
    double share;     /* progress of this search, 0 to 1 */
    double *progress; /* the sum of all searches' shares */
} gonio_i_swap_search;

/* The panels hold the problem's rows and must outlive the search; *progress is the sum of the
 * shares of all searches of the problem. False when out of memory, after a message. */
bool gonio_i_swap_search_allocate(const gonio_i_selection_problem *problem,
                                  const gonio_i_packed_rows *packed, double *progress, int threads,
                                  gonio_i_swap_search *search);
void gonio_i_swap_search_free(gonio_i_swap_search *search);

/* Sets the choice, chosen[count]; search->condition_number then is its kappa. */
gonio_status gonio_i_swap_search_begin(gonio_i_swap_search *search, const size_t *chosen);

/* The rows that lower kappa at a position, each the first of its chunk, in cyclic order from `from`
 * on, into found[most]; returns how many. */
size_t gonio_i_swap_search_winners(gonio_i_swap_search *search, size_t position, size_t from,
                                   size_t most, size_t *found);

/* Starts the clock by which the search decides whether several threads are faster. */
void gonio_i_swap_search_watch(gonio_i_swap_search *search);

/* Makes swaps until no single swap lowers kappa. Records them in the selection's history, numbered
 * from `swaps` on, the number of swaps made before. */
gonio_status gonio_i_swap_search_descend(gonio_i_swap_search *search, int restart, int swaps,
                                         gonio_i_selection *selection);

/* Reports the progress of this search, 0 to 1, as a part of the progress of all searches. */
gonio_status gonio_i_swap_search_report(gonio_i_swap_search *search, double share);

#endif
