/* Tables as text: what is written is read again; what is read is understood. */
#include "../support.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/csv.h"
#include "core/csv_reader.h"

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

/* What spreadsheets and other programs make of a table: the rows below are the same. */
static void test_what_programs_make_of_tables(void **state)
{
    static const char *const texts[] = {
        "# note,,\n# more: 1;,\na,b,\n1.5,-2e3,\n,,\n,,\n",
        "# note;;\n# more: 1;;\na;b\n;\n1,5;-2e3\n",
        "\"# note\"\n\"# more: 1\",\na,b\n1.5,-2e3\n",
        "\"# note\"\t\t\n# more: 1\na\tb\t\t\n1.5\t-2e3\t\t\n",
        "sep=;\n# note\n# more: 1\na;b\n1.5;-2e3\n",
        "\xef\xbb\xbfsep=|\r\n# note\r\n# more: 1\r\na|b\r\n1.5|-2e3\r\n",
        "\"sep=,\"\n# note\n# more: 1\na,b\n1.5,-2e3\n",
        "# note\r# more: 1\ra,b\r1.5,-2e3\r",
        "# note\r\r\n# more: 1\r\r\na,b\r\r\n1.5,-2e3\r\r\n",
        "# note\n# more: 1\na,b,,\n1.5,-2e3\n",
        "# note\n# more: 1\na,b\n1.5,-2e3,,,\n",
        "# note\n\"\",\"\"\n# more: 1\na,b\n \t\n1.5,-2e3\n\"\",\n",
    };
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        gonio_i_csv *csv = read_text(*state, texts[k]);
        double a = 0.0;
        double b = 0.0;
        assert_int_equal(csv->rows, 1);
        assert_true(gonio_i_csv_number(csv, 0, (size_t)gonio_i_csv_column(csv, "a"), &a));
        assert_true(gonio_i_csv_number(csv, 0, (size_t)gonio_i_csv_column(csv, "b"), &b));
        assert_true(a == 1.5 && b == -2000.0);
        assert_int_equal(csv->comment.count, 2);
        assert_string_equal(csv->comment.line[0], "note");
        assert_string_equal(gonio_i_comments_value(&csv->comment, "more"), "1");
        gonio_i_csv_free(&csv);
    }
}

/* A cell may begin with # or hold a line's end, in quotes; a comment may hold quotes. */
static void test_quotes(void **state)
{
    gonio_i_csv *csv =
        read_text(*state, "\"# a \"\"b\"\", c\",\n\"#\",x\n\"#1\",2\n3,\"two\nlines\"\n"
                          "4,5\n");
    assert_int_equal(csv->comment.count, 1);
    assert_string_equal(csv->comment.line[0], "a \"b\", c");
    assert_int_equal(csv->rows, 3);
    assert_string_equal(csv->name[0], "#");
    assert_string_equal(gonio_i_csv_cell(csv, 0, 0), "#1");
    assert_string_equal(gonio_i_csv_cell(csv, 1, 1), "two\nlines");
    assert_int_equal(csv->line[1], 4);
    assert_int_equal(csv->line[2], 6);
    assert_int_equal(gonio_i_csv_write(NULL, csv, ((fixture *)*state)->path), GONIO_OK);
    gonio_i_csv *again = NULL;
    assert_int_equal(gonio_i_csv_read(NULL, ((fixture *)*state)->path, &again), GONIO_OK);
    assert_int_equal(again->rows, 3);
    assert_string_equal(gonio_i_csv_cell(again, 1, 1), "two\nlines");
    assert_string_equal(gonio_i_csv_cell(again, 0, 0), "#1");
    gonio_i_csv_free(&csv);
    gonio_i_csv_free(&again);
}

/* Numbers are those of strtod, to the last bit. */
static void test_numbers_are_those_of_strtod(void **state)
{
    (void)state;
    static const char *const cells[] = {
        "0",
        "-0",
        "0.1",
        ".5",
        "5.",
        "-12.75",
        "42.490980836",
        "1e-7",
        "3.14159",
        "0.3",
        "1234567890.12345",
        "999999999999999",
        "0.00000000000001",
        "9007199254740993",
        "0.1000000000000000055511151231257827",
        "123456.7890123456",
        "+1.5",
        "0x10",
        "inf",
        "1E5",
        "00000000000000000001",
    };
    unsigned seed = 1;
    for (size_t k = 0; k < 20000; k++) {
        char random[32];
        char *end = NULL;
        double value = 0.0;
        seed = seed * 1664525U + 1013904223U;
        snprintf(random, sizeof random, "%.*f", (int)(seed >> 16) % 13, seed / 1e4 - 2e5);
        const char *cell = k < sizeof cells / sizeof *cells ? cells[k] : random;
        assert_true(gonio_i_csv_is_number(cell, ',', &value));
        const double expected = strtod(cell, &end);
        if (memcmp(&value, &expected, sizeof value) != 0) {
            fail_msg("%s: %.17g, not %.17g", cell, value, expected);
        }
    }
    double value = 0.0;
    assert_true(gonio_i_csv_is_number("-2.5D-03", ',', &value) && value == -2.5e-3); /* Fortran */
    assert_true(gonio_i_csv_is_number("4,5d2", ';', &value) && value == 450.0);
    static const char *const others[] = {"",    "-",  ".",  "-.", "1.2.3", "1,2",  "1 ",
                                         "--1", "1x", "1D", "D2", "1D-",   "1D2.5"};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        if (gonio_i_csv_is_number(others[k], ',', &value)) {
            fail_msg("'%s' is no number", others[k]);
        }
    }
}

