/* Random rows: the yardstick that every other method has to beat. */
#include <stdlib.h>

#include "../core/random.h"
#include "method.h"

gonio_status gonio_i_random_choice(const gonio_i_selection_problem *problem, uint64_t stream,
                                   size_t *chosen)
{
    unsigned char *used = gonio_i_allocate(problem->context, problem->rows, 1);
    if (used == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_i_random random;
    gonio_i_random_seed(&random, problem->seed, stream);
    gonio_i_random_subset(&random, problem->rows, problem->count, used, chosen);
    free(used);
    return GONIO_OK;
}

static gonio_status select_random(const gonio_i_selection_problem *problem,
                                  gonio_i_selection *selection)
{
    gonio_status status = gonio_i_random_choice(problem, 0, selection->chosen);
    if (status == GONIO_OK) {
        status = gonio_i_chosen_condition(problem, selection->chosen, &selection->condition_number);
    }
    if (status == GONIO_OK) {
        status = gonio_i_selection_record(problem, selection, 0, 0, selection->condition_number);
    }
    return status;
}

const gonio_i_method gonio_i_random_method = {"random", "rows drawn at random, the yardstick",
                                              false, select_random};
