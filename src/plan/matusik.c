/* Linear combinations of the materials themselves (Matusik et al. 2003): rows of H, log BRDFs
 * without mean, with a low condition number.
 *
 * H = V S W' with all components. So H and V S have the same singular values on any rows, and the
 * swaps of condition.c work on rows of V S. They choose among 8,000 random rows of the full grid.
 * Such rows have condition numbers near a million, where the filter of the search rejects little.
 * So more rows take more time, and the reconstruction does not improve. */
#include <stdlib.h>
#include <string.h>

#include "../core/random.h"
#include "method.h"

enum { POOL = 8000 };

/* A stream of random numbers that no start uses. */
static const uint64_t pool_stream = UINT64_MAX;

static size_t pool_size(const gonio_i_selection_problem *problem)
{
    const size_t wanted = problem->count > POOL ? problem->count : POOL;
    return wanted < problem->rows ? wanted : problem->rows;
}

/* Draws the rows among which the search chooses, ascending. */
static gonio_status draw_pool(const gonio_i_selection_problem *problem, size_t count, size_t *pool)
{
    unsigned char *used = gonio_i_allocate(problem->context, problem->rows, 1);
    if (used == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_i_random random;
    gonio_i_random_seed(&random, problem->seed, pool_stream);
    gonio_i_random_subset(&random, problem->rows, count, used, pool);
    free(used);
    return GONIO_OK;
}

/* The condition search among the rows of V S in the pool. */
static gonio_status search(const gonio_i_selection_problem *problem, const size_t *pool,
                           size_t count, double *scaled, gonio_i_selection *selection)
{
    for (size_t j = 0; j < count; j++) {
        gonio_i_scaled_row(problem, pool[j], scaled + j * problem->components);
    }
    gonio_i_selection_problem within = *problem;
    within.vectors = scaled;
    within.rows = count;
    within.stride = problem->components;
    within.basis = NULL;
    const gonio_status status = gonio_i_condition_method.select(&within, selection);
    for (size_t j = 0; j < problem->count && status == GONIO_OK; j++) {
        selection->chosen[j] = pool[selection->chosen[j]];
    }
    return status;
}

static gonio_status select_matusik(const gonio_i_selection_problem *problem,
                                   gonio_i_selection *selection)
{
    const size_t count = pool_size(problem);
    size_t *pool = gonio_i_allocate(problem->context, count, sizeof *pool);
    double *scaled =
        gonio_i_allocate(problem->context, count * problem->components, sizeof *scaled);
    gonio_status status = pool == NULL || scaled == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = draw_pool(problem, count, pool);
    }
    if (status == GONIO_OK) {
        status = search(problem, pool, count, scaled, selection);
    }
    free(pool);
    free(scaled);
    return status;
}

const gonio_i_method gonio_i_matusik_method = {
    .name = "matusik",
    .summary = "the materials themselves, by swaps (Matusik et al. 2003)",
    .reconstruction = "least-squares",
    .basis = {.representation = GONIO_FULL, .channels = GONIO_JOINT, .without_mean = true},
    .needs = GONIO_I_NEEDS_NO_MEAN,
    .where_it_lacks = "matusik works on materials without a mean taken out; learn such a basis: "
                      "gonio learn --no-mean --grid full",
    .needs_full_rank = true,
    .select = select_matusik,
};
