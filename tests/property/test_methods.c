/* The methods that plans are compared with, against plain ways to the same numbers. */
#include "../support.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "basis/basis.h"
#include "core/random.h"

enum { MATERIALS = 7, MOST = 3 * MATERIALS };

static const char *const paths[MATERIALS] = {
    "atlas:gold-polished", "atlas:red-glossy-plastic", "atlas:burgundy-velvet", "atlas:oak-sawn",
    "atlas:plaster-cast",  "atlas:steel-brushed",      "atlas:white-linen"};

typedef struct fixture {
    gonio_context *context;
    gonio_basis *relative; /* bivariate, separate, centred: what nielsen and frost work on */
    gonio_basis *plain;    /* bivariate, joint, without mean: what matusik works on */
} fixture;

static gonio_database *make_database(gonio_representation representation,
                                     gonio_channel_model channels, gonio_mapping mapping)
{
    const gonio_database_options how = {.size = sizeof how,
                                        .representation = representation,
                                        .channels = channels,
                                        .mapping = mapping};
    gonio_database *database = NULL;
    assert_int_equal(gonio_database_create(NULL, paths, MATERIALS, &how, &database), GONIO_OK);
    return database;
}

static gonio_basis *learn(gonio_channel_model channels, gonio_mapping mapping,
                          gonio_basis_options options)
{
    gonio_database *database = make_database(GONIO_BIVARIATE, channels, mapping);
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_basis_learn(NULL, database, &options, &basis), GONIO_OK);
    gonio_database_free(&database);
    return basis;
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->context = support_context();
    f->relative =
        learn(GONIO_SEPARATE, GONIO_LOG_RELATIVE,
              (gonio_basis_options){.size = sizeof(gonio_basis_options), .components = 12});
    f->plain =
        learn(GONIO_JOINT, GONIO_LOG,
              (gonio_basis_options){.size = sizeof(gonio_basis_options), .without_mean = true});
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_basis_free(&f->relative);
    gonio_basis_free(&f->plain);
    gonio_context_free(&f->context);
    free(f);
    return 0;
}

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

/* ---- the mapping ---- */

static double weight(gonio_half_difference at)
{
    double incident = 0.0;
    double outgoing = 0.0;
    gonio_cosines(at, &incident, &outgoing);
    return fmin(fmax(incident * outgoing, 0.01), 1.0);
}

static void test_mappings_and_their_inverses(void **state)
{
    (void)state;
    static const double rho[] = {0.0, 1e-6, 0.02, 1.0, 350.0, 1e5};
    double *scale = malloc(GONIO_SLAB_BINS * sizeof *scale);
    for (int32_t index = 0; index < GONIO_BINS; index += 1009) {
        const gonio_bin bin = gonio_bin_from_index(index);
        const gonio_half_difference at = gonio_bin_centre(bin);
        for (size_t k = 0; k < sizeof rho / sizeof *rho && gonio_bin_is_valid(bin); k++) {
            const double g = gonio_mapped_from_brdf(GONIO_LOG_RELATIVE, rho[k], 1, at);
            assert_close(g, log((rho[k] * weight(at) + 0.001) / 0.001), 1e-12);
            assert_close(gonio_brdf_from_mapped(GONIO_LOG_RELATIVE, g, 1, at), rho[k],
                         1e-13 * rho[k]);
            assert_true(gonio_mapped_from_brdf(GONIO_LOG, rho[k], 1, at) ==
                        gonio_log_from_brdf(rho[k], 1));
            assert_close(gonio_brdf_from_mapped(GONIO_LOG, gonio_log_from_brdf(rho[k], 1), 1, at),
                         rho[k], 1e-13 * rho[k]);
        }
        for (int mapping = GONIO_LOG; mapping <= GONIO_LOG_RELATIVE; mapping++) {
            gonio_slab_scale((gonio_mapping)mapping, 2, bin.theta_h, scale);
            const double expected = gonio_mapping_scale((gonio_mapping)mapping, 2, at);
            assert_close(scale[bin.theta_d * GONIO_PHI_D_BINS + bin.phi_d], expected,
                         1e-9 * expected);
        }
    }
    assert_true(gonio_brdf_from_mapped(GONIO_LOG_RELATIVE, -1.0, 0, (gonio_half_difference){0}) ==
                0.0);
    free(scale);
}

