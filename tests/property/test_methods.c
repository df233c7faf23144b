/* The planning methods that others published, against plain ways to the same numbers. */
#include "../support.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "basis/basis.h"
#include "core/random.h"
#include "methods_fixture.h"

static size_t *make_rows(const fixture *f, const gonio_basis *basis, const char *method,
                         size_t count, double *condition)
{
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.method = method;
    options.count = count;
    options.restarts = 1;
    gonio_plan *plan = NULL;
    assert_int_equal(gonio_plan_create(f->context, basis, &options, &plan), GONIO_OK);
    assert_string_equal(plan->method, method);
    size_t *rows = malloc(count * sizeof *rows);
    assert_int_equal(gonio_plan_rows(NULL, plan, basis, rows), GONIO_OK);
    for (size_t j = 1; j < count; j++) {
        assert_true(rows[j - 1] < rows[j]);
    }
    *condition = plan->condition_number;
    gonio_plan_free(&plan);
    return rows;
}

/* V S, [rows][components]. */
static double *make_scaled(const gonio_basis *basis, size_t components)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    double *q = malloc(view->rows * components * sizeof *q);
    assert_non_null(q);
    assert_int_equal(gonio_basis_rows(NULL, basis, 0, view->rows, components, q), GONIO_OK);
    for (size_t i = 0; i < view->rows; i++) {
        for (size_t k = 0; k < components; k++) {
            q[i * components + k] *= gonio_basis_singular_value(basis, k);
        }
    }
    return q;
}

static double condition_of(const double *q, size_t all, size_t components, const size_t *rows,
                           size_t count)
{
    double condition = 0.0;
    assert_int_equal(
        gonio_condition_number(NULL, q, all, components, components, rows, count, &condition),
        GONIO_OK);
    return condition;
}

/* Every material of the basis comes back from enough rows. */
static void test_matusik_gives_its_materials_back(void **state)
{
    const fixture *f = *state;
    double condition = 0.0;
    size_t *rows = make_rows(f, f->plain, "matusik", 20, &condition);
    const gonio_basis_view *view = gonio_basis_describe(f->plain);
    double *q = make_scaled(f->plain, view->components);
    assert_close(condition_of(q, view->rows, view->components, rows, 20), condition,
                 1e-6 * condition);
    for (size_t k = 0; k < MATERIALS; k++) {
        gonio_material *original = NULL;
        gonio_material *average = NULL;
        gonio_material *found = NULL;
        gonio_comparison comparison;
        assert_int_equal(gonio_material_open(NULL, paths[k], &original), GONIO_OK);
        assert_int_equal(gonio_bivariate_material(NULL, original, &average), GONIO_OK);
        assert_int_equal(
            gonio_reconstruct_material(f->context, f->plain, original, rows, 20, NULL, &found),
            GONIO_OK);
        assert_int_equal(gonio_compare(NULL, average, found, &comparison), GONIO_OK);
        assert_true(comparison.all.value[GONIO_E6] < 1e-3);
        gonio_material_free(&found);
        gonio_material_free(&average);
        gonio_material_free(&original);
    }
    free(q);
    free(rows);
}

/* The neighbours of a bivariate row, by looking for the cell; SIZE_MAX where there is none. */
static size_t shifted(const gonio_basis_view *view, size_t row, int theta_h, int theta_d)
{
    const int h = view->cell[row] / GONIO_THETA_D_BINS + theta_h;
    const int d = view->cell[row] % GONIO_THETA_D_BINS + theta_d;
    for (size_t k = 0; k < view->cells; k++) {
        if (view->cell[k] == d + GONIO_THETA_D_BINS * h && d >= 0 && d < GONIO_THETA_D_BINS) {
            return k;
        }
    }
    return SIZE_MAX;
}

static bool among(const size_t *rows, size_t count, size_t row)
{
    for (size_t j = 0; j < count; j++) {
        if (rows[j] == row) {
            return true;
        }
    }
    return false;
}

