/* Safetensors files: what is written is read again; no lie in a header is believed. */
#include "../support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/safetensors.h"

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
    snprintf(f->path, sizeof f->path, "%s/file.safetensors", f->folder);
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

/* The bytes of a file, aligned, with one byte more that is 0. */
static char *load(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *bytes = aligned_alloc(64, 1 << 16);
    assert_non_null(bytes);
    *size = fread(bytes, 1, (1 << 16) - 1, file);
    bytes[*size] = '\0';
    fclose(file);
    return bytes;
}

static const uint8_t letters[3] = {'a', 'b', 'c'};
static const double numbers[2][3] = {{1.0, -2.5, 1e300}, {0.0, 1e-300, -0.0}};
static const float few[5] = {1.0F, 2.0F, 3.0F, 4.0F, 5.5F};
static const int32_t whole[2] = {-1, INT32_MAX};
static const uint64_t large[1] = {UINT64_MAX};

static const gonio_i_array arrays[] = {
    {.name = "letters", .type = GONIO_I_U8, .rank = 1, .shape = {3}, .data = letters},
    {.name = "few", .type = GONIO_I_F32, .rank = 1, .shape = {5}, .data = few},
    {.name = "numbers", .type = GONIO_I_F64, .rank = 2, .shape = {2, 3}, .data = numbers},
    {.name = "whole", .type = GONIO_I_I32, .rank = 1, .shape = {2}, .data = whole},
    {.name = "none", .type = GONIO_I_F64, .rank = 2, .shape = {0, 7}, .data = numbers},
    {.name = "large", .type = GONIO_I_U64, .rank = 0, .data = large},
};

enum { ARRAYS = sizeof arrays / sizeof *arrays };

static const gonio_i_metadata texts[] = {
    {"format", "made for a test"}, {"quotes", "\"\\\n\t\x01"}, {"bytes", "gr\xFCn \x80"}, {"", ""}};

enum { TEXTS = sizeof texts / sizeof *texts };

static void write_file(const fixture *f)
{
    assert_int_equal(gonio_i_safetensors_write(f->context, texts, TEXTS, arrays, ARRAYS, f->path),
                     GONIO_OK);
}

static void test_what_is_written_is_read(void **state)
{
    const fixture *f = *state;
    gonio_i_safetensors *file = NULL;
    write_file(f);
    assert_int_equal(gonio_i_safetensors_open(f->context, f->path, "mend it", &file), GONIO_OK);
    for (size_t k = 0; k < ARRAYS; k++) {
        const gonio_i_array *found = gonio_i_safetensors_array(file, arrays[k].name);
        assert_non_null(found);
        assert_string_equal(found->name, arrays[k].name);
        assert_int_equal(found->type, arrays[k].type);
        assert_int_equal(found->rank, arrays[k].rank);
        for (int j = 0; j < found->rank; j++) {
            assert_int_equal(found->shape[j], arrays[k].shape[j]);
        }
        assert_memory_equal(found->data, arrays[k].data, found->size);
    }
    assert_int_equal(gonio_i_safetensors_array(file, "numbers")->size, sizeof numbers);
    assert_int_equal(gonio_i_safetensors_array(file, "none")->size, 0);
    assert_null(gonio_i_safetensors_array(file, "other"));
    assert_null(gonio_i_safetensors_array(file, "__metadata__"));
    assert_string_equal(gonio_i_safetensors_text(file, "quotes"), "\"\\\n\t\x01");
    assert_string_equal(gonio_i_safetensors_text(file, "bytes"), "gr\xEF\xBF\xBDn \xEF\xBF\xBD");
    assert_string_equal(gonio_i_safetensors_text(file, ""), "");
    assert_null(gonio_i_safetensors_text(file, "numbers"));
    gonio_i_safetensors_close(&file);
    assert_null(file);
    gonio_i_safetensors_close(&file);
}

