/* The trials of a benchmark as pieces of work: see run.h. */
#include "run.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

#include "run/checkpoint.h"
#include "trial.h"

#include "core/core.h"

/* One trial. */
typedef struct piece {
    size_t subject;
    int ways;
    size_t draw;
} piece;

/* The work of one lesson. */
typedef struct work {
    const benchmark_setting *setting;
    const benchmark_subjects *subjects;
    const benchmark_lesson *lesson;
    const benchmark_pairs *candidates;
    benchmark_bases bases;
    size_t plans;
    int planned[BENCHMARK_MOST_WORDS];  /* [plans]: ways whose plans all tables share */
    json_t *plan[BENCHMARK_MOST_WORDS]; /* [plans] */
    size_t pieces;
    piece *piece; /* [pieces] */
} work;

/* ---- the run's identity ---- */

static json_t *subjects_json(const benchmark_subjects *subjects)
{
    json_t *list = json_array();
    for (size_t k = 0; k < subjects->count; k++) {
        char hash[17];
        snprintf(hash, sizeof hash, "%016" PRIx64, subjects->subject[k].hash);
        json_array_append_new(list, json_pack("[s, s, s]", subjects->subject[k].set,
                                              subjects->subject[k].name, hash));
    }
    return list;
}

static json_t *words_json(const benchmark_setting *s, bool methods)
{
    json_t *list = json_array();
    for (size_t k = 0; k < (methods ? s->method_count : s->direction_count); k++) {
        json_array_append_new(
            list, json_string(methods ? benchmark_method_at(s->method[k])->name
                                      : benchmark_directions_at(s->directions[k])->name));
    }
    return list;
}

static json_t *sizes_json(const benchmark_setting *s)
{
    json_t *list = json_array();
    for (size_t k = 0; k < s->sizes; k++) {
        json_array_append_new(list, json_integer((json_int_t)s->size[k]));
    }
    return list;
}

/* Ways that are asked for later can be added: they are not in it. Methods are, since a trial has
 * all. */
static json_t *identity_of(const benchmark_setting *s, const benchmark_subjects *subjects,
                           const benchmark_lessons *lessons)
{
    json_t *as = json_pack("{s:s?, s:i, s:i, s:i, s:i, s:i, s:i}", "format", s->reading.as.format,
                           "angles", s->reading.as.angles, "values", s->reading.as.values, "mirror",
                           s->reading.as.mirror, "zeros", s->reading.as.zeros, "sample",
                           s->reading.as.sample, "scale", s->reading.as.scale);
    return json_pack("{s:s, s:o, s:o, s:o, s:o, s:I, s:f, s:f, s:f, s:f, s:I, s:I, s:b, s:b, s:s?, "
                     "s:I, s:o, s:I}",
                     "build", GONIO_FINGERPRINT, "subjects", subjects_json(subjects), "lessons",
                     benchmark_lessons_json(lessons), "sizes", sizes_json(s), "methods",
                     words_json(s, true), "candidates", (json_int_t)s->candidates, "reach",
                     s->reach, "noise", s->noise, "floor", s->floor, "outliers", s->outliers,
                     "batch", (json_int_t)s->batch, "channels", (json_int_t)s->channels, "no_bands",
                     s->no_bands, "render", s->render, "external", s->external, "seed",
                     (json_int_t)s->seed, "as", as, "instrument", (json_int_t)s->instrument_hash);
}

/* ---- plans ---- */

static char *name_plan(void *user, size_t k)
{
    const work *w = user;
    return gonio_i_format("plan-%s-%s", w->lesson->name,
                          benchmark_directions_at(w->planned[k])->name);
}

static gonio_status compute_plan(void *user, gonio_context *context, size_t k, json_t **result)
{
    work *w = user;
    return benchmark_plan(context, w->setting, &w->bases, benchmark_directions_at(w->planned[k]),
                          w->candidates, result);
}

static bool accept_plan(void *user, size_t k, const json_t *result, char *complaint)
{
    const work *w = user;
    return benchmark_plan_accept(benchmark_directions_at(w->planned[k]), result, complaint,
                                 GONIO_I_COMPLAINT);
}

static bool has_tables(const work *w)
{
    bool any = false;
    for (size_t k = 0; k < w->lesson->subjects; k++) {
        any = any || !w->subjects->subject[w->lesson->subject[k]].scattered;
    }
    return any;
}

