/* Basis files: they keep everything, and files that lie or are damaged are refused. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "edited_basis.h"
#include "learned_basis.h"

static void test_the_file_keeps_everything(void **state)
{
    (void)state;
    static const gonio_channel_model models[] = {GONIO_JOINT, GONIO_SEPARATE};
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/basis.gonio", folder);
    for (size_t m = 0; m < 2; m++) {
        gonio_database *database = make_database(NULL, 3, GONIO_BIVARIATE, models[m]);
        gonio_basis *basis = learn(NULL, database, 2);
        gonio_basis *again = NULL;
        assert_int_equal(gonio_basis_write(NULL, basis, "a 'command'", path), GONIO_OK);
        assert_int_equal(gonio_basis_read(NULL, path, &again), GONIO_OK);
        const gonio_basis_view *a = gonio_basis_describe(basis);
        const gonio_basis_view *b = gonio_basis_describe(again);
        assert_true(a->fingerprint == b->fingerprint);
        assert_int_equal(a->channels, b->channels);
        assert_int_equal(a->rows, b->rows);
        assert_int_equal(a->components, b->components);
        assert_int_equal(a->materials, b->materials);
        assert_memory_equal(a->cell, b->cell, a->cells * sizeof *a->cell);
        assert_memory_equal(a->mean, b->mean, a->rows * sizeof *a->mean);
        double *vectors[2] = {support_vectors(basis), support_vectors(again)};
        assert_memory_equal(vectors[0], vectors[1], a->rows * a->components * sizeof *vectors[0]);
        free(vectors[0]);
        free(vectors[1]);
        assert_memory_equal(a->variances, b->variances, a->variance_count * sizeof *a->variances);
        assert_memory_equal(a->fingerprints, b->fingerprints, 3 * sizeof *a->fingerprints);
        assert_string_equal(a->names[2], b->names[2]);
        assert_string_equal(b->command, "a 'command'");
        gonio_basis_free(&basis);
        gonio_basis_free(&again);
        gonio_database_free(&database);
    }
    support_remove(folder);
}

/* A change of a basis file, and what is said of it. */
typedef struct lie {
    const char *from, *to; /* in the header; NULL: unchanged */
    const char *array;     /* NULL: unchanged */
    size_t at;             /* bytes from its beginning */
    double value;
    const char *says; /* NULL: it is believed */
} lie;

static const lie lies[] = {
    {.says = NULL},
    {"gonio basis", "gonio bases", .says = "a safetensors file, but not a gonio basis"},
    {"\"format\"", "\"forma\"", .says = "a safetensors file, but not a gonio basis"},
    {"format_version\":\"2", "format_version\":\"3", .says = "a basis of format version 3"},
    {"format_version", "version", .says = "a basis of format version (none)"},
    {"theta_d_bins\":\"90", "theta_d_bins\":\"91", .says = "on a grid with 91 theta_d_bins"},
    {"phi_d_bins", "phi", .says = "'phi_d_bins' is missing"},
    {"bivariate", "univariate", .says = "'representation' is missing or unknown"},
    {"joint", "paint", .says = "'channels' is missing or unknown"},
    {"\"mapping\":\"log", "\"mapping\":\"lag", .says = "'mapping' is missing or unknown"},
    {"\"centring\"", "\"centering\"", .says = "'centring' is missing or unknown"},
    {"\"program\"", "\"programme\"", .says = "'program' is missing"},
    {"\"command\"", "\"commands\"", .says = "'command' is missing"},
    {"\"mapping\":\"log", "\"mapping\":\"relative", .says = "'fingerprint' does not fit"},
    {"\"centring\":\"mean", "\"centring\":\"none", .says = "'fingerprint' does not fit"},
    {"\"fingerprint\":\"", "\"fingerprint\":\"0", .says = "'fingerprint' does not fit"},
    {"\"fingerprint\"", "\"fingertip\"", .says = "'fingerprint' does not fit"},
    {"\"xxh3.mean\"", "\"xxh4.mean\"", .says = "'xxh3.mean' does not fit"},
    {"\"xxh3.components\"", "\"xxh4.components\"", .says = "not those of the checksum"},
    /* arrays that are missing, of another type or shape */
    {"\"log_scale\":{", "\"scale\":{", .says = "'log_scale' is missing"},
    {"\"mean\":{", "\"meen\":{", .says = "'mean' is missing"},
    {"\"variances\":{", "\"variance\":{", .says = "'variances' is missing"},
    {"\"components\":{", "\"component\":{", .says = "'components' is missing"},
    {"\"cell\":{", "\"cells\":{", .says = "'cell' is missing"},
    {"\"material_names\":{", "\"names\":{", .says = "'material_names' is missing"},
    {"\"material_fingerprints\":{", "\"prints\":{", .says = "'material_fingerprints' is missing"},
    {"\"loadings\":{", "\"loading\":{", .says = NULL},
    {"\"mean\":{\"dtype\":\"F64\"", "\"mean\":{\"dtype\":\"I64\"", .says = "another type or rank"},
    {"\"components\":{\"dtype\":\"F32\"", "\"components\":{\"dtype\":\"I32\"",
     .says = "'components' has another type or rank"},
    {"[24069,2]", "[48138]", .says = "'components' has another type or rank"},
    {"[24069,2]", "[48138,1]", .says = "'components' has a shape that does not fit"},
    {"[24069,2]", "[2,24069]", .says = "'components' has a shape that does not fit"},
    {"[24069,2]", "[8023,6]", .says = "'components' has a shape that does not fit"},
    {"[24069]", "[24069,1]", .says = "'mean' has another type or rank"},
    {"joint", "separate", .says = "'mean' has a shape that does not fit the cells"},
    {"[3,2]", "[2,3]", .says = "'loadings' has a shape that does not fit"},
    {"\"mixtures\":\"0\"", "\"mixtures\":\"1\"",
     .says = "'loadings' has a shape that does not fit"},
    /* values, with right checksums */
    {NULL, NULL, "log_scale", 8, 1e-3, "'log_scale' is not this program's"},
    {NULL, NULL, "mean", 8, NAN, "'mean' holds a number that is no logarithm"},
    {NULL, NULL, "mean", 800, -INFINITY, "'mean' holds a number that is no logarithm"},
    {NULL, NULL, "mean", 8, 1e300, "'mean' holds a number that is no logarithm"},
    {NULL, NULL, "variances", 0, NAN, "'variances' are not descending"},
    {NULL, NULL, "variances", 8, -1.0, "'variances' are not descending"},
    {NULL, NULL, "variances", 0, 1e300, "'variances' are not descending"},
    {NULL, NULL, "variances", 0, 0.0, "'variances' are not descending"},
    {NULL, NULL, "variances", 0, 1e15, "'fingerprint' does not fit"},
    {NULL, NULL, "loadings", 0, NAN, "'loadings' are not orthonormal"},
    {NULL, NULL, "loadings", 16, 2.0, "'loadings' are not orthonormal"},
    {NULL, NULL, "components", 0, NAN, "'components' are not orthonormal"},
    {NULL, NULL, "components", 80000, INFINITY, "'components' are not orthonormal"},
    {NULL, NULL, "components", 80000, 1e-2, "'components' are not orthonormal"},
    {NULL, NULL, "cell", 0, 7.0, "'cell' is not a rising list"},
    {NULL, NULL, "cell", 32088, 8100.0, "'cell' is not a rising list"},
    {NULL, NULL, "cell", 0, -1.0, "'cell' is not a rising list"},
    {NULL, NULL, "material_names", 3, 0.0, "'material_names' has more names"},
    {NULL, NULL, "material_names", 13, 65.0, "'material_names' has fewer names"},
};

