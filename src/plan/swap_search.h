/* The swaps of the condition-number search (Ali et al., section 3.8), from one start to a local
 * optimum.
 *
 * The positions of the choice take turns; the rows outside are tried at each in cyclic order from a
 * random one on, and the first that lowers kappa is taken. (On ten bases of 35 components, 80 rows
 * and one start, this ends at kappa 4.2 on average; the best row of each position at 5.2, the best
 * of all swaps at over 6: greed gets stuck early.)
 *
 * Taking a row v out leaves a largest eigenvalue of at least d_{K-1}, the second largest of G, and
 * of at least d_K - |v|^2, so a swap that lowers kappa must have lambda_min > mu, the larger of
 * these for the longest chosen row over kappa. The filter (swap_filter.h) finds the rows that do,
 * all at once, and those are decided exactly (exchange_eigenvalues.h). Nothing is approximated: the
 * same swaps win as if kappa were computed for every one. A full turn without a swap proves a local
 * optimum. */
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
    double *old_y; /* [K] of the row that went out */
    double condition_number;
    gonio_i_swap_filter filter;
    gonio_i_swap_search_worker *workers; /* [threads] */
    size_t *winners;                     /* [chunks + 1]: scratch */
    int threads;
    double began;   /* s: when the descent began */
    uint64_t waits; /* for other threads */
    double worked;  /* s: what to add to the thread's clock for the time that it did work */
    size_t from;    /* the row that the next position begins with */
    gonio_i_random random;
    uint64_t tests;   /* that a search without the filter would have made */
    double share;     /* how far this search is, 0 to 1 */
    double *progress; /* the sum of all searches' shares */
} gonio_i_swap_search;

/* The panels hold the problem's rows and must outlive the search; *progress is the sum of the
 * shares of all searches of the problem. False when out of memory, after a message. */
bool gonio_i_swap_search_allocate(const gonio_i_selection_problem *problem,
                                  const gonio_i_packed_rows *packed, double *progress, int threads,
                                  gonio_i_swap_search *search);
void gonio_i_swap_search_free(gonio_i_swap_search *search);

/* Turns to a choice, chosen[count]; search->condition_number then is its kappa. */
gonio_status gonio_i_swap_search_begin(gonio_i_swap_search *search, const size_t *chosen);

/* The rows that lower kappa at a position, each the first of its chunk, in cyclic order from `from`
 * on, into found[most]; returns how many. */
size_t gonio_i_swap_search_winners(gonio_i_swap_search *search, size_t position, size_t from,
                                   size_t most, size_t *found);

/* Begins the time by which the search sees whether threads pay. */
void gonio_i_swap_search_watch(gonio_i_swap_search *search);

/* Swaps until no single swap lowers kappa; records them in the selection's history, after `swaps`
 * that were made before. */
gonio_status gonio_i_swap_search_descend(gonio_i_swap_search *search, int restart, int swaps,
                                         gonio_i_selection *selection);

/* Reports how far this search is, 0 to 1, as its share of the progress of all. */
gonio_status gonio_i_swap_search_report(gonio_i_swap_search *search, double share);

#endif