/* What tables are planned by; `next` begins as `planned`. */
static void list_plans(work *w)
{
    const benchmark_setting *s = w->setting;
    const int usual = benchmark_directions_find("planned");
    bool listed = false;
    for (size_t k = 0; k < s->direction_count && has_tables(w); k++) {
        const benchmark_directions *ways = benchmark_directions_at(s->directions[k]);
        if (ways->own_methods) {
            w->planned[w->plans++] = s->directions[k];
        } else if (ways->plan_method != NULL && !listed) {
            w->planned[w->plans++] = usual;
            listed = true;
        }
    }
}

static const json_t *plan_for(const work *w, const piece *p)
{
    const benchmark_directions *ways = benchmark_directions_at(p->ways);
    const int wanted = ways->own_methods ? p->ways : benchmark_directions_find("planned");
    const json_t *plan = NULL;
    for (size_t k = 0; k < w->plans; k++) {
        plan = w->planned[k] == wanted ? w->plan[k] : plan;
    }
    return w->subjects->subject[p->subject].scattered || ways->plan_method == NULL ? NULL : plan;
}

/* ---- trials ---- */

static char *name_trial(void *user, size_t k)
{
    const work *w = user;
    const piece *p = &w->piece[k];
    const benchmark_subject *s = &w->subjects->subject[p->subject];
    return gonio_i_format("%s-%s-%s-%s-%zu", w->lesson->name, s->set, s->name,
                          benchmark_directions_at(p->ways)->name, p->draw);
}

static gonio_status compute_trial(void *user, gonio_context *context, size_t k, json_t **result)
{
    work *w = user;
    const piece *p = &w->piece[k];
    const benchmark_trial trial = {.setting = w->setting,
                                   .subject = &w->subjects->subject[p->subject],
                                   .ways = benchmark_directions_at(p->ways),
                                   .draw = p->draw,
                                   .candidates = w->candidates,
                                   .plan = plan_for(w, p),
                                   .bases = &w->bases};
    return benchmark_trial_run(context, &trial, result);
}

static bool accept_trial(void *user, size_t k, const json_t *result, char *complaint)
{
    (void)user;
    (void)k;
    return benchmark_rows_accept(result, complaint, GONIO_I_COMPLAINT);
}

/* Seconds, roughly. */
static double cost_trial(void *user, size_t k)
{
    const work *w = user;
    const piece *p = &w->piece[k];
    const bool table = !w->subjects->subject[p->subject].scattered;
    const double next = benchmark_directions_at(p->ways)->on_the_way ? 30.0 : 0.0;
    const double rendered = table && w->setting->render && p->draw == 0 ? 20.0 : 0.0;
    return next + rendered + (table ? 5.0 : 3.0);
}

/* Published ways choose anywhere on the grid, and so are for tables. */
static gonio_status list_trials(gonio_context *context, work *w)
{
    const benchmark_setting *s = w->setting;
    w->piece = gonio_i_allocate(context, w->lesson->subjects * s->direction_count * s->draws + 1,
                                sizeof *w->piece);
    if (w->piece == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < w->lesson->subjects; k++) {
        const size_t subject = w->lesson->subject[k];
        for (size_t i = 0; i < s->direction_count; i++) {
            const benchmark_directions *ways = benchmark_directions_at(s->directions[i]);
            const size_t draws = ways->drawn ? s->draws : 1;
            const bool fits = !(ways->own_methods && w->subjects->subject[subject].scattered);
            for (size_t draw = 0; draw < draws && fits; draw++) {
                w->piece[w->pieces++] = (piece){subject, s->directions[i], draw};
            }
        }
    }
    return GONIO_OK;
}

/* ---- rows ---- */

static double number_of(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

static void read_row(const work *w, const piece *p, const json_t *json, benchmark_row *row)
{
    const char *method = json_string_value(json_object_get(json, "method"));
    const benchmark_method *known = benchmark_method_at(benchmark_method_find(method));
    const json_t *errors = json_object_get(json, "errors");
    *row = (benchmark_row){.subject = &w->subjects->subject[p->subject],
                           .lesson = w->lesson,
                           .ways = benchmark_directions_at(p->ways),
                           .method = method,
                           .simple = known != NULL && known->simple,
                           .draw = p->draw,
                           .n = (size_t)number_of(json, "n"),
                           .read = (size_t)number_of(json, "read"),
                           .values = (size_t)number_of(json, "values"),
                           .inside = number_of(json, "inside"),
                           .expected = number_of(json, "expected"),
                           .expected_here = number_of(json, "expected_here"),
                           .psnr = number_of(json, "psnr"),
                           .delta_e_itp = number_of(json, "delta_e_itp"),
                           .seconds = number_of(json, "seconds")};
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        const json_t *value = json_array_get(errors, (size_t)m);
        row->error.value[m] = json_is_number(value) ? json_number_value(value) : NAN;
    }
}

