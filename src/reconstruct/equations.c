/* Coefficients from equations: see equations.h. */
#include "equations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../basis/basis.h"
#include "../linalg/linalg.h"
#include "../measurement/readings.h"

static gonio_reconstruction *allocate(gonio_context *context, const gonio_basis_view *basis,
                                      size_t components)
{
    gonio_reconstruction *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return NULL;
    }
    made->components = components;
    made->columns = gonio_i_columns_per_material(basis->channels);
    made->coefficients =
        gonio_i_allocate(context, made->columns * components, sizeof *made->coefficients);
    if (made->coefficients == NULL) {
        gonio_reconstruction_free(&made);
    }
    return made;
}

/* Equations while they are gathered. */
typedef struct gathered {
    const char *origin; /* the file of the readings and ": ", for messages; "" if there is none */
    size_t count;
    double *x; /* [count][components] */
    double *b; /* [count]: readings in log space less m */
} gathered;

static bool allocate_equations(gonio_context *context, size_t most, size_t components, gathered *e)
{
    e->origin = "";
    e->x = gonio_i_allocate(context, most * components, sizeof *e->x);
    e->b = gonio_i_allocate(context, most, sizeof *e->b);
    return e->x != NULL && e->b != NULL;
}

static void free_equations(gathered *e)
{
    free(e->x);
    free(e->b);
}

static gonio_status undetermined(gonio_context *context, const gathered *e, size_t rank,
                                 size_t needed, const char *channel)
{
    if (rank == 0) {
        return gonio_i_fail(context, GONIO_ERROR_UNDETERMINED,
                            "%sno usable reading%s to determine %zu coefficients from: are the "
                            "cells of the values empty?",
                            e->origin, channel, needed);
    }
    return gonio_i_fail(
        context, GONIO_ERROR_UNDETERMINED,
        "%s%zu readings%s of which %zu are independent cannot determine %zu "
        "coefficients: measure at least %zu more directions, or use fewer components "
        "(--components %zu)",
        e->origin, e->count, channel, rank, needed, needed - rank, rank);
}

/* Root mean square of X c - b. */
static double residual_of(const gathered *e, size_t components, const double *c)
{
    double sum = 0.0;
    for (size_t i = 0; i < e->count; i++) {
        double difference = -e->b[i];
        for (size_t k = 0; k < components; k++) {
            difference += e->x[i * components + k] * c[k];
        }
        sum += difference * difference;
    }
    return sqrt(sum / (double)e->count);
}

/* How to solve them. */
typedef struct solver {
    gonio_context *context;
    const gonio_i_reconstruct_method *method;
    double eta;
    double *singular; /* [components] */
} solver;

static solver solver_of(const gonio_i_reconstruct_task *task)
{
    return (solver){.context = task->context, .method = task->method, .eta = task->eta};
}

static gonio_status solve_column(const solver *s, const gathered *e, size_t column,
                                 gonio_reconstruction *r)
{
    static const char *const channels[GONIO_CHANNELS] = {" in R", " in G", " in B"};
    const size_t k = r->components;
    gonio_i_solution solution = {r->coefficients + column * k, 0, INFINITY};
    if (e->count > 0) {
        const gonio_i_equations equations = {e->count, k, e->x, e->b, s->singular, s->eta};
        const gonio_status status = s->method->solve(s->context, &equations, &solution);
        if (status != GONIO_OK) {
            return status;
        }
    }
    if (solution.rank < k) {
        return undetermined(s->context, e, solution.rank, k,
                            r->columns > 1 ? channels[column] : "");
    }
    const double residual = residual_of(e, k, solution.coefficients);
    r->readings = e->count;
    r->condition_number = fmax(r->condition_number, solution.condition_number);
    r->residual = hypot(r->residual, residual / sqrt((double)r->columns));
    return GONIO_OK;
}

