/* Optimal, minimal sampling (Nielsen et al. 2015, section 5): n rows of Q = V S with a low
 * condition number of their first n columns. The first row is the longest. Each next one is the
 * best of 500 random rows. Then rows move on the grid, by 3 bins and by 1, while this lowers the
 * number. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include "../basis/basis.h"
#include "../core/random.h"
#include "../linalg/linalg.h"
#include "method.h"

enum { CANDIDATES = 500, MOST_ROUNDS = 100, STEPS = 2, MOVES = 6 };

static const int step_length[STEPS] = {3, 1}; /* cells */

/* A move has to lower the condition number by more than this fraction; less is rounding. */
static const double least_gain = 1e-10;

/* Scratch of one thread. */
typedef struct worker {
    double *rows;   /* [count][K]: Q of the rows that are tried */
    double *gram;   /* of its shorter side */
    double *values; /* [K] */
} worker;

typedef struct search {
    const gonio_i_selection_problem *problem;
    size_t *chosen; /* in the order in which they were found */
    size_t count;   /* of them so far */
    double *rows;   /* [count][K]: their Q */
    double condition_number;
    int threads;
    worker *workers;
    size_t tried[CANDIDATES]; /* rows */
    double result[CANDIDATES];
    uint64_t tests;
} search;

/* ---- the condition number ---- */

/* The condition number of a worker's first `count` rows: the ratio of the largest and the smallest
 * eigenvalue of Q'Q, or of QQ' if there are fewer rows than columns. */
static gonio_status condition_of(const search *s, const worker *w, size_t count, double *condition)
{
    gonio_context *context = s->problem->context;
    const size_t k = s->problem->components;
    const size_t n = count < k ? count : k;
    gonio_status status = count < k ? gonio_i_product_transposed(context, w->rows, count, k,
                                                                 w->rows, count, w->gram, count)
                                    : gonio_i_gram_rows(context, w->rows, count, k, k, w->gram);
    if (status == GONIO_OK) {
        status = gonio_i_eigen(context, w->gram, n, false, w->values);
    }
    if (status == GONIO_OK) {
        *condition = gonio_i_condition(w->values, n);
    }
    return status;
}

/* The condition numbers with each of the rows tried[candidates] at a position of the choice. */
static gonio_status try_rows(search *s, size_t position, size_t candidates)
{
    const size_t k = s->problem->components;
    const size_t count = position < s->count ? s->count : position + 1;
    gonio_status result = GONIO_OK;
#pragma omp parallel num_threads(s->threads) if (candidates > 1)
    {
        const worker *w = &s->workers[omp_get_thread_num()];
        memcpy(w->rows, s->rows, s->count * k * sizeof *w->rows);
#pragma omp for schedule(static)
        for (size_t c = 0; c < candidates; c++) {
            gonio_i_scaled_row(s->problem, s->tried[c], w->rows + position * k);
            const gonio_status status = condition_of(s, w, count, &s->result[c]);
            if (status != GONIO_OK) {
#pragma omp atomic write
                result = status;
            }
        }
    }
    s->tests += candidates;
    return result;
}

/* The candidate with the lowest condition number, the first on ties. */
static size_t best_of(const search *s, size_t candidates)
{
    size_t best = 0;
    for (size_t c = 1; c < candidates; c++) {
        best = s->result[c] < s->result[best] ? c : best;
    }
    return best;
}

static void put(search *s, size_t position, size_t row, double condition_number)
{
    s->chosen[position] = row;
    s->count = position < s->count ? s->count : position + 1;
    s->condition_number = condition_number;
    gonio_i_scaled_row(s->problem, row, s->rows + position * s->problem->components);
}

static bool is_chosen(const search *s, size_t row)
{
    for (size_t j = 0; j < s->count; j++) {
        if (s->chosen[j] == row) {
            return true;
        }
    }
    return false;
}

/* ---- the first choice ---- */

GONIO_I_VECTORISED static double squared_length(const double *row, const double *singular, size_t k)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t j = 0; j < k; j++) {
        sum += row[j] * singular[j] * (row[j] * singular[j]);
    }
    return sum;
}

