/* The error to expect: lessons and regression against dense algebra on the columns themselves, what
 * it makes of readings, and how near it is to the errors of materials that were left out. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "core/random.h"
#include "posterior/learned_error.h"

enum { READINGS = 12, FOLDS = 10, FEATURES = 4, UNKNOWNS = FEATURES + 1, MIXTURES = 60 };

static const double NOISE = 1e-3; /* log units: little beside what is left open */

/* The first 18 are learned from. */
static const char *const names[] = {"atlas:gold-polished",
                                    "atlas:copper-worn",
                                    "atlas:chromium-satin",
                                    "atlas:steel-brushed",
                                    "atlas:lead-dull",
                                    "atlas:crimson-metallic",
                                    "atlas:sapphire-metallic",
                                    "atlas:platinum-metallic",
                                    "atlas:white-pearl",
                                    "atlas:red-glossy-plastic",
                                    "atlas:blue-glossy-plastic",
                                    "atlas:green-satin-plastic",
                                    "atlas:lemon-matte-plastic",
                                    "atlas:black-glossy-plastic",
                                    "atlas:ivory-polymer",
                                    "atlas:orange-acrylic",
                                    "atlas:purple-vinyl",
                                    "atlas:pink-polystyrene",
                                    "atlas:brass-satin",
                                    "atlas:iron-ground",
                                    "atlas:gilt-lacquer",
                                    "atlas:burgundy-velvet",
                                    "atlas:oak-sawn",
                                    "atlas:red-cotton"};

enum { MATERIALS = sizeof names / sizeof *names, LEARNED = 18 };

static gonio_context *context;
static gonio_basis *basis; /* bivariate */
static gonio_i_prior *prior;

static gonio_basis *learn(size_t materials, size_t mixtures)
{
    gonio_recipe recipe;
    gonio_basis *made = NULL;
    gonio_recipe_for_grid(&recipe, GONIO_BIVARIATE);
    recipe.channels = GONIO_SEPARATE;
    recipe.mixtures = mixtures;
    recipe.seed = 3;
    assert_int_equal(gonio_learn(context, names, materials, &recipe, &made), GONIO_OK);
    return made;
}

static int set_up(void **state)
{
    (void)state;
    context = support_context();
    basis = learn(LEARNED, MIXTURES);
    assert_int_equal(gonio_i_prior_create(context, basis, &prior), GONIO_OK);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    gonio_i_prior_free(&prior);
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    return 0;
}

static double column_at(size_t column, size_t row)
{
    double f[256];
    double g = prior->view->mean[row];
    assert_true(prior->components <= 256);
    gonio_i_prior_row(prior, row, f);
    for (size_t k = 0; k < prior->components; k++) {
        g += f[k] * prior->sample[column * prior->components + k];
    }
    return g;
}

/* Readings at the middles of cells: rows spread over the grid, clear of the horizon. */
static size_t row_of(size_t reading)
{
    return (reading + 1) * 331;
}

static void read_values(const double *g, gonio_i_observation *o)
{
    for (size_t i = 0; i < READINGS; i++) {
        int channel = 0;
        o[i] =
            (gonio_i_observation){.at = gonio_i_row_coordinates(prior->view, row_of(i), &channel),
                                  .g = g[i],
                                  .variance = NOISE * NOISE};
    }
}

/* From covariances of z, which are made once for many sites, the same is found. */
static void assert_prepared_is_same(gonio_i_learned_error *learned, const gonio_i_fit *fit,
                                    double expected)
{
    gonio_i_folds *folds = NULL;
    double square = 0.0;
    assert_int_equal(gonio_i_learned_error_prepare(context, learned), GONIO_OK);
    assert_int_equal(gonio_i_folds_create(context, learned, fit->sites, &folds), GONIO_OK);
    assert_int_equal(gonio_i_learned_error_find(folds, fit, &square), GONIO_OK);
    assert_true(fabs(square - expected) <= 1e-7 * expected);
    gonio_i_folds_free(&folds);
}

