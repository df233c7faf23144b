/* Tables as text: what is written is read again; what is read is understood. */
#include "../support.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/csv.h"

typedef struct fixture {
    char *folder;
    char path[256];
    gonio_context *context;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->folder = support_folder();
    snprintf(f->path, sizeof f->path, "%s/table.csv", f->folder);
    f->context = support_context();
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_context_free(&f->context);
    support_remove(f->folder);
    free(f);
    return 0;
}

static void write_text(const fixture *f, const char *text)
{
    FILE *file = fopen(f->path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static gonio_i_csv *read_text(const fixture *f, const char *text)
{
    gonio_i_csv *csv = NULL;
    write_text(f, text);
    if (gonio_i_csv_read(f->context, f->path, &csv) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    return csv;
}

static void assert_refused(const fixture *f, const char *text, const char *message)
{
    gonio_i_csv *csv = NULL;
    write_text(f, text);
    assert_int_equal(gonio_i_csv_read(f->context, f->path, &csv), GONIO_ERROR_FORMAT);
    assert_null(csv);
    assert_non_null(strstr(support_message(), f->path));
    if (strstr(support_message(), message) == NULL) {
        fail_msg("'%s' lacks '%s'", support_message(), message);
    }
}

static void test_what_is_written_is_read(void **state)
{
    const fixture *f = *state;
    static const char *const cells[] = {"plain",    "",      "a,b",  "say \"hi\"",
                                        " leading", "#hash", "ünder"};
    enum { CELLS = sizeof cells / sizeof *cells };
    gonio_i_csv *csv = gonio_i_csv_create(NULL);
    gonio_i_csv *again = NULL;
    assert_non_null(csv);
    assert_true(gonio_i_comments_add(&csv->comment, "key: %d", 5));
    assert_true(gonio_i_csv_add_column(csv, "first"));
    for (size_t k = 0; k < CELLS; k++) {
        assert_true(gonio_i_csv_add_row(csv, 0));
        assert_true(gonio_i_csv_set(csv, k, 0, "%zu", k));
    }
    assert_true(gonio_i_csv_add_column(csv, "second, with a comma"));
    for (size_t k = 0; k < CELLS; k++) {
        assert_string_equal(gonio_i_csv_cell(csv, k, 1), "");
        assert_true(gonio_i_csv_set(csv, k, 1, "%s", cells[k]));
    }
    assert_int_equal(gonio_i_csv_write(f->context, csv, f->path), GONIO_OK);
    assert_int_equal(gonio_i_csv_read(f->context, f->path, &again), GONIO_OK);
    assert_int_equal(again->rows, CELLS);
    assert_int_equal(again->columns, 2);
    assert_string_equal(gonio_i_comments_value(&again->comment, "key"), "5");
    assert_int_equal(gonio_i_csv_column(again, "SECOND, with a comma"), 1);
    for (size_t k = 0; k < CELLS; k++) {
        double number = -1.0;
        assert_string_equal(gonio_i_csv_cell(again, k, 1), cells[k]);
        assert_true(gonio_i_csv_number(again, k, 0, &number));
        assert_true(number == (double)k);
        assert_int_equal(again->line[k], k + 3);
    }
    gonio_i_csv_free(&csv);
    gonio_i_csv_free(&again);
    assert_null(again);
}

static void test_dialects(void **state)
{
    static const char *const texts[] = {
        "a,b\n1.5,-2e3\n",
        "\xef\xbb\xbf"
        "a,b\r\n1.5,-2e3\r\n",
        "a;b\n1,5;-2e3\n",
        "a\tb\n1,5\t-2e3",
        "\n  \n# note\na , b\n\n 1.5 , -2e3 \n# end",
        "\"a\",\"b\"\n\"1.5\",\"-2e3\"\n",
    };
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        gonio_i_csv *csv = read_text(*state, texts[k]);
        double a = 0.0;
        double b = 0.0;
        assert_int_equal(csv->rows, 1);
        assert_true(gonio_i_csv_number(csv, 0, (size_t)gonio_i_csv_column(csv, "a"), &a));
        assert_true(gonio_i_csv_number(csv, 0, (size_t)gonio_i_csv_column(csv, "b"), &b));
        assert_true(a == 1.5 && b == -2000.0);
        assert_int_equal(gonio_i_csv_column(csv, "c"), -1);
        gonio_i_csv_free(&csv);
    }
}

static void test_what_is_no_number(void **state)
{
    gonio_i_csv *csv = read_text(*state, "a;b\n;1.2.3\nx;1,2,3\n1 2;1e\n");
    for (size_t k = 0; k < csv->rows * csv->columns; k++) {
        double value = 0.0;
        assert_false(gonio_i_csv_number(csv, k / 2, k % 2, &value));
    }
    gonio_i_csv_free(&csv);
}

static void test_notes(void **state)
{
    gonio_i_csv *csv = read_text(*state, "# a: 1\n#b:2\n#   a: 3\n# ab: 4\nx\n");
    assert_string_equal(gonio_i_comments_value(&csv->comment, "a"), "1");
    assert_string_equal(gonio_i_comments_value(&csv->comment, "b"), "2");
    assert_null(gonio_i_comments_value(&csv->comment, "c"));
    gonio_i_comments_drop(&csv->comment, "a");
    assert_null(gonio_i_comments_value(&csv->comment, "a"));
    assert_string_equal(gonio_i_comments_value(&csv->comment, "ab"), "4");
    assert_int_equal(csv->comment.count, 2);
    gonio_i_csv_free(&csv);
}

static void test_refused(void **state)
{
    assert_refused(*state, "", "the file is empty");
    assert_refused(*state, "\n# only this\n", "no line of column names");
    assert_refused(*state, "a,b\n1,2\n1\n", ":3: 1 cells where the header names 2 columns");
    assert_refused(*state, "a,A\n", ":1: column 'A' occurs twice");
    assert_refused(*state, "a,b\n1,\"2\n", ":2: quotes");
    assert_refused(*state, "a,b\n1,\x02\n", ":2: binary data");
    assert_int_equal(gonio_i_csv_read(((fixture *)*state)->context, "/", &(gonio_i_csv *){NULL}),
                     GONIO_ERROR_IO);
}

/* A program in another locale reads and writes the same files. */
static void test_locale_does_not_matter(void **state)
{
    static const char *const locales[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    size_t k = 0;
    while (k < sizeof locales / sizeof *locales && setlocale(LC_ALL, locales[k]) == NULL) {
        k++;
    }
    char sample[16];
    snprintf(sample, sizeof sample, "%.1f", 1.5);
    if (strcmp(sample, "1,5") != 0) {
        setlocale(LC_ALL, "C");
        print_message("not tested: no locale with decimal commas is installed\n");
        return;
    }
    gonio_i_csv *csv = read_text(*state, "a,b\n1.5,2\n");
    double value = 0.0;
    const bool read = gonio_i_csv_number(csv, 0, 0, &value);
    const bool set = gonio_i_csv_set(csv, 0, 1, "%.1f", 2.5);
    setlocale(LC_ALL, "C");
    assert_true(read && value == 1.5);
    assert_true(set);
    assert_string_equal(gonio_i_csv_cell(csv, 0, 1), "2.5");
    gonio_i_csv_free(&csv);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_what_is_written_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_dialects, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_what_is_no_number, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_notes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_locale_does_not_matter, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("csv", tests, NULL, NULL);
}
