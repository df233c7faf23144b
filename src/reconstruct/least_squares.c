/* Least squares (Ali et al., eq. (5)): c = argmin |X c - b|, by QR with column pivoting. */
#include "../linalg/linalg.h"
#include "equations.h"

static gonio_status solve(gonio_context *context, const gonio_i_equations *equations,
                          gonio_i_solution *solution)
{
    return gonio_i_least_squares(context, equations->x, equations->count, equations->components,
                                 equations->b, 1, solution->coefficients, &solution->rank,
                                 &solution->condition_number);
}

const gonio_i_reconstruct_method gonio_i_least_squares_method = {
    .name = "least-squares",
    .summary = "what fits the readings best (Ali et al.)",
    .wants = {.colours = true, .full_rank = true},
    .from_readings = gonio_i_equations_from_readings,
    .from_rows = gonio_i_equations_from_rows,
    .solve = solve,
};
