/* Bases by certificates: orthonormality, projection of what was learned from, variances; the file;
 * the map of nearest cells. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "basis/basis.h"
#include "core/random.h"
#include "edited_basis.h"
#include "made_material.h"

enum { MATERIALS = 6 };

static const char *const paths[MATERIALS] = {"atlas:gold-polished",   "atlas:red-glossy-plastic",
                                             "atlas:burgundy-velvet", "atlas:oak-sawn",
                                             "atlas:plaster-cast",    "atlas:steel-brushed"};

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

static gonio_database *make_database(gonio_context *context, size_t count,
                                     gonio_representation representation,
                                     gonio_channel_model channels)
{
    const gonio_database_options options = {
        .size = sizeof options, .representation = representation, .channels = channels};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(context, paths, count, &options, &database), GONIO_OK);
    return database;
}

static gonio_basis *learn(gonio_context *context, const gonio_database *database, size_t components)
{
    const gonio_basis_options options = {.size = sizeof options, .components = components};
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_basis_learn(context, database, &options, &basis), GONIO_OK);
    return basis;
}

/* V as learned, of which the basis has every number rounded. */
static double *exact_vectors(gonio_context *context, const gonio_database *database,
                             const gonio_basis *basis)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const gonio_basis_options options = {.size = sizeof options, .components = view->components};
    gonio_basis *same = NULL;
    double *exact = NULL;
    assert_int_equal(gonio_i_basis_learn_exact(context, database, &options, &same, &exact),
                     GONIO_OK);
    double *rounded = support_vectors(basis);
    for (size_t k = 0; k < view->rows * view->components; k++) {
        assert_true(rounded[k] == (double)(float)exact[k]);
    }
    free(rounded);
    gonio_basis_free(&same);
    return exact;
}

static void assert_orthonormal(const gonio_basis *basis, const double *vectors)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const size_t k = view->components;
    for (size_t a = 0; a < k; a++) {
        double largest = 0.0;
        for (size_t b = 0; b <= a; b++) {
            double sum = 0.0;
            for (size_t i = 0; i < view->rows; i++) {
                sum += vectors[i * k + a] * vectors[i * k + b];
            }
            assert_close(sum, a == b ? 1.0 : 0.0, 1e-12);
        }
        for (size_t i = 0; i < view->rows; i++) {
            const double v = vectors[i * k + a];
            largest = fabs(v) > fabs(largest) ? v : largest;
        }
        assert_true(largest > 0.0);
    }
}

/* With all components, what was learned from lies in the span: V V'(h - m) = h - m; and the scatter
 * along component k is its variance. */
static void assert_projection(const gonio_database *database, const gonio_basis *basis,
                              const double *vectors)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const gonio_database_view *data = gonio_database_describe(database);
    const size_t k = view->components;
    double *h = malloc(data->rows * data->columns * sizeof *h);
    double *c = calloc(k, sizeof *c);
    double *variance = calloc(k, sizeof *variance);
    assert_true(h != NULL && c != NULL && variance != NULL);
    assert_int_equal(gonio_database_read_rows(NULL, database, 0, data->rows, NULL, 0, h), GONIO_OK);
    for (size_t column = 0; column < data->columns; column++) {
        double *x = h + column * data->rows;
        double scatter = 0.0;
        double rest = 0.0;
        memset(c, 0, k * sizeof *c);
        for (size_t i = 0; i < data->rows; i++) {
            x[i] -= view->mean[i];
            scatter += x[i] * x[i];
            for (size_t j = 0; j < k; j++) {
                c[j] += vectors[i * k + j] * x[i];
            }
        }
        for (size_t i = 0; i < data->rows; i++) {
            double residual = x[i];
            for (size_t j = 0; j < k; j++) {
                residual -= vectors[i * k + j] * c[j];
            }
            rest += residual * residual;
        }
        assert_true(scatter > 0.0);
        assert_true(sqrt(rest / scatter) < 1e-7);
        for (size_t j = 0; j < k; j++) {
            variance[j] += c[j] * c[j] / (double)(data->columns - 1);
        }
    }
    for (size_t j = 0; j < k; j++) {
        assert_true(j == 0 || view->variances[j] <= view->variances[j - 1]);
        assert_close(variance[j] / view->variances[0], view->variances[j] / view->variances[0],
                     1e-11);
    }
    free(h);
    free(c);
    free(variance);
}