/* The relative matrix of both grids against the bins of the materials. */
static void assert_relative_rows(gonio_representation representation)
{
    gonio_database *database = make_database(representation, GONIO_SEPARATE, GONIO_LOG_RELATIVE);
    const gonio_database_view *view = gonio_database_describe(database);
    assert_int_equal(view->mapping, GONIO_LOG_RELATIVE);
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    double row[MOST];
    assert_int_equal(gonio_material_open(NULL, paths[0], &material), GONIO_OK);
    assert_int_equal(gonio_table_load(NULL, material, &table), GONIO_OK);
    for (size_t i = 0; i < view->cells; i += view->cells / 97) {
        const bool full = representation == GONIO_FULL;
        const gonio_bin first = gonio_bin_from_index(view->cell[i] * (full ? 1 : GONIO_PHI_D_BINS));
        double sum = 0.0;
        int bins = 0;
        for (int p = first.phi_d; p < (full ? first.phi_d + 1 : GONIO_PHI_D_BINS); p++) {
            const gonio_bin bin = {first.theta_h, first.theta_d, p};
            double rho[GONIO_CHANNELS];
            if (gonio_bin_is_valid(bin) && gonio_table_value(table, gonio_bin_centre(bin), rho)) {
                sum += log((rho[1] * weight(gonio_bin_centre(bin)) + 0.001) / 0.001);
                bins++;
            }
        }
        assert_int_equal(gonio_database_read_rows(NULL, database, i, 1, NULL, 0, row), GONIO_OK);
        assert_close(row[1], sum / bins, 2e-6);
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
    gonio_database_free(&database);
}

static void test_relative_rows(void **state)
{
    (void)state;
    assert_relative_rows(GONIO_BIVARIATE);
    assert_relative_rows(GONIO_FULL);
}

/* ---- bases ---- */

static int compare_values(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Without mean, a row of the relative mapping is relative to its median over what is learned from:
 * an odd and an even number of columns, and a subset. */
static void test_medians_of_what_is_learned(void **state)
{
    (void)state;
    static const size_t subset[] = {5, 0, 3, 6};
    gonio_database *database = make_database(GONIO_BIVARIATE, GONIO_SEPARATE, GONIO_LOG_RELATIVE);
    for (size_t count = 3; count <= 4; count++) {
        const gonio_basis_options options = {
            .size = sizeof options, .subset = subset, .subset_count = count, .without_mean = true};
        gonio_basis *basis = NULL;
        assert_int_equal(gonio_basis_learn(NULL, database, &options, &basis), GONIO_OK);
        const gonio_basis_view *view = gonio_basis_describe(basis);
        assert_int_equal(view->components, 3 * count);
        assert_int_equal(view->columns, 3 * count);
        assert_int_equal(view->variance_count, 3 * count);
        for (size_t i = 0; i < view->rows; i += 211) {
            double x[MOST];
            assert_int_equal(gonio_database_read_rows(NULL, database, i, 1, subset, count, x),
                             GONIO_OK);
            for (size_t j = 0; j < 3 * count; j++) {
                x[j] = 0.001 * expm1(x[j]); /* rho w */
            }
            qsort(x, 3 * count, sizeof *x, compare_values);
            const double median = 0.5 * (x[(3 * count - 1) / 2] + x[3 * count / 2]);
            assert_close(view->mean[i], log((median + 0.001) / 0.001), 1e-12);
        }
        gonio_basis_free(&basis);
    }
    gonio_database_free(&database);
}

/* H - m = V S W' with all components, W'W = I. */
static void test_loadings(void **state)
{
    (void)state;
    for (int without_mean = 0; without_mean < 2; without_mean++) {
        gonio_database *database = make_database(GONIO_BIVARIATE, GONIO_JOINT, GONIO_LOG);
        const gonio_basis_options options = {.size = sizeof options, .without_mean = without_mean};
        gonio_basis *basis = NULL;
        double *vectors = NULL; /* before they are rounded */
        assert_int_equal(gonio_i_basis_learn_exact(NULL, database, &options, &basis, &vectors),
                         GONIO_OK);
        assert_int_equal(gonio_i_basis_finish(NULL, basis), GONIO_OK);
        const gonio_basis_view *view = gonio_basis_describe(basis);
        const size_t k = view->components;
        assert_int_equal(k, without_mean ? MATERIALS : MATERIALS - 1);
        for (size_t i = 0; i < view->rows; i += 97) {
            double h[MATERIALS];
            assert_int_equal(gonio_database_read_rows(NULL, database, i, 1, NULL, 0, h), GONIO_OK);
            assert_true(!without_mean || view->mean[i] == 0.0);
            for (size_t column = 0; column < MATERIALS; column++) {
                double sum = view->mean[i];
                for (size_t j = 0; j < k; j++) {
                    sum += vectors[i * k + j] * gonio_basis_singular_value(basis, j) *
                           view->loadings[column * k + j];
                }
                assert_close(sum, h[column], 1e-9);
            }
        }
        free(vectors);
        for (size_t a = 0; a < k * k; a++) {
            double sum = 0.0;
            for (size_t column = 0; column < MATERIALS; column++) {
                sum += view->loadings[column * k + a / k] * view->loadings[column * k + a % k];
            }
            assert_close(sum, a / k == a % k ? 1.0 : 0.0, 1e-12);
        }
        gonio_basis_free(&basis);
        gonio_database_free(&database);
    }
}

static void test_every_kind_has_a_fingerprint_of_its_own(void **state)
{
    (void)state;
    uint64_t seen[4];
    for (size_t kind = 0; kind < 4; kind++) {
        gonio_basis *basis = learn(GONIO_JOINT, (gonio_mapping)(kind % 2),
                                   (gonio_basis_options){.size = sizeof(gonio_basis_options),
                                                         .components = 2,
                                                         .without_mean = kind > 1});
        seen[kind] = gonio_basis_describe(basis)->fingerprint;
        for (size_t j = 0; j < kind; j++) {
            assert_true(seen[j] != seen[kind]);
        }
        gonio_basis_free(&basis);
    }
}

/* ---- plans ---- */

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

/* ---- SOMP by the book ---- */

enum { PURSUED = 6 };

/* Solves a x = b (n x n, n <= MOST), by elimination with pivoting; a and b are used up. */
static void eliminate(size_t n, double *a, double *b)
{
    for (size_t c = 0; c < n; c++) {
        size_t pivot = c;
        for (size_t r = c + 1; r < n; r++) {
            pivot = fabs(a[r * n + c]) > fabs(a[pivot * n + c]) ? r : pivot;
        }
        for (size_t k = 0; k < n; k++) {
            const double swap = a[c * n + k];
            a[c * n + k] = a[pivot * n + k];
            a[pivot * n + k] = swap;
        }
        const double swap = b[c];
        b[c] = b[pivot];
        b[pivot] = swap;
        for (size_t r = 0; r < n; r++) {
            const double factor = r == c ? 0.0 : a[r * n + c] / a[c * n + c];
            for (size_t k = 0; k < n; k++) {
                a[r * n + k] -= factor * a[c * n + k];
            }
            b[r] -= factor * b[c];
        }
    }
    for (size_t c = 0; c < n; c++) {
        b[c] /= a[c * n + c];
    }
}

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

/* ---- ridge ---- */

/* (Q'Q + eta I) c = Q'b. */
static void test_ridge_solves_the_normal_equations(void **state)
{
    const fixture *f = *state;
    const gonio_basis_view *view = gonio_basis_describe(f->relative);
    gonio_i_random random;
    gonio_i_random_seed(&random, 3, 0);
    for (size_t count = 3; count <= 30; count += 9) {
        const size_t k = count < view->components ? count : view->components;
        const double eta = count == 3 ? 0.0 : 0.01 * (double)(count * count); /* 0 is 40 */
        size_t rows[30];
        double b[GONIO_CHANNELS * 30];
        for (size_t i = 0; i < count; i++) {
            rows[i] = (size_t)gonio_i_random_below(&random, view->rows);
        }
        for (size_t i = 0; i < GONIO_CHANNELS * count; i++) {
            b[i] = 5.0 * gonio_i_random_uniform(&random);
        }
        const gonio_reconstruct_options options = {
            .size = sizeof options, .method = "ridge", .eta = eta};
        gonio_reconstruction *r = NULL;
        assert_int_equal(
            gonio_reconstruct_rows_with(f->context, f->relative, &options, rows, count, b, &r),
            GONIO_OK);
        assert_int_equal(r->components, k);
        for (size_t column = 0; column < GONIO_CHANNELS; column++) {
            double a[MOST * MOST] = {0};
            double c[MOST] = {0};
            for (size_t p = 0; p < k; p++) {
                a[p * k + p] = eta > 0.0 ? eta : 40.0;
            }
            for (size_t i = 0; i < count; i++) {
                double v[MOST];
                assert_int_equal(gonio_basis_rows(f->context, f->relative, rows[i], 1, k, v),
                                 GONIO_OK);
                for (size_t p = 0; p < k; p++) {
                    const double left = v[p] * gonio_basis_singular_value(f->relative, p);
                    c[p] += left * (b[column * count + i] - view->mean[rows[i]]);
                    for (size_t j = 0; j < k; j++) {
                        a[p * k + j] += left * v[j] * gonio_basis_singular_value(f->relative, j);
                    }
                }
            }
            eliminate(k, a, c);
            for (size_t p = 0; p < k; p++) {
                const double expected = c[p] * gonio_basis_singular_value(f->relative, p);
                assert_close(r->coefficients[column * k + p], expected,
                             1e-8 * (1.0 + fabs(expected)));
            }
        }
        gonio_reconstruction_free(&r);
    }
}

static void test_what_ridge_refuses(void **state)
{
    const fixture *f = *state;
    enum { size = sizeof(gonio_reconstruct_options) };
    const size_t row = 5;
    const double b[GONIO_CHANNELS] = {1.0, 1.0, 1.0};
    static const struct {
        gonio_reconstruct_options options;
        const char *message;
    } cases[] = {
        {{.size = size, .method = "lasso"}, "no reconstruction method is called 'lasso'"},
        {{.size = size, .method = "ridge", .eta = -1.0}, "eta has to be a number above 0"},
        {{.size = size, .method = "ridge", .eta = INFINITY}, "eta has to be a number above 0"},
        {{.size = size, .method = "ridge", .components = 13},
         "13 components asked for, but the basis has 12"},
    };
    gonio_reconstruction *r = NULL;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(
            gonio_reconstruct_rows_with(f->context, f->relative, &cases[k].options, &row, 1, b, &r),
            GONIO_ERROR_ARGUMENT);
        assert_non_null(strstr(support_message(), cases[k].message));
        assert_null(r);
    }
    assert_string_equal(gonio_reconstruct_method_name(1), "ridge");
    assert_string_equal(gonio_reconstruct_method_name(2), "posterior");
    assert_null(gonio_reconstruct_method_name(3));
    assert_true(gonio_reconstruct_method_suits_mixtures("posterior"));
    assert_false(gonio_reconstruct_method_suits_mixtures("ridge"));
    assert_false(gonio_reconstruct_method_suits_mixtures("none"));
    assert_null(gonio_reconstruct_method_summary(-1));
}

/* ---- reading known materials ---- */

/* Cell by cell what the database has of the material. */
static void test_material_rows_are_the_databases(void **state)
{
    const fixture *f = *state;
    for (int kind = GONIO_BIVARIATE; kind <= GONIO_SECTORED; kind++) {
        const gonio_mapping mapping = kind == GONIO_SECTORED ? GONIO_LOG : GONIO_LOG_RELATIVE;
        gonio_database *database =
            make_database((gonio_representation)kind, GONIO_SEPARATE, mapping);
        gonio_basis *basis = NULL;
        const gonio_basis_options options = {.size = sizeof options, .components = 3};
        gonio_material *material = NULL;
        size_t rows[11];
        double b[GONIO_CHANNELS * 11];
        double h[MOST];
        assert_int_equal(gonio_basis_learn(NULL, database, &options, &basis), GONIO_OK);
        assert_int_equal(gonio_material_open(NULL, paths[2], &material), GONIO_OK);
        for (size_t i = 0; i < 11; i++) { /* in no order, one twice */
            rows[i] = (i % 10) * 7919 * 104729 % gonio_basis_describe(basis)->rows;
        }
        assert_int_equal(gonio_material_rows(f->context, basis, material, rows, 11, b), GONIO_OK);
        for (size_t i = 0; i < 11; i++) {
            assert_int_equal(gonio_database_read_rows(NULL, database, rows[i], 1, NULL, 0, h),
                             GONIO_OK);
            for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
                assert_close(b[channel * 11 + i], h[3 * 2 + channel], 2e-6);
            }
        }
        gonio_material_free(&material);
        gonio_basis_free(&basis);
        gonio_database_free(&database);
    }
}

