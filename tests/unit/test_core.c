/* The context's messages, outputs that appear whole or not at all, random numbers. */
#include "../support.h"

#include <dirent.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cblas.h>

#include "core/core.h"
#include "core/output.h"
#include "core/random.h"
#include "linalg/linalg.h"

/* ---- context ---- */

static int messages = 0;

static void count_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    (void)level;
    (void)text;
    messages++;
}

static void test_a_message_is_one_line(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    assert_int_equal(gonio_i_fail(context, GONIO_ERROR_DATA, "a\nb\r\x1b[31mc\xc3\xa9"),
                     GONIO_ERROR_DATA);
    assert_string_equal(support_message(), "a?b??[31mc\xc3\xa9");
    assert_int_equal(gonio_i_fail(NULL, GONIO_ERROR_IO, "nobody listens"), GONIO_ERROR_IO);
    gonio_context_free(&context);
    assert_null(context);
}

static void test_a_shared_context_tells_its_first_error_only(void **state)
{
    (void)state;
    gonio_context *context = NULL;
    const gonio_context_options options = {
        .size = sizeof options, .message = count_message, .threads = 2};
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    for (int time = 1; time <= 2; time++) {
        gonio_context *shared = gonio_i_shared_context_begin(context);
        gonio_context *inner = gonio_i_shared_context_begin(shared);
        messages = 0;
#pragma omp parallel for num_threads(4)
        for (int k = 0; k < 100; k++) {
            gonio_i_fail(k % 2 ? inner : shared, GONIO_ERROR_IO, "error %d", k);
        }
        assert_int_equal(messages, 1);
        gonio_i_warn(inner, "warnings all come through");
        gonio_i_note(shared, "and notes");
        assert_int_equal(messages, 3);
        assert_int_equal(gonio_context_threads(shared), gonio_context_threads(context));
        gonio_i_shared_context_end(inner, shared);
        gonio_i_shared_context_end(shared, context);
    }
    assert_null(gonio_i_shared_context_begin(NULL));
    gonio_context_free(&context);
}

static int stop_at_half(void *user, const char *task, double fraction)
{
    (void)user;
    (void)task;
    return fraction >= 0.5;
}

static int cancel_if_asked(void *user, const char *task, double fraction)
{
    (void)task;
    (void)fraction;
    return *(const int *)user;
}

static void test_a_shared_context_can_be_cancelled(void **state)
{
    (void)state;
    gonio_context *context = NULL;
    const gonio_context_options options = {.size = sizeof options, .progress = stop_at_half};
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    gonio_context *shared = gonio_i_shared_context_begin(context);
    assert_int_equal(gonio_i_progress(shared, "work", 0.2), GONIO_OK);
    assert_int_equal(gonio_i_progress(shared, "work", 0.7), GONIO_ERROR_CANCELLED);
    assert_int_equal(gonio_i_progress(context, "work", 0.3), GONIO_ERROR_CANCELLED);
    gonio_i_shared_context_end(shared, context);
    gonio_context_free(&context);
}

/* What cancels a context does so until it is told to go on. */
static void test_a_cancelled_context_can_work_again(void **state)
{
    (void)state;
    int cancel = 1;
    gonio_context *context = NULL;
    const gonio_context_options options = {
        .size = sizeof options, .progress = cancel_if_asked, .user = &cancel};
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    assert_int_equal(gonio_material_open(context, "atlas:gold-polished", &material), GONIO_OK);
    assert_int_equal(gonio_table_load(context, material, &table), GONIO_ERROR_CANCELLED);
    cancel = 0;
    assert_int_equal(gonio_table_load(context, material, &table), GONIO_ERROR_CANCELLED);
    assert_null(table);
    gonio_context_resume(context);
    assert_int_equal(gonio_table_load(context, material, &table), GONIO_OK);
    gonio_table_free(&table);
    cancel = 1;
    assert_int_equal(gonio_table_load(context, material, &table), GONIO_ERROR_CANCELLED);
    assert_null(table);
    gonio_context_resume(NULL);
    gonio_material_free(&material);
    gonio_context_free(&context);
}

static char told[256];

static int note_progress(void *user, const char *task, double fraction)
{
    (void)user;
    snprintf(told, sizeof told, "%s %.2f", task, fraction);
    return fraction >= 0.5;
}

