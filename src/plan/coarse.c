/* A start for very many rows: the local optimum among a random few of them, from there the one
 * among eight times as many, and so on. Most swaps are then made where looking at every row is
 * cheap, and few are left for all of them. */
#include <stdlib.h>
#include <string.h>

#include "../core/random.h"
#include "start.h"

enum { LEAST_ROWS = 16000, MORE = 8 };

/* The first `count` of a random order of the rows (Fisher and Yates). */
static size_t *random_order(const gonio_i_selection_problem *p, int restart, size_t count)
{
    size_t *order = gonio_i_allocate(p->context, p->rows, sizeof *order);
    if (order == NULL) {
        return NULL;
    }
    gonio_i_random random;
    gonio_i_random_seed(&random, p->seed, 2 * (uint64_t)restart);
    for (size_t k = 0; k < p->rows; k++) {
        order[k] = k;
    }
    for (size_t k = 0; k < count; k++) {
        const size_t other = k + (size_t)gonio_i_random_below(&random, p->rows - k);
        const size_t swapped = order[k];
        order[k] = order[other];
        order[other] = swapped;
    }
    return order;
}

/* Improves chosen[], positions in order[], among the first `rows` of that order. */
static gonio_status improve_among(const gonio_i_selection_problem *p, int restart,
                                  const size_t *order, size_t rows, size_t *chosen)
{
    double *few = gonio_i_allocate(p->context, rows * p->components, sizeof *few);
    if (few == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < rows; k++) {
        memcpy(few + k * p->components, gonio_i_row(p, order[k]), p->components * sizeof *few);
    }
    gonio_i_selection_problem part = *p;
    part.vectors = few;
    part.stride = p->components;
    part.rows = rows;
    part.seed = p->seed + (uint64_t)restart;
    part.restarts = 1;
    part.keep_history = false;
    part.given = chosen;
    gonio_i_selection selection = {.chosen = chosen};
    const gonio_status status = gonio_i_condition_method.select(&part, &selection);
    free(few);
    return status;
}

/* The number of rows of the first level. */
static size_t fewest(const gonio_i_selection_problem *p)
{
    const size_t least = p->count > LEAST_ROWS / MORE ? p->count * MORE : LEAST_ROWS;
    size_t rows = p->rows;
    while (rows / MORE >= least) {
        rows /= MORE;
    }
    return rows;
}

gonio_status gonio_i_coarse_start(const gonio_i_selection_problem *p, int restart, size_t *chosen)
{
    const size_t most = p->rows / MORE;
    size_t *order = random_order(p, restart, most > p->count ? most : p->count);
    if (order == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t j = 0; j < p->count; j++) {
        chosen[j] = j;
    }
    gonio_status status = GONIO_OK;
    for (size_t rows = fewest(p); rows < p->rows && status == GONIO_OK; rows *= MORE) {
        status = improve_among(p, restart, order, rows < most ? rows : most, chosen);
    }
    for (size_t j = 0; j < p->count; j++) {
        chosen[j] = order[chosen[j]];
    }
    free(order);
    return status;
}