/* All channels of few directions determine as much as the same rows given one by one. */
static void test_all_channels_of_a_known_material(void **state)
{
    const fixture *f = *state;
    size_t few[4] = {30, 9000, 31, 15001};
    size_t all[9] = {30, 31, 32, 9000, 9001, 9002, 15000, 15001, 15002};
    const gonio_reconstruct_options more = {.size = sizeof more, .all_channels = true};
    gonio_material *original = NULL;
    gonio_material *a = NULL;
    gonio_material *b = NULL;
    gonio_comparison comparison;
    assert_int_equal(gonio_material_open(NULL, "atlas:gold-leaf", &original), GONIO_OK);
    assert_int_equal(gonio_reconstruct_material(f->context, f->plain, original, few, 4, NULL, &a),
                     GONIO_ERROR_UNDETERMINED);
    assert_int_equal(gonio_reconstruct_material(f->context, f->plain, original, few, 4, &more, &a),
                     GONIO_OK);
    assert_int_equal(gonio_reconstruct_material(f->context, f->plain, original, all, 9, NULL, &b),
                     GONIO_OK);
    assert_int_equal(gonio_compare(NULL, a, b, &comparison), GONIO_OK);
    assert_true(comparison.all.value[GONIO_E6] < 1e-9);
    gonio_material_free(&a);
    gonio_material_free(&b);
    gonio_material_free(&original);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mappings_and_their_inverses),
        cmocka_unit_test(test_relative_rows),
        cmocka_unit_test(test_medians_of_what_is_learned),
        cmocka_unit_test(test_loadings),
        cmocka_unit_test(test_every_kind_has_a_fingerprint_of_its_own),
        cmocka_unit_test(test_matusik_gives_its_materials_back),
        cmocka_unit_test(test_nielsen_ends_where_no_move_helps),
        cmocka_unit_test(test_frost_is_simultaneous_matching_pursuit),
        cmocka_unit_test(test_any_number_of_threads),
        cmocka_unit_test(test_components_follow_the_readings),
        cmocka_unit_test(test_what_a_method_cannot_work_on),
        cmocka_unit_test(test_ridge_solves_the_normal_equations),
        cmocka_unit_test(test_what_ridge_refuses),
        cmocka_unit_test(test_material_rows_are_the_databases),
        cmocka_unit_test(test_all_channels_of_a_known_material),
    };
    return cmocka_run_group_tests_name("methods", tests, set_up, tear_down);
}
