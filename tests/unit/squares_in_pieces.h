/* Work in pieces for the tests: squares, whose run in a folder is stopped, damaged and gone on
 * with. */
#ifndef SQUARES_IN_PIECES_H
#define SQUARES_IN_PIECES_H

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/core.h"
#include "run/checkpoint.h"
#include "run/run_folder.h"

enum { PIECES = 12 };

/* ---- the work: piece k, "square k" times its cost ---- */

typedef struct squares {
    int computed[PIECES];
    int total;
    int failing;                      /* this piece fails; -1 for none */
    const char *(*naming)(int piece); /* NULL for "square-N" */
    bool large; /* every third is one of those of which there is one at a time */
    int large_now, most_large;
    int refused; /* of kept results, this piece's is; 0 for none, as 0 is accepted always */
} squares;

static inline char *name_of(void *user, size_t piece)
{
    const squares *s = user;
    return s->naming != NULL ? strdup(s->naming((int)piece)) : gonio_i_format("square-%zu", piece);
}

static inline double cost_of(void *user, size_t piece)
{
    (void)user;
    return (double)(1 + piece % 5);
}

static inline bool is_large(void *user, size_t piece)
{
    const squares *s = user;
    return s->large && piece % 3 == 0;
}

/* Takes a while, so that others of its kind would be noticed. */
static inline void be_large(squares *s)
{
#pragma omp critical(large)
    {
        s->large_now++;
        s->most_large = s->large_now > s->most_large ? s->large_now : s->most_large;
    }
    usleep(10000);
#pragma omp critical(large)
    s->large_now--;
}

static inline gonio_status compute(void *user, gonio_context *context, size_t piece,
                                   json_t **result)
{
    squares *s = user;
    if (is_large(user, piece)) {
        be_large(s);
    }
    assert_int_equal(gonio_context_threads(context), 1);
#pragma omp critical
    {
        s->computed[piece]++;
        s->total++;
    }
    if ((int)piece == s->failing) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "no square today");
    }
    /* As a long computation inside does; must not be taken for the progress of the whole. */
    const gonio_status status = gonio_i_progress(context, "inside", 1.0);
    if (status == GONIO_OK) {
        *result = json_pack("{s:f, s:f, s:i, s:s}", "value", pow((double)piece, 2.0) / 3.0, "tiny",
                            -1.0e-300 * (double)piece, "count", (int)piece, "text", "\xc3\xa9\"\n");
    }
    return status;
}

static inline bool accept(void *user, size_t piece, const json_t *result, char *complaint)
{
    const squares *s = user;
    assert_true(json_is_object(result));
    if (s->refused == 0 || piece != (size_t)s->refused) {
        return true;
    }
    snprintf(complaint, GONIO_I_COMPLAINT, "it is no square");
    return false;
}

/* ---- contexts that listen ---- */

typedef struct listener {
    double fraction; /* told last */
    int ends;        /* how often 1 was told */
    bool went_back;
    double stop_at; /* cancels from this fraction on */
    int warnings, notes, errors;
    char warning[1024], error[1024];
} listener;

static inline int on_progress(void *user, const char *task, double fraction)
{
    listener *l = user;
    assert_string_equal(task, "squares");
    l->went_back = l->went_back || fraction < l->fraction;
    l->fraction = fraction;
    l->ends += fraction == 1.0;
    return fraction >= l->stop_at;
}

static inline void on_message(void *user, gonio_message_level level, const char *text)
{
    listener *l = user;
    l->errors += level == GONIO_MESSAGE_ERROR;
    l->warnings += level == GONIO_MESSAGE_WARNING;
    l->notes += level == GONIO_MESSAGE_NOTE;
    if (level != GONIO_MESSAGE_NOTE) {
        snprintf(level == GONIO_MESSAGE_ERROR ? l->error : l->warning, 1024, "%s", text);
    }
}

static inline gonio_context *listen(listener *l, int threads)
{
    gonio_context *context = NULL;
    *l = (listener){.stop_at = 2.0};
    const gonio_context_options options = {.size = sizeof options,
                                           .message = on_message,
                                           .progress = on_progress,
                                           .user = l,
                                           .threads = threads};
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    return context;
}

/* ---- a run from opening to results ---- */

static inline bool no_barrier(void *user)
{
    (*(int *)user)++;
    return true;
}