static void note_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    (void)level;
    snprintf(told, sizeof told, "%s", text);
}

static void test_a_piece_is_part_of_a_whole(void **state)
{
    (void)state;
    gonio_context *context = NULL;
    const gonio_context_options options = {
        .size = sizeof options, .message = note_message, .progress = note_progress, .threads = 2};
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    gonio_context *shared = gonio_i_shared_context_begin(context);
    gonio_context *piece = NULL, *inner = NULL;
    assert_int_equal(gonio_i_piece_begin(shared, "gold", &piece), GONIO_OK);
    assert_int_equal(gonio_i_piece_begin(piece, "start 2", &inner), GONIO_OK);
    assert_int_equal(gonio_context_threads(piece), 1);
    assert_int_equal(gonio_i_progress(piece, "inside", 1.0), GONIO_OK);
    assert_string_equal(told, " 0.00");
    assert_int_equal(gonio_i_progress(shared, "whole", 0.25), GONIO_OK);
    assert_int_equal(gonio_i_progress(inner, "inside", 1.0), GONIO_OK);
    assert_string_equal(told, "whole 0.25");
    gonio_i_warn(inner, "%s", "dull");
    assert_string_equal(told, "gold: start 2: dull");
    gonio_i_fail(piece, GONIO_ERROR_DATA, "first");
    gonio_i_fail(inner, GONIO_ERROR_DATA, "second, which the shared context keeps to itself");
    assert_string_equal(told, "gold: first");
    assert_int_equal(gonio_i_progress(shared, "whole", 0.75), GONIO_ERROR_CANCELLED);
    assert_int_equal(gonio_i_progress(inner, "inside", 0.1), GONIO_ERROR_CANCELLED);
    gonio_i_piece_end(inner);
    gonio_i_piece_end(piece);
    gonio_i_shared_context_end(shared, context);
    gonio_context_free(&context);

    assert_int_equal(gonio_i_piece_begin(NULL, "alone", &piece), GONIO_OK);
    assert_int_equal(gonio_i_progress(piece, "inside", 0.5), GONIO_OK);
    assert_int_equal(gonio_i_fail(piece, GONIO_ERROR_IO, "nobody listens"), GONIO_ERROR_IO);
    gonio_i_piece_end(piece);
}

static void test_threads(void **state)
{
    (void)state;
    gonio_context *context = NULL;
    gonio_context_options options = {.size = sizeof options, .threads = 1000000};
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    assert_true(gonio_context_threads(context) <= 16 * omp_get_num_procs());
    gonio_context_free(&context);
    options.threads = 2;
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    assert_int_equal(gonio_context_threads(context), 2);
    gonio_context_free(&context);
    options.threads = -1;
    assert_int_equal(gonio_context_create(&context, &options), GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_context_threads(NULL), omp_get_num_procs());
}

/* Neither the library's threads in those of its caller, nor OpenBLAS's in the library's, whether
 * there is a context or not. */
static void test_threads_do_not_nest(void **state)
{
    (void)state;
    double gram[4] = {0.0};
    const double a[4] = {1.0, 2.0, 3.0, 4.0};
    double triangle[1] = {2.0};
    int inside[2] = {0, 0};
#pragma omp parallel num_threads(2)
    inside[omp_get_thread_num()] = gonio_context_threads(NULL);
    assert_true(inside[0] == 1 && inside[1] == 1);
    openblas_set_num_threads(2);
    assert_int_equal(gonio_context_threads(NULL), omp_get_num_procs());
    assert_int_equal(openblas_get_num_threads(), 1);
    openblas_set_num_threads(2);
    assert_int_equal(gonio_i_add_gram_rows(NULL, a, 2, 2, gram), GONIO_OK);
    assert_int_equal(openblas_get_num_threads(), 1);
    openblas_set_num_threads(2);
    gonio_i_divide_lower(triangle, 1, 1, a);
    assert_int_equal(openblas_get_num_threads(), 1);
}