static double expected_of(const gonio_i_prior *with, gonio_i_observation *o, size_t count)
{
    const gonio_i_column column = {count, o};
    gonio_i_learned_error *learned = NULL;
    gonio_i_sites *sites = NULL;
    gonio_i_folds *folds = NULL;
    gonio_i_fit gaussian;
    gonio_i_targets grid;
    double square = 0.0;
    assert_int_equal(gonio_i_targets_create(context, with, NULL, 0, &grid), GONIO_OK);
    assert_int_equal(gonio_i_learned_error_create(context, with, &grid, &learned), GONIO_OK);
    gonio_i_targets_free(&grid);
    assert_non_null(learned);
    assert_int_equal(gonio_i_sites_create(context, with, &column, &sites), GONIO_OK);
    assert_int_equal(gonio_i_folds_create(context, learned, sites, &folds), GONIO_OK);
    assert_int_equal(gonio_i_fit_begin(context, sites, false, &column, &gaussian), GONIO_OK);
    assert_int_equal(gonio_i_learned_error_find(folds, &gaussian, &square), GONIO_OK);
    assert_prepared_is_same(learned, &gaussian, square);
    gonio_i_fit_end(&gaussian);
    gonio_i_folds_free(&folds);
    gonio_i_sites_free(&sites);
    gonio_i_learned_error_free(&learned);
    return square;
}

/* ---- dense algebra ---- */

/* x = A^-1 b for a symmetric positive definite A (n x n), which is lost. */
static void solve_densely(double *a, size_t n, double *b)
{
    for (size_t c = 0; c < n; c++) {
        assert_true(a[c * n + c] > 0.0);
        for (size_t i = c + 1; i < n; i++) {
            const double factor = a[i * n + c] / a[c * n + c];
            for (size_t j = c; j < n; j++) {
                a[i * n + j] -= factor * a[c * n + j];
            }
            b[i] -= factor * b[c];
        }
    }
    for (size_t c = n; c-- > 0;) {
        for (size_t j = c + 1; j < n; j++) {
            b[c] -= a[c * n + j] * b[j];
        }
        b[c] /= a[c * n + c];
    }
}

/* The columns that a fold keeps, as values g in every row, and their shares. */
typedef struct kept {
    size_t count;
    size_t column[512];
    double share[512];
} kept;

static bool touches(size_t column, size_t fold)
{
    return column / GONIO_CHANNELS % FOLDS == fold;
}

static kept keep(size_t fold)
{
    const size_t measured = (size_t)GONIO_CHANNELS * LEARNED;
    kept k = {0};
    double all = 0.0;
    for (size_t j = 0; j < prior->samples; j++) {
        const int32_t *parent = j < measured ? NULL : prior->view->parents + 2 * (j - measured);
        const bool out = parent == NULL
                             ? touches(j, fold)
                             : touches((size_t)parent[0], fold) || touches((size_t)parent[1], fold);
        if (!out) {
            k.column[k.count] = j;
            k.share[k.count++] = prior->share[j];
            all += prior->share[j];
        }
    }
    for (size_t j = 0; j < k.count; j++) {
        k.share[j] /= all;
    }
    return k;
}

/* S and the mean of the kept columns at the readings, from the values of columns there. */
static void covariance_of(const kept *k, const double *values, double *mean, double *s)
{
    memset(mean, 0, READINGS * sizeof *mean);
    memset(s, 0, READINGS * READINGS * sizeof *s);
    for (size_t j = 0; j < k->count; j++) {
        for (size_t i = 0; i < READINGS; i++) {
            mean[i] += k->share[j] * values[k->column[j] * READINGS + i];
        }
    }
    for (size_t j = 0; j < k->count; j++) {
        const double *v = values + k->column[j] * READINGS;
        for (size_t a = 0; a < READINGS; a++) {
            for (size_t b = 0; b < READINGS; b++) {
                s[a * READINGS + b] += k->share[j] * (v[a] - mean[a]) * (v[b] - mean[b]);
            }
        }
    }
    for (size_t i = 0; i < READINGS; i++) {
        s[i * READINGS + i] += NOISE * NOISE;
    }
}

/* S^-1 b. */
static void solved_by(const double *s, const double *b, double *x)
{
    double copy[READINGS * READINGS];
    memcpy(copy, s, sizeof copy);
    memcpy(x, b, READINGS * sizeof *x);
    solve_densely(copy, READINGS, x);
}

static void features_of(const double *s, const double *mean, const double *g, double *feature)
{
    double y[READINGS];
    double x[READINGS];
    double surprise = 0.0;
    double distance = 0.0;
    double sum = 0.0;
    double square = 0.0;
    for (size_t i = 0; i < READINGS; i++) {
        y[i] = g[i] - mean[i];
    }
    solved_by(s, y, x);
    for (size_t i = 0; i < READINGS; i++) {
        double unit[READINGS] = {0};
        double column[READINGS];
        unit[i] = 1.0;
        solved_by(s, unit, column);
        surprise += x[i] * x[i] / column[i];
        distance += y[i] * x[i];
        sum += g[i];
        square += g[i] * g[i];
    }
    const double average = sum / READINGS;
    feature[0] = log(surprise / READINGS + 0.01);
    feature[1] = log(distance / READINGS + 0.01);
    feature[2] = average;
    feature[3] = log(sqrt(square / READINGS - average * average) + 0.1);
}

