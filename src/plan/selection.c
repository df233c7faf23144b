/* Functions that methods that choose rows share: histories, condition numbers, random choices. */
#include "method.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../basis/basis.h"
#include "../core/random.h"
#include "../linalg/linalg.h"

/* ---- histories and condition numbers ---- */

gonio_status gonio_i_selection_record(const gonio_i_selection_problem *problem,
                                      gonio_i_selection *selection, int restart, int swap,
                                      double condition_number)
{
    const size_t n = selection->steps;
    if (!problem->keep_history) {
        return GONIO_OK;
    }
    if ((n & (n - 1)) == 0) {
        void *more = reallocarray(selection->history, n > 0 ? 2 * n : 1, sizeof(gonio_plan_step));
        if (more == NULL) {
            return gonio_i_fail(problem->context, GONIO_ERROR_MEMORY, "out of memory");
        }
        selection->history = more;
    }
    selection->history[n] = (gonio_plan_step){restart, swap, condition_number};
    selection->steps++;
    return GONIO_OK;
}

double gonio_i_condition(const double *eigenvalues, size_t n)
{
    const double smallest = eigenvalues[0];
    const double largest = eigenvalues[n - 1];
    return smallest > largest * DBL_EPSILON * (double)n ? largest / smallest : INFINITY;
}

gonio_status gonio_i_chosen_gram(const gonio_i_selection_problem *problem, const size_t *chosen,
                                 double *rows, double *gram)
{
    const size_t k = problem->components;
    for (size_t j = 0; j < problem->count; j++) {
        memcpy(rows + j * k, gonio_i_row(problem, chosen[j]), k * sizeof *rows);
    }
    return gonio_i_gram_rows(problem->context, rows, problem->count, k, k, gram);
}

gonio_status gonio_i_chosen_condition(const gonio_i_selection_problem *problem,
                                      const size_t *chosen, double *condition_number)
{
    const size_t k = problem->components;
    double *rows = gonio_i_allocate(problem->context, problem->count * k, sizeof *rows);
    double *gram = gonio_i_allocate(problem->context, k * k + k, sizeof *gram);
    gonio_status status = rows == NULL || gram == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_i_chosen_gram(problem, chosen, rows, gram);
    }
    if (status == GONIO_OK) {
        status = gonio_i_eigen(problem->context, gram, k, false, gram + k * k);
    }
    if (status == GONIO_OK) {
        *condition_number = gonio_i_condition(gram + k * k, k);
    }
    free(rows);
    free(gram);
    return status;
}

/* ---- rows of V S ---- */

void gonio_i_scaled_row(const gonio_i_selection_problem *problem, size_t row, double *scaled)
{
    const double *v = gonio_i_row(problem, row);
    for (size_t k = 0; k < problem->components; k++) {
        scaled[k] = v[k] * gonio_i_singular_value(problem->basis, k);
    }
}

gonio_status gonio_i_scaled_condition(const gonio_i_selection_problem *problem,
                                      const size_t *chosen, double *condition_number)
{
    const size_t k = problem->components;
    double *rows = gonio_i_allocate(problem->context, problem->count * k, sizeof *rows);
    size_t *all = gonio_i_allocate(problem->context, problem->count, sizeof *all);
    gonio_status status = rows == NULL || all == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t j = 0; j < problem->count && status == GONIO_OK; j++) {
        gonio_i_scaled_row(problem, chosen[j], rows + j * k);
        all[j] = j;
    }
    if (status == GONIO_OK) {
        gonio_i_selection_problem scaled = *problem;
        scaled.vectors = rows;
        scaled.stride = k;
        status = gonio_i_chosen_condition(&scaled, all, condition_number);
    }
    free(rows);
    free(all);
    return status;
}

/* ---- choices ---- */

static int compare_rows(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a;
    const size_t y = *(const size_t *)b;
    return (x > y) - (x < y);
}

void gonio_i_sort_rows(size_t *rows, size_t count)
{
    qsort(rows, count, sizeof *rows, compare_rows);
}

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

/* ---- any rows ---- */

static gonio_status check_chosen(gonio_context *context, size_t rows, const size_t *chosen,
                                 size_t count)
{
    for (size_t j = 0; j < count; j++) {
        if (chosen[j] >= rows) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                "row %zu is outside a matrix of %zu rows", chosen[j], rows);
        }
    }
    return GONIO_OK;
}

/* Of rows that are there. */
static gonio_status condition_of(gonio_context *context, const double *vectors, size_t leading,
                                 size_t components, const size_t *chosen, size_t count,
                                 double *condition_number)
{
    double *rows = gonio_i_allocate(context, count * components, sizeof *rows);
    size_t *all = gonio_i_allocate(context, count, sizeof *all);
    gonio_status status = rows == NULL || all == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t j = 0; j < count && status == GONIO_OK; j++) {
        memcpy(rows + j * components, vectors + chosen[j] * leading, components * sizeof *rows);
        all[j] = j;
    }
    if (status == GONIO_OK) {
        const gonio_i_selection_problem problem = {.context = context,
                                                   .vectors = rows,
                                                   .rows = count,
                                                   .components = components,
                                                   .stride = components,
                                                   .count = count};
        status = gonio_i_chosen_condition(&problem, all, condition_number);
    }
    free(rows);
    free(all);
    return status;
}

gonio_status gonio_condition_number(gonio_context *context, const double *vectors, size_t rows,
                                    size_t leading, size_t components, const size_t *chosen,
                                    size_t count, double *condition_number)
{
    const gonio_status status = check_chosen(context, rows, chosen, count);
    if (status != GONIO_OK) {
        return status;
    }
    if (components == 0 || components > leading) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu components requested, but the rows have %zu", components, leading);
    }
    return condition_of(context, vectors, leading, components, chosen, count, condition_number);
}
