/* Plans: the table of methods, and from chosen rows to light/view pairs. */
#include <gonio/plan.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../basis/basis.h"
#include "../linalg/linalg.h"
#include "expected_error_plan.h"
#include "method.h"
#include "starting_rows.h"

/* The methods, and what their plans are made for. */
static const struct {
    const gonio_i_method *method;
    const char *reconstruction; /* reconstruct.h */
    bool few_components;        /* no more components than readings */
} methods[] = {
    {&gonio_i_expected_error_method, "posterior", false},
    {&gonio_i_condition_method, "least-squares", false},
    {&gonio_i_random_method, "least-squares", false},
    {&gonio_i_matusik_method, "least-squares", false},
    {&gonio_i_nielsen_method, "ridge", true},
    {&gonio_i_frost_method, "ridge", true},
};

enum { METHODS = sizeof methods / sizeof *methods };

const char *gonio_plan_method_name(int index)
{
    return index >= 0 && index < METHODS ? methods[index].method->name : NULL;
}

const char *gonio_plan_method_summary(int index)
{
    return index >= 0 && index < METHODS ? methods[index].method->summary : NULL;
}

/* Its place in the table; METHODS if there is none. */
static int find_method(const char *name)
{
    int k = 0;
    while (k < METHODS && strcmp(methods[k].method->name, name) != 0) {
        k++;
    }
    return k;
}

const char *gonio_plan_method_reconstruction(const char *method)
{
    const int k = find_method(method);
    return k < METHODS ? methods[k].reconstruction : NULL;
}

void gonio_plan_options_default(gonio_plan_options *options)
{
    *options = (gonio_plan_options){
        .count = 80, .restarts = 5, .keep_history = true, .start = "random", .phi_d = M_PI / 2.0};
}

const char *gonio_plan_start_name(int index)
{
    return gonio_i_start_at(index) != NULL ? gonio_i_start_at(index)->name : NULL;
}

const char *gonio_plan_start_summary(int index)
{
    return gonio_i_start_at(index) != NULL ? gonio_i_start_at(index)->summary : NULL;
}

/* ---- what the methods share ---- */

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
        scaled[k] = v[k] * gonio_basis_singular_value(problem->basis, k);
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

/* ---- selecting ---- */

/* The method asked for, or what suits the basis. */
static const char *method_of(const gonio_basis_view *basis, const gonio_plan_options *options)
{
    const bool mixtures = basis != NULL && basis->mixtures > 0;
    const gonio_i_method *usual =
        mixtures ? &gonio_i_expected_error_method : &gonio_i_condition_method;
    return options->method != NULL ? options->method : usual->name;
}

static gonio_status check_selection(gonio_context *context, size_t rows, size_t components,
                                    const gonio_plan_options *options)
{
    const int method = find_method(options->method);
    const size_t n = options->count;
    if (method == METHODS) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "no selection method is called '%s'",
                            options->method);
    }
    if (gonio_i_find_start(options->start) == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "no start is called '%s'",
                            options->start);
    }
    if (n == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a plan needs at least 1 reading");
    }
    if (n > rows) {
        return gonio_i_fail(
            context, GONIO_ERROR_ARGUMENT,
            "%zu readings asked for, but the basis has only %zu rows to choose from", n, rows);
    }
    if (methods[method].method->needs_full_rank && n < components) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu readings cannot determine %zu coefficients: plan at least %zu "
                            "readings, or use fewer components (--components %zu or less)",
                            n, components, components, n);
    }
    if (options->restarts < 1) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "at least 1 start is needed, not %d",
                            options->restarts);
    }
    return GONIO_OK;
}

/* Completes a problem and solves it. */
static gonio_status select_rows(gonio_i_selection_problem *problem,
                                const gonio_plan_options *options, size_t *chosen,
                                gonio_selection_report *report)
{
    gonio_status status =
        check_selection(problem->context, problem->rows, problem->components, options);
    if (status != GONIO_OK) {
        return status;
    }
    problem->count = options->count;
    problem->restarts = options->restarts;
    problem->seed = options->seed;
    problem->keep_history = options->keep_history;
    problem->start = options->start;
    gonio_i_selection selection = {.chosen = chosen};
    status = methods[find_method(options->method)].method->select(problem, &selection);
    if (status != GONIO_OK) {
        free(selection.history);
        return status;
    }
    *report = (gonio_selection_report){selection.condition_number, selection.tests, selection.steps,
                                       selection.history};
    return GONIO_OK;
}

gonio_status gonio_plan_select(gonio_context *context, const double *vectors, size_t rows,
                               size_t leading, size_t components, const gonio_plan_options *options,
                               size_t *chosen, gonio_selection_report *report)
{
    gonio_plan_options named = *options;
    named.method = method_of(NULL, options);
    gonio_i_selection_problem problem = {.context = context,
                                         .vectors = vectors,
                                         .rows = rows,
                                         .components = components,
                                         .stride = leading};
    return select_rows(&problem, &named, chosen, report);
}