static void test_names(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"gold.binary", "gold"}, {"a/b.c/gold.v2.h5", "gold.v2"}, {"/.hidden", ".hidden"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *name = gonio_i_base_name(cases[k][0], false);
        assert_string_equal(name, cases[k][1]);
        free(name);
    }
    assert_string_equal(gonio_status_text(GONIO_ERROR_MEMORY), "out of memory");
    assert_string_equal(gonio_status_text(-1), "unknown status");
    assert_string_equal(gonio_status_text(1000), "unknown status");
}

/* ---- outputs ---- */

static int entries_in(const char *folder)
{
    int count = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    while (readdir(directory) != NULL) {
        count++;
    }
    closedir(directory);
    return count - 2; /* . and .. */
}

static void assert_contents(const char *path, const char *expected)
{
    char text[64] = "";
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t size = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[size] = '\0';
    assert_string_equal(text, expected);
}

static gonio_status write_output(const char *path, const char *text, gonio_status status)
{
    gonio_i_output output;
    const gonio_status opened = gonio_i_output_open(NULL, path, &output);
    if (opened != GONIO_OK) {
        return opened;
    }
    assert_int_equal(gonio_i_output_write(NULL, &output, text, strlen(text)), GONIO_OK);
    return gonio_i_output_close(NULL, &output, status);
}

static void test_an_output_appears_whole_or_not_at_all(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256], link[256];
    snprintf(path, sizeof path, "%s/file", folder);
    snprintf(link, sizeof link, "%s/link", folder);

    gonio_i_output output;
    assert_int_equal(gonio_i_output_open(NULL, path, &output), GONIO_OK);
    assert_int_equal(gonio_i_output_write(NULL, &output, "ab..ef", 6), GONIO_OK);
    assert_int_equal(gonio_i_output_write_at(NULL, &output, "cd", 2, 2), GONIO_OK);
    assert_int_equal(access(path, F_OK), -1); /* not before it is whole */
    assert_int_equal(gonio_i_output_close(NULL, &output, GONIO_OK), GONIO_OK);
    assert_contents(path, "abcdef");
    assert_int_equal(entries_in(folder), 1);

    assert_int_equal(write_output(path, "half", GONIO_ERROR_DATA), GONIO_ERROR_DATA);
    assert_contents(path, "abcdef");
    assert_int_equal(entries_in(folder), 1);

    assert_int_equal(write_output(path, "new", GONIO_OK), GONIO_OK);
    assert_contents(path, "new");

    assert_int_equal(symlink("file", link), 0);
    assert_int_equal(write_output(link, "through", GONIO_OK), GONIO_OK);
    assert_contents(path, "through");
    assert_int_equal(entries_in(folder), 2);
    support_remove(folder);
}

static void test_outputs_that_cannot_be(void **state)
{
    (void)state;
    char *folder = support_folder();
    char nowhere[256];
    gonio_i_output output;
    gonio_context *context = support_context();
    snprintf(nowhere, sizeof nowhere, "%s/nowhere/file", folder);
    assert_int_equal(gonio_i_output_open(context, nowhere, &output), GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), nowhere));
    assert_int_equal(gonio_i_output_open(context, folder, &output), GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), "Is a directory"));
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(gonio_i_output_open(context, "/dev/full", &output), GONIO_OK);
        assert_int_equal(gonio_i_output_write(context, &output, "x", 1), GONIO_ERROR_IO);
        assert_int_equal(gonio_i_output_close(context, &output, GONIO_ERROR_IO), GONIO_ERROR_IO);
    }
    assert_int_equal(entries_in(folder), 0);
    gonio_context_free(&context);
    support_remove(folder);
}

/* The entries of a folder. */
static int count_entries(const char *folder)
{
    int count = 0;
    DIR *entries = opendir(folder);
    assert_non_null(entries);
    while (readdir(entries) != NULL) {
        count++;
    }
    closedir(entries);
    return count - 2;
}

static void write_letters(gonio_context *context, const char *path)
{
    gonio_i_output output;
    assert_int_equal(gonio_i_output_open(context, path, &output), GONIO_OK);
    const gonio_status status = gonio_i_output_write(context, &output, "abc", 3);
    assert_int_equal(gonio_i_output_close(context, &output, status), GONIO_OK);
}

