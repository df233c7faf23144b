/* What a file is, by its content: every format, files that only look like one, pipes. */
#include "../support.h"

#include <gonio/file.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define BYTES(text) text, sizeof(text) - 1

typedef struct example {
    const char *name; /* of the file: says nothing, or something else */
    const char *bytes;
    size_t size;
    gonio_kind kind;
    const char *format;
} example;

static const example examples[] = {
    {"a.csv",
     BYTES("\x01\0\0\0\x01\0\0\0\x01\0\0\0"
           "123456781234567812345678"),
     GONIO_KIND_MATERIAL, "MERL .binary table"},
    {"b.csv", BYTES("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0"), GONIO_KIND_MATERIAL, "MERL .binary table"},
    {"c.png", BYTES("\x89HDF\r\n\x1a\nxxxx"), GONIO_KIND_MATERIAL, "neural BRDF .h5"},
    {"d.h5", BYTES("\x89HDF\r\n\x1a\nxxxx\0gonio basis\0"), GONIO_KIND_BASIS,
     "gonio basis of an older gonio, HDF5"},
    {"d.gonio", BYTES("\x30\0\0\0\0\0\0\0{\"__metadata__\":{\"format\":\"gonio basis\"}}"),
     GONIO_KIND_BASIS, "gonio basis"},
    {"e.binary", BYTES("theta_i_deg,phi_i_deg\n"), GONIO_KIND_READINGS, "CSV"},
    {"f.obj", BYTES("# v is here\n\n# f\ntheta_i_deg;phi_i_deg\n"), GONIO_KIND_READINGS, "CSV"},
    {"g", BYTES("\xef\xbb\xbftheta_i_deg\tphi_i_deg\r\n"), GONIO_KIND_READINGS, "CSV"},
    {"h", BYTES("# only comments\n"), GONIO_KIND_READINGS, "CSV"},
    {"i.csv", BYTES("# paint\n 2 # wavelengths\n400 500\n"), GONIO_KIND_READINGS,
     "scattered readings as text"},
    {"j.csv", BYTES("# theta_i_deg,phi_i_deg\nv 0 0 0\n"), GONIO_KIND_MESH, "OBJ"},
    {"k", BYTES("\n\n  mtllib x.mtl\n"), GONIO_KIND_MESH, "OBJ"},
    {"l.obj", BYTES("ply\nformat ascii 1.0\n"), GONIO_KIND_MESH, "PLY"},
    {"m.hdr", BYTES("\x76\x2f\x31\x01\x02\0\0\0"), GONIO_KIND_IMAGE, "OpenEXR"},
    {"n", BYTES("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"), GONIO_KIND_IMAGE, "Radiance .hdr"},
    {"o", BYTES("#?RGBE\n"), GONIO_KIND_IMAGE, "Radiance .hdr"},
    {"p.exr", BYTES("\x89PNG\r\n\x1a\n"), GONIO_KIND_IMAGE, "PNG"},
    {"q.csv", BYTES("some words\n"), GONIO_KIND_UNKNOWN, NULL},
    {"r.obj", BYTES("vector 1 2 3\n"), GONIO_KIND_UNKNOWN, NULL},
    {"s.csv", BYTES("theta_i_deg,\0phi_i_deg\n"), GONIO_KIND_UNKNOWN, NULL},
    {"t.binary",
     BYTES("\x01\0\0\0\x01\0\0\0\x01\0\0\0"
           "1234567"),
     GONIO_KIND_UNKNOWN, NULL},
    {"u.h5", BYTES("\x89HDF\r\n\x1a"), GONIO_KIND_UNKNOWN, NULL},
    {"v", "", 0, GONIO_KIND_UNKNOWN, NULL},
};

enum { EXAMPLES = sizeof examples / sizeof *examples };

static const gonio_kind kinds[] = {GONIO_KIND_MATERIAL, GONIO_KIND_BASIS, GONIO_KIND_READINGS,
                                   GONIO_KIND_MESH, GONIO_KIND_IMAGE};

enum { KINDS = sizeof kinds / sizeof *kinds };

static void write_example(const char *folder, const example *e, char path[4096])
{
    snprintf(path, 4096, "%s/%s", folder, e->name);
    FILE *file = fopen(path, "wbe");
    assert_non_null(file);
    assert_int_equal(fwrite(e->bytes, 1, e->size, file), e->size);
    assert_int_equal(fclose(file), 0);
}

static void test_every_format(void **state)
{
    (void)state;
    char *folder = support_folder();
    for (int k = 0; k < EXAMPLES; k++) {
        char path[4096];
        gonio_kind kind = GONIO_KIND_MESH;
        const char *format = "none";
        write_example(folder, &examples[k], path);
        assert_int_equal(gonio_file_kind(NULL, path, &kind, &format), GONIO_OK);
        if (kind != examples[k].kind) {
            fail_msg("%s: kind %d", examples[k].name, (int)kind);
        }
        if (examples[k].format == NULL) {
            assert_null(format);
        } else {
            assert_string_equal(format, examples[k].format);
        }
        assert_int_equal(gonio_file_kind(NULL, path, &kind, NULL), GONIO_OK);
    }
    support_remove(folder);
}

