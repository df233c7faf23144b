/* Ridge regression (Nielsen et al. 2015, eq. (10)): c = argmin |Q c - b|^2 + eta |c|^2 with
 * Q = X S, the rows of V scaled by the singular values; S c are the coefficients of V.
 *
 * This is the least-squares solution of Q c = b stacked on sqrt(eta) c = 0, which always has full
 * rank. So the same QR solves it, without the normal equations. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "equations.h"

/* Q on top of sqrt(eta) I, and b on top of 0. */
static void stack(const gonio_i_equations *e, double *a, double *right)
{
    const size_t k = e->components;
    for (size_t i = 0; i < e->count; i++) {
        for (size_t j = 0; j < k; j++) {
            a[i * k + j] = e->x[i * k + j] * e->singular[j];
        }
    }
    memcpy(right, e->b, e->count * sizeof *right);
    for (size_t j = 0; j < k; j++) {
        a[(e->count + j) * k + j] = sqrt(e->eta);
    }
}

static gonio_status solve(gonio_context *context, const gonio_i_equations *equations,
                          gonio_i_solution *solution)
{
    const size_t k = equations->components;
    const size_t rows = equations->count + k;
    double *a = gonio_i_allocate(context, rows * k, sizeof *a);
    double *right = gonio_i_allocate(context, rows, sizeof *right);
    gonio_status status = a == NULL || right == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        stack(equations, a, right);
        status = gonio_i_least_squares(context, a, rows, k, right, 1, solution->coefficients,
                                       &solution->rank, &solution->condition_number);
    }
    for (size_t j = 0; j < k && status == GONIO_OK && solution->rank == k; j++) {
        solution->coefficients[j] *= equations->singular[j];
    }
    free(a);
    free(right);
    return status;
}

const gonio_i_reconstruct_method gonio_i_ridge_method = {
    .name = "ridge",
    .summary = "with a penalty on large coefficients (Nielsen et al.)",
    .wants = {.colours = true},
    .from_readings = gonio_i_equations_from_readings,
    .from_rows = gonio_i_equations_from_rows,
    .solve = solve,
};