/* The default number of components of the method. */
static size_t default_components(const solver *s, size_t readings, size_t available)
{
    return s->method->wants.full_rank || available < readings ? available : readings;
}

static gonio_status find_singular(solver *s, const gonio_basis_view *basis, size_t components)
{
    s->singular = gonio_i_allocate(s->context, components, sizeof *s->singular);
    for (size_t k = 0; s->singular != NULL && k < components; k++) {
        s->singular[k] = gonio_i_singular_value(basis, k);
    }
    return s->singular != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* ---- from readings at directions ---- */

typedef struct gathering {
    gonio_context *context;
    const gonio_basis *basis;
    const gonio_readings *readings;
    const gonio_reconstruct_options *options;
    gonio_mapping mapping;
    solver solver;
} gathering;

/* Whether a reading's channel becomes an equation, given the planned channel. A direction that is
 * listed once for each channel was read once. So with all channels, a line that repeats the first
 * line of the same directions does not count again. */
static bool is_used(const gathering *t, size_t index, int channel)
{
    const gonio_readings *r = t->readings;
    if (!t->options->all_channels || r->planned[index] == GONIO_ALL_CHANNELS) {
        return r->planned[index] == GONIO_ALL_CHANNELS || r->planned[index] == channel;
    }
    const size_t first = r->first_same[index];
    return first == index || r->value[index * GONIO_CHANNELS + (size_t)channel] !=
                                 r->value[first * GONIO_CHANNELS + (size_t)channel];
}

static gonio_status add_reading(const gathering *t, size_t reading, int channel, size_t components,
                                gathered *e)
{
    const double value = gonio_readings_value(t->readings, reading, (size_t)channel);
    if (isnan(value) && channel == t->readings->planned[reading]) {
        return gonio_i_fail(
            t->context, GONIO_ERROR_DATA,
            "%s:%zu: channel %c was planned here but not read; read it, or delete the "
            "line",
            t->readings->path, t->readings->line[reading], "RGB"[channel]);
    }
    if (isnan(value)) {
        return GONIO_OK;
    }
    const gonio_half_difference at = gonio_half_difference_from_pair(t->readings->pair[reading]);
    double mean = 0.0;
    gonio_i_basis_row_at(t->basis, at, channel, components, &mean, e->x + e->count * components);
    e->b[e->count++] = gonio_mapped_from_brdf(t->mapping, value, channel, at) - mean;
    return GONIO_OK;
}

static gonio_status collect(const gathering *t, size_t column, bool joint, size_t components,
                            gathered *e)
{
    gonio_status status = GONIO_OK;
    const int first = joint ? 0 : (int)column;
    const int last = joint ? GONIO_CHANNELS - 1 : (int)column;
    e->count = 0;
    for (size_t k = 0; k < t->readings->count; k++) {
        for (int channel = first; channel <= last && status == GONIO_OK; channel++) {
            if (is_used(t, k, channel)) {
                status = add_reading(t, k, channel, components, e);
            }
        }
    }
    return status;
}

static gonio_status solve_readings(const gathering *t, gonio_reconstruction *r)
{
    gathered e = {0};
    gonio_status status = GONIO_ERROR_MEMORY;
    char *origin = gonio_i_format("%s: ", t->readings->path);
    if (allocate_equations(t->context, GONIO_CHANNELS * t->readings->count, r->components, &e) &&
        origin != NULL) {
        e.origin = origin;
        status = GONIO_OK;
    }
    for (size_t column = 0; column < r->columns && status == GONIO_OK; column++) {
        status = collect(t, column, r->columns == 1, r->components, &e);
        if (status == GONIO_OK) {
            status = solve_column(&t->solver, &e, column, r);
        }
    }
    free_equations(&e);
    free(origin);
    return status;
}

/* K: the number asked for, that of the plan, or all. */
static gonio_status choose_components(const gathering *t, size_t available, size_t *components)
{
    const size_t planned = t->readings->components;
    size_t k = t->options->components;
    k = k > 0 ? k : planned;
    k = k > 0 ? k : default_components(&t->solver, t->readings->count, available);
    if (t->options->components > available) {
        return gonio_i_fail(t->context, GONIO_ERROR_ARGUMENT,
                            "%zu components asked for, but the basis has %zu", k, available);
    }
    if (k > available) {
        return gonio_i_fail(t->context, GONIO_ERROR_MISMATCH,
                            "%s: planned for %zu components, but the basis has %zu; give the basis "
                            "of the plan, or use fewer components (--components %zu)",
                            t->readings->path, k, available, available);
    }
    *components = k;
    return GONIO_OK;
}

gonio_status gonio_i_equations_from_readings(const gonio_i_reconstruct_task *asked,
                                             const gonio_readings *readings,
                                             gonio_reconstruction **reconstruction)
{
    const gonio_basis_view *view = gonio_basis_describe(asked->basis);
    gathering t = {.context = asked->context,
                   .basis = asked->basis,
                   .readings = readings,
                   .options = asked->options,
                   .mapping = view->mapping,
                   .solver = solver_of(asked)};
    size_t components = 0;
    gonio_status status = choose_components(&t, view->components, &components);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_reconstruction *made = allocate(t.context, view, components);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    status = find_singular(&t.solver, view, components);
    if (status == GONIO_OK) {
        status = solve_readings(&t, made);
    }
    free(t.solver.singular);
    if (status != GONIO_OK) {
        gonio_reconstruction_free(&made);
        return status;
    }
    *reconstruction = made;
    return GONIO_OK;
}

/* ---- from rows of the basis ---- */

static gonio_status solve_rows(const solver *s, const gonio_basis *basis, const size_t *rows,
                               size_t count, const double *b, gonio_reconstruction *r)
{
    const double *mean = gonio_basis_describe(basis)->mean;
    gathered e = {0};
    const size_t k = r->components;
    gonio_status status = GONIO_ERROR_MEMORY;
    if (allocate_equations(s->context, count, k, &e)) {
        status = GONIO_OK;
    }
    for (size_t column = 0; column < r->columns && status == GONIO_OK; column++) {
        e.count = count;
        for (size_t i = 0; i < count; i++) {
            gonio_i_basis_rows(basis, rows[i], 1, k, e.x + i * k);
            e.b[i] = b[column * count + i] - mean[rows[i]];
        }
        status = solve_column(s, &e, column, r);
    }
    free_equations(&e);
    return status;
}

gonio_status gonio_i_equations_of_rows(const gonio_i_reconstruct_task *task, size_t components,
                                       const size_t *rows, size_t count, const double *b,
                                       gonio_reconstruction **reconstruction)
{
    const gonio_basis_view *view = gonio_basis_describe(task->basis);
    solver s = solver_of(task);
    if (components == 0 || components > view->components) {
        return gonio_i_fail(task->context, GONIO_ERROR_ARGUMENT,
                            "%zu components asked for, but the basis has %zu", components,
                            view->components);
    }
    gonio_reconstruction *made = allocate(task->context, view, components);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = find_singular(&s, view, components);
    if (status == GONIO_OK) {
        status = solve_rows(&s, task->basis, rows, count, b, made);
    }
    free(s.singular);
    if (status != GONIO_OK) {
        gonio_reconstruction_free(&made);
        return status;
    }
    *reconstruction = made;
    return GONIO_OK;
}

gonio_status gonio_i_equations_from_rows(const gonio_i_reconstruct_task *task, const size_t *rows,
                                         size_t count, const double *b,
                                         gonio_reconstruction **reconstruction)
{
    const solver s = solver_of(task);
    const size_t available = gonio_basis_describe(task->basis)->components;
    const size_t asked = task->options->components;
    const size_t components = asked > 0 ? asked : default_components(&s, count, available);
    return gonio_i_equations_of_rows(task, components, rows, count, b, reconstruction);
}