/* ---- encodings ---- */

/* A text of ASCII and the letter U+00B5 for each '~', as UTF-16. */
static size_t as_utf16(const char *text, bool big, bool marked, char *to)
{
    size_t size = 0;
    for (const char *at = marked ? "\x01" : text; at != NULL; at = *at == '\x01' ? text : at + 1) {
        const unsigned unit = *at == '\x01' ? 0xfeff : *at == '~' ? 0xb5 : (unsigned char)*at;
        if (unit == 0) {
            break;
        }
        to[size++] = (char)(big ? unit >> 8 : unit & 0xff);
        to[size++] = (char)(big ? unit & 0xff : unit >> 8);
    }
    return size;
}

static void write_bytes(const fixture *f, const char *bytes, size_t size)
{
    FILE *file = fopen(f->path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void test_utf16(void **state)
{
    const fixture *f = *state;
    static const char text[] = "# ~m\r\nfirst\tsecond\r\n1,5\tx\r\n2,5\t\r\n";
    for (int k = 0; k < 4; k++) {
        char bytes[256];
        gonio_i_csv *csv = NULL;
        double value = 0.0;
        const char *from = k >= 2 ? strchr(text, 'f') : text; /* without a mark plain ASCII only */
        write_bytes(f, bytes, as_utf16(from, k % 2 == 1, k < 2, bytes));
        assert_int_equal(gonio_i_csv_read(f->context, f->path, &csv), GONIO_OK);
        assert_int_equal(csv->rows, 2);
        assert_true(gonio_i_csv_number(csv, 1, 0, &value) && value == 2.5);
        if (k < 2) {
            assert_string_equal(csv->comment.line[0], "\xc2\xb5m");
        }
        gonio_i_csv_free(&csv);
    }
}

static void test_broken_utf16(void **state)
{
    const fixture *f = *state;
    /* a high half alone, a pair, a low half, half a character at the end */
    static const char bytes[] = "\xff\xfe"
                                "a\0\n\0"
                                "\x3d\xd8,\0"
                                "\n\0\x3d\xd8\x00\xde\n\0"
                                "\x00\xde\n\0b";
    gonio_i_csv *csv = NULL;
    write_bytes(f, bytes, sizeof bytes - 1);
    assert_int_equal(gonio_i_csv_read(f->context, f->path, &csv), GONIO_OK);
    assert_int_equal(csv->rows, 4);
    assert_string_equal(gonio_i_csv_cell(csv, 0, 0), "\xef\xbf\xbd");
    assert_string_equal(gonio_i_csv_cell(csv, 1, 0), "\xf0\x9f\x98\x80");
    assert_string_equal(gonio_i_csv_cell(csv, 2, 0), "\xef\xbf\xbd");
    assert_string_equal(gonio_i_csv_cell(csv, 3, 0), "\xef\xbf\xbd");
    gonio_i_csv_free(&csv);
    write_bytes(f, "\xff\xfe\0\0a\0", 6);
    assert_int_equal(gonio_i_csv_read(f->context, f->path, &csv), GONIO_ERROR_FORMAT);
    write_bytes(f, "\xff\xfe", 2);
    assert_int_equal(gonio_i_csv_read(f->context, f->path, &csv), GONIO_ERROR_FORMAT);
    write_bytes(f, "\xff", 1);
    assert_int_equal(gonio_i_csv_read(f->context, f->path, &csv), GONIO_OK);
    gonio_i_csv_free(&csv);
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
        cmocka_unit_test_setup_teardown(test_what_programs_make_of_tables, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_quotes, set_up, tear_down),
        cmocka_unit_test(test_numbers_are_those_of_strtod),
        cmocka_unit_test_setup_teardown(test_utf16, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_broken_utf16, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_what_is_no_number, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_notes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_locale_does_not_matter, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("csv", tests, NULL, NULL);
}