/* Of the kinds that are wanted, and of others: what is said of those. */
static void test_expected_kinds(void **state)
{
    (void)state;
    char *folder = support_folder();
    gonio_context *context = support_context();
    for (int k = 0; k < EXAMPLES * KINDS; k++) {
        const example *e = &examples[k / KINDS];
        const gonio_kind wanted = kinds[k % KINDS];
        char path[4096];
        gonio_kind kind = GONIO_KIND_UNKNOWN;
        write_example(folder, e, path);
        const gonio_status status = gonio_file_expect(context, path, wanted, &kind);
        /* An HDF5 file is left to the reader of bases. */
        const bool may_be =
            wanted == GONIO_KIND_BASIS && strncmp(e->bytes, "\x89HDF\r\n\x1a\n", 8) == 0;
        /* The samples of a tensor file are readings. */
        const bool samples =
            wanted == GONIO_KIND_READINGS && strncmp(e->bytes, "tensor_file", 11) == 0;
        assert_int_equal(status,
                         e->kind == wanted || may_be || samples ? GONIO_OK : GONIO_ERROR_FORMAT);
        assert_int_equal(kind, status == GONIO_OK ? wanted : GONIO_KIND_UNKNOWN);
        if (status != GONIO_OK && e->kind != GONIO_KIND_UNKNOWN) {
            assert_non_null(strstr(support_message(), gonio_kind_name(e->kind)));
            assert_non_null(strstr(support_message(), e->format));
        }
        if (status != GONIO_OK) {
            assert_non_null(
                strstr(support_message(), e->size > 0 ? gonio_kind_name(wanted) : "empty"));
        }
    }
    gonio_context_free(&context);
    support_remove(folder);
}

/* Whether one of the wanted kinds has the format: Zemax files are readings and materials. */
static bool is_read(unsigned wanted, const char *format)
{
    for (int k = 0; k < KINDS; k++) {
        for (int j = 0; (wanted & kinds[k]) != 0 && gonio_kind_format(kinds[k], j) != NULL; j++) {
            if (strcmp(gonio_kind_format(kinds[k], j), format) == 0) {
                return true;
            }
        }
    }
    return false;
}

/* An unknown file is told every format of the kinds that are wanted, and no other. */
static void test_what_is_read_is_told(void **state)
{
    (void)state;
    char *folder = support_folder();
    gonio_context *context = support_context();
    const example words = {"words", BYTES("some words\n"), GONIO_KIND_UNKNOWN, NULL};
    char path[4096];
    write_example(folder, &words, path);
    for (unsigned wanted = 1; wanted < 1U << KINDS; wanted++) {
        gonio_kind kind = GONIO_KIND_UNKNOWN;
        assert_int_equal(gonio_file_expect(context, path, wanted, &kind), GONIO_ERROR_FORMAT);
        for (int k = 0; k < KINDS; k++) {
            for (int j = 0; gonio_kind_format(kinds[k], j) != NULL; j++) {
                const char *format = gonio_kind_format(kinds[k], j);
                const bool told = strstr(support_message(), format) != NULL;
                assert_int_equal(told, is_read(wanted, format));
            }
        }
    }
    gonio_context_free(&context);
    support_remove(folder);
}

static void test_names(void **state)
{
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        assert_non_null(gonio_kind_name(kinds[k]));
        assert_non_null(gonio_kind_format(kinds[k], 0));
        assert_null(gonio_kind_format(kinds[k], -1));
        assert_null(gonio_kind_format(kinds[k], 100));
    }
    assert_null(gonio_kind_name(GONIO_KIND_UNKNOWN));
    assert_null(gonio_kind_format(GONIO_KIND_UNKNOWN, 0));
}

/* A pipe that nobody writes into would block whoever opens it. */
static void test_other_places(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    const char *format = "none";
    snprintf(path, sizeof path, "%s/pipe", folder);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_int_equal(gonio_file_kind(NULL, path, &kind, &format), GONIO_OK);
    assert_int_equal(kind, GONIO_KIND_READINGS);
    assert_null(format);
    assert_int_equal(
        gonio_file_expect(NULL, path, GONIO_KIND_MATERIAL | GONIO_KIND_READINGS, &kind), GONIO_OK);
    assert_int_equal(gonio_file_expect(NULL, path, GONIO_KIND_MATERIAL, &kind), GONIO_ERROR_IO);
    assert_int_equal(gonio_file_kind(NULL, folder, &kind, NULL), GONIO_ERROR_IO);
    assert_int_equal(gonio_file_kind(NULL, "no such file", &kind, NULL), GONIO_ERROR_IO);
    assert_int_equal(gonio_file_kind(NULL, "atlas:anything", &kind, &format), GONIO_OK);
    assert_int_equal(kind, GONIO_KIND_MATERIAL);
    assert_string_equal(format, "built-in");
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_format),         cmocka_unit_test(test_expected_kinds),
        cmocka_unit_test(test_what_is_read_is_told), cmocka_unit_test(test_names),
        cmocka_unit_test(test_other_places),
    };
    return cmocka_run_group_tests_name("file_kind", tests, NULL, NULL);
}