/* Mean square, over the bins, of what a fold makes of a column, less the column. */
static double square_of(const kept *k, const double *values, const double *rows, const double *mean,
                        const double *s, size_t column)
{
    double y[READINGS];
    double x[READINGS];
    double use[512];
    double sum = 0.0;
    double all = 0.0;
    for (size_t i = 0; i < READINGS; i++) {
        y[i] = values[column * READINGS + i] - mean[i];
    }
    solved_by(s, y, x);
    for (size_t j = 0; j < k->count; j++) {
        use[j] = 0.0;
        for (size_t i = 0; i < READINGS; i++) {
            use[j] += (values[k->column[j] * READINGS + i] - mean[i]) * x[i];
        }
    }
    for (size_t row = 0; row < prior->view->rows; row++) {
        const double bins = gonio_i_row_bins(prior->view, row);
        const double *g = rows + row * prior->samples;
        double middle = 0.0;
        double made = 0.0;
        for (size_t j = 0; j < k->count; j++) {
            middle += k->share[j] * g[k->column[j]];
        }
        for (size_t j = 0; j < k->count; j++) {
            made += k->share[j] * use[j] * (g[k->column[j]] - middle);
        }
        const double off = g[column] - middle - made;
        sum += bins * off * off;
        all += bins;
    }
    return sum / all;
}

/* Ridge regression by its normal equations; what it says of the last row's features. */
static double regress_densely(double (*feature)[FEATURES], const double *square, size_t count,
                              const double *asked)
{
    double a[UNKNOWNS * UNKNOWNS] = {0};
    double b[UNKNOWNS] = {0};
    double mean[FEATURES] = {0};
    double deviation[FEATURES] = {0};
    for (size_t k = 0; k < FEATURES; k++) {
        for (size_t j = 0; j < count; j++) {
            mean[k] += feature[j][k] / (double)count;
        }
        for (size_t j = 0; j < count; j++) {
            deviation[k] += (feature[j][k] - mean[k]) * (feature[j][k] - mean[k]) / (double)count;
        }
        deviation[k] = sqrt(deviation[k]);
    }
    for (size_t j = 0; j < count; j++) {
        double row[UNKNOWNS] = {[FEATURES] = 1.0};
        for (size_t k = 0; k < FEATURES; k++) {
            row[k] = (feature[j][k] - mean[k]) / deviation[k];
        }
        for (size_t p = 0; p < UNKNOWNS; p++) {
            b[p] += row[p] * log(square[j]);
            for (size_t q = 0; q < UNKNOWNS; q++) {
                a[p * UNKNOWNS + q] += row[p] * row[q];
            }
        }
    }
    for (size_t k = 0; k < FEATURES; k++) {
        a[k * UNKNOWNS + k] += 10.0;
    }
    solve_densely(a, UNKNOWNS, b);
    double smearing = 0.0;
    for (size_t j = 0; j < count; j++) {
        double fit = b[FEATURES];
        for (size_t k = 0; k < FEATURES; k++) {
            fit += b[k] * (feature[j][k] - mean[k]) / deviation[k];
        }
        smearing += exp(0.5 * (log(square[j]) - fit)) / (double)count;
    }
    double fit = b[FEATURES];
    for (size_t k = 0; k < FEATURES; k++) {
        fit += b[k] * (asked[k] - mean[k]) / deviation[k];
    }
    return smearing * smearing * exp(fit);
}

/* Values of all columns, rows first: [rows][samples]. */
static double *all_rows(void)
{
    double *rows = malloc(prior->view->rows * prior->samples * sizeof *rows);
    assert_non_null(rows);
    for (size_t row = 0; row < prior->view->rows; row++) {
        for (size_t j = 0; j < prior->samples; j++) {
            rows[row * prior->samples + j] = column_at(j, row);
        }
    }
    return rows;
}

