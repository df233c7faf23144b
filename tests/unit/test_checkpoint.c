/* Work in pieces: what was finished stays, what is missing is computed, and the bytes do not depend
 * on how often a run was stopped, on threads or on ranks. */
#include "../support.h"

#include "squares_in_pieces.h"

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
        TEST(test_ranks_share_the_work),
        TEST(test_names),
        TEST(test_a_full_disk),
        TEST(test_without_a_context),
    };
    return cmocka_run_group_tests_name("pieces", tests, NULL, NULL);
}
