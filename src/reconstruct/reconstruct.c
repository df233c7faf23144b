/* Reconstruction: the table of methods, and the choice of the method. */
#include <gonio/reconstruct.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "equations.h"
#include "../core/options.h"
#include "method.h"

void gonio_reconstruct_options_default_of(gonio_reconstruct_options *options, size_t size)
{
    const gonio_reconstruct_options usual = {.eta = 40.0, .noise = 0.01, .floor = 1e-5};
    gonio_i_give(&usual, sizeof usual, options, size);
}

/* ---- methods ---- */

#define ROW(name) &gonio_i_##name##_method,
static const gonio_i_reconstruct_method *const methods[] = {GONIO_I_RECONSTRUCT_METHODS(ROW)};

enum { METHODS = sizeof methods / sizeof *methods };

static const double default_eta = 40.0;

const char *gonio_reconstruct_method_name(int index)
{
    return index >= 0 && index < METHODS ? methods[index]->name : NULL;
}

const char *gonio_reconstruct_method_summary(int index)
{
    return index >= 0 && index < METHODS ? methods[index]->summary : NULL;
}

/* NULL if there is none of that name. */
static const gonio_i_reconstruct_method *find_method(const char *name)
{
    for (int k = 0; k < METHODS; k++) {
        if (strcmp(methods[k]->name, name) == 0) {
            return methods[k];
        }
    }
    return NULL;
}

bool gonio_reconstruct_method_suits_mixtures(const char *name)
{
    const gonio_i_reconstruct_method *method = find_method(name);
    return method != NULL && method->wants.basis_of_mixtures;
}

/* The default method for a basis, without a plan. */
static const gonio_i_reconstruct_method *usual_method(const gonio_basis_view *basis)
{
    for (int k = 0; k < METHODS; k++) {
        if (methods[k]->wants.basis_of_mixtures && basis->mixtures > 0) {
            return methods[k];
        }
    }
    return methods[0];
}

/* The first that takes readings of any channels. */
static const char *method_of_any_channels(void)
{
    int k = 0;
    while (k < METHODS - 1 && methods[k]->wants.colours) {
        k++;
    }
    return methods[k]->name;
}

/* ---- what a method wants ---- */

/* Squares of larger numbers, and quotients of them, would not be finite. */
static const double MOST_NOISE = 1e6;

static bool is_noise(const gonio_reconstruct_options *options)
{
    return options->noise >= 0.0 && options->noise <= MOST_NOISE && options->floor >= 0.0 &&
           options->floor <= MOST_NOISE && options->saturation >= 0.0;
}

static gonio_status check_basis(gonio_context *context, const gonio_i_reconstruct_method *method,
                                const gonio_basis_view *basis,
                                const gonio_reconstruct_options *options)
{
    if (method->wants.log_mapping && basis->mapping != GONIO_LOG) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%s needs a basis of the log mapping (gonio learn without "
                            "--mapping relative)",
                            method->name);
    }
    if (method->wants.all_components && options->components != 0 &&
        options->components != basis->components) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%s uses all %zu components of the basis, not %zu; learn one of fewer",
                            method->name, basis->components, options->components);
    }
    if (method->wants.noise && !is_noise(options)) {
        return gonio_i_fail(
            context, GONIO_ERROR_ARGUMENT,
            "noise, floor and saturation must not be negative, and noise and floor at most %g",
            MOST_NOISE);
    }
    return GONIO_OK;
}

static gonio_status check_readings(gonio_context *context, const gonio_i_reconstruct_method *method,
                                   const gonio_basis_view *basis, const gonio_readings *readings)
{
    if (gonio_readings_are_colours(readings)) {
        return GONIO_OK;
    }
    if (method->wants.colours) {
        const gonio_readings_view *view = gonio_readings_describe(readings);
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "%s: %s need --method %s", view->path,
                            view->wavelength != NULL ? "spectral readings"
                                                     : "channels other than R, G, B",
                            method_of_any_channels());
    }
    if (basis->channels == GONIO_JOINT) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                            "spectral readings need a basis of separate channels (gonio learn "
                            "--channels separate)");
    }
    return GONIO_OK;
}

gonio_status gonio_i_reconstruct_check(gonio_context *context,
                                       const gonio_i_reconstruct_method *method,
                                       const gonio_basis *basis, const gonio_readings *readings,
                                       const gonio_reconstruct_options *options)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const gonio_status status = check_basis(context, method, view, options);
    return status == GONIO_OK && readings != NULL ? check_readings(context, method, view, readings)
                                                  : status;
}

gonio_status gonio_i_reconstruct_check_rows(gonio_context *context, const gonio_basis *basis,
                                            const size_t *rows, size_t count)
{
    const size_t all = gonio_basis_describe(basis)->rows;
    for (size_t k = 0; k < count; k++) {
        if (rows[k] >= all) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                "row %zu is outside a basis of %zu rows", rows[k], all);
        }
    }
    return count > 0 ? GONIO_OK
                     : gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "no rows of the basis given");
}