static void test_joint(void **state)
{
    (void)state;
    gonio_database *database = make_database(NULL, MATERIALS, GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *basis = learn(NULL, database, 0);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    assert_int_equal(view->components, MATERIALS - 1);
    assert_int_equal(view->rows, 3 * view->cells);
    assert_int_equal(view->variance_count, MATERIALS - 1);
    assert_string_equal(view->names[1], "red-glossy-plastic");
    assert_close(gonio_basis_cumulative_variance(basis, MATERIALS - 1), 1.0, 1e-15);
    assert_true(gonio_basis_cumulative_variance(basis, 1) < 1.0);
    double *vectors = exact_vectors(NULL, database, basis);
    assert_orthonormal(basis, vectors);
    assert_projection(database, basis, vectors);
    free(vectors);
    gonio_basis_free(&basis);
    assert_null(basis);
    gonio_database_free(&database);
}

static void test_separate(void **state)
{
    (void)state;
    gonio_database *database = make_database(NULL, MATERIALS, GONIO_BIVARIATE, GONIO_SEPARATE);
    gonio_basis *basis = learn(NULL, database, 3 * MATERIALS - 1);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    assert_int_equal(view->rows, view->cells);
    assert_int_equal(view->materials, MATERIALS);
    double *vectors = exact_vectors(NULL, database, basis);
    assert_orthonormal(basis, vectors);
    assert_projection(database, basis, vectors);
    free(vectors);
    gonio_basis_free(&basis);
    gonio_database_free(&database);
}

static void test_threads_and_subsets_do_not_matter(void **state)
{
    (void)state;
    uint64_t fingerprint = 0;
    for (int threads = 1; threads <= 3; threads++) {
        const gonio_context_options options = {.size = sizeof options, .threads = threads};
        gonio_context *context = NULL;
        assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
        gonio_database *database = make_database(context, 4, GONIO_BIVARIATE, GONIO_JOINT);
        gonio_basis *basis = learn(context, database, 3);
        const gonio_basis_view *view = gonio_basis_describe(basis);
        fingerprint = threads == 1 ? view->fingerprint : fingerprint;
        assert_true(view->fingerprint == fingerprint);
        gonio_basis_free(&basis);
        gonio_database_free(&database);
        gonio_context_free(&context);
    }
    const size_t subset[] = {0, 1, 2, 3};
    const gonio_basis_options some = {
        .size = sizeof some, .components = 3, .subset = subset, .subset_count = 4};
    gonio_database *database = make_database(NULL, MATERIALS, GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_basis_learn(NULL, database, &some, &basis), GONIO_OK);
    assert_true(gonio_basis_describe(basis)->fingerprint == fingerprint);
    gonio_basis_free(&basis);
    gonio_database_free(&database);
}

static void test_the_full_grid_on_any_number_of_threads(void **state)
{
    (void)state;
    uint64_t checksum = 0;
    for (int threads = 1; threads <= 3; threads++) {
        const gonio_context_options options = {.size = sizeof options, .threads = threads};
        gonio_context *context = NULL;
        assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
        gonio_database *database = make_database(context, 3, GONIO_FULL, GONIO_SEPARATE);
        gonio_basis *basis = learn(context, database, 8);
        const gonio_basis_view *view = gonio_basis_describe(basis);
        assert_int_equal(view->rows, 1096216);
        checksum = threads == 1 ? view->checksum : checksum;
        assert_true(view->checksum == checksum);
        if (threads == 1) {
            double *vectors = exact_vectors(context, database, basis);
            assert_orthonormal(basis, vectors);
            assert_projection(database, basis, vectors);
            free(vectors);
        }
        gonio_basis_free(&basis);
        gonio_database_free(&database);
        gonio_context_free(&context);
    }
}

/* Two materials that differ by little more than rounding from being copies: V'V needs mending. */
static void test_nearly_dependent_columns(void **state)
{
    (void)state;
    static const double red[4] = {1.0, 1.0 + 1e-5, 1.0, 2.0};
    char *folder = support_folder();
    char names[4][256];
    const char *files[4];
    for (size_t k = 0; k < 4; k++) {
        const made_constant made = {{red[k], k == 2 ? 1.0 + 1e-5 : 1.0, 1.0}, NULL};
        gonio_material *material = made_material(made);
        files[k] = names[k];
        snprintf(names[k], sizeof names[k], "%s/%zu.binary", folder, k);
        assert_int_equal(gonio_material_write_merl(NULL, material, names[k]), GONIO_OK);
        gonio_material_free(&material);
    }
    const gonio_database_options options = {.size = sizeof options, .channels = GONIO_JOINT};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(NULL, files, 4, &options, &database), GONIO_OK);
    gonio_basis *basis = learn(NULL, database, 2);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    assert_true(view->variances[1] < 1e-8 * view->variances[0]);
    double *vectors = exact_vectors(NULL, database, basis);
    assert_orthonormal(basis, vectors);
    free(vectors);
    gonio_basis_free(&basis);
    gonio_database_free(&database);
    support_remove(folder);
}