/* The row with the longest Q, the first of several. */
static gonio_status find_longest(const gonio_i_selection_problem *problem, size_t *longest)
{
    const size_t k = problem->components;
    double *singular = gonio_i_allocate(problem->context, k, sizeof *singular);
    double *length = gonio_i_allocate(problem->context, problem->rows, sizeof *length);
    const bool ready = singular != NULL && length != NULL;
    for (size_t j = 0; j < k && ready; j++) {
        singular[j] = gonio_i_singular_value(problem->basis, j);
    }
    const size_t rows = ready ? problem->rows : 0;
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(problem->context))
    for (size_t i = 0; i < rows; i++) {
        length[i] = squared_length(gonio_i_row(problem, i), singular, k);
    }
    *longest = 0;
    for (size_t i = 1; i < rows; i++) {
        *longest = length[i] > length[*longest] ? i : *longest;
    }
    free(singular);
    free(length);
    return ready ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* Draws rows that are not chosen yet; returns their number. */
static size_t draw(search *s, gonio_i_random *random)
{
    const size_t rows = s->problem->rows;
    size_t count = 0;
    for (int c = 0; c < CANDIDATES; c++) {
        s->tried[count] = (size_t)gonio_i_random_below(random, rows);
        count += !is_chosen(s, s->tried[count]);
    }
    while (count == 0) { /* nearly all are chosen: the next free one */
        s->tried[0] = (s->tried[0] + 1) % rows;
        count += !is_chosen(s, s->tried[0]);
    }
    return count;
}

static gonio_status grow(search *s)
{
    size_t longest = 0;
    gonio_i_random random;
    gonio_i_random_seed(&random, s->problem->seed, 0);
    gonio_status status = find_longest(s->problem, &longest);
    if (status == GONIO_OK) {
        put(s, 0, longest, 1.0);
    }
    while (s->count < s->problem->count && status == GONIO_OK) {
        const size_t candidates = draw(s, &random);
        status = try_rows(s, s->count, candidates);
        if (status == GONIO_OK) {
            const size_t best = best_of(s, candidates);
            put(s, s->count, s->tried[best], s->result[best]);
            status = gonio_i_progress(s->problem->context, "planning",
                                      0.5 * (double)s->count / (double)s->problem->count);
        }
    }
    return status;
}

/* ---- moves ---- */

/* Moves a cell; false if it would leave the grid. phi_d is periodic. */
static bool move_cell(int32_t phi_cells, int move, int length, gonio_i_cell_indices *at)
{
    const int by = move % 2 == 0 ? length : -length;
    at->theta_h += move / 2 == 0 ? by : 0;
    at->theta_d += move / 2 == 1 ? by : 0;
    at->phi += move / 2 == 2 ? by : 0;
    at->phi = (at->phi % phi_cells + phi_cells) % phi_cells;
    return at->theta_h >= 0 && at->theta_h < GONIO_THETA_H_BINS && at->theta_d >= 0 &&
           at->theta_d < GONIO_THETA_D_BINS;
}

