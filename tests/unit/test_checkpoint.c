/* Work in pieces: what was finished stays, what is missing is computed, and the bytes do not depend
 * on how often a run was stopped, on threads or on ranks. */
#include "../support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
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

static char *name_of(void *user, size_t piece)
{
    const squares *s = user;
    return s->naming != NULL ? strdup(s->naming((int)piece)) : gonio_i_format("square-%zu", piece);
}

static double cost_of(void *user, size_t piece)
{
    (void)user;
    return (double)(1 + piece % 5);
}

static bool is_large(void *user, size_t piece)
{
    const squares *s = user;
    return s->large && piece % 3 == 0;
}

/* Takes a while, so that others of its kind would be noticed. */
static void be_large(squares *s)
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

static gonio_status compute(void *user, gonio_context *context, size_t piece, json_t **result)
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

static bool accept(void *user, size_t piece, const json_t *result, char *complaint)
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

static int on_progress(void *user, const char *task, double fraction)
{
    listener *l = user;
    assert_string_equal(task, "squares");
    l->went_back = l->went_back || fraction < l->fraction;
    l->fraction = fraction;
    l->ends += fraction == 1.0;
    return fraction >= l->stop_at;
}

static void on_message(void *user, gonio_message_level level, const char *text)
{
    listener *l = user;
    l->errors += level == GONIO_MESSAGE_ERROR;
    l->warnings += level == GONIO_MESSAGE_WARNING;
    l->notes += level == GONIO_MESSAGE_NOTE;
    if (level != GONIO_MESSAGE_NOTE) {
        snprintf(level == GONIO_MESSAGE_ERROR ? l->error : l->warning, 1024, "%s", text);
    }
}

static gonio_context *listen(listener *l, int threads)
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

static bool no_barrier(void *user)
{
    (*(int *)user)++;
    return true;
}

static json_t *identity(int seed)
{
    return json_pack("{s:i, s:f, s:{s:s, s:s}}", "seed", seed, "noise", 0.1, "materials", "gold",
                     "a1", "oak", "b2");
}

static gonio_status run(gonio_context *context, const char *folder, squares *s,
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

static void free_results(json_t **results)
{
    for (int k = 0; k < PIECES; k++) {
        json_decref(results[k]);
    }
}

static char *read_file(const char *path)
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
static char *bytes_of(const char *folder, int *count)
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

static int entries_in(const char *folder, const char *inner)
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

static int set_up(void **state)
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

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_context_free(&f->context);
    support_remove(f->folder);
    free(f->bytes);
    free(f);
    return 0;
}

static void assert_same_bytes(const fixture *f)
{
    int count = 0;
    char *bytes = bytes_of(f->out, &count);
    assert_int_equal(count, PIECES);
    assert_string_equal(bytes, f->bytes);
    assert_int_equal(entries_in(f->out, "pieces"), PIECES);
    assert_int_equal(entries_in(f->out, ""), 2);
    free(bytes);
}

/* ---- tests ---- */

static void test_results_come_back_exactly(void **state)
{
    fixture *f = *state;
    squares s = {.failing = -1};
    json_t *results[PIECES] = {0};
    assert_int_equal(run(f->context, f->out, &s, NULL, results), GONIO_OK);
    for (int k = 0; k < PIECES; k++) {
        assert_true(json_real_value(json_object_get(results[k], "value")) == k * k / 3.0);
        assert_true(json_real_value(json_object_get(results[k], "tiny")) == -1.0e-300 * k);
        assert_string_equal(json_string_value(json_object_get(results[k], "text")), "\xc3\xa9\"\n");
    }
    free_results(results);
    assert_same_bytes(f);
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_OK);
    assert_int_equal(s.total, PIECES); /* nothing is computed twice */
    assert_int_equal(f->heard.errors + f->heard.warnings + f->heard.notes, 0);
}

/* Its checksum is right, and it is not computed again: somebody wrote it. */
static void test_what_is_not_accepted_is_an_error(void **state)
{
    fixture *f = *state;
    squares s = {.failing = -1, .refused = 5};
    assert_int_equal(run(f->context, f->whole, &s, NULL, NULL), GONIO_ERROR_FORMAT);
    assert_int_equal(s.total, 0);
    assert_int_equal(f->heard.errors, 1);
    assert_non_null(strstr(f->heard.error, "/whole/pieces/square-5.json: it is no square: "));
}

