/* What is learned from: see lessons.h. */
#include "lessons.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "directions.h"
#include "core/core.h"

enum { LEAST_TABLES = 4, FOLD_STREAM = 2000 };

void benchmark_lessons_free(benchmark_lessons *lessons)
{
    for (size_t k = 0; k < lessons->count; k++) {
        free(lessons->lesson[k].name);
        free(lessons->lesson[k].path);
        free(lessons->lesson[k].subject);
    }
    free(lessons->lesson);
    *lessons = (benchmark_lessons){0};
}

/* A new lesson with room for so many materials and subjects; takes `name`. NULL when out of memory.
 */
static benchmark_lesson *add_lesson(benchmark_lessons *lessons, char *name, size_t paths,
                                    size_t subjects)
{
    benchmark_lesson *more =
        reallocarray(lessons->lesson, lessons->count + 1, sizeof *lessons->lesson);
    if (more == NULL) {
        free(name);
        return NULL;
    }
    lessons->lesson = more;
    benchmark_lesson *lesson = &more[lessons->count++];
    *lesson = (benchmark_lesson){.name = name,
                                 .path = calloc(paths + 1, sizeof *lesson->path),
                                 .subject = calloc(subjects + 1, sizeof *lesson->subject)};
    return name != NULL && lesson->path != NULL && lesson->subject != NULL ? lesson : NULL;
}

static gonio_status no_memory(gonio_context *context)
{
    return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
}

/* ---- one for all ---- */

/* Whether a basis that is given suits all that is asked for. */
static gonio_status check_given(gonio_context *context, const benchmark_setting *setting)
{
    const char *method[BENCHMARK_MOST_WORDS];
    for (size_t k = 0; k < setting->direction_count; k++) {
        const benchmark_directions *ways = benchmark_directions_at(setting->directions[k]);
        method[k] = ways->plan_method != NULL ? ways->plan_method : "expected-error";
    }
    return benchmark_check_basis(context, setting->basis, method, setting->direction_count);
}

static gonio_status give_all(gonio_context *context, const benchmark_setting *setting,
                             const benchmark_subjects *subjects, benchmark_lessons *lessons)
{
    benchmark_lesson *lesson =
        add_lesson(lessons, strdup("given"), setting->learn_count, subjects->count);
    if (lesson == NULL) {
        return no_memory(context);
    }
    lesson->basis = setting->basis;
    for (size_t k = 0; k < setting->learn_count; k++) {
        lesson->path[lesson->count++] = setting->learn[k];
    }
    for (size_t k = 0; k < subjects->count; k++) {
        lesson->subject[lesson->subjects++] = k;
    }
    return GONIO_OK;
}

/* ---- by turns ---- */

static gonio_status give_builtin(gonio_context *context, const benchmark_setting *setting,
                                 const benchmark_subjects *subjects, benchmark_lessons *lessons)
{
    benchmark_lesson *lesson = NULL;
    for (size_t k = 0; k < subjects->count; k++) {
        if (!subjects->subject[k].scattered) {
            continue;
        }
        if (lesson == NULL) {
            lesson = add_lesson(lessons, strdup("built-in"), 0, subjects->count);
        }
        if (lesson == NULL) {
            return no_memory(context);
        }
        lesson->basis = setting->builtin;
        lesson->subject[lesson->subjects++] = k;
    }
    return GONIO_OK;
}

/* The tables of a set that has none before subject `first`, in random order: order[count]. */
static size_t shuffle_set(const benchmark_setting *setting, const benchmark_subjects *subjects,
                          size_t first, size_t *order)
{
    gonio_i_random random;
    size_t count = 0;
    for (size_t k = first; k < subjects->count; k++) {
        const benchmark_subject *s = &subjects->subject[k];
        if (!s->scattered && strcmp(s->set, subjects->subject[first].set) == 0) {
            order[count++] = k;
        }
    }
    gonio_i_random_seed(&random, setting->seed, FOLD_STREAM);
    for (size_t k = count; k > 1; k--) {
        const size_t other = gonio_i_random_below(&random, k);
        const size_t kept = order[k - 1];
        order[k - 1] = order[other];
        order[other] = kept;
    }
    return count;
}