static void test_against_dense_algebra(void **state)
{
    (void)state;
    enum { MEASURED = GONIO_CHANNELS * LEARNED };
    double feature[MEASURED][FEATURES];
    double square[MEASURED];
    double asked[FEATURES];
    double mean[READINGS];
    double s[READINGS * READINGS];
    double *rows = all_rows();
    double *values = malloc(prior->samples * READINGS * sizeof *values);
    assert_non_null(values);
    for (size_t j = 0; j < prior->samples; j++) {
        for (size_t i = 0; i < READINGS; i++) {
            values[j * READINGS + i] = rows[row_of(i) * prior->samples + j];
        }
    }
    size_t count = 0;
    for (size_t fold = 0; fold < FOLDS; fold++) {
        const kept k = keep(fold);
        covariance_of(&k, values, mean, s);
        for (size_t j = 0; j < MEASURED; j++) {
            if (touches(j, fold)) {
                features_of(s, mean, values + j * READINGS, feature[count]);
                square[count++] = square_of(&k, values, rows, mean, s, j);
            }
        }
    }
    assert_int_equal(count, MEASURED);
    const kept everything = keep(FOLDS);
    covariance_of(&everything, values, mean, s);
    for (size_t j = 0; j < MEASURED; j += 7) {
        /* Readings of no column: between one and the next. */
        double g[READINGS];
        gonio_i_observation o[READINGS];
        for (size_t i = 0; i < READINGS; i++) {
            g[i] = 0.5 * (values[j * READINGS + i] + values[(j + 1) * READINGS + i]);
        }
        features_of(s, mean, g, asked);
        read_values(g, o);
        const double dense = regress_densely(feature, square, count, asked);
        const double found = expected_of(prior, o, READINGS);
        /* Every second row and readings with noise there, all rows and none here. */
        if (!(fabs(log(found / dense)) < 0.05)) {
            fail_msg("column %zu: %g where %g is expected", j, found, dense);
        }
    }
    free(values);
    free(rows);
}

/* ---- what it makes of readings ---- */

static void test_contradictions_and_numbers(void **state)
{
    (void)state;
    for (size_t j = 0; j < 9; j++) {
        double g[READINGS];
        gonio_i_observation o[READINGS];
        gonio_i_random random;
        gonio_i_random_seed(&random, 5, j);
        for (size_t i = 0; i < READINGS; i++) {
            g[i] = column_at(4 * j, row_of(i));
        }
        read_values(g, o);
        const double as_known = expected_of(prior, o, READINGS);
        const double fewer = expected_of(prior, o, READINGS / 2);
        const double one = expected_of(prior, o, 1);
        for (size_t i = 0; i < READINGS; i++) {
            o[i].g += 0.5 * gonio_i_random_normal(&random);
        }
        const double contradicted = expected_of(prior, o, READINGS);
        assert_true(as_known > 0.0 && as_known < fewer && isfinite(one) && one > as_known);
        assert_true(contradicted > 1.5 * as_known);
        /* The same with readings that nobody believes. */
        for (size_t i = 0; i < READINGS; i++) {
            o[i].variance = i < READINGS / 2 ? o[i].variance : 1e8;
        }
        const double half = expected_of(prior, o, READINGS);
        const double known = expected_of(prior, o, READINGS / 2);
        assert_true(fabs(log(half / known)) < 0.1);
    }
}

static gonio_plan *make_plan(size_t count)
{
    gonio_plan_options how;
    gonio_plan *plan = NULL;
    gonio_plan_options_default(&how);
    how.count = count;
    assert_int_equal(gonio_plan_create(context, basis, &how, &plan), GONIO_OK);
    return plan;
}

/* A material, read as planned. */
static gonio_readings *read_material(const gonio_plan *plan, const gonio_material *material)
{
    gonio_instrument_options instrument;
    gonio_readings *readings = NULL;
    gonio_table *table = NULL;
    gonio_instrument_options_default(&instrument);
    assert_int_equal(gonio_readings_create_from_plan(context, plan, &readings), GONIO_OK);
    assert_int_equal(gonio_table_load(context, material, &table), GONIO_OK);
    assert_int_equal(gonio_measure(context, readings, table, &instrument), GONIO_OK);
    gonio_table_free(&table);
    return readings;
}

