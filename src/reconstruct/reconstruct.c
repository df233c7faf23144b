/* Coefficients from readings: Ali et al., eq. (5), by QR. */
#include <gonio/reconstruct.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "../measurement/readings.h"

void gonio_reconstruct_options_default(gonio_reconstruct_options *options)
{
    *options = (gonio_reconstruct_options){0};
}

void gonio_reconstruction_free(gonio_reconstruction **reconstruction)
{
    if (reconstruction == NULL || *reconstruction == NULL) {
        return;
    }
    free((*reconstruction)->coefficients);
    free(*reconstruction);
    *reconstruction = NULL;
}

static gonio_reconstruction *allocate(gonio_context *context, const gonio_basis_view *basis,
                                      size_t components)
{
    gonio_reconstruction *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return NULL;
    }
    made->components = components;
    made->columns = basis->channels == GONIO_JOINT ? 1 : GONIO_CHANNELS;
    made->coefficients =
        gonio_i_allocate(context, made->columns * components, sizeof *made->coefficients);
    if (made->coefficients == NULL) {
        gonio_reconstruction_free(&made);
    }
    return made;
}

/* The equations X c = b - m of one column. */
typedef struct equations {
    const char *origin; /* the file of the readings and ": ", for messages; "" if there is none */
    size_t count;
    double *x; /* [count][components] */
    double *b; /* [count]: readings in log space less the mean */
} equations;

static bool allocate_equations(gonio_context *context, size_t most, size_t components, equations *e)
{
    e->origin = "";
    e->x = gonio_i_allocate(context, most * components, sizeof *e->x);
    e->b = gonio_i_allocate(context, most, sizeof *e->b);
    return e->x != NULL && e->b != NULL;
}

static void free_equations(equations *e)
{
    free(e->x);
    free(e->b);
}

static gonio_status undetermined(gonio_context *context, const equations *e, size_t rank,
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
        "(--basis %zu)",
        e->origin, e->count, channel, rank, needed, needed - rank, rank);
}

/* Root mean square of X c - b. */
static double residual_of(const equations *e, size_t components, const double *c)
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

static gonio_status solve_column(gonio_context *context, const equations *e, size_t column,
                                 gonio_reconstruction *r)
{
    static const char *const channels[GONIO_CHANNELS] = {" in R", " in G", " in B"};
    const size_t k = r->components;
    double *c = r->coefficients + column * k;
    size_t rank = 0;
    double condition = INFINITY;
    if (e->count > 0) {
        const gonio_status status =
            gonio_i_least_squares(context, e->x, e->count, k, e->b, 1, c, &rank, &condition);
        if (status != GONIO_OK) {
            return status;
        }
    }
    if (rank < k) {
        return undetermined(context, e, rank, k, r->columns > 1 ? channels[column] : "");
    }
    const double residual = residual_of(e, k, c);
    r->readings = e->count;
    r->condition_number = fmax(r->condition_number, condition);
    r->residual = hypot(r->residual, residual / sqrt((double)r->columns));
    return GONIO_OK;
}

/* ---- from readings at directions ---- */

typedef struct task {
    gonio_context *context;
    const gonio_basis *basis;
    const gonio_readings *readings;
    const gonio_reconstruct_options *options;
} task;

/* Whether a reading's channel makes an equation, given what was planned. A direction that is listed
 * once for each channel was read once: with all channels, a line that says again what the first
 * line of the same directions says does not count again. */
static bool is_used(const task *t, size_t index, int channel)
{
    const gonio_reading *reading = &t->readings->reading[index];
    if (!t->options->all_channels || reading->channel == GONIO_ALL_CHANNELS) {
        return reading->channel == GONIO_ALL_CHANNELS || reading->channel == channel;
    }
    const size_t first = t->readings->first_same[index];
    return first == index || reading->value[channel] != t->readings->reading[first].value[channel];
}

static gonio_status add_reading(const task *t, const gonio_reading *reading, int channel,
                                size_t components, equations *e)
{
    const double value = reading->value[channel];
    if (isnan(value) && channel == reading->channel) {
        return gonio_i_fail(
            t->context, GONIO_ERROR_DATA,
            "%s:%zu: channel %c was planned here but not read; read it, or delete the "
            "line",
            t->readings->path, reading->line, "RGB"[channel]);
    }
    if (isnan(value)) {
        return GONIO_OK;
    }
    double mean = 0.0;
    gonio_basis_row_at(t->basis, gonio_half_difference_from_pair(reading->pair), channel,
                       components, &mean, e->x + e->count * components);
    e->b[e->count++] = gonio_log_from_brdf(value, channel) - mean;
    return GONIO_OK;
}