/* The layout, by hand: what other programs rely on. */
static void test_layout(void **state)
{
    const fixture *f = *state;
    static const char header[] =
        "{\"__metadata__\":{\"format\":\"made for a test\",\"quotes\":\"\\\"\\\\\\n\\t\\u0001\","
        "\"bytes\":\"gr\xEF\xBF\xBDn \xEF\xBF\xBD\",\"\":\"\"},"
        "\"numbers\":{\"dtype\":\"F64\",\"shape\":[2,3],\"data_offsets\":[0,48]},"
        "\"none\":{\"dtype\":\"F64\",\"shape\":[0,7],\"data_offsets\":[48,48]},"
        "\"large\":{\"dtype\":\"U64\",\"shape\":[],\"data_offsets\":[48,56]},"
        "\"few\":{\"dtype\":\"F32\",\"shape\":[5],\"data_offsets\":[56,76]},"
        "\"whole\":{\"dtype\":\"I32\",\"shape\":[2],\"data_offsets\":[76,84]},"
        "\"letters\":{\"dtype\":\"U8\",\"shape\":[3],\"data_offsets\":[84,87]}}";
    size_t size = 0;
    uint64_t length = 0;
    write_file(f);
    char *bytes = load(f->path, &size);
    memcpy(&length, bytes, sizeof length);
    assert_int_equal((8 + length) % 64, 0);
    assert_in_range(length, sizeof header - 1, sizeof header - 1 + 63);
    assert_memory_equal(bytes + 8, header, sizeof header - 1);
    for (uint64_t k = sizeof header - 1; k < length; k++) {
        assert_int_equal(bytes[8 + k], ' ');
    }
    assert_int_equal(size, 8 + length + 87);
    assert_memory_equal(bytes + 8 + length, numbers, sizeof numbers);
    assert_memory_equal(bytes + size - 3, letters, 3);
    free(bytes);
}

static void test_a_file_without_arrays(void **state)
{
    const fixture *f = *state;
    gonio_i_safetensors *file = NULL;
    assert_int_equal(gonio_i_safetensors_write(f->context, NULL, 0, NULL, 0, f->path), GONIO_OK);
    assert_int_equal(gonio_i_safetensors_open(f->context, f->path, "mend it", &file), GONIO_OK);
    assert_null(gonio_i_safetensors_array(file, ""));
    gonio_i_safetensors_close(&file);
}

/* A header, spaces in front of `data` bytes of 0 so that these are aligned, and what is said of it;
 * NULL: it is read. A `%` stands for 10,000 more of the character before it. */
typedef struct lie {
    const char *header;
    size_t data;
    const char *says;
} lie;

#define ONE(dtype, shape, offsets)                                                                 \
    "{\"a\":{\"dtype\":" dtype ",\"shape\":" shape ",\"data_offsets\":" offsets "}}"
#define TWO(first, second)                                                                         \
    "{\"a\":{\"dtype\":\"U8\",\"shape\":[8],\"data_offsets\":" first "},"                          \
    "\"b\":{\"dtype\":\"F64\",\"shape\":[1],\"data_offsets\":" second "}}"