/* No move of a row by 1 or 3 bins lowers the condition number. */
static void test_nielsen_ends_where_no_move_helps(void **state)
{
    const fixture *f = *state;
    enum { N = 7 };
    double condition = 0.0;
    size_t *rows = make_rows(f, f->relative, "nielsen", N, &condition);
    const gonio_basis_view *view = gonio_basis_describe(f->relative);
    double *q = make_scaled(f->relative, N);
    assert_close(condition_of(q, view->rows, N, rows, N), condition, 1e-6 * condition);
    static const int moves[8][2] = {{1, 0}, {-1, 0}, {3, 0}, {-3, 0},
                                    {0, 1}, {0, -1}, {0, 3}, {0, -3}};
    for (size_t j = 0; j < N; j++) {
        const size_t old = rows[j];
        for (int m = 0; m < 8; m++) {
            const size_t moved = shifted(view, old, moves[m][0], moves[m][1]);
            if (moved != SIZE_MAX && !among(rows, N, moved)) {
                rows[j] = moved;
                assert_true(condition_of(q, view->rows, N, rows, N) > condition * (1.0 - 1e-8));
                rows[j] = old;
            }
        }
    }
    free(q);
    free(rows);
}

enum { PURSUED = 6 };

/* What least squares of y on the columns d[chosen] leaves of it. */
static void residual_of(const double *d, const size_t *chosen, size_t count, const double *y,
                        double *residual)
{
    double a[PURSUED * PURSUED] = {0};
    double x[PURSUED] = {0};
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < PURSUED; k++) {
            x[i] += d[chosen[i] * PURSUED + k] * y[k];
            for (size_t j = 0; j < count; j++) {
                a[i * count + j] += d[chosen[i] * PURSUED + k] * d[chosen[j] * PURSUED + k];
            }
        }
    }
    eliminate(count, a, x);
    for (size_t k = 0; k < PURSUED; k++) {
        residual[k] = y[k];
        for (size_t i = 0; i < count; i++) {
            residual[k] -= x[i] * d[chosen[i] * PURSUED + k];
        }
    }
}

/* Columns of pinv(S) V', each of length 1: d[position][component]. */
static double *make_dictionary(const gonio_basis *basis)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    double *d = malloc(view->rows * PURSUED * sizeof *d);
    assert_non_null(d);
    assert_int_equal(gonio_basis_rows(NULL, basis, 0, view->rows, PURSUED, d), GONIO_OK);
    for (size_t i = 0; i < view->rows; i++) {
        double squares = 0.0;
        for (size_t k = 0; k < PURSUED; k++) {
            d[i * PURSUED + k] /= gonio_basis_singular_value(basis, k);
            squares += d[i * PURSUED + k] * d[i * PURSUED + k];
        }
        for (size_t k = 0; k < PURSUED; k++) {
            d[i * PURSUED + k] /= sqrt(squares);
        }
    }
    return d;
}

static void test_frost_is_simultaneous_matching_pursuit(void **state)
{
    const fixture *f = *state;
    double condition = 0.0;
    size_t *rows = make_rows(f, f->relative, "frost", PURSUED, &condition);
    const gonio_basis_view *view = gonio_basis_describe(f->relative);
    double *d = make_dictionary(f->relative);
    double *q = make_scaled(f->relative, PURSUED);
    double target[PURSUED][PURSUED];
    double residual[PURSUED][PURSUED];
    size_t chosen[PURSUED];
    for (size_t material = 0; material < PURSUED; material++) {
        for (size_t k = 0; k < PURSUED; k++) {
            target[material][k] = view->loadings[material * view->components + k];
        }
    }
    memcpy(residual, target, sizeof target);
    for (size_t step = 0; step < PURSUED; step++) {
        double most = -1.0;
        for (size_t i = 0; i < view->rows; i++) {
            double score = 0.0;
            for (size_t material = 0; material < PURSUED; material++) {
                double product = 0.0;
                for (size_t k = 0; k < PURSUED; k++) {
                    product += d[i * PURSUED + k] * residual[material][k];
                }
                score += fabs(product);
            }
            chosen[step] = score > most ? i : chosen[step];
            most = fmax(score, most);
        }
        for (size_t material = 0; material < PURSUED; material++) {
            residual_of(d, chosen, step + 1, target[material], residual[material]);
        }
        assert_true(among(rows, PURSUED, chosen[step]));
    }
    assert_close(condition_of(q, view->rows, PURSUED, rows, PURSUED), condition, 1e-6 * condition);
    free(q);
    free(d);
    free(rows);
}