static void test_large_pieces_one_at_a_time(void **state)
{
    fixture *f = *state;
    listener heard;
    squares s = {.failing = -1, .large = true};
    gonio_context *context = listen(&heard, 4);
    assert_int_equal(run(context, f->out, &s, NULL, NULL), GONIO_OK);
    gonio_context_free(&context);
    assert_int_equal(s.total, PIECES);
    assert_int_equal(s.most_large, 1);
    assert_same_bytes(f);
}

static void test_progress_is_by_cost(void **state)
{
    fixture *f = *state;
    listener heard;
    squares s = {.failing = -1};
    gonio_context *context = listen(&heard, 1);
    assert_int_equal(run(context, f->out, &s, NULL, NULL), GONIO_OK);
    assert_true(heard.ends == 1 && heard.fraction == 1.0 && !heard.went_back);
    gonio_context_free(&context);
}

static void test_a_stopped_run_goes_on(void **state)
{
    fixture *f = *state;
    squares s = {.failing = -1};
    int before = 0;
    for (int stop = 1; stop <= 4; stop++) {
        listener heard;
        gonio_context *context = listen(&heard, 1 + stop % 2);
        heard.stop_at = 0.3;
        assert_int_equal(run(context, f->out, &s, NULL, NULL), GONIO_ERROR_CANCELLED);
        assert_int_equal(heard.errors, 0);
        gonio_context_free(&context);
        int count = 0;
        free(bytes_of(f->out, &count));
        assert_true(count > before && count < PIECES);
        before = count;
    }
    char part[512]; /* as a kill leaves behind */
    snprintf(part, sizeof part, "%s/pieces/square-3.json.77-0.part", f->out);
    assert_int_equal(gonio_i_write_text(NULL, part, "{\"pie"), GONIO_OK);
    s = (squares){.failing = -1};
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_OK);
    assert_int_equal(s.total, PIECES - before); /* only missing ones */
    assert_int_equal(f->heard.notes, 1);
    assert_same_bytes(f);
}

static void test_a_failing_piece(void **state)
{
    fixture *f = *state;
    squares s = {.failing = 7};
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_ERROR_DATA);
    assert_string_equal(f->heard.error, "square-7: no square today");
    assert_int_equal(f->heard.errors, 1);
    int count = 0;
    free(bytes_of(f->out, &count));
    assert_true(count > 0 && count < PIECES); /* the others stay */
    s.failing = -1;
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_OK);
    assert_same_bytes(f);
}

static void test_damaged_pieces_are_not_believed(void **state)
{
    fixture *f = *state;
    squares s = {.failing = -1};
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_OK);
    char path[512], other[512];
    snprintf(path, sizeof path, "%s/pieces/square-5.json", f->out);
    snprintf(other, sizeof other, "%s/pieces/square-6.json", f->out);
    char *good = read_file(path);
    char *foreign = read_file(other);
    char *digit = strdup(good);
    *strstr(digit, "8.33") = '9';
    char *half = strdup(good);
    half[strlen(half) / 2] = '\0';
    char *longer = gonio_i_format("%s ", good);
    const char *const texts[] = {digit, half, foreign, longer, "", "[]", "{}", "\xff\xfe"};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        s = (squares){.failing = -1};
        f->heard.warnings = 0;
        assert_int_equal(gonio_i_write_text(NULL, path, texts[k]), GONIO_OK);
        assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_OK);
        assert_int_equal(s.total, 1);
        assert_int_equal(s.computed[5], 1);
        assert_int_equal(f->heard.warnings, 1);
        assert_non_null(strstr(f->heard.warning, path));
        assert_same_bytes(f);
    }
    free(longer);
    free(half);
    free(digit);
    free(foreign);
    free(good);
}