static int stop_learning(void *user, const char *task, double fraction)
{
    double *last = user;
    if (strcmp(task, "learning") != 0) {
        return 0;
    }
    *last = fraction;
    return fraction > 0.6; /* in the second pass */
}

static void test_learning_can_be_stopped(void **state)
{
    (void)state;
    double last = 0.0;
    const gonio_context_options options = {
        .size = sizeof options, .progress = stop_learning, .user = &last};
    gonio_context *context = NULL;
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    gonio_database *database = make_database(context, 3, GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_basis_learn(context, database, NULL, &basis), GONIO_ERROR_CANCELLED);
    assert_null(basis);
    assert_true(last > 0.6 && last < 1.0);
    gonio_database_free(&database);
    gonio_context_free(&context);
}

static void test_what_cannot_be_learned(void **state)
{
    (void)state;
    enum { size = sizeof(gonio_basis_options) };
    static const size_t twice[] = {0, 1, 0, 1};
    const struct {
        gonio_basis_options options;
        gonio_status status;
        const char *message;
    } cases[] = {
        {{.size = size, .components = MATERIALS}, GONIO_ERROR_ARGUMENT, "give at most 5"},
        {{.size = size, .subset = twice, .subset_count = 1},
         GONIO_ERROR_ARGUMENT,
         "at least 2 materials"},
        {{.size = size, .subset = twice, .subset_count = 4},
         GONIO_ERROR_DATA,
         "span only 1 dimensions"},
    };
    gonio_context *context = support_context();
    gonio_database *database = make_database(NULL, MATERIALS, GONIO_BIVARIATE, GONIO_JOINT);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_basis *basis = NULL;
        assert_int_equal(gonio_basis_learn(context, database, &cases[k].options, &basis),
                         cases[k].status);
        assert_null(basis);
        assert_non_null(strstr(support_message(), cases[k].message));
    }
    gonio_database_free(&database);
    gonio_context_free(&context);
}

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

/* ---- lies in a file ---- */

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

/* ---- look-ups ---- */

static void test_row_at_a_centre_is_the_cells_own(void **state)
{
    (void)state;
    gonio_database *database = make_database(NULL, 3, GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *basis = learn(NULL, database, 2);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    double *vectors = support_vectors(basis);
    for (size_t position = 0; position < view->cells; position += 17) {
        const int32_t cell = view->cell[position];
        const gonio_bin bin = {cell / GONIO_THETA_D_BINS, cell % GONIO_THETA_D_BINS, 50};
        assert_int_equal(gonio_basis_position(basis, cell), position);
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            const size_t row = 3 * position + (size_t)channel;
            double mean = 0.0;
            double found[2];
            gonio_basis_row_at(basis, gonio_bin_centre(bin), channel, 2, &mean, found);
            assert_close(mean, view->mean[row], 1e-11);
            assert_close(found[0], vectors[2 * row], 1e-13);
            assert_close(found[1], vectors[2 * row + 1], 1e-13);
        }
    }
    free(vectors);
    /* Half way between two centres: their average. */
    const gonio_half_difference a = gonio_bin_centre((gonio_bin){20, 30, 0});
    const gonio_half_difference b = gonio_bin_centre((gonio_bin){20, 31, 0});
    double mean[3], rows[3];
    gonio_basis_row_at(basis, a, 1, 1, &mean[0], &rows[0]);
    gonio_basis_row_at(basis, b, 1, 1, &mean[1], &rows[1]);
    gonio_basis_row_at(basis,
                       (gonio_half_difference){a.theta_h, 0.5 * (a.theta_d + b.theta_d), 1.0}, 1, 1,
                       &mean[2], &rows[2]);
    assert_close(mean[2], 0.5 * (mean[0] + mean[1]), 1e-12);
    assert_close(rows[2], 0.5 * (rows[0] + rows[1]), 1e-14);
    gonio_basis_free(&basis);
    gonio_database_free(&database);
}

/* Squared distance in index space, phi_d periodic. */
static int distance(gonio_bin a, gonio_bin b)
{
    const int h = a.theta_h - b.theta_h;
    const int d = a.theta_d - b.theta_d;
    const int p = abs(a.phi_d - b.phi_d);
    const int turn = p < GONIO_PHI_D_BINS - p ? p : GONIO_PHI_D_BINS - p;
    return h * h + d * d + turn * turn;
}