static void test_any_number_of_threads(void **state)
{
    const fixture *f = *state;
    static const char *const methods[] = {"matusik", "nielsen", "frost"};
    for (size_t m = 0; m < 3; m++) {
        const gonio_basis *basis = m == 0 ? f->plain : f->relative;
        size_t *first = NULL;
        for (int threads = 1; threads <= 3; threads++) {
            const gonio_context_options options = {.size = sizeof options, .threads = threads};
            fixture other = {0};
            double condition = 0.0;
            assert_int_equal(gonio_context_create(&other.context, &options), GONIO_OK);
            size_t *rows = make_rows(&other, basis, methods[m], 9, &condition);
            if (first != NULL) {
                assert_memory_equal(rows, first, 9 * sizeof *rows);
                free(rows);
            } else {
                first = rows;
            }
            gonio_context_free(&other.context);
        }
        free(first);
    }
}

static void test_components_follow_the_readings(void **state)
{
    const fixture *f = *state;
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.method = "nielsen";
    for (size_t n = 1; n <= 17; n += 4) {
        gonio_plan *plan = NULL;
        options.count = n;
        assert_int_equal(gonio_plan_create(f->context, f->relative, &options, &plan), GONIO_OK);
        assert_int_equal(plan->components, n < 12 ? n : 12);
        gonio_plan_free(&plan);
    }
}

static void test_what_a_method_cannot_work_on(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *method, *message;
        size_t count;
    } cases[] = {
        {"matusik", "gonio learn --no-mean --grid full", 20},
        {"frost", "13 readings need a basis with as many (gonio learn --components 13)", 13},
    };
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    gonio_plan *plan = NULL;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        options.method = cases[k].method;
        options.count = cases[k].count;
        assert_int_equal(gonio_plan_create(f->context, f->relative, &options, &plan),
                         GONIO_ERROR_ARGUMENT);
        assert_non_null(strstr(support_message(), cases[k].message));
        assert_null(plan);
    }
    static const char *const needing[] = {"matusik", "nielsen", "frost"};
    const double rows[4] = {1.0, 2.0, 3.0, 4.0};
    for (size_t k = 0; k < 3; k++) {
        size_t chosen[2];
        gonio_selection_report report;
        options.method = needing[k];
        options.count = 2;
        assert_int_equal(gonio_plan_select(f->context, rows, 4, 1, 1, &options, chosen, &report),
                         GONIO_ERROR_ARGUMENT);
    }
    assert_string_equal(gonio_plan_method_reconstruction("frost"), "ridge");
    assert_string_equal(gonio_plan_method_reconstruction("condition"), "least-squares");
    assert_null(gonio_plan_method_reconstruction("none"));
    for (int k = 0; gonio_plan_method_name(k) != NULL; k++) {
        const char *name = gonio_plan_method_name(k);
        const gonio_plan_basis *meant = gonio_plan_method_basis(name);
        assert_non_null(meant);
        assert_int_equal(meant->mixtures,
                         strcmp(gonio_plan_method_reconstruction(name), "posterior") == 0);
        assert_int_equal(meant->without_mean, strcmp(name, "matusik") == 0);
    }
    const gonio_plan_basis *frosts = gonio_plan_method_basis("frost");
    assert_int_equal(frosts->representation, GONIO_FULL);
    assert_int_equal(frosts->mapping, GONIO_LOG_RELATIVE);
    assert_null(gonio_plan_method_basis("none"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_matusik_gives_its_materials_back),
        cmocka_unit_test(test_nielsen_ends_where_no_move_helps),
        cmocka_unit_test(test_frost_is_simultaneous_matching_pursuit),
        cmocka_unit_test(test_any_number_of_threads),
        cmocka_unit_test(test_components_follow_the_readings),
        cmocka_unit_test(test_what_a_method_cannot_work_on),
    };
    return cmocka_run_group_tests_name("methods", tests, set_up, tear_down);
}
