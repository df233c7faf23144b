/* Starts of the condition-number search: the choice that the swaps begin with. To add one, write a
 * function and add a line to the table in starting_rows.c. */
#ifndef GONIO_STARTING_ROWS_H
#define GONIO_STARTING_ROWS_H

#include "method.h"

typedef struct gonio_i_start {
    const char *name;
    const char *summary;
    /* Fills chosen[count], in any order, without repeats. */
    gonio_status (*choose)(const gonio_i_selection_problem *problem, int restart, size_t *chosen);
} gonio_i_start;

/* By name; NULL if there is none. */
const gonio_i_start *gonio_i_find_start(const char *name);

/* The start whose rows span K dimensions if any rows do. */
const gonio_i_start *gonio_i_spanning_start(void);

#endif