static gonio_status open_as(fixture *f, const char *folder, json_t *who)
{
    gonio_i_checkpoint *checkpoint = NULL;
    f->heard.error[0] = '\0';
    const gonio_status status = gonio_i_checkpoint_open(f->context, folder, who, NULL, &checkpoint);
    gonio_i_checkpoint_free(&checkpoint);
    json_decref(who);
    return status;
}

static void assert_tells(const fixture *f, const char *text)
{
    if (strstr(f->heard.error, text) == NULL) {
        fail_msg("'%s' is not in '%s'", text, f->heard.error);
    }
}

static void test_other_runs_are_refused(void **state)
{
    fixture *f = *state;
    assert_int_equal(open_as(f, f->whole, identity(1)), GONIO_OK);
    assert_int_equal(open_as(f, f->whole, identity(2)), GONIO_ERROR_MISMATCH);
    assert_tells(f, "identity.seed is 1 there and 2 here");
    json_t *who = identity(1);
    json_object_set_new(json_object_get(who, "materials"), "gold", json_string("c3"));
    json_object_set_new(json_object_get(who, "materials"), "tin", json_string("d4"));
    assert_int_equal(open_as(f, f->whole, who), GONIO_ERROR_MISMATCH);
    assert_tells(f, "identity.materials.gold is \"a1\" there and \"c3\" here; "
                    "identity.materials.tin is missing there and \"d4\" here");
}

static void test_other_versions_are_refused(void **state)
{
    fixture *f = *state;
    char path[512];
    snprintf(path, sizeof path, "%s/run.json", f->whole);
    json_t *run_file = json_load_file(path, 0, NULL);
    json_object_set_new(run_file, "gonio", json_string("0.0.7"));
    assert_int_equal(json_dump_file(run_file, path, 0), 0);
    json_decref(run_file);
    assert_int_equal(open_as(f, f->whole, identity(1)), GONIO_ERROR_MISMATCH);
    assert_tells(f, "gonio is \"0.0.7\" there and \"");
    assert_int_equal(gonio_i_write_text(NULL, path, "{\"gonio\""), GONIO_OK);
    assert_int_equal(open_as(f, f->whole, identity(1)), GONIO_ERROR_FORMAT);
    assert_tells(f, path);
}

static void test_other_folders_are_refused(void **state)
{
    fixture *f = *state;
    char path[512];
    assert_int_equal(mkdir(f->out, 0777), 0);
    snprintf(path, sizeof path, "%s/run.json.12-0.part", f->out); /* killed at the beginning */
    assert_int_equal(gonio_i_write_text(NULL, path, "{"), GONIO_OK);
    assert_int_equal(open_as(f, f->out, identity(1)), GONIO_OK);

    snprintf(path, sizeof path, "%s/holiday.jpg", f->folder);
    assert_int_equal(gonio_i_write_text(NULL, path, "beach"), GONIO_OK);
    assert_int_equal(open_as(f, f->folder, identity(1)), GONIO_ERROR_ARGUMENT);
    assert_tells(f, "but no run of gonio");
    assert_int_equal(open_as(f, path, identity(1)), GONIO_ERROR_IO); /* a file */
    snprintf(path, sizeof path, "%s/no/where", f->folder);
    assert_int_equal(open_as(f, path, identity(1)), GONIO_ERROR_IO);
    assert_tells(f, path);
}

static void test_two_runs_at_once_are_refused(void **state)
{
    fixture *f = *state;
    gonio_i_checkpoint *checkpoint = NULL;
    json_t *who = identity(1);
    assert_int_equal(gonio_i_checkpoint_open(f->context, f->out, who, NULL, &checkpoint), GONIO_OK);
    assert_int_equal(open_as(f, f->out, json_incref(who)), GONIO_ERROR_ARGUMENT);
    assert_tells(f, "another run is using");
    gonio_i_checkpoint_free(&checkpoint);
    assert_null(checkpoint);
    assert_int_equal(open_as(f, f->out, who), GONIO_OK);
}