static gonio_status collect(const task *t, size_t column, bool joint, size_t components,
                            equations *e)
{
    gonio_status status = GONIO_OK;
    const int first = joint ? 0 : (int)column;
    const int last = joint ? GONIO_CHANNELS - 1 : (int)column;
    e->count = 0;
    for (size_t k = 0; k < t->readings->count; k++) {
        for (int channel = first; channel <= last && status == GONIO_OK; channel++) {
            if (is_used(t, k, channel)) {
                status = add_reading(t, &t->readings->reading[k], channel, components, e);
            }
        }
    }
    return status;
}

static gonio_status solve_readings(const task *t, gonio_reconstruction *r)
{
    equations e = {0};
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
            status = solve_column(t->context, &e, column, r);
        }
    }
    free_equations(&e);
    free(origin);
    return status;
}

/* K: as asked, or as planned, or all. */
static gonio_status choose_components(const task *t, size_t available, size_t *components)
{
    const size_t planned = t->readings->components;
    size_t k = t->options->components;
    k = k > 0 ? k : planned;
    k = k > 0 ? k : available;
    if (t->options->components > available) {
        return gonio_i_fail(t->context, GONIO_ERROR_ARGUMENT,
                            "%zu components asked for, but the basis has %zu", k, available);
    }
    if (k > available) {
        return gonio_i_fail(t->context, GONIO_ERROR_MISMATCH,
                            "%s: planned for %zu components, but the basis has %zu; give the basis "
                            "of the plan, or use fewer components (--basis %zu)",
                            t->readings->path, k, available, available);
    }
    *components = k;
    return GONIO_OK;
}

gonio_status gonio_reconstruct(gonio_context *context, const gonio_basis *basis,
                               const gonio_readings *readings,
                               const gonio_reconstruct_options *options,
                               gonio_reconstruction **reconstruction)
{
    gonio_reconstruct_options defaults;
    gonio_reconstruct_options_default(&defaults);
    const task t = {context, basis, readings, options != NULL ? options : &defaults};
    const gonio_basis_view view = gonio_basis_describe(basis);
    if (readings->basis != 0 && readings->basis != view.fingerprint && !t.options->other_basis) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                            "%s: planned with another basis (%016" PRIx64
                            ", this one is %016" PRIx64
                            "); give that basis, or accept this one with --other-basis",
                            readings->path, readings->basis, view.fingerprint);
    }
    size_t components = 0;
    gonio_status status = choose_components(&t, view.components, &components);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_reconstruction *made = allocate(context, &view, components);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    status = solve_readings(&t, made);
    if (status != GONIO_OK) {
        gonio_reconstruction_free(&made);
        return status;
    }
    *reconstruction = made;
    return GONIO_OK;
}

/* ---- from rows of the basis ---- */

static gonio_status solve_rows(gonio_context *context, const gonio_basis_view *basis,
                               const size_t *rows, size_t count, const double *b,
                               gonio_reconstruction *r)
{
    equations e = {0};
    const size_t k = r->components;
    gonio_status status = GONIO_ERROR_MEMORY;
    if (allocate_equations(context, count, k, &e)) {
        status = GONIO_OK;
    }
    for (size_t column = 0; column < r->columns && status == GONIO_OK; column++) {
        e.count = count;
        for (size_t i = 0; i < count; i++) {
            memcpy(e.x + i * k, basis->vectors + rows[i] * basis->components, k * sizeof *e.x);
            e.b[i] = b[column * count + i] - basis->mean[rows[i]];
        }
        status = solve_column(context, &e, column, r);
    }
    free_equations(&e);
    return status;
}

gonio_status gonio_reconstruct_rows(gonio_context *context, const gonio_basis *basis,
                                    size_t components, const size_t *rows, size_t count,
                                    const double *b, gonio_reconstruction **reconstruction)
{
    const gonio_basis_view view = gonio_basis_describe(basis);
    if (components == 0 || components > view.components) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu components asked for, but the basis has %zu", components,
                            view.components);
    }
    gonio_reconstruction *made = allocate(context, &view, components);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = solve_rows(context, &view, rows, count, b, made);
    if (status != GONIO_OK) {
        gonio_reconstruction_free(&made);
        return status;
    }
    *reconstruction = made;
    return GONIO_OK;
}
