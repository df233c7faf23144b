/* Condition-number plans (Ali et al., section 3.8). From each of several starts the search swaps
 * chosen rows for others until no single swap lowers kappa (swap_search.h). The best result is
 * kept.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "method.h"
#include "shortlist.h"
#include "swap_search.h"
#include "starting_rows.h"

static gonio_i_selector select_by_condition;

/* The first choice: from a start, or (NULL) the given one. */
static gonio_status begin_with(gonio_i_swap_search *s, const gonio_i_start *by, int restart)
{
    const gonio_i_selection_problem *p = s->problem;
    size_t *chosen = gonio_i_allocate(p->context, p->count, sizeof *chosen);
    gonio_status status = chosen == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK && by == NULL) {
        memcpy(chosen, p->given, p->count * sizeof *chosen);
    } else if (status == GONIO_OK) {
        status = by->choose(p, restart, chosen);
    }
    if (status == GONIO_OK) {
        status = gonio_i_swap_search_begin(s, chosen);
    }
    free(chosen);
    return status;
}

/* Makes the chosen start. If its rows do not span K dimensions, makes a start whose rows do. */
static gonio_status start(gonio_i_swap_search *s, int restart)
{
    gonio_i_random_seed(&s->random, s->problem->seed, 2 * (uint64_t)restart + 1);
    s->from = (size_t)gonio_i_random_below(&s->random, s->problem->rows);
    gonio_status status =
        begin_with(s, s->problem->given != NULL ? NULL : s->problem->start, restart);
    if (status == GONIO_OK && isinf(s->condition_number)) {
        status = begin_with(s, gonio_i_spanning_start(), restart);
    }
    if (status == GONIO_OK && isinf(s->condition_number)) {
        status = gonio_i_fail(s->problem->context, GONIO_ERROR_DATA,
                              "the rows of the basis do not span %zu dimensions",
                              s->problem->components);
    }
    return status;
}

/* The state that all starts share. */
typedef struct starts {
    const gonio_i_selection_problem *problem;
    const gonio_i_packed_rows *packed;
    double progress;              /* the sum of the starts' shares */
    gonio_i_selection *histories; /* [restarts]: only the history of each */
    int threads;                  /* within a start */
    _Atomic gonio_status status;
    int best; /* the start with the lowest kappa, the first on ties; its result is in `selection` */
    gonio_i_selection *selection;
} starts;

/* Keeps the result of a start if it is the best so far. */
static void keep_best(starts *all, const gonio_i_swap_search *s, int restart)
{
#pragma omp critical(gonio_condition_best)
    {
        gonio_i_selection *kept = all->selection;
        const bool better = s->condition_number < kept->condition_number ||
                            (s->condition_number == kept->condition_number && restart < all->best);
        if (all->best < 0 || better) {
            all->best = restart;
            kept->condition_number = s->condition_number;
            memcpy(kept->chosen, s->chosen, s->problem->count * sizeof *s->chosen);
        }
        kept->tests += s->tests;
    }
}

/* The swaps of a start. */
static gonio_status descend(gonio_i_swap_search *s, int restart, gonio_i_selection *selection)
{
    const gonio_i_selection_problem *p = s->problem;
    int swaps = 0;
    gonio_i_swap_search_watch(s);
    gonio_status status = gonio_i_selection_record(p, selection, restart, 0, s->condition_number);
    if (status == GONIO_OK && p->components > 1 && p->rows >= GONIO_I_MANY_ROWS) {
        status = gonio_i_search_shortlists(s, restart, select_by_condition, &swaps, selection);
    }
    return status == GONIO_OK ? gonio_i_swap_search_descend(s, restart, swaps, selection) : status;
}

/* One start and its descent. */
static void run(starts *all, int restart)
{
    gonio_i_swap_search s;
    gonio_status status =
        gonio_i_swap_search_allocate(all->problem, all->packed, &all->progress, all->threads, &s)
            ? GONIO_OK
            : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = start(&s, restart);
    }
    if (status == GONIO_OK) {
        status = descend(&s, restart, &all->histories[restart]);
    }
    if (status == GONIO_OK) {
        keep_best(all, &s, restart);
    } else {
        all->status = status;
    }
    gonio_i_swap_search_free(&s);
}

static void run_unless_failed(starts *all, int restart)
{
    if (all->status == GONIO_OK) {
        run(all, restart);
    }
}

/* Runs several starts in parallel: they share only the rows, while threads within one start wait
 * for each other at every step. The remaining threads work within the starts. (A single start is
 * not run in a parallel region, because nested regions create their threads each time.) */
static void run_all(starts *all)
{
    const int restarts = all->problem->restarts;
    const int threads = gonio_context_threads(all->problem->context);
    const int at_once = restarts < threads ? restarts : threads;
    all->threads = threads / at_once;
    if (at_once == 1) {
        for (int restart = 0; restart < restarts; restart++) {
            run_unless_failed(all, restart);
        }
        return;
    }
#pragma omp parallel for schedule(dynamic) num_threads(at_once)
    for (int restart = 0; restart < restarts; restart++) {
        run_unless_failed(all, restart);
    }
}

/* The histories of all starts, in order. */
static gonio_status join_histories(const starts *all)
{
    gonio_status status = GONIO_OK;
    for (int restart = 0; restart < all->problem->restarts; restart++) {
        const gonio_i_selection *one = &all->histories[restart];
        for (size_t k = 0; k < one->steps && status == GONIO_OK; k++) {
            const gonio_plan_step *step = &one->history[k];
            status = gonio_i_selection_record(all->problem, all->selection, step->restart,
                                              step->swap, step->condition_number);
        }
    }
    return status;
}

static gonio_status select_by_condition(const gonio_i_selection_problem *problem,
                                        gonio_i_selection *selection)
{
    gonio_context *context = problem->context;
    const size_t restarts = (size_t)problem->restarts;
    gonio_i_packed_rows packed = {0};
    starts all = {.problem = problem,
                  .packed = &packed,
                  .histories = gonio_i_allocate(context, restarts, sizeof *all.histories),
                  .best = -1,
                  .selection = selection};
    gonio_status status = GONIO_ERROR_MEMORY;
    if (all.histories != NULL && gonio_i_packed_rows_make(problem, &packed)) {
        run_all(&all);
        status = all.status;
    }
    if (status == GONIO_OK) {
        gonio_i_sort_rows(selection->chosen, problem->count);
        status = join_histories(&all);
    }
    if (status == GONIO_OK && !problem->part) {
        status = gonio_i_progress(context, "planning", 1.0);
    }
    for (size_t k = 0; all.histories != NULL && k < restarts; k++) {
        free(all.histories[k].history);
    }
    free(all.histories);
    gonio_i_packed_rows_free(&packed);
    return status;
}

const gonio_i_method gonio_i_condition_method = {
    .name = "condition",
    .summary = "lowest condition number by swaps (Ali et al.)",
    .reconstruction = "least-squares",
    .basis = GONIO_I_PAPERS_BASIS,
    .needs_full_rank = true,
    .select = select_by_condition,
};