/* None is there until all are. */
static void test_outputs_that_appear_together(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[2][512];
    gonio_context *context = support_context();
    for (int k = 0; k < 2; k++) {
        snprintf(path[k], sizeof path[k], "%s/%d", folder, k);
    }
    for (int good = 0; good < 2; good++) {
        assert_int_equal(gonio_outputs_hold(context), GONIO_OK);
        assert_int_equal(gonio_outputs_hold(context), GONIO_ERROR_ARGUMENT);
        write_letters(context, path[0]);
        gonio_context *shared = gonio_i_shared_context_begin(context);
        write_letters(shared, path[1]);
        gonio_i_shared_context_end(shared, context);
        assert_int_not_equal(access(path[0], F_OK), 0);
        assert_int_not_equal(access(path[1], F_OK), 0);
        const gonio_status status = good ? GONIO_OK : GONIO_ERROR_DATA;
        assert_int_equal(gonio_outputs_release(context, status), status);
        assert_int_equal(count_entries(folder), good ? 2 : 0);
    }
    write_letters(context, path[0]); /* held no longer */
    assert_int_equal(gonio_outputs_release(context, GONIO_ERROR_IO), GONIO_ERROR_IO);
    assert_int_equal(gonio_outputs_hold(NULL), GONIO_ERROR_ARGUMENT);
    assert_int_equal(count_entries(folder), 2);
    gonio_context_free(&context);
    support_remove(folder);
}

/* One that cannot be put in place any more takes those after it with it. */
static void test_held_outputs_without_a_place(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[2][512];
    gonio_context *context = support_context();
    for (int k = 0; k < 2; k++) {
        snprintf(path[k], sizeof path[k], "%s/%d", folder, k);
    }
    assert_int_equal(gonio_outputs_hold(context), GONIO_OK);
    write_letters(context, path[0]);
    write_letters(context, path[1]);
    assert_int_equal(mkdir(path[0], 0700), 0);
    assert_int_equal(gonio_outputs_release(context, GONIO_OK), GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), "/0: cannot write"));
    assert_int_equal(count_entries(folder), 1);
    gonio_context_free(&context);
    support_remove(folder);
}

/* Its mode, and a link to it. */
static void test_what_an_output_replaces_stays(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[512];
    char link[512];
    struct stat about;
    snprintf(path, sizeof path, "%s/file", folder);
    snprintf(link, sizeof link, "%s/link", folder);
    assert_int_equal(symlink("file", link), 0); /* to what is not there yet */
    write_letters(NULL, link);
    assert_int_equal(lstat(link, &about), 0);
    assert_true(S_ISLNK(about.st_mode));
    assert_int_equal(chmod(path, 0640), 0);
    write_letters(NULL, link);
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_mode & 07777, 0640);
    assert_int_equal(about.st_size, 3);
    assert_int_equal(count_entries(folder), 2);
    support_remove(folder);
}

static void test_a_long_name(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[1024];
    snprintf(path, sizeof path, "%s/%0250d", folder, 7);
    write_letters(NULL, path);
    assert_int_equal(access(path, F_OK), 0);
    assert_int_equal(count_entries(folder), 1);
    support_remove(folder);
}

/* ---- random numbers ---- */

/* The generator's published answers, and those of an independent implementation of the seeding. */
static void test_known_random_numbers(void **state)
{
    (void)state;
    gonio_i_random random = {{1, 2, 3, 4}};
    assert_true(gonio_i_random_next(&random) == UINT64_C(11520));
    assert_true(gonio_i_random_next(&random) == UINT64_C(0));
    assert_true(gonio_i_random_next(&random) == UINT64_C(1509978240));
    assert_true(gonio_i_random_next(&random) == UINT64_C(1215971899390074240));
    static const struct {
        uint64_t seed, stream, first;
    } seeds[] = {{0, 0, UINT64_C(0xfb5405f7bd79c540)},
                 {2023, 0, UINT64_C(0x81e94ca48a7ef3b4)},
                 {2023, 1, UINT64_C(0x1ee853ff7d6b7544)}};
    for (size_t k = 0; k < sizeof seeds / sizeof *seeds; k++) {
        gonio_i_random_seed(&random, seeds[k].seed, seeds[k].stream);
        assert_true(gonio_i_random_next(&random) == seeds[k].first);
    }
}