static const lie lies[] = {
    {ONE("\"F64\"", "[2]", "[0,16]"), 16, NULL},
    {ONE("\"BF16\"", "[2,1,4]", "[0,16]"), 16, NULL},
    {ONE("\"F8_E5M2\"", "[16]", "[0,16]"), 16, NULL},
    {TWO("[0,8]", "[8,16]"), 16, NULL},
    {"{\"__metadata__\":{\"a\":\"b\"}}", 0, NULL},
    /* no header */
    {"[1]", 0, "not a safetensors file"},
    {" {}", 0, "not a safetensors file"},
    {"{", 0, "is not JSON"},
    {"{\"a\"}", 0, "is not JSON"},
    {"{} {}", 0, "is not JSON"},
    {"{\"\\u0000\":0}", 0, "is not JSON"},
    {"{\"\xFF\":0}", 0, "is not JSON"},
    {"{\"a\":1e999}", 0, "is not JSON"},
    {"{\"a\":99999999999999999999}", 0, "is not JSON"},
    {"{\"a\":[[[[%", 0, "nested too deeply"},
    /* no array */
    {"{\"a\":0}", 0, "is not a dtype, a shape and data_offsets"},
    {"{\"a\":[]}", 0, "is not a dtype, a shape and data_offsets"},
    {"{\"a\":{}}", 0, "is not a dtype, a shape and data_offsets"},
    {"{\"a\":{\"dtype\":\"U8\",\"shape\":[],\"data_offsets\":[0,1],\"more\":0}}", 1,
     "is not a dtype, a shape and data_offsets"},
    {"{\"a\":{\"type\":\"U8\",\"shape\":[],\"data_offsets\":[0,1]}}", 1, "unknown dtype"},
    {"{\"a\":{\"dtype\":\"U8\",\"shapes\":[],\"data_offsets\":[0,1]}}", 1, "has a shape"},
    {"{\"a\":{\"dtype\":\"U8\",\"shape\":[],\"offsets\":[0,1]}}", 1, "has data_offsets"},
    {"{\"a\x1B%\":0}", 0, "is not JSON"},
    {"{\"a%\":0}", 0, "is not a dtype, a shape and data_offsets"},
    /* dtypes */
    {ONE("\"F63\"", "[2]", "[0,16]"), 16, "unknown dtype"},
    {ONE("\"\"", "[2]", "[0,16]"), 16, "unknown dtype"},
    {ONE("8", "[2]", "[0,16]"), 16, "unknown dtype"},
    {ONE("null", "[2]", "[0,16]"), 16, "unknown dtype"},
    /* shapes */
    {ONE("\"F64\"", "2", "[0,16]"), 16, "has a shape that is not a list"},
    {ONE("\"F64\"", "[2.0]", "[0,16]"), 16, "has a shape that is not a list"},
    {ONE("\"F64\"", "[\"2\"]", "[0,16]"), 16, "has a shape that is not a list"},
    {ONE("\"F64\"", "[-1]", "[0,16]"), 16, "has a shape that is not a list"},
    {ONE("\"F64\"", "[-2,-1]", "[0,16]"), 16, "has a shape that is not a list"},
    {ONE("\"F64\"", "[2,1,1,1,1,1,1,1,1]", "[0,16]"), 16, "has a shape that is not a list"},
    {ONE("\"F64\"", "[3]", "[0,16]"), 16, "does not fit its data_offsets"},
    {ONE("\"F64\"", "[]", "[0,16]"), 16, "does not fit its data_offsets"},
    {ONE("\"F64\"", "[2305843009213693954]", "[0,16]"), 16, "does not fit its data_offsets"},
    {ONE("\"F64\"", "[4294967296,4294967296,2]", "[0,0]"), 0, "does not fit its data_offsets"},
    {ONE("\"U8\"", "[9223372036854775807,2,1]", "[0,16]"), 16, "does not fit its data_offsets"},
    /* places */
    {ONE("\"F64\"", "[2]", "[16,0]"), 16, "data_offsets that are not in the file"},
    {ONE("\"F64\"", "[2]", "[0,16,16]"), 16, "data_offsets that are not in the file"},
    {ONE("\"F64\"", "[2]", "[0]"), 16, "data_offsets that are not in the file"},
    {ONE("\"F64\"", "[2]", "[-16,0]"), 16, "data_offsets that are not in the file"},
    {ONE("\"F64\"", "[2]", "[0,16.0]"), 16, "data_offsets that are not in the file"},
    {ONE("\"F64\"", "[2]", "[0,16]"), 15, "data_offsets that are not in the file"},
    {ONE("\"F64\"", "[2]", "[9223372036854775807,9223372036854775807]"), 16,
     "data_offsets that are not in the file"},
    {ONE("\"F64\"", "[2]", "[0,16]"), 17, "does not say what the last bytes are"},
    {"{}", 1, "does not say what the last bytes are"},
    {ONE("\"F64\"", "[1]", "[8,16]"), 16, "comes after a gap"},
    {TWO("[0,8]", "[16,24]"), 24, "comes after a gap"},
    {TWO("[0,8]", "[0,8]"), 8, "overlaps another array"},
    {TWO("[4,12]", "[0,8]"), 16, "overlaps another array"},
    {ONE("\"F64\"", "[1]", "[4,12]"), 12, "is not aligned"},
    /* names and metadata */
    {"{\"a\":{\"dtype\":\"U8\",\"shape\":[1],\"data_offsets\":[0,1]},"
     "\"a\":{\"dtype\":\"U8\",\"shape\":[1],\"data_offsets\":[1,2]}}",
     2, "has a name twice"},
    {"{\"__metadata__\":{\"a\":\"b\",\"a\":\"c\"}}", 0, "has a name twice"},
    {"{\"a\":{\"dtype\":\"U8\",\"dtype\":\"U8\",\"shape\":[1],\"data_offsets\":[0,1]}}", 1,
     "has a name twice"},
    {"{\"__metadata__\":[]}", 0, "is not an object"},
    {"{\"__metadata__\":{\"a\":0}}", 0, "is not a text"},
    {"{\"__metadata__\":{\"a\":{}}}", 0, "is not a text"},
};

/* Length, header and data of a case; *size bytes. */
static char *make_bytes(const lie *l, size_t *size)
{
    enum { MANY = 10000 };
    char *bytes = aligned_alloc(64, 1 << 16);
    const char *mark = strchr(l->header, '%');
    const size_t before = mark != NULL ? (size_t)(mark - l->header) : strlen(l->header);
    assert_non_null(bytes);
    memset(bytes, 0, 1 << 16);
    memcpy(bytes + 8, l->header, before);
    char *end = bytes + 8 + before;
    if (mark != NULL) {
        memset(end, mark[-1], MANY);
        end = stpcpy(end + MANY, mark + 1);
    }
    while ((end - bytes) % 8 != 0) {
        *end++ = ' ';
    }
    const uint64_t length = (uint64_t)(end - bytes - 8);
    memcpy(bytes, &length, sizeof length);
    *size = 8 + (size_t)length + l->data;
    return bytes;
}