gonio_status gonio_condition_number(gonio_context *context, const double *vectors, size_t leading,
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

/* ---- plans ---- */

gonio_plan_entry gonio_i_plan_entry(const gonio_basis_view *basis, size_t row, double phi_d)
{
    const int32_t cell = gonio_i_row_cell(basis, row);
    const bool joint = basis->channels == GONIO_JOINT;
    return (gonio_plan_entry){cell,
                              joint ? gonio_i_channel_of(basis->channels, row) : GONIO_ALL_CHANNELS,
                              gonio_pair_from_half_difference(
                                  gonio_i_cell_direction(basis->representation, cell, phi_d))};
}

void gonio_plan_rows(const gonio_plan *plan, const gonio_basis *basis, size_t *rows)
{
    const gonio_channel_model channels = gonio_basis_describe(basis).channels;
    for (size_t j = 0; j < plan->count; j++) {
        const gonio_plan_entry *entry = &plan->entries[j];
        const size_t position = gonio_basis_position(basis, entry->cell);
        rows[j] = gonio_i_row_of(channels, position, entry->channel);
    }
}

gonio_plan *gonio_i_allocate_plan(gonio_context *context, size_t count)
{
    gonio_plan *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made != NULL) {
        made->count = count;
        made->entries = gonio_i_allocate(context, count, sizeof *made->entries);
    }
    if (made != NULL && made->entries == NULL) {
        gonio_plan_free(&made);
    }
    return made;
}

static gonio_status choose(gonio_context *context, const gonio_basis *basis,
                           const gonio_plan_options *options, gonio_plan *plan)
{
    const gonio_basis_view view = gonio_basis_describe(basis);
    const size_t values = view.rows * plan->components;
    size_t *chosen = gonio_i_allocate(context, plan->count, sizeof *chosen);
    double *vectors = gonio_i_allocate(context, values, sizeof *vectors);
    gonio_selection_report report;
    gonio_status status = chosen == NULL || vectors == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        gonio_i_basis_rows(basis, 0, view.rows, plan->components, vectors);
        gonio_i_selection_problem problem = {.context = context,
                                             .vectors = vectors,
                                             .rows = view.rows,
                                             .components = plan->components,
                                             .stride = plan->components,
                                             .basis = &view};
        status = select_rows(&problem, options, chosen, &report);
    }
    if (status == GONIO_OK) {
        plan->condition_number = report.condition_number;
        plan->tests = report.tests;
        plan->history = report.history;
        plan->steps = report.steps;
        for (size_t j = 0; j < plan->count; j++) {
            plan->entries[j] = gonio_i_plan_entry(&view, chosen[j], options->phi_d);
        }
    }
    free(vectors);
    free(chosen);
    return status;
}

/* K: as asked, or as many as the basis has and the method takes. */
static size_t choose_components(const gonio_basis_view *basis, const gonio_plan_options *options)
{
    const int method = find_method(options->method);
    const bool few = method < METHODS && methods[method].few_components;
    const size_t asked = options->components > 0 ? options->components : basis->components;
    const bool cut =
        few && asked <= basis->components && options->count > 0 && options->count < asked;
    return cut ? options->count : asked;
}

gonio_status gonio_plan_create(gonio_context *context, const gonio_basis *basis,
                               const gonio_plan_options *asked, gonio_plan **plan)
{
    const gonio_basis_view view = gonio_basis_describe(basis);
    gonio_plan_options named = *asked;
    named.method = method_of(&view, asked);
    const gonio_plan_options *options = &named;
    if (strcmp(options->method, gonio_i_expected_error_method.name) == 0) {
        return gonio_i_expected_error_plan(context, basis, options, plan);
    }
    if (options->candidates != NULL || options->target > 0.0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "candidates and target errors are for the method expected-error");
    }
    const size_t components = choose_components(&view, options);
    if (components > view.components) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu components asked for, but the basis has %zu; learn one with more "
                            "(gonio learn --components %zu)",
                            components, view.components, components);
    }
    if (!(options->phi_d >= 0.0 && options->phi_d < M_PI)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "phi_d of %g degrees is outside [0, 180)",
                            options->phi_d * 180.0 / M_PI);
    }
    gonio_status status = check_selection(context, view.rows, components, options);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_plan *made = gonio_i_allocate_plan(context, options->count);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->components = components;
    made->basis = view.fingerprint;
    snprintf(made->method, sizeof made->method, "%s", options->method);
    status = choose(context, basis, options, made);
    if (status != GONIO_OK) {
        gonio_plan_free(&made);
        return status;
    }
    *plan = made;
    return GONIO_OK;
}

void gonio_plan_free(gonio_plan **plan)
{
    if (plan == NULL || *plan == NULL) {
        return;
    }
    free((*plan)->entries);
    free((*plan)->history);
    free((*plan)->expected);
    free(*plan);
    *plan = NULL;
}