/* The nearest cell, lowest position first, by looking at all of them. */
static size_t nearest(const gonio_basis_view *view, gonio_bin bin)
{
    const int depth = view->representation == GONIO_FULL ? 1 : GONIO_PHI_D_BINS;
    size_t best = 0;
    int least = 1 << 30;
    for (size_t k = 0; k < view->cells; k++) {
        const int found = distance(bin, gonio_bin_from_index(view->cell[k] * depth));
        if (found < least) {
            best = k;
            least = found;
        }
    }
    return best;
}

/* Looks at cells without data: there the nearest with data stands in. */
static void assert_nearest(gonio_representation representation, const char *const *files,
                           int trials)
{
    const bool full = representation == GONIO_FULL;
    const gonio_database_options options = {.size = sizeof options,
                                            .representation = representation};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(NULL, files, 2, &options, &database), GONIO_OK);
    gonio_basis *basis = learn(NULL, database, 1);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const int depth = full ? 1 : GONIO_PHI_D_BINS;
    gonio_i_random random;
    gonio_i_random_seed(&random, 9, 0);
    while (trials > 0) {
        const int32_t cell =
            (int32_t)gonio_i_random_below(&random, full ? GONIO_BINS : GONIO_CELLS);
        const size_t found = gonio_basis_position(basis, cell);
        if (view->cell[found] != cell) {
            assert_int_equal(found, nearest(view, gonio_bin_from_index(cell * depth)));
            trials--;
        }
    }
    gonio_basis_free(&basis);
    gonio_database_free(&database);
}

static bool is_scattered_hole(gonio_bin bin)
{
    return bin.phi_d < 3 || bin.phi_d > 120 || (bin.theta_h + 3 * bin.theta_d) % 5 > 1;
}

static void test_cells_without_data_have_the_nearest(void **state)
{
    (void)state;
    char *folder = support_folder();
    char a[256], b[256];
    const char *const holes[2] = {a, b};
    snprintf(a, sizeof a, "%s/a.binary", folder);
    snprintf(b, sizeof b, "%s/b.binary", folder);
    for (int k = 0; k < 2; k++) {
        gonio_material *material =
            made_material((made_constant){{1.0 + k, 1.0, 1.0}, is_scattered_hole});
        assert_int_equal(gonio_material_write_merl(NULL, material, holes[k]), GONIO_OK);
        gonio_material_free(&material);
    }
    assert_nearest(GONIO_BIVARIATE, paths, 60);
    assert_nearest(GONIO_FULL, paths, 60);
    assert_nearest(GONIO_BIVARIATE, holes, 500);
    assert_nearest(GONIO_FULL, holes, 200);
    support_remove(folder);
}

static void test_rows_that_a_basis_does_not_have(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_database *database = make_database(NULL, 3, GONIO_BIVARIATE, GONIO_JOINT);
    gonio_basis *basis = learn(NULL, database, 2);
    const size_t rows = gonio_basis_describe(basis)->rows;
    const struct {
        size_t first, count, components;
    } wrong[] = {{rows, 1, 2}, {0, rows + 1, 2}, {rows - 1, 2, 1}, {rows + 1, 0, 1}, {0, 1, 3}};
    double *all = support_vectors(basis);
    double few[3] = {7.0, 7.0, 7.0};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(gonio_basis_rows(context, basis, wrong[k].first, wrong[k].count,
                                          wrong[k].components, few),
                         GONIO_ERROR_ARGUMENT);
        assert_non_null(strstr(support_message(), "but the basis has 2 components"));
        assert_true(few[0] == 7.0);
    }
    assert_int_equal(gonio_basis_rows(context, basis, rows - 2, 2, 1, few), GONIO_OK);
    assert_true(few[0] == all[2 * rows - 4] && few[1] == all[2 * rows - 2] && few[2] == 7.0);
    assert_int_equal(gonio_basis_rows(context, basis, rows, 0, 2, few), GONIO_OK);
    free(all);
    gonio_basis_free(&basis);
    gonio_database_free(&database);
    gonio_context_free(&context);
}

/* Learned by the steps that a recipe stands for. */
static gonio_basis *learn_by_steps(const gonio_database_options *grid,
                                   const gonio_basis_options *options)
{
    gonio_database *database = NULL;
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_database_create(NULL, paths, 3, grid, &database), GONIO_OK);
    assert_int_equal(gonio_basis_learn(NULL, database, options, &basis), GONIO_OK);
    gonio_database_free(&database);
    return basis;
}