/* ln of the expected error over the true one. */
static double judge(const gonio_plan *plan, const char *name)
{
    gonio_reconstruct_options options;
    gonio_material *original = NULL;
    gonio_material *made = NULL;
    gonio_reconstruction *r = NULL;
    gonio_comparison comparison;
    gonio_reconstruct_options_default(&options);
    assert_int_equal(gonio_material_open(context, name, &original), GONIO_OK);
    gonio_readings *readings = read_material(plan, original);
    assert_int_equal(gonio_reconstruct(context, basis, readings, &options, &r), GONIO_OK);
    assert_int_equal(gonio_reconstruction_material(context, basis, r, "made", &made), GONIO_OK);
    assert_int_equal(gonio_compare(context, original, made, &comparison), GONIO_OK);
    print_message("%s: E6 %.2f %%, expected %.2f %%\n", name, comparison.all.value[GONIO_E6],
                  r->predicted_e6);
    const double off = log(r->predicted_e6 / comparison.all.value[GONIO_E6]);
    gonio_material_free(&made);
    gonio_reconstruction_free(&r);
    gonio_readings_free(&readings);
    gonio_material_free(&original);
    return off;
}

/* Of the materials that were not learned from: the error that a reconstruction expects, and the one
 * it has. */
static void test_materials_left_out(void **state)
{
    (void)state;
    double sum = 0.0;
    gonio_plan *plan = make_plan(10);
    for (size_t k = LEARNED; k < MATERIALS; k++) {
        sum += judge(plan, names[k]);
    }
    gonio_plan_free(&plan);
    const double ratio = exp(sum / (MATERIALS - LEARNED));
    print_message("expected / true: %.2f\n", ratio);
    assert_true(ratio > 0.6 && ratio < 1.7);
}

/* However little is expected now, more readings never promise more. */
static void test_what_comes_next_is_no_worse(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    gonio_reconstruct_options options;
    gonio_plan_options more;
    gonio_plan *plan = NULL;
    gonio_plan *first = make_plan(80);
    double now = 0.0;
    gonio_reconstruct_options_default(&options);
    gonio_plan_options_default(&more);
    more.count = 5;
    assert_int_equal(gonio_material_open(context, "atlas:purple-vinyl", &material), GONIO_OK);
    gonio_readings *readings = read_material(first, material);
    assert_int_equal(gonio_plan_next(context, basis, readings, &options, &more, &now, NULL, &plan),
                     GONIO_OK);
    print_message("now %.3f %%, then %.3f %%\n", now, plan->expected[0]);
    assert_true(plan->expected[0] > 0.0 && plan->expected[0] <= now);
    for (size_t k = 1; k < plan->count; k++) {
        assert_true(plan->expected[k] <= plan->expected[k - 1]);
    }
    gonio_plan_free(&plan);
    gonio_plan_free(&first);
    gonio_readings_free(&readings);
    gonio_material_free(&material);
}

/* ---- what cannot tell ---- */

static void test_who_cannot_tell(void **state)
{
    (void)state;
    gonio_i_learned_error *learned = NULL;
    gonio_i_targets grid;
    gonio_basis *few = learn(9, 0);
    gonio_i_prior *other = NULL;
    assert_int_equal(gonio_i_prior_create(context, few, &other), GONIO_OK);
    assert_int_equal(gonio_i_targets_create(context, other, NULL, 0, &grid), GONIO_OK);
    assert_int_equal(gonio_i_learned_error_create(context, other, &grid, &learned), GONIO_OK);
    assert_null(learned);
    gonio_i_prior_free(&other);
    gonio_basis_free(&few);
    gonio_basis *enough = learn(10, 0);
    assert_int_equal(gonio_i_prior_create(context, enough, &other), GONIO_OK);
    double g[READINGS];
    gonio_i_observation o[READINGS];
    for (size_t i = 0; i < READINGS; i++) {
        g[i] = column_at(1, row_of(i));
    }
    read_values(g, o);
    const double square = expected_of(other, o, READINGS);
    assert_true(isfinite(square) && square > 0.0);
    gonio_i_prior_free(&other);
    gonio_basis_free(&enough);
    /* Mixtures of a file that does not say what they are made of. */
    gonio_i_prior orphans = *prior;
    gonio_basis_view view = *prior->view;
    view.parents = NULL;
    orphans.view = &view;
    assert_int_equal(gonio_i_learned_error_create(context, &orphans, &grid, &learned), GONIO_OK);
    assert_null(learned);
    gonio_i_targets_free(&grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_dense_algebra),
        cmocka_unit_test(test_contradictions_and_numbers),
        cmocka_unit_test(test_materials_left_out),
        cmocka_unit_test(test_what_comes_next_is_no_worse),
        cmocka_unit_test(test_who_cannot_tell),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
