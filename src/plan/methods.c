/* The table of planning methods, and plans by any of them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/options.h"
#include "method.h"
#include "plan.h"
#include "starting_rows.h"

#define ROW(name) &gonio_i_##name##_method,
static const gonio_i_method *const methods[] = {GONIO_I_PLAN_METHODS(ROW)};

enum { METHODS = sizeof methods / sizeof *methods };

/* ---- the table ---- */

const char *gonio_plan_method_name(int index)
{
    return index >= 0 && index < METHODS ? methods[index]->name : NULL;
}

const char *gonio_plan_method_summary(int index)
{
    return index >= 0 && index < METHODS ? methods[index]->summary : NULL;
}

static const gonio_i_method *find_method(const char *name)
{
    for (int k = 0; k < METHODS; k++) {
        if (strcmp(methods[k]->name, name) == 0) {
            return methods[k];
        }
    }
    return NULL;
}

const char *gonio_plan_method_reconstruction(const char *method)
{
    const gonio_i_method *found = find_method(method);
    return found != NULL ? found->reconstruction : NULL;
}

const gonio_plan_basis *gonio_plan_method_basis(const char *method)
{
    const gonio_i_method *found = find_method(method);
    return found != NULL ? &found->basis : NULL;
}

void gonio_plan_options_default_of(gonio_plan_options *options, size_t size)
{
    const gonio_plan_options usual = {.count = GONIO_USUAL_COUNT,
                                      .restarts = 5,
                                      .keep_history = true,
                                      .start = "random",
                                      .phi_d = M_PI / 2.0};
    gonio_i_give(&usual, sizeof usual, options, size);
}

/* What is wrong whatever the method, also where it does not use it. */
static gonio_status check_values(gonio_context *context, const gonio_plan_options *options)
{
    if (gonio_i_find_start(options->start) == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "no start is called '%s'",
                            options->start);
    }
    if (!(options->phi_d >= 0.0 && options->phi_d < M_PI)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "phi_d of %g degrees is outside [0, 180)",
                            options->phi_d * 180.0 / M_PI);
    }
    if (options->anisotropic && options->method != NULL &&
        strcmp(options->method, gonio_i_expected_error_method.name) != 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "plans for anisotropic materials need the method %s",
                            gonio_i_expected_error_method.name);
    }
    if (options->instrument == NULL && (options->budget != 0.0 || options->nested)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a budget or nested blocks need an instrument");
    }
    return GONIO_OK;
}

/* The given options, with defaults for those that are not set: no more readings than there are
 * candidates. */
static gonio_status take(gonio_context *context, const gonio_plan_options *asked,
                         gonio_plan_options *options)
{
    const gonio_status status = GONIO_I_TAKE(context, gonio_plan_options, asked, options);
    if (status == GONIO_OK && options->count == GONIO_USUAL_COUNT && options->budget == 0.0) {
        options->count = options->target > 0.0 ? 300 : 80;
        if (options->candidates != NULL && options->candidate_count < options->count) {
            options->count = options->candidate_count;
        }
    }
    return status == GONIO_OK ? check_values(context, options) : status;
}

/* The first that is made for bases with mixtures, or for those without. */
static const gonio_i_method *usual_method(bool mixtures)
{
    int k = 0;
    while (methods[k]->basis.mixtures != mixtures) {
        k++;
    }
    return methods[k];
}

/* The method asked for, or the default of the basis (NULL: the caller's rows). */
static gonio_status choose_method(gonio_context *context, const gonio_basis_view *basis,
                                  const gonio_plan_options *options, const gonio_i_method **method)
{
    *method = options->method != NULL ? find_method(options->method)
                                      : usual_method(basis != NULL && basis->mixtures > 0);
    return *method != NULL ? GONIO_OK
                           : gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                          "no selection method is called '%s'", options->method);
}

/* ---- choosing rows ---- */