static void assert_learns(const gonio_recipe *recipe, gonio_basis *expected)
{
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_learn(NULL, paths, 3, recipe, &basis), GONIO_OK);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    assert_true(view->checksum == gonio_basis_describe(expected)->checksum);
    gonio_basis_free(&basis);
    gonio_basis_free(&expected);
}

static void test_recipes(void **state)
{
    (void)state;
    const gonio_database_options papers = {
        .size = sizeof papers, .representation = GONIO_BIVARIATE, .channels = GONIO_JOINT};
    const gonio_database_options relative = {.size = sizeof relative,
                                             .representation = GONIO_BIVARIATE,
                                             .channels = GONIO_SEPARATE,
                                             .mapping = GONIO_LOG_RELATIVE};
    const gonio_basis_options nothing = {.size = sizeof nothing, .components = 0};
    const gonio_basis_options without_mean = {
        .size = sizeof without_mean, .without_mean = true, .components = 4};
    gonio_recipe recipe;
    gonio_recipe_paper(&recipe);
    assert_learns(&recipe, learn_by_steps(&papers, &nothing));
    recipe.channels = GONIO_SEPARATE;
    recipe.mapping = GONIO_LOG_RELATIVE;
    recipe.without_mean = true;
    recipe.components = 4;
    assert_learns(&recipe, learn_by_steps(&relative, &without_mean));
}

/* The library's defaults are one: of the recipe, of no recipe, of databases and of bases. */
static void test_the_default_recipe(void **state)
{
    (void)state;
    gonio_database_options grid;
    gonio_basis_options options;
    gonio_recipe recipe;
    gonio_database_options_default(&grid);
    gonio_basis_options_default(&options);
    gonio_recipe_default(&recipe);
    assert_true(grid.representation == recipe.representation && grid.channels == recipe.channels &&
                grid.mapping == recipe.mapping && options.mixtures == recipe.mixtures &&
                options.components == recipe.components && options.seed == recipe.seed);
    options.mixtures = 20;
    recipe.mixtures = 20;
    assert_learns(&recipe, learn_by_steps(NULL, &options));
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_learn(NULL, paths, 2, NULL, &basis), GONIO_OK);
    const gonio_basis_view *view = gonio_basis_describe(basis);
    assert_true(view->representation == GONIO_SECTORED && view->channels == GONIO_SEPARATE);
    assert_int_equal(view->mixtures, GONIO_DEFAULT_MIXTURES);
    gonio_basis_free(&basis);
}

/* A caller that knows fewer fields gets the default of the others. */
static void test_recipes_of_older_callers(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_basis *basis = NULL;
    gonio_recipe recipe;
    gonio_recipe_paper(&recipe);
    recipe.size = offsetof(gonio_recipe, components);
    recipe.components = 1000; /* not looked at */
    recipe.mixtures = 1;
    recipe.scratch = "/nonexistent";
    assert_int_equal(gonio_learn(context, paths, 3, &recipe, &basis), GONIO_OK);
    assert_int_equal(gonio_basis_describe(basis)->components, 2);
    assert_int_equal(gonio_basis_describe(basis)->mixtures, 0);
    gonio_basis_free(&basis);
    recipe = (gonio_recipe){.size = 0};
    assert_int_equal(gonio_learn(context, paths, 3, &recipe, &basis), GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), "gonio_recipe_default"));
    gonio_recipe_default(&recipe);
    assert_int_equal(gonio_learn(context, paths, 0, &recipe, &basis), GONIO_ERROR_ARGUMENT);
    assert_null(basis);
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_joint),
        cmocka_unit_test(test_separate),
        cmocka_unit_test(test_threads_and_subsets_do_not_matter),
        cmocka_unit_test(test_the_full_grid_on_any_number_of_threads),
        cmocka_unit_test(test_nearly_dependent_columns),
        cmocka_unit_test(test_recipes),
        cmocka_unit_test(test_the_default_recipe),
        cmocka_unit_test(test_recipes_of_older_callers),
        cmocka_unit_test(test_learning_can_be_stopped),
        cmocka_unit_test(test_what_cannot_be_learned),
        cmocka_unit_test(test_the_file_keeps_everything),
        cmocka_unit_test(test_lies_in_a_file),
        cmocka_unit_test(test_damage_is_noticed),
        cmocka_unit_test(test_rows_that_a_basis_does_not_have),
        cmocka_unit_test(test_row_at_a_centre_is_the_cells_own),
        cmocka_unit_test(test_cells_without_data_have_the_nearest),
    };
    return cmocka_run_group_tests_name("basis", tests, NULL, NULL);
}
