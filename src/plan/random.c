/* Random rows: the baseline that every other method has to beat. */
#include "method.h"

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

const gonio_i_method gonio_i_random_method = {.name = "random",
                                              .summary = "rows drawn at random, the yardstick",
                                              .reconstruction = "least-squares",
                                              .basis = GONIO_I_PAPERS_BASIS,
                                              .select = select_random};