/* Mean and variance of a million numbers, within five standard errors. */
static void test_moments(void **state)
{
    (void)state;
    enum { COUNT = 1000000 };
    gonio_i_random random;
    double uniform[2] = {0.0, 0.0};
    double normal[2] = {0.0, 0.0};
    gonio_i_random_seed(&random, 11, 0);
    for (int k = 0; k < COUNT; k++) {
        const double u = gonio_i_random_uniform(&random);
        const double z = gonio_i_random_normal(&random);
        assert_true(u > 0.0 && u < 1.0);
        assert_true(isfinite(z));
        uniform[0] += u / COUNT;
        uniform[1] += (u - 0.5) * (u - 0.5) / COUNT;
        normal[0] += z / COUNT;
        normal[1] += z * z / COUNT;
    }
    assert_true(fabs(uniform[0] - 0.5) < 5.0 * 0.289 / 1000.0);
    assert_true(fabs(uniform[1] - 1.0 / 12.0) < 5.0 * 0.0745 / 1000.0);
    assert_true(fabs(normal[0]) < 5.0 / 1000.0);
    assert_true(fabs(normal[1] - 1.0) < 5.0 * 1.414 / 1000.0);
}

/* Each number is drawn as often as any other: chi-squared with 6 degrees of freedom, of which one
 * in a million is above 38. */
static void test_below_is_unbiased(void **state)
{
    (void)state;
    enum { COUNT = 700000 };
    gonio_i_random random;
    double drawn[7] = {0};
    double chi_squared = 0.0;
    gonio_i_random_seed(&random, 12, 0);
    for (int k = 0; k < COUNT; k++) {
        drawn[gonio_i_random_below(&random, 7)]++;
    }
    for (int k = 0; k < 7; k++) {
        chi_squared += (drawn[k] - COUNT / 7.0) * (drawn[k] - COUNT / 7.0) / (COUNT / 7.0);
    }
    assert_true(chi_squared < 38.0);
    assert_true(gonio_i_random_below(&random, 1) == 0);
}

static void test_subsets(void **state)
{
    (void)state;
    enum { N = 12, TRIALS = 60000 };
    gonio_i_random random;
    gonio_i_random_seed(&random, 13, 0);
    for (size_t count = 0; count <= N; count++) {
        double chosen[N] = {0};
        for (int trial = 0; trial < TRIALS; trial++) {
            unsigned char used[N] = {0};
            size_t subset[N];
            gonio_i_random_subset(&random, N, count, used, subset);
            for (size_t k = 0; k < count; k++) {
                assert_true(subset[k] < N && (k == 0 || subset[k] > subset[k - 1]));
                chosen[subset[k]]++;
            }
        }
        for (size_t k = 0; k < N; k++) { /* within five standard errors */
            const double share = (double)count / N;
            assert_true(fabs(chosen[k] / TRIALS - share) <=
                        5.0 * sqrt(share * (1.0 - share) / TRIALS));
        }
    }
}

static void test_the_version_as_a_number(void **state)
{
    (void)state;
    const int number = gonio_version_number();
    char text[32];
    snprintf(text, sizeof text, "%d.%d.%d", number / 10000, number / 100 % 100, number % 100);
    assert_string_equal(text, gonio_version());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_message_is_one_line),
        cmocka_unit_test(test_a_shared_context_tells_its_first_error_only),
        cmocka_unit_test(test_a_shared_context_can_be_cancelled),
        cmocka_unit_test(test_a_cancelled_context_can_work_again),
        cmocka_unit_test(test_a_piece_is_part_of_a_whole),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_threads_do_not_nest),
        cmocka_unit_test(test_the_version_as_a_number),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_an_output_appears_whole_or_not_at_all),
        cmocka_unit_test(test_outputs_that_cannot_be),
        cmocka_unit_test(test_outputs_that_appear_together),
        cmocka_unit_test(test_held_outputs_without_a_place),
        cmocka_unit_test(test_what_an_output_replaces_stays),
        cmocka_unit_test(test_a_long_name),
        cmocka_unit_test(test_known_random_numbers),
        cmocka_unit_test(test_moments),
        cmocka_unit_test(test_below_is_unbiased),
        cmocka_unit_test(test_subsets),
    };
    return cmocka_run_group_tests_name("core", tests, NULL, NULL);
}
