/* A trial: see trial.h. */
#include "trial.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "score.h"

#include "core/core.h"

/* While a trial is made. */
typedef struct state {
    const benchmark_trial *trial;
    gonio_context *context; /* asks whether to stop */
    gonio_context *silent;  /* for the work: what it notes of each reading does not matter here */
    char *fault;            /* what it said last of an error; NULL: nothing */
    benchmark_sample sample;
    benchmark_pairs chosen;
    gonio_reference *reference; /* the rendered table; NULL until it is needed */
    json_t *rows;
} state;

static void keep_fault(void *user, gonio_message_level level, const char *text)
{
    state *s = user;
    if (level == GONIO_MESSAGE_ERROR) {
        free(s->fault);
        s->fault = strdup(text);
    }
}

/* Why the work failed, in words. */
static const char *reason(const state *s, gonio_status status)
{
    return s->fault != NULL ? s->fault : gonio_status_text(status);
}

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

/* ---- renderings ---- */

static bool is_rendered(const state *s, size_t n)
{
    bool wanted = false;
    for (size_t k = 0; k < BENCHMARK_RENDERED_SIZES; k++) {
        wanted = wanted || n == benchmark_rendered_sizes[k];
    }
    return wanted && s->trial->setting->render && s->sample.table != NULL && s->trial->draw == 0;
}

static gonio_status compare_rendered(state *s, const gonio_material *made, gonio_image_error *error)
{
    gonio_status status = GONIO_OK;
    if (s->reference == NULL) {
        status = gonio_reference_create(s->silent, s->sample.material, NULL, &s->reference);
    }
    return status == GONIO_OK ? gonio_reference_compare(s->silent, s->reference, made, error)
                              : status;
}

/* ---- one method from one n ---- */

static json_t *errors_json(const gonio_error *error)
{
    json_t *list = json_array();
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        json_array_append_new(list, number(error->value[m]));
    }
    return list;
}

static void add_row(const state *s, size_t n, const char *method, size_t read,
                    const benchmark_score *score, double expected, const gonio_image_error *image,
                    double seconds)
{
    json_array_append_new(
        s->rows,
        json_pack("{s:I, s:s, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "n", (json_int_t)n,
                  "method", method, "read", (json_int_t)read, "values", (json_int_t)score->values,
                  "errors", errors_json(&score->error), "inside", number(score->inside), "expected",
                  number(expected), "expected_here", number(score->expected_here), "psnr",
                  number(image->psnr), "delta_e_itp", number(image->delta_e_itp), "seconds",
                  number(seconds)));
}

static gonio_status judge(state *s, gonio_context *context, const benchmark_task *task, size_t n,
                          const benchmark_completion *completion, benchmark_score *score,
                          gonio_image_error *image)
{
    gonio_material *whole = NULL;
    if (s->sample.known != NULL) {
        return benchmark_score_readings(context, &s->sample, task->readings, completion, score);
    }
    gonio_status status =
        benchmark_score_table(context, &s->sample, task->setting->reach, completion, score, &whole);
    if (status == GONIO_OK && is_rendered(s, n)) {
        status = compare_rendered(s, whole, image);
    }
    gonio_material_free(&whole);
    return status;
}

/* Whether a method may fail so without ending the run. */
static bool is_excused(gonio_status status)
{
    return status == GONIO_ERROR_UNDETERMINED || status == GONIO_ERROR_DATA ||
           status == GONIO_ERROR_NUMERICAL || status == GONIO_ERROR_MISMATCH;
}

/* What is known of one completion. */
typedef struct outcome {
    benchmark_score score;
    gonio_image_error image;
    double expected, seconds;
} outcome;

static outcome no_outcome(void)
{
    outcome o = {.score = {.inside = NAN, .expected_here = NAN},
                 .image = {NAN, NAN},
                 .expected = NAN,
                 .seconds = NAN};
    for (int m = 0; m < GONIO_MOST_METRICS; m++) {
        o.score.error.value[m] = NAN;
    }
    return o;
}

static gonio_status complete_and_judge(state *s, gonio_context *context, const benchmark_task *task,
                                       size_t n, const benchmark_method *method, outcome *o)
{
    benchmark_completion completion = {.expected = NAN};
    const double start = seconds_now();
    gonio_status status = method->complete(context, task, &completion);
    o->seconds = seconds_now() - start;
    o->expected = completion.expected;
    if (status == GONIO_OK) {
        status = judge(s, context, task, n, &completion, &o->score, &o->image);
    }
    benchmark_completion_free(&completion);
    return status;
}

/* The author of an external program wants to know why it fails; other methods may fail silently. */
static gonio_status try_method(state *s, const benchmark_task *task, size_t n,
                               const benchmark_method *method, const char *name)
{
    const size_t read = gonio_readings_describe(task->readings)->count;
    const bool loud = method == &benchmark_external;
    outcome o = no_outcome();
    const gonio_status status =
        complete_and_judge(s, loud ? s->context : s->silent, task, n, method, &o);
    if (status == GONIO_OK || (is_excused(status) && !loud)) {
        add_row(s, n, name, read, &o.score, o.expected, &o.image, o.seconds);
        free(s->fault);
        s->fault = NULL;
        return GONIO_OK;
    }
    return gonio_i_fail(s->context, status, "%s by %s from %zu readings: %s",
                        s->trial->subject->name, name, n, reason(s, status));
}