static inline json_t *identity(int seed)
{
    return json_pack("{s:i, s:f, s:{s:s, s:s}}", "seed", seed, "noise", 0.1, "materials", "gold",
                     "a1", "oak", "b2");
}

static inline gonio_status run(gonio_context *context, const char *folder, squares *s,
                               const process_group *group, json_t **results)
{
    gonio_i_checkpoint *checkpoint = NULL;
    json_t *who = identity(1);
    const gonio_i_work work = {.title = "squares",
                               .count = PIECES,
                               .user = s,
                               .name = name_of,
                               .cost = cost_of,
                               .compute = compute,
                               .accept = accept,
                               .one_at_a_time = is_large};
    gonio_status status = gonio_i_checkpoint_open(context, folder, who, group, &checkpoint);
    json_decref(who);
    if (status == GONIO_OK) {
        status = gonio_i_checkpoint_run(context, checkpoint, &work, results);
    }
    gonio_i_checkpoint_free(&checkpoint);
    return status;
}

static inline void free_results(json_t **results)
{
    for (int k = 0; k < PIECES; k++) {
        json_decref(results[k]);
    }
}

static inline char *read_file(const char *path)
{
    char *text = NULL;
    size_t room = 0;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return NULL;
    }
    if (getdelim(&text, &room, '\0', file) < 0) {
        text[0] = '\0';
    }
    fclose(file);
    return text;
}

/* All pieces of the folder one after the other; `count` of them. */
static inline char *bytes_of(const char *folder, int *count)
{
    char *all = strdup("");
    *count = 0;
    for (int k = 0; k < PIECES; k++) {
        char path[512];
        snprintf(path, sizeof path, "%s/pieces/square-%d.json", folder, k);
        char *text = read_file(path);
        if (text != NULL) {
            char *more = gonio_i_format("%s%s", all, text);
            free(all);
            all = more;
            (*count)++;
        }
        free(text);
    }
    return all;
}

static inline int entries_in(const char *folder, const char *inner)
{
    char path[512];
    int count = 0;
    snprintf(path, sizeof path, "%s/%s", folder, inner);
    DIR *entries = opendir(path);
    assert_non_null(entries);
    while (readdir(entries) != NULL) {
        count++;
    }
    closedir(entries);
    return count - 2;
}

typedef struct fixture {
    char *folder;    /* for the tests */
    char whole[256]; /* a run that was never stopped, in this folder */
    char out[256];   /* not there yet */
    char *bytes;     /* of the whole one's pieces */
    listener heard;
    gonio_context *context;
} fixture;

static inline int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    squares s = {.failing = -1};
    int count = 0;
    f->folder = support_folder();
    snprintf(f->whole, sizeof f->whole, "%s/whole", f->folder);
    snprintf(f->out, sizeof f->out, "%s/out", f->folder);
    f->context = listen(&f->heard, 2);
    assert_int_equal(run(f->context, f->whole, &s, NULL, NULL), GONIO_OK);
    assert_int_equal(s.total, PIECES);
    f->bytes = bytes_of(f->whole, &count);
    assert_int_equal(count, PIECES);
    *state = f;
    return 0;
}

static inline int tear_down(void **state)
{
    fixture *f = *state;
    gonio_context_free(&f->context);
    support_remove(f->folder);
    free(f->bytes);
    free(f);
    return 0;
}

static inline void assert_same_bytes(const fixture *f)
{
    int count = 0;
    char *bytes = bytes_of(f->out, &count);
    assert_int_equal(count, PIECES);
    assert_string_equal(bytes, f->bytes);
    assert_int_equal(entries_in(f->out, "pieces"), PIECES);
    assert_int_equal(entries_in(f->out, ""), 2);
    free(bytes);
}

static inline gonio_status open_as(fixture *f, const char *folder, json_t *who)
{
    gonio_i_checkpoint *checkpoint = NULL;
    f->heard.error[0] = '\0';
    const gonio_status status = gonio_i_checkpoint_open(f->context, folder, who, NULL, &checkpoint);
    gonio_i_checkpoint_free(&checkpoint);
    json_decref(who);
    return status;
}

static inline void assert_tells(const fixture *f, const char *text)
{
    if (strstr(f->heard.error, text) == NULL) {
        fail_msg("'%s' is not in '%s'", text, f->heard.error);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

#endif