static bool is_first_of_set(const benchmark_subjects *subjects, size_t k)
{
    bool first = !subjects->subject[k].scattered;
    for (size_t i = 0; i < k && first; i++) {
        first = subjects->subject[i].scattered ||
                strcmp(subjects->subject[i].set, subjects->subject[k].set) != 0;
    }
    return first;
}

static int compare_places(const void *a, const void *b)
{
    const size_t p = *(const size_t *)a;
    const size_t q = *(const size_t *)b;
    return (p > q) - (p < q);
}

/* The fold-th of `folds` parts is tested. */
static gonio_status give_fold(gonio_context *context, const benchmark_subjects *subjects,
                              const size_t *order, size_t count, size_t folds, size_t fold,
                              benchmark_lessons *lessons)
{
    char *name =
        gonio_i_format("%s fold %zu of %zu", subjects->subject[order[0]].set, fold + 1, folds);
    benchmark_lesson *lesson = add_lesson(lessons, name, count, count);
    if (lesson == NULL) {
        return no_memory(context);
    }
    size_t *learned = calloc(count, sizeof *learned);
    if (learned == NULL) {
        return no_memory(context);
    }
    for (size_t k = 0; k < count; k++) {
        if (k % folds == fold) {
            lesson->subject[lesson->subjects++] = order[k];
        } else {
            learned[lesson->count++] = order[k];
        }
    }
    qsort(learned, lesson->count, sizeof *learned, compare_places);
    qsort(lesson->subject, lesson->subjects, sizeof *lesson->subject, compare_places);
    for (size_t k = 0; k < lesson->count; k++) {
        lesson->path[k] = subjects->subject[learned[k]].path;
    }
    free(learned);
    return GONIO_OK;
}

static gonio_status give_folds(gonio_context *context, const benchmark_setting *setting,
                               const benchmark_subjects *subjects, size_t first, size_t *order,
                               benchmark_lessons *lessons)
{
    const size_t count = shuffle_set(setting, subjects, first, order);
    const size_t folds = setting->folds < count ? setting->folds : count;
    if (count < LEAST_TABLES) {
        return gonio_i_fail(context, GONIO_ERROR_DATA,
                            "%s: %zu materials are too few to learn from some and test on others: "
                            "at least %d are needed, or --learn",
                            subjects->subject[first].set, count, LEAST_TABLES);
    }
    gonio_status status = GONIO_OK;
    for (size_t fold = 0; fold < folds && status == GONIO_OK; fold++) {
        status = give_fold(context, subjects, order, count, folds, fold, lessons);
    }
    return status;
}

static gonio_status give_turns(gonio_context *context, const benchmark_setting *setting,
                               const benchmark_subjects *subjects, benchmark_lessons *lessons)
{
    size_t *order = gonio_i_allocate(context, subjects->count, sizeof *order);
    gonio_status status = order != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < subjects->count && status == GONIO_OK; k++) {
        if (is_first_of_set(subjects, k)) {
            status = give_folds(context, setting, subjects, k, order, lessons);
        }
    }
    free(order);
    return status;
}

/* ---- splits of a file ---- */

/* The table of a name; the number of subjects if there is none. */
static size_t find_table(const benchmark_subjects *subjects, const char *name)
{
    const char *plain = name != NULL && strncmp(name, "atlas:", 6) == 0 ? name + 6 : name;
    size_t k = 0;
    while (k < subjects->count && (plain == NULL || subjects->subject[k].scattered ||
                                   strcmp(subjects->subject[k].name, plain) != 0)) {
        k++;
    }
    return k;
}