static gonio_status check_selection(gonio_context *context, const gonio_i_method *method,
                                    size_t rows, size_t components,
                                    const gonio_plan_options *options)
{
    const size_t n = options->count;
    if (n == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a plan needs at least 1 reading");
    }
    if (n > rows) {
        return gonio_i_fail(
            context, GONIO_ERROR_ARGUMENT,
            "%zu readings asked for, but the basis has only %zu rows to choose from", n, rows);
    }
    if (method->needs_full_rank && n < components) {
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

/* Checks that a method can work on these rows. basis: NULL for the caller's rows. */
static gonio_status check_basis(gonio_context *context, const gonio_i_method *method,
                                const gonio_basis_view *basis)
{
    const bool lacks[] = {
        [GONIO_I_NEEDS_ROWS] = false,
        [GONIO_I_NEEDS_A_BASIS] = basis == NULL,
        [GONIO_I_NEEDS_NO_MEAN] = basis == NULL || !basis->without_mean,
        [GONIO_I_NEEDS_LOADINGS] = basis == NULL || basis->loadings == NULL,
    };
    return lacks[method->needs]
               ? gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "%s", method->where_it_lacks)
               : GONIO_OK;
}

/* Completes a problem and solves it. */
static gonio_status select_rows(const gonio_i_method *method, gonio_i_selection_problem *problem,
                                const gonio_plan_options *options, size_t *chosen,
                                gonio_selection_report *report)
{
    gonio_status status =
        check_selection(problem->context, method, problem->rows, problem->components, options);
    if (status == GONIO_OK) {
        status = check_basis(problem->context, method, problem->basis);
    }
    if (status != GONIO_OK) {
        return status;
    }
    problem->count = options->count;
    problem->restarts = options->restarts;
    problem->seed = options->seed;
    problem->keep_history = options->keep_history;
    problem->start = gonio_i_find_start(options->start);
    gonio_i_selection selection = {.chosen = chosen};
    status = method->select(problem, &selection);
    if (status != GONIO_OK) {
        free(selection.history);
        return status;
    }
    *report = (gonio_selection_report){selection.condition_number, selection.tests, selection.steps,
                                       selection.history};
    return GONIO_OK;
}

gonio_status gonio_plan_select(gonio_context *context, const double *vectors, size_t rows,
                               size_t leading, size_t components, const gonio_plan_options *asked,
                               size_t *chosen, gonio_selection_report *report)
{
    gonio_plan_options options;
    gonio_status status = take(context, asked, &options);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_i_selection_problem problem = {.context = context,
                                         .vectors = vectors,
                                         .rows = rows,
                                         .components = components,
                                         .stride = leading};
    const gonio_i_method *method = NULL;
    status = choose_method(context, NULL, &options, &method);
    if (status != GONIO_OK) {
        return status;
    }
    if (method->select == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "%s needs a basis, not only its rows",
                            method->name);
    }
    if (components == 0 || components > leading) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu components requested, but the rows have %zu", components, leading);
    }
    return select_rows(method, &problem, &options, chosen, report);
}

/* ---- plans of rows ---- */

static gonio_status choose_entries(gonio_context *context, const gonio_i_method *method,
                                   const gonio_basis *basis, const gonio_plan_options *options,
                                   gonio_plan *plan)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const size_t values = view->rows * plan->components;
    size_t *chosen = gonio_i_allocate(context, plan->count, sizeof *chosen);
    double *vectors = gonio_i_allocate(context, values, sizeof *vectors);
    gonio_selection_report report;
    gonio_status status = chosen == NULL || vectors == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        gonio_i_basis_rows(basis, 0, view->rows, plan->components, vectors);
        gonio_i_selection_problem problem = {.context = context,
                                             .vectors = vectors,
                                             .rows = view->rows,
                                             .components = plan->components,
                                             .stride = plan->components,
                                             .basis = view};
        status = select_rows(method, &problem, options, chosen, &report);
    }
    if (status == GONIO_OK) {
        plan->condition_number = report.condition_number;
        plan->tests = report.tests;
        plan->history = report.history;
        plan->steps = report.steps;
        for (size_t j = 0; j < plan->count; j++) {
            plan->entries[j] = gonio_i_plan_entry(view, chosen[j], options->phi_d);
        }
    }
    free(vectors);
    free(chosen);
    return status;
}

/* K: the number asked for, or all of the basis that the method takes. */
static size_t choose_components(const gonio_i_method *method, const gonio_basis_view *basis,
                                const gonio_plan_options *options)
{
    const size_t asked = options->components > 0 ? options->components : basis->components;
    const bool cut = method->few_components && asked <= basis->components && options->count > 0 &&
                     options->count < asked;
    return cut ? options->count : asked;
}

static gonio_status check_options(gonio_context *context, const gonio_basis_view *basis,
                                  size_t components, const gonio_plan_options *options)
{
    if (options->candidates != NULL || options->target > 0.0 || options->instrument != NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "candidates, target errors and instruments need the method %s",
                            usual_method(true)->name);
    }
    if (components > basis->components) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu components asked for, but the basis has %zu; learn one with more "
                            "(gonio learn --components %zu)",
                            components, basis->components, components);
    }
    return GONIO_OK;
}

static gonio_status plan_rows(gonio_context *context, const gonio_i_method *method,
                              const gonio_basis *basis, const gonio_plan_options *options,
                              gonio_plan **plan)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const size_t components = choose_components(method, view, options);
    gonio_status status = check_options(context, view, components, options);
    if (status == GONIO_OK) {
        status = check_selection(context, method, view->rows, components, options);
    }
    if (status != GONIO_OK) {
        return status;
    }
    gonio_plan *made =
        gonio_i_allocate_plan(context, view, method->name, components, options->count);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    status = choose_entries(context, method, basis, options, made);
    if (status != GONIO_OK) {
        gonio_plan_free(&made);
        return status;
    }
    *plan = made;
    return GONIO_OK;
}

gonio_status gonio_plan_create(gonio_context *context, const gonio_basis *basis,
                               const gonio_plan_options *asked, gonio_plan **plan)
{
    gonio_plan_options options;
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const gonio_i_method *method = NULL;
    gonio_status status = take(context, asked, &options);
    if (status == GONIO_OK) {
        status = choose_method(context, view, &options, &method);
    }
    if (status != GONIO_OK) {
        return status;
    }
    return method->select != NULL ? plan_rows(context, method, basis, &options, plan)
                                  : method->plan(context, basis, &options, plan);
}
