/* A search of very many rows in rounds: see shortlist.h. */
#include "shortlist.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_WINNERS = 200, MOST_ROUNDS = 50 }; /* winners at each position */

/* A round that lowers kappa by less than this fraction is the last. */
static const double least_gain = 1e-4;

/* Lists the chosen rows, and for each position up to MOST_WINNERS rows that lower kappa, without
 * repeats, in rows[]. */
static size_t gather_rows(gonio_i_swap_search *s, unsigned char *used, size_t *rows)
{
    const gonio_i_selection_problem *p = s->problem;
    size_t count = p->count;
    memcpy(rows, s->chosen, count * sizeof *rows);
    memcpy(used, s->taken, p->rows);
    for (size_t position = 0; position < p->count; position++) {
        const size_t from = (size_t)gonio_i_random_below(&s->random, p->rows);
        const size_t found =
            gonio_i_swap_search_winners(s, position, from, MOST_WINNERS, rows + count);
        const size_t end = count + found;
        for (size_t k = count; k < end; k++) {
            const size_t row = rows[k];
            rows[count] = row;
            count += !used[row];
            used[row] = 1;
        }
    }
    return count;
}

/* Adds the swaps in the problem `part` to the history of the whole problem, except the last. Its
 * kappa is recomputed from the rows of the whole problem. */
static gonio_status search_part(gonio_i_swap_search *s, gonio_i_selector *select,
                                const gonio_i_selection_problem *part, size_t *chosen, int restart,
                                int *swaps, gonio_i_selection *selection)
{
    gonio_i_selection found = {.chosen = chosen};
    gonio_status status = select(part, &found);
    s->tests += found.tests;
    for (size_t k = 1; k + 1 < found.steps && status == GONIO_OK; k++) {
        status = gonio_i_selection_record(s->problem, selection, restart, ++*swaps,
                                          found.history[k].condition_number);
    }
    free(found.history);
    return status;
}

/* Searches rows[count] alone, from the chosen rows, which come first. The result becomes the
 * choice. */
static gonio_status search_among(gonio_i_swap_search *s, gonio_i_selector *select,
                                 const size_t *rows, size_t count, int restart, int *swaps,
                                 gonio_i_selection *selection)
{
    const gonio_i_selection_problem *p = s->problem;
    const size_t k = p->components;
    double *few = gonio_i_allocate(p->context, count * k, sizeof *few);
    size_t *chosen = gonio_i_allocate(p->context, p->count, sizeof *chosen);
    gonio_status status = few == NULL || chosen == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t j = 0; j < count && status == GONIO_OK; j++) {
        memcpy(few + j * k, gonio_i_row(p, rows[j]), k * sizeof *few);
    }
    if (status == GONIO_OK) {
        for (size_t j = 0; j < p->count; j++) {
            chosen[j] = j;
        }
        gonio_i_selection_problem part = *p;
        part.vectors = few;
        part.stride = k;
        part.rows = count;
        part.restarts = 1;
        part.given = chosen;
        part.part = true;
        status = search_part(s, select, &part, chosen, restart, swaps, selection);
    }
    if (status == GONIO_OK) {
        for (size_t j = 0; j < p->count; j++) {
            chosen[j] = rows[chosen[j]];
        }
        status = gonio_i_swap_search_begin(s, chosen);
    }
    if (status == GONIO_OK) {
        status = gonio_i_selection_record(p, selection, restart, ++*swaps, s->condition_number);
    }
    free(few);
    free(chosen);
    return status;
}

gonio_status gonio_i_search_shortlists(gonio_i_swap_search *s, int restart,
                                       gonio_i_selector *select, int *swaps,
                                       gonio_i_selection *selection)
{
    const gonio_i_selection_problem *p = s->problem;
    unsigned char *used = gonio_i_allocate(p->context, p->rows, 1);
    size_t *rows =
        gonio_i_allocate(p->context, p->count * (MOST_WINNERS + 1) + MOST_WINNERS, sizeof *rows);
    gonio_status status = used == NULL || rows == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    bool worth = true;
    for (int round = 0; round < MOST_ROUNDS && worth && status == GONIO_OK; round++) {
        const double before = s->condition_number;
        const size_t count = gather_rows(s, used, rows);
        if (count > p->count) {
            status = search_among(s, select, rows, count, restart, swaps, selection);
        }
        worth = s->condition_number < before * (1.0 - least_gain);
        if (status == GONIO_OK) {
            status = gonio_i_swap_search_report(s, round / (round + 10.0));
        }
    }
    free(used);
    free(rows);
    return status;
}