/* Takes the results. */
static gonio_status add_rows(gonio_context *context, const work *w, json_t **results,
                             benchmark_rows *rows)
{
    size_t more = 0;
    for (size_t k = 0; k < w->pieces; k++) {
        more += json_array_size(results[k]);
    }
    benchmark_row *all = reallocarray(rows->row, rows->count + more + 1, sizeof *all);
    if (all == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    rows->row = all;
    for (size_t k = 0; k < w->pieces; k++) {
        for (size_t i = 0; i < json_array_size(results[k]); i++) {
            read_row(w, &w->piece[k], json_array_get(results[k], i), &all[rows->count++]);
        }
        json_array_append(rows->kept, results[k]);
    }
    return GONIO_OK;
}

void benchmark_rows_free(benchmark_rows *rows)
{
    free(rows->row);
    json_decref(rows->kept);
    *rows = (benchmark_rows){0};
}

/* ---- a lesson ---- */

static gonio_status run_trials(gonio_context *context, work *w,
                               const gonio_i_checkpoint *checkpoint, benchmark_rows *rows)
{
    const gonio_i_work trials = {.title = "trials",
                                 .count = w->pieces,
                                 .user = w,
                                 .name = name_trial,
                                 .cost = cost_trial,
                                 .compute = compute_trial,
                                 .accept = accept_trial};
    json_t **results = gonio_i_allocate(context, w->pieces + 1, sizeof(json_t *));
    gonio_status status = results != NULL
                              ? gonio_i_checkpoint_run(context, checkpoint, &trials, results)
                              : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = add_rows(context, w, results, rows);
    }
    for (size_t k = 0; results != NULL && k < w->pieces; k++) {
        json_decref(results[k]);
    }
    free(results);
    return status;
}

static gonio_status run_lesson(gonio_context *context, work *w,
                               const gonio_i_checkpoint *checkpoint, benchmark_rows *rows)
{
    list_plans(w);
    const gonio_i_work plans = {.title = "plans",
                                .count = w->plans,
                                .user = w,
                                .name = name_plan,
                                .compute = compute_plan,
                                .accept = accept_plan};
    gonio_status status = list_trials(context, w);
    if (status == GONIO_OK && w->plans > 0) {
        status = gonio_i_checkpoint_run(context, checkpoint, &plans, w->plan);
    }
    if (status == GONIO_OK) {
        status = run_trials(context, w, checkpoint, rows);
    }
    for (size_t k = 0; k < w->plans; k++) {
        json_decref(w->plan[k]);
    }
    benchmark_bases_free(&w->bases);
    free(w->piece);
    return status;
}

static gonio_status run_lessons(gonio_context *context, const benchmark_setting *setting,
                                const benchmark_subjects *subjects,
                                const benchmark_lessons *lessons,
                                const gonio_i_checkpoint *checkpoint, benchmark_rows *rows)
{
    benchmark_pairs candidates = {0};
    gonio_status status = benchmark_candidates(context, setting, &candidates);
    for (size_t k = 0; k < lessons->count && status == GONIO_OK; k++) {
        work w = {
            .setting = setting,
            .subjects = subjects,
            .lesson = &lessons->lesson[k],
            .candidates = &candidates,
            .bases = {.lesson = &lessons->lesson[k], .most = setting->size[setting->sizes - 1]}};
        status = run_lesson(context, &w, checkpoint, rows);
    }
    free(candidates.pair);
    return status;
}

gonio_status benchmark_run(gonio_context *context, const benchmark_setting *setting,
                           const benchmark_subjects *subjects, const benchmark_lessons *lessons,
                           const char *folder, benchmark_rows *rows)
{
    *rows = (benchmark_rows){.kept = json_array()};
    gonio_i_checkpoint *checkpoint = NULL;
    json_t *identity = identity_of(setting, subjects, lessons);
    gonio_status status =
        identity != NULL
            ? gonio_i_checkpoint_open(context, folder, identity, setting->group, &checkpoint)
            : gonio_i_fail(context, GONIO_ERROR_MEMORY, "a name is not UTF-8, or out of memory");
    if (status == GONIO_OK) {
        status = run_lessons(context, setting, subjects, lessons, checkpoint, rows);
    }
    gonio_i_checkpoint_free(&checkpoint);
    json_decref(identity);
    return status;
}
