/* Learning by certificates: orthonormality, projection of what was learned from, variances, any
 * number of threads. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "basis/basis.h"
#include "learned_basis.h"
#include "made_material.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_joint),
        cmocka_unit_test(test_separate),
        cmocka_unit_test(test_threads_and_subsets_do_not_matter),
        cmocka_unit_test(test_the_full_grid_on_any_number_of_threads),
        cmocka_unit_test(test_nearly_dependent_columns),
        cmocka_unit_test(test_learning_can_be_stopped),
        cmocka_unit_test(test_what_cannot_be_learned),
    };
    return cmocka_run_group_tests_name("basis", tests, NULL, NULL);
}