static void check_lie(const fixture *f, const lie *l)
{
    size_t size = 0;
    char *bytes = make_bytes(l, &size);
    /* As much memory as the bytes take, so that a sanitizer sees who reads beyond. */
    char *exact = aligned_alloc(64, (size + 63) / 64 * 64);
    assert_non_null(exact);
    exact = memcpy(exact, bytes, size);
    gonio_i_safetensors *file = NULL;
    const gonio_status status =
        gonio_i_safetensors_parse(f->context, "made", "mend it", exact, size, &file);
    if (l->says == NULL) {
        assert_int_equal(status, GONIO_OK);
    } else if (status != GONIO_ERROR_FORMAT || strstr(support_message(), l->says) == NULL) {
        fail_msg("%s: status %d, \"%s\"", l->header, (int)status, support_message());
    } else {
        assert_non_null(strstr(support_message(), "mend it"));
        assert_null(file);
    }
    gonio_i_safetensors_close(&file);
    free(bytes);
    free(exact);
}

static void test_lies(void **state)
{
    for (size_t k = 0; k < sizeof lies / sizeof *lies; k++) {
        check_lie(*state, &lies[k]);
    }
}

/* Every length that is not the file's, and every length of the header that is not its own. */
static void test_cut_anywhere(void **state)
{
    const fixture *f = *state;
    size_t size = 0;
    write_file(f);
    char *bytes = load(f->path, &size);
    for (size_t length = 0; length <= size + 1; length++) {
        gonio_i_safetensors *file = NULL;
        char *part = aligned_alloc(64, (length + 64) / 64 * 64);
        assert_non_null(part);
        memcpy(part, bytes, length);
        assert_int_equal(
            gonio_i_safetensors_parse(f->context, "cut", "mend it", part, length, &file),
            length == size ? GONIO_OK : GONIO_ERROR_FORMAT);
        gonio_i_safetensors_close(&file);
        free(part);
    }
    static const uint64_t lengths[] = {0, 1, 2, 1 << 24, (1 << 24) + 1, UINT64_MAX, UINT64_MAX - 7};
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
        gonio_i_safetensors *file = NULL;
        memcpy(bytes, &lengths[k], sizeof lengths[k]);
        assert_int_equal(
            gonio_i_safetensors_parse(f->context, "cut", "mend it", bytes, size, &file),
            GONIO_ERROR_FORMAT);
    }
    free(bytes);
}

static void test_what_is_no_file(void **state)
{
    const fixture *f = *state;
    gonio_i_safetensors *file = NULL;
    const struct {
        const char *path;
        const char *says;
    } cases[] = {{f->folder, "cannot read: Is a directory"},
                 {f->path, "cannot read: No such file"},
                 {"/dev/null", "a pipe or a device"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(gonio_i_safetensors_open(f->context, cases[k].path, "mend it", &file),
                         GONIO_ERROR_IO);
        assert_non_null(strstr(support_message(), cases[k].says));
    }
    assert_int_equal(mkfifo(f->path, 0600), 0);
    assert_int_equal(gonio_i_safetensors_open(f->context, f->path, "mend it", &file),
                     GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), "a pipe or a device"));
    assert_int_equal(remove(f->path), 0);
    fclose(fopen(f->path, "wb"));
    assert_int_equal(gonio_i_safetensors_open(f->context, f->path, "mend it", &file),
                     GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "not a safetensors file; mend it"));
    assert_null(file);
}

/* Not every file that begins with a number is one. */
static void test_beginnings(void **state)
{
    (void)state;
    static const struct {
        const char *head;
        size_t size;
        bool is;
    } cases[] = {{"\x02\0\0\0\0\0\0\0{}", 10, true},
                 {"\x02\0\0\0\0\0\0\0{", 9, true},
                 {"\x02\0\0\0\0\0\0\0", 8, false},
                 {"\x01\0\0\0\0\0\0\0{}", 10, false},
                 {"\x02\0\0\0\0\0\0\0[]", 10, false},
                 {"\x02\0\0\0\0\0\1\0{}", 10, false},
                 {"\x89HDF\r\n\x1a\n{\0", 10, false},
                 {"{\"a\": [1, 2]}", 13, false},
                 {"", 0, false}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(gonio_i_safetensors_begin(cases[k].head, cases[k].size), cases[k].is);
    }
}

static void test_a_file_that_cannot_be_written(void **state)
{
    const fixture *f = *state;
    assert_int_equal(
        gonio_i_safetensors_write(f->context, texts, TEXTS, arrays, ARRAYS, "/no/such/folder/file"),
        GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), "/no/such/folder/file: cannot write"));
    assert_int_equal(gonio_i_safetensors_write(f->context, texts, TEXTS, arrays, ARRAYS, f->folder),
                     GONIO_ERROR_IO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_what_is_written_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_layout, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_a_file_without_arrays, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_lies, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_cut_anywhere, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_what_is_no_file, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_beginnings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_a_file_that_cannot_be_written, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("safetensors", tests, NULL, NULL);
}