/* In the type of the array. */
static void put_value(const lie *l, char *data)
{
    const float single = (float)l->value;
    const bool bytes = strcmp(l->array, "material_names") == 0;
    const bool whole = strcmp(l->array, "cell") == 0;
    const int32_t integer = bytes || whole ? (int32_t)l->value : 0;
    if (bytes || whole) {
        memcpy(data + l->at, &integer, bytes ? 1 : sizeof integer);
    } else if (strcmp(l->array, "components") == 0) {
        memcpy(data + l->at, &single, sizeof single);
    } else {
        memcpy(data + l->at, &l->value, sizeof l->value);
    }
}

static void tell_lie(const lie *l, const char *path)
{
    edited e = edited_load(path);
    if (l->from != NULL) {
        edited_header(&e, l->from, l->to);
    }
    if (l->array != NULL) {
        size_t size = 0;
        char *data = edited_array(&e, l->array, &size);
        assert_in_range(l->at, 0, size - 1);
        put_value(l, data);
        edited_seal(&e);
    }
    edited_save(&e, path);
}

static void test_lies_in_a_file(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/basis.gonio", folder);
    gonio_context *context = support_context();
    gonio_database *database = make_database(NULL, 3, GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *basis = learn(NULL, database, 2);
    for (size_t k = 0; k < sizeof lies / sizeof *lies; k++) {
        gonio_basis *again = NULL;
        assert_int_equal(gonio_basis_write(context, basis, "a command", path), GONIO_OK);
        tell_lie(&lies[k], path);
        const gonio_status status = gonio_basis_read(context, path, &again);
        if ((status == GONIO_OK) != (lies[k].says == NULL) ||
            (status != GONIO_OK && strstr(support_message(), lies[k].says) == NULL)) {
            fail_msg("lie %zu: status %d, %s", k, (int)status, support_message());
        }
        gonio_basis_free(&again);
    }
    gonio_basis_free(&basis);
    gonio_database_free(&database);
    gonio_context_free(&context);
    support_remove(folder);
}

/* Any byte of the arrays that changes is noticed, and so is a file that ends early. */
static void test_damage_is_noticed(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/basis.gonio", folder);
    gonio_context *context = support_context();
    gonio_database *database = make_database(NULL, 3, GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *basis = learn(NULL, database, 2);
    gonio_basis *again = NULL;
    for (size_t k = 0; k < 60; k++) {
        assert_int_equal(gonio_basis_write(context, basis, NULL, path), GONIO_OK);
        edited e = edited_load(path);
        const size_t data = edited_data(&e);
        if (k % 2 == 0) {
            e.bytes[data + (e.size - data - 1) * k / 59] ^= 1;
        } else {
            e.size = (e.size - 1) * k / 59;
        }
        edited_save(&e, path);
        assert_int_equal(gonio_basis_read(context, path, &again), GONIO_ERROR_FORMAT);
        assert_null(again);
        assert_non_null(strstr(support_message(), "learn"));
    }
    gonio_basis_free(&basis);
    gonio_database_free(&database);
    gonio_context_free(&context);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_file_keeps_everything),
        cmocka_unit_test(test_lies_in_a_file),
        cmocka_unit_test(test_damage_is_noticed),
    };
    return cmocka_run_group_tests_name("basis file", tests, NULL, NULL);
}