/* One after the other, so the last one has all the results. */
static void test_ranks_share_the_work(void **state)
{
    fixture *f = *state;
    for (int size = 2; size <= 3; size++) {
        int barriers = 0, total = 0;
        double cost[3] = {0.0};
        json_t *results[PIECES] = {0};
        snprintf(f->out, sizeof f->out, "%s/ranks-%d", f->folder, size);
        assert_int_equal(open_as(f, f->out, identity(1)), GONIO_OK);
        for (int rank = size - 1; rank >= 0; rank--) {
            squares s = {.failing = -1};
            listener heard;
            gonio_context *context = listen(&heard, 2);
            const process_group group = {rank, size, no_barrier, &barriers};
            if (rank > 0) { /* tells no progress */
                context = (gonio_context_free(&context), support_context());
            }
            assert_int_equal(run(context, f->out, &s, &group, rank == 0 ? results : NULL),
                             GONIO_OK);
            for (int k = 0; k < PIECES; k++) {
                cost[rank] += s.computed[k] * cost_of(NULL, (size_t)k);
            }
            total += s.total;
            gonio_context_free(&context);
        }
        assert_int_equal(total, PIECES);
        assert_int_equal(barriers, 2 * size);
        for (int rank = 0; rank < size; rank++) { /* within one piece of an equal share */
            assert_true(fabs(cost[rank] - 33.0 / size) < 5.0);
        }
        assert_same_bytes(f);
        free_results(results);
    }
}

static const char *hostile(int piece)
{
    static const char *const names[PIECES] = {
        "../../escape",
        "a/b",
        "",
        ".",
        "..",
        "gold \"paint\"",
        "x\ny",
        "\xc3\xa9",
        "`id`",
        "a.b",
        "two words",
        "a very long name, longer than what file systems take, which is 255 bytes: "
        "a very long name, longer than what file systems take, which is 255 bytes: "
        "a very long name, longer than what file systems take, which is 255 bytes: "
        "a very long name, longer than what file systems take, which is 255 bytes"};
    return names[piece];
}

static const char *same(int piece)
{
    return piece == 3 || piece == 8 ? "twin" : hostile(piece);
}

static const char *not_utf8(int piece)
{
    return piece == 3 ? "\xff" : hostile(piece);
}

static void test_names(void **state)
{
    fixture *f = *state;
    squares s = {.failing = -1, .naming = hostile};
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_OK);
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_OK);
    assert_int_equal(s.total, PIECES);
    assert_int_equal(entries_in(f->out, "pieces"), PIECES);
    assert_int_equal(entries_in(f->folder, ""), 2);
    s.naming = same;
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_ERROR_ARGUMENT);
    assert_tells(f, "two computations are called 'twin'");
    s.naming = not_utf8;
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_ERROR_MEMORY);
    assert_tells(f, "not UTF-8");
}

static void test_a_full_disk(void **state)
{
    fixture *f = *state;
    squares s = {.failing = -1};
    char path[512];
    assert_int_equal(open_as(f, f->out, identity(1)), GONIO_OK);
    snprintf(path, sizeof path, "%s/pieces/square-4.json", f->out);
    assert_int_equal(symlink("/dev/full", path), 0);
    assert_int_equal(run(f->context, f->out, &s, NULL, NULL), GONIO_ERROR_IO);
    assert_tells(f, "No space left on device");
}

static void test_without_a_context(void **state)
{
    fixture *f = *state;
    squares s = {.failing = -1};
    assert_int_equal(run(NULL, f->out, &s, NULL, NULL), GONIO_OK);
    assert_same_bytes(f);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_results_come_back_exactly),
        TEST(test_progress_is_by_cost),
        TEST(test_large_pieces_one_at_a_time),
        TEST(test_what_is_not_accepted_is_an_error),
        TEST(test_a_stopped_run_goes_on),
        TEST(test_a_failing_piece),
        TEST(test_damaged_pieces_are_not_believed),
        TEST(test_other_runs_are_refused),
        TEST(test_other_versions_are_refused),
        TEST(test_other_folders_are_refused),
        TEST(test_two_runs_at_once_are_refused),
        TEST(test_ranks_share_the_work),
        TEST(test_names),
        TEST(test_a_full_disk),
        TEST(test_without_a_context),
    };
    return cmocka_run_group_tests_name("pieces", tests, NULL, NULL);
}