static int compare_cells(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a;
    const int32_t y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* The row with the same channel in a cell nearby; false if the basis has none there. */
static bool neighbour(const gonio_basis_view *basis, size_t row, int move, int length,
                      size_t *moved)
{
    const int32_t phi_cells = gonio_i_phi_cells(basis->representation);
    gonio_i_cell_indices at = gonio_i_indices_of_cell(phi_cells, gonio_i_row_cell(basis, row));
    if (!move_cell(phi_cells, move, length, &at)) {
        return false;
    }
    const int32_t cell = gonio_i_cell_at(phi_cells, at);
    const int32_t *found =
        bsearch(&cell, basis->cell, basis->cells, sizeof *basis->cell, compare_cells);
    if (found != NULL) {
        *moved = gonio_i_row_of(basis->channels, (size_t)(found - basis->cell),
                                gonio_i_channel_of(basis->channels, row));
    }
    return found != NULL;
}

/* Tries all moves of one row by one length. Makes the best one if it lowers the condition number.
 */
static gonio_status move_row(search *s, size_t position, int length, bool *moved)
{
    size_t candidates = 0;
    for (int move = 0; move < MOVES; move++) {
        candidates += neighbour(s->problem->basis, s->chosen[position], move, length,
                                &s->tried[candidates]) &&
                      !is_chosen(s, s->tried[candidates]);
    }
    if (candidates == 0) {
        return GONIO_OK;
    }
    const gonio_status status = try_rows(s, position, candidates);
    const size_t best = best_of(s, candidates);
    if (status == GONIO_OK && s->result[best] < s->condition_number * (1.0 - least_gain)) {
        put(s, position, s->tried[best], s->result[best]);
        *moved = true;
    }
    return status;
}

static gonio_status improve(search *s, gonio_i_selection *selection)
{
    gonio_status status =
        gonio_i_selection_record(s->problem, selection, 0, 0, s->condition_number);
    int swaps = 0;
    bool moved = s->problem->count > 1;
    for (int round = 0; round < MOST_ROUNDS && moved && status == GONIO_OK; round++) {
        moved = false;
        for (size_t k = 0; k < STEPS * s->count && status == GONIO_OK; k++) {
            bool one = false;
            status = move_row(s, k / STEPS, step_length[k % STEPS], &one);
            if (status == GONIO_OK && one) {
                moved = true;
                status = gonio_i_selection_record(s->problem, selection, 0, ++swaps,
                                                  s->condition_number);
            }
        }
        if (status == GONIO_OK) {
            status =
                gonio_i_progress(s->problem->context, "planning", 0.5 + 0.5 * round / MOST_ROUNDS);
        }
    }
    return status;
}

/* ---- all of it ---- */

static bool allocate_search(const gonio_i_selection_problem *problem, size_t *chosen, search *s)
{
    gonio_context *context = problem->context;
    const size_t k = problem->components;
    s->problem = problem;
    s->chosen = chosen;
    s->threads = gonio_context_threads(context);
    s->rows = gonio_i_allocate(context, problem->count * k, sizeof *s->rows);
    s->workers = gonio_i_allocate(context, (size_t)s->threads, sizeof *s->workers);
    bool ready = s->rows != NULL && s->workers != NULL;
    for (int t = 0; t < s->threads && ready; t++) {
        worker *w = &s->workers[t];
        w->rows = gonio_i_allocate(context, problem->count * k, sizeof *w->rows);
        w->gram = gonio_i_allocate(context, k * k, sizeof *w->gram);
        w->values = gonio_i_allocate(context, k, sizeof *w->values);
        ready = w->rows != NULL && w->gram != NULL && w->values != NULL;
    }
    return ready;
}

static void free_search(search *s)
{
    for (int t = 0; s->workers != NULL && t < s->threads; t++) {
        free(s->workers[t].rows);
        free(s->workers[t].gram);
        free(s->workers[t].values);
    }
    free(s->workers);
    free(s->rows);
}

static gonio_status select_nielsen(const gonio_i_selection_problem *problem,
                                   gonio_i_selection *selection)
{
    search *s = gonio_i_allocate(problem->context, 1, sizeof *s);
    if (s == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status =
        allocate_search(problem, selection->chosen, s) ? grow(s) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = improve(s, selection);
    }
    if (status == GONIO_OK) {
        selection->condition_number = s->condition_number;
        selection->tests = s->tests;
        gonio_i_sort_rows(selection->chosen, problem->count);
        status = gonio_i_progress(problem->context, "planning", 1.0);
    }
    free_search(s);
    free(s);
    return status;
}

const gonio_i_method gonio_i_nielsen_method = {
    .name = "nielsen",
    .summary = "lowest condition number by moves over the grid (Nielsen et al. 2015)",
    .reconstruction = "ridge",
    .basis = GONIO_I_RELATIVE_BASIS,
    .needs = GONIO_I_NEEDS_A_BASIS,
    .where_it_lacks = "nielsen works on a basis, not on rows alone",
    .few_components = true,
    .select = select_nielsen,
};
