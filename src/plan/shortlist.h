/* Very many rows: most of the swaps are made where they are cheap.
 *
 * Looking at every row takes long when there are a million, and so does every swap, as it makes all
 * gains anew. So before the search proper, what is looked for in one turn through the positions are
 * not single winners but several for each; then only those and the chosen rows are searched, to
 * their own local optimum; and so on until a turn brings little. The search proper then finds the
 * few swaps that are left, and proves the optimum as ever. */
#ifndef GONIO_SHORTLIST_H
#define GONIO_SHORTLIST_H

#include "swap_search.h"

enum { GONIO_I_MANY_ROWS = 100000 };

/* Makes those swaps; counts and records them. `select` finds a local optimum of a part of the rows
 * from the choice that is given. */
gonio_status gonio_i_search_shortlists(gonio_i_swap_search *search, int restart,
                                       gonio_i_selector *select, int *swaps,
                                       gonio_i_selection *selection);

#endif
