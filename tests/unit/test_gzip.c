/* Texts compressed with gzip: whole, of several members, with zeros behind them; refused where they
 * were changed. */
#include "../support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <zlib.h>

#include "core/text_file.h"

static const char first[] = "theta_i_deg,theta_o_deg\n";
static const char second[] = "10,20\n30,40\n";

/* A file to try, piece by piece. */
typedef struct file {
    char *folder;
    char path[256];
} file;

static int set_up(void **state)
{
    static file f;
    f.folder = support_folder();
    snprintf(f.path, sizeof f.path, "%s/text.gz", f.folder);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    const file *f = *state;
    support_remove(f->folder);
    return 0;
}

/* mode: "wb" begins a file, "ab" appends a member. */
static void write_member(const file *f, const char *mode, const char *text)
{
    gzFile to = gzopen(f->path, mode);
    assert_non_null(to);
    assert_int_equal(gzwrite(to, text, (unsigned)strlen(text)), (int)strlen(text));
    assert_int_equal(gzclose(to), Z_OK);
}

static void append(const file *f, const char *bytes, size_t size)
{
    FILE *to = fopen(f->path, "ab");
    assert_non_null(to);
    assert_int_equal(fwrite(bytes, 1, size, to), size);
    assert_int_equal(fclose(to), 0);
}

static void check_text(const file *f, const char *expected)
{
    char *text = NULL;
    size_t size = 0;
    assert_int_equal(gonio_i_text_read(NULL, f->path, &text, &size), GONIO_OK);
    assert_int_equal(size, strlen(expected));
    assert_string_equal(text, expected);
    free(text);
}

static void check_refused(const file *f)
{
    char *text = NULL;
    size_t size = 0;
    assert_int_equal(gonio_i_text_read(NULL, f->path, &text, &size), GONIO_ERROR_FORMAT);
    assert_null(text);
}

static void test_appended_members_are_one_text(void **state)
{
    const file *f = *state;
    char both[sizeof first + sizeof second];
    snprintf(both, sizeof both, "%s%s", first, second);
    write_member(f, "wb", first);
    check_text(f, first);
    write_member(f, "ab", second);
    check_text(f, both);
}

static void test_zeros_behind_the_text(void **state)
{
    const file *f = *state;
    static const char zeros[512] = {0};
    write_member(f, "wb", first);
    append(f, zeros, sizeof zeros);
    check_text(f, first);
}

static void test_nothing_is_left_out(void **state)
{
    const file *f = *state;
    write_member(f, "wb", first);
    append(f, second, strlen(second)); /* not compressed */
    check_refused(f);
    write_member(f, "wb", first);
    append(f, "\x1f\x8b\x08", 3); /* a member cut short */
    check_refused(f);
}

/* 24 MiB in 24 kB: no table. */
static void test_what_fills_the_memory_is_refused(void **state)
{
    enum { BLOCK = 1 << 20, BLOCKS = 24 };
    const file *f = *state;
    gonio_context *context = support_context();
    char *block = malloc(BLOCK);
    char *text = NULL;
    size_t size = 0;
    gzFile to = gzopen(f->path, "wb");
    assert_true(block != NULL && to != NULL);
    memset(block, '0', BLOCK);
    for (int k = 0; k < BLOCKS; k++) {
        assert_int_equal(gzwrite(to, block, BLOCK), BLOCK);
    }
    assert_int_equal(gzclose(to), Z_OK);
    assert_int_equal(gonio_i_text_read(context, f->path, &text, &size), GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), " MiB once decompressed"));
    assert_null(text);
    free(block);
    gonio_context_free(&context);
}

int GONIO_TEST(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_appended_members_are_one_text, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_zeros_behind_the_text, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_nothing_is_left_out, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_what_fills_the_memory_is_refused, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("gzip", tests, NULL, NULL);
}