/* ---- a task ---- */

/* The method asked for, that of the plan (its name, or NULL), or the default. */
static gonio_status begin(gonio_context *context, const gonio_basis *basis,
                          const gonio_reconstruct_options *options, const char *plan,
                          gonio_i_reconstruct_task *task)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const char *planned = plan != NULL ? gonio_plan_method_reconstruction(plan) : NULL;
    const char *name = options->method != NULL ? options->method : planned;
    *task = (gonio_i_reconstruct_task){
        .context = context,
        .method = name != NULL ? find_method(name) : usual_method(view),
        .basis = basis,
        .options = options,
        .eta = options->eta != 0.0 ? options->eta : default_eta,
    };
    if (task->method == NULL) {
        gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "no reconstruction method is called '%s'",
                     name);
        return GONIO_ERROR_ARGUMENT;
    }
    if (!(task->eta > 0.0 && isfinite(task->eta))) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "eta must be above 0, not %g",
                            task->eta);
    }
    return GONIO_OK;
}

static gonio_status check_fingerprint(gonio_context *context, const gonio_basis *basis,
                                      const gonio_readings_view *readings,
                                      const gonio_reconstruct_options *options)
{
    const uint64_t fingerprint = gonio_basis_describe(basis)->fingerprint;
    if (readings->basis != 0 && readings->basis != fingerprint && !options->other_basis) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                            "%s: planned with another basis (%016" PRIx64
                            ", this one is %016" PRIx64
                            "); give that basis, or accept this one with --other-basis",
                            readings->path, readings->basis, fingerprint);
    }
    return GONIO_OK;
}

static gonio_status check_apertures(const gonio_i_reconstruct_task *task)
{
    if (gonio_i_has_apertures(task->options) && task->method != &gonio_i_posterior_method) {
        return gonio_i_fail(task->context, GONIO_ERROR_ARGUMENT,
                            "apertures need a reconstruction by posterior, not by %s",
                            task->method->name);
    }
    return gonio_i_check_half_angles(task->context, task->options);
}

gonio_status gonio_reconstruct(gonio_context *context, const gonio_basis *basis,
                               const gonio_readings *readings,
                               const gonio_reconstruct_options *options,
                               gonio_reconstruction **reconstruction)
{
    gonio_reconstruct_options how;
    gonio_i_reconstruct_task task;
    const gonio_readings_view *view = gonio_readings_describe(readings);
    gonio_status status = GONIO_I_TAKE(context, gonio_reconstruct_options, options, &how);
    if (status == GONIO_OK) {
        status = check_fingerprint(context, basis, view, &how);
    }
    if (status == GONIO_OK) {
        status = begin(context, basis, &how, view->method, &task);
    }
    if (status == GONIO_OK) {
        status = gonio_i_reconstruct_check(context, task.method, basis, readings, &how);
    }
    if (status == GONIO_OK) {
        status = check_apertures(&task);
    }
    if (status != GONIO_OK) {
        return status;
    }
    return gonio_i_has_apertures(&how)
               ? gonio_i_reconstruct_apertures(&task, readings, reconstruction)
               : task.method->from_readings(&task, readings, reconstruction);
}

gonio_status gonio_reconstruct_rows(gonio_context *context, const gonio_basis *basis,
                                    size_t components, const size_t *rows, size_t count,
                                    const double *b, gonio_reconstruction **reconstruction)
{
    gonio_reconstruct_options options;
    gonio_reconstruct_options_default(&options);
    const gonio_i_reconstruct_task task = {
        context, &gonio_i_least_squares_method, basis, &options, default_eta, NULL};
    const gonio_status status = gonio_i_reconstruct_check_rows(context, basis, rows, count);
    return status == GONIO_OK
               ? gonio_i_equations_of_rows(&task, components, rows, count, b, reconstruction)
               : status;
}

gonio_status gonio_reconstruct_rows_with(gonio_context *context, const gonio_basis *basis,
                                         const gonio_reconstruct_options *options,
                                         const size_t *rows, size_t count, const double *b,
                                         gonio_reconstruction **reconstruction)
{
    gonio_reconstruct_options how;
    gonio_i_reconstruct_task task;
    gonio_status status = GONIO_I_TAKE(context, gonio_reconstruct_options, options, &how);
    if (status == GONIO_OK) {
        status = begin(context, basis, &how, NULL, &task);
    }
    if (status == GONIO_OK) {
        status = gonio_i_reconstruct_check(context, task.method, basis, NULL, &how);
    }
    if (status == GONIO_OK) {
        status = gonio_i_reconstruct_check_rows(context, basis, rows, count);
    }
    return status == GONIO_OK ? task.method->from_rows(&task, rows, count, b, reconstruction)
                              : status;
}