/* ---- all methods from one n ---- */

static gonio_status find_basis(state *s, const gonio_basis **basis)
{
    const char *plan = s->trial->ways->plan_method;
    return benchmark_basis(s->silent, s->trial->bases, plan != NULL ? plan : "expected-error",
                           basis);
}

/* The reconstruction that published directions are made for. */
static gonio_status try_published(state *s, size_t n, benchmark_task *task)
{
    const gonio_status status = find_basis(s, &task->basis);
    task->method = gonio_plan_method_reconstruction(s->trial->ways->plan_method);
    return status == GONIO_OK ? try_method(s, task, n, &benchmark_published, task->method) : status;
}

static gonio_status try_methods(state *s, size_t n, const gonio_readings *readings)
{
    const benchmark_setting *setting = s->trial->setting;
    benchmark_task task = {.setting = setting,
                           .readings = readings,
                           .compared = s->sample.candidate,
                           .compared_count = s->sample.candidates};
    gonio_status status = GONIO_OK;
    if (s->trial->ways->own_methods) {
        return try_published(s, n, &task);
    }
    for (size_t k = 0; k < setting->method_count && status == GONIO_OK; k++) {
        const benchmark_method *method = benchmark_method_at(setting->method[k]);
        if (method->learned) {
            status = find_basis(s, &task.basis);
        }
        if (status == GONIO_OK) {
            status = try_method(s, &task, n, method, method->name);
        }
    }
    return status;
}

static gonio_status choose_and_try(state *s, size_t n)
{
    const benchmark_trial *t = s->trial;
    const benchmark_choosing with = {t->setting, &s->sample, t->bases, t->plan, t->draw};
    gonio_readings *readings = NULL;
    gonio_status status = t->ways->choose(s->silent, &with, n, &s->chosen);
    const benchmark_pairs first = {n + t->ways->repeats, s->chosen.pair};
    if (status != GONIO_OK || s->chosen.count < first.count) {
        return status;
    }
    status = benchmark_sample_read(s->silent, t->setting, &s->sample, &first, &readings);
    if (status == GONIO_OK) {
        status = try_methods(s, n, readings);
    }
    gonio_readings_free(&readings);
    return status;
}

static gonio_status try_sizes(state *s)
{
    const benchmark_setting *setting = s->trial->setting;
    const size_t most = benchmark_sample_most(&s->sample);
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < setting->sizes && status == GONIO_OK; k++) {
        if (setting->size[k] <= most) {
            status = choose_and_try(s, setting->size[k]);
        }
        if (status == GONIO_OK) {
            status = gonio_i_progress(s->context, "a trial", 0.5);
        }
    }
    return status;
}

gonio_status benchmark_trial_run(gonio_context *context, const benchmark_trial *trial,
                                 json_t **rows)
{
    state s = {.trial = trial, .context = context, .rows = json_array()};
    const gonio_context_options quiet = {
        .size = sizeof quiet, .message = keep_fault, .user = &s, .threads = 1};
    gonio_status status = gonio_context_create(&s.silent, &quiet);
    if (status == GONIO_OK) {
        status = benchmark_sample_open(s.silent, trial->setting, trial->subject, trial->candidates,
                                       &s.sample);
    }
    if (status == GONIO_OK) {
        status = try_sizes(&s);
    }
    if (status == GONIO_OK) {
        *rows = json_incref(s.rows);
    } else if (status != GONIO_ERROR_CANCELLED) {
        gonio_i_fail(context, status, "%s, %s: %s", trial->subject->path, trial->ways->name,
                     reason(&s, status));
    }
    free(s.fault);
    json_decref(s.rows);
    gonio_reference_free(&s.reference);
    benchmark_sample_free(&s.sample);
    free(s.chosen.pair);
    gonio_context_free(&s.silent);
    return status;
}

/* ---- rows from a file ---- */

static bool is_number(const json_t *value)
{
    return json_is_number(value) || json_is_null(value);
}

static bool is_count(const json_t *value)
{
    return json_is_integer(value) && json_integer_value(value) >= 0;
}

/* NULL if a row is fine; otherwise the name of what is not. */
static const char *find_fault(const json_t *row)
{
    static const char *const counts[] = {"n", "read", "values"};
    static const char *const numbers[] = {"inside", "expected",    "expected_here",
                                          "psnr",   "delta_e_itp", "seconds"};
    const json_t *errors = json_object_get(row, "errors");
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        if (!is_count(json_object_get(row, counts[k]))) {
            return counts[k];
        }
    }
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        if (!is_number(json_object_get(row, numbers[k]))) {
            return numbers[k];
        }
    }
    for (size_t m = 0; gonio_metric_describe((int)m) != NULL; m++) {
        if (!is_number(json_array_get(errors, m))) {
            return "errors";
        }
    }
    return json_is_string(json_object_get(row, "method")) ? NULL : "method";
}

bool benchmark_rows_accept(const json_t *rows, char *complaint, size_t size)
{
    const char *fault = json_is_array(rows) ? NULL : "the list";
    for (size_t k = 0; k < json_array_size(rows) && fault == NULL; k++) {
        fault = find_fault(json_array_get(rows, k));
    }
    if (fault != NULL) {
        snprintf(complaint, size, "%s of a trial is not as it should be", fault);
    }
    return fault == NULL;
}