static gonio_status give_split(gonio_context *context, const benchmark_setting *setting,
                               const benchmark_subjects *subjects, const json_t *split,
                               size_t number, benchmark_lessons *lessons)
{
    const json_t *names[2] = {json_object_get(split, "basis"), json_object_get(split, "test")};
    benchmark_lesson *lesson = add_lesson(lessons, gonio_i_format("split %zu", number),
                                          json_array_size(names[0]), json_array_size(names[1]));
    if (lesson == NULL) {
        return no_memory(context);
    }
    for (int part = 0; part < 2; part++) {
        for (size_t k = 0; k < json_array_size(names[part]); k++) {
            const char *name = json_string_value(json_array_get(names[part], k));
            const size_t found = find_table(subjects, name);
            if (found == subjects->count) {
                return gonio_i_fail(context, GONIO_ERROR_DATA,
                                    "%s: split %zu: no material is called '%s'", setting->splits,
                                    number, name != NULL ? name : "");
            }
            if (part == 0) {
                lesson->path[lesson->count++] = subjects->subject[found].path;
            } else {
                lesson->subject[lesson->subjects++] = found;
            }
        }
    }
    return lesson->count >= LEAST_TABLES - 1 && lesson->subjects > 0
               ? GONIO_OK
               : gonio_i_fail(context, GONIO_ERROR_DATA,
                              "%s: split %zu: arrays 'basis' and 'test' of at least %d and 1 names "
                              "are needed",
                              setting->splits, number, LEAST_TABLES - 1);
}

static gonio_status give_splits(gonio_context *context, const benchmark_setting *setting,
                                const benchmark_subjects *subjects, benchmark_lessons *lessons)
{
    json_error_t error;
    json_t *file = json_load_file(setting->splits, JSON_REJECT_DUPLICATES, &error);
    if (file == NULL) {
        return error.line < 0
                   ? gonio_i_fail(context, GONIO_ERROR_IO, "%s: %s", setting->splits, error.text)
                   : gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s:%d: not JSON: %s",
                                  setting->splits, error.line, error.text);
    }
    const json_t *list = json_object_get(file, "splits");
    gonio_status status = json_array_size(list) > 0
                              ? GONIO_OK
                              : gonio_i_fail(context, GONIO_ERROR_FORMAT,
                                             "%s: holds no array 'splits'", setting->splits);
    for (size_t s = 0; s < json_array_size(list) && status == GONIO_OK; s++) {
        status = give_split(context, setting, subjects, json_array_get(list, s), s + 1, lessons);
    }
    json_decref(file);
    return status;
}

gonio_status benchmark_lessons_make(gonio_context *context, const benchmark_setting *setting,
                                    const benchmark_subjects *subjects, benchmark_lessons *lessons)
{
    *lessons = (benchmark_lessons){0};
    if (setting->basis != NULL || setting->learn_count > 0) {
        const gonio_status fits = setting->basis != NULL ? check_given(context, setting) : GONIO_OK;
        return fits == GONIO_OK ? give_all(context, setting, subjects, lessons) : fits;
    }
    const gonio_status status = setting->splits != NULL
                                    ? give_splits(context, setting, subjects, lessons)
                                    : give_turns(context, setting, subjects, lessons);
    return status == GONIO_OK ? give_builtin(context, setting, subjects, lessons) : status;
}

/* Base name and hash of a file. */
static json_t *file_json(const char *path)
{
    char hash[17];
    char *name = path != NULL ? gonio_i_base_name(path, true) : NULL;
    snprintf(hash, sizeof hash, "%016" PRIx64, path != NULL ? benchmark_hash(path) : 0);
    json_t *json = path != NULL ? json_pack("[s?, s]", name, hash) : json_null();
    free(name);
    return json;
}

json_t *benchmark_lessons_json(const benchmark_lessons *lessons)
{
    json_t *list = json_array();
    for (size_t k = 0; k < lessons->count; k++) {
        const benchmark_lesson *lesson = &lessons->lesson[k];
        json_t *paths = json_array();
        for (size_t i = 0; i < lesson->count; i++) {
            json_array_append_new(paths, file_json(lesson->path[i]));
        }
        json_array_append_new(list, json_pack("{s:s, s:o, s:o}", "name", lesson->name, "basis",
                                              file_json(lesson->basis), "materials", paths));
    }
    return list;
}
