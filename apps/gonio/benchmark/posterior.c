/* gonio's own method, as `gonio reconstruct` does it without options; and, with the directions that
 * they are published with, its other methods. */
#include "methods.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/core.h"

typedef struct made {
    const benchmark_task *task;
    gonio_reconstruction *reconstruction;
    gonio_material *material; /* of other methods than the posterior */
} made;

static void release(void *self)
{
    made *m = self;
    gonio_material_free(&m->material);
    gonio_reconstruction_free(&m->reconstruction);
    free(m);
}

/* The values as `gonio reconstruct --predict-at` gives them. */
static gonio_status predict_values(const made *m, gonio_context *context, const gonio_pair *pair,
                                   size_t count, double *values)
{
    const gonio_readings_view *view = gonio_readings_describe(m->task->readings);
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = count,
                                          .channels = view->channels,
                                          .pair = pair,
                                          .wavelength = view->wavelength};
    gonio_readings_options any;
    gonio_readings_options_default(&any);
    any.average_repeats = true;
    gonio_readings *at = NULL;
    gonio_status status = gonio_readings_create(context, &arrays, &any, &at);
    if (status == GONIO_OK) {
        status =
            gonio_reconstruction_predict_readings(context, m->task->basis, m->reconstruction, at);
    }
    if (status == GONIO_OK) {
        memcpy(values, gonio_readings_describe(at)->value, count * view->channels * sizeof *values);
    }
    gonio_readings_free(&at);
    return status;
}

static gonio_status predict(void *self, gonio_context *context, const gonio_pair *pair,
                            size_t count, double *values, double *deviations)
{
    const made *m = self;
    const size_t channels = gonio_readings_describe(m->task->readings)->channels;
    double *unused = gonio_i_allocate(context, channels, sizeof *unused);
    gonio_status status =
        unused != NULL ? predict_values(m, context, pair, count, values) : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < count && status == GONIO_OK && deviations != NULL; k++) {
        gonio_reconstruction_predict(m->task->basis, m->reconstruction,
                                     gonio_half_difference_from_pair(pair[k]), unused,
                                     deviations + k * channels);
    }
    free(unused);
    return status;
}

static gonio_status materials(void *self, gonio_context *context, gonio_material **values,
                              gonio_material **deviations)
{
    const made *m = self;
    const gonio_basis *basis = m->task->basis;
    gonio_status status =
        gonio_reconstruction_material(context, basis, m->reconstruction, "made", values);
    if (status == GONIO_OK && m->reconstruction->deviation != NULL) {
        status =
            gonio_reconstruction_deviation_material(context, basis, m->reconstruction, deviations);
    }
    return status;
}

static gonio_status predict_published(void *self, gonio_context *context, const gonio_pair *pair,
                                      size_t count, double *values, double *deviations)
{
    const made *m = self;
    (void)deviations;
    return gonio_material_evaluate(context, m->material, pair, count, values);
}

static gonio_status complete(gonio_context *context, const benchmark_task *task,
                             benchmark_completion *completion)
{
    gonio_reconstruct_options how = benchmark_how(task->setting);
    how.expected_at = task->compared;
    how.expected_count = task->compared_count;
    made *m = gonio_i_allocate(context, 1, sizeof *m);
    if (m == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    m->task = task;
    const gonio_status status =
        gonio_reconstruct(context, task->basis, task->readings, &how, &m->reconstruction);
    if (status != GONIO_OK) {
        release(m);
        return status;
    }
    *completion = (benchmark_completion){.self = m,
                                         .release = release,
                                         .predict = predict,
                                         .materials = materials,
                                         .has_deviations = m->reconstruction->deviation != NULL,
                                         .expected = m->reconstruction->predicted_e6};
    return GONIO_OK;
}

/* Readings of which every channel was read: what equations of all channels need. */
static gonio_status keep_whole(gonio_context *context, const gonio_readings *readings,
                               gonio_readings **whole)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    const size_t c = view->channels;
    gonio_pair *pair = gonio_i_allocate(context, view->count, sizeof *pair);
    double *value = gonio_i_allocate(context, view->count * c, sizeof *value);
    size_t count = 0;
    for (size_t k = 0; pair != NULL && value != NULL && k < view->count; k++) {
        bool all = true;
        for (size_t i = 0; i < c; i++) {
            all = all && !isnan(view->value[k * c + i]);
        }
        if (all) {
            pair[count] = view->pair[k];
            memcpy(value + count++ * c, view->value + k * c, c * sizeof *value);
        }
    }
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = count, .channels = c, .pair = pair, .value = value};
    gonio_readings_options any;
    gonio_readings_options_default(&any);
    any.average_repeats = true;
    const gonio_status status = pair == NULL || value == NULL ? GONIO_ERROR_MEMORY
                                : count == 0                  ? GONIO_ERROR_DATA
                                             : gonio_readings_create(context, &arrays, &any, whole);
    free(pair);
    free(value);
    return status;
}

static gonio_status complete_published(gonio_context *context, const benchmark_task *task,
                                       benchmark_completion *completion)
{
    gonio_readings *whole = NULL;
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    how.all_channels = true;
    how.method = task->method;
    made *m = gonio_i_allocate(context, 1, sizeof *m);
    if (m == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    m->task = task;
    gonio_status status = keep_whole(context, task->readings, &whole);
    if (status == GONIO_OK) {
        const size_t n = gonio_readings_describe(whole)->count;
        const size_t most = gonio_basis_describe(task->basis)->components;
        how.components = most < n ? most : n;
        status = gonio_reconstruct(context, task->basis, whole, &how, &m->reconstruction);
    }
    if (status == GONIO_OK) {
        status = gonio_reconstruction_material(context, task->basis, m->reconstruction, "made",
                                               &m->material);
    }
    gonio_readings_free(&whole);
    if (status != GONIO_OK) {
        release(m);
        return status;
    }
    *completion = (benchmark_completion){.self = m,
                                         .release = release,
                                         .predict = predict_published,
                                         .materials = materials,
                                         .expected = NAN};
    return GONIO_OK;
}

const benchmark_method benchmark_posterior = {.name = "posterior",
                                              .summary = "gonio reconstruct without options",
                                              .learned = true,
                                              .complete = complete};

const benchmark_method benchmark_published = {.name = "published",
                                              .summary = "that of the directions",
                                              .learned = true,
                                              .complete = complete_published};
