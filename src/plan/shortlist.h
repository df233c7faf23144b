/* The search over very many rows makes most of its swaps on short lists of rows.
 *
 * With a million rows, a test of every row takes long. So does every swap, because it changes all
 * gains. So rounds precede the search over all rows. A round sweeps once over the positions and
 * gathers several rows for each that lower kappa. Then it searches these and the chosen rows alone,
 * to their local optimum. The rounds end when one gains little. The search over all rows then finds
 * the few remaining swaps and proves the optimum. */
#ifndef GONIO_SHORTLIST_H
#define GONIO_SHORTLIST_H

#include "swap_search.h"

enum { GONIO_I_MANY_ROWS = 100000 };

/* Makes the swaps of the rounds, counts and records them. `select` finds a local optimum of some of
 * the rows from a given choice. */
gonio_status gonio_i_search_shortlists(gonio_i_swap_search *search, int restart,
                                       gonio_i_selector *select, int *swaps,
                                       gonio_i_selection *selection);

#endif
