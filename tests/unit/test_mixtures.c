/* Mixtures by certificates: each against the formula of basis.h, the mean and the weights, columns
 * given back by their samples, threads, the file. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "basis/mixtures.h"
#include "prior/prior.h"
#include "core/random.h"
#include "edited_basis.h"
#include "made_basis.h"

enum { SEED = 7 };

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

static const struct {
    gonio_representation representation;
    gonio_channel_model channels;
} kinds[] = {{GONIO_SECTORED, GONIO_SEPARATE},
             {GONIO_SECTORED, GONIO_JOINT},
             {GONIO_BIVARIATE, GONIO_SEPARATE},
             {GONIO_BIVARIATE, GONIO_JOINT}};

enum { KINDS = sizeof kinds / sizeof *kinds };

/* A basis, the columns that it was learned from, measured ones first: h[column][rows]. */
typedef struct fixture {
    gonio_database *database;
    gonio_basis *basis;
    const gonio_basis_view *view;
    size_t measured;
    double *h;
} fixture;

static fixture make(gonio_context *context, int kind)
{
    fixture f = {.database = made_database(kinds[kind].representation, kinds[kind].channels),
                 .basis =
                     made_basis(context, kinds[kind].representation, kinds[kind].channels, SEED)};
    const gonio_basis_options options = {
        .size = sizeof options, .mixtures = MADE_MIXTURES, .seed = SEED};
    f.view = gonio_basis_describe(f.basis);
    f.measured = f.view->columns - f.view->mixtures;
    f.h = malloc(f.view->columns * f.view->rows * sizeof *f.h);
    float *values = malloc(f.view->mixtures * f.view->rows * sizeof *values);
    assert_true(f.h != NULL && values != NULL);
    assert_int_equal(gonio_database_read_rows(NULL, f.database, 0, f.view->rows, NULL, 0, f.h),
                     GONIO_OK);
    gonio_i_mixtures *mixtures = NULL;
    assert_int_equal(gonio_i_mixtures_create(context, f.basis, f.database, &options, &mixtures),
                     GONIO_OK);
    gonio_i_mixtures_fill(mixtures, 0, f.view->rows, values);
    for (size_t k = 0; k < f.view->mixtures * f.view->rows; k++) {
        f.h[f.measured * f.view->rows + k] = (double)values[k];
    }
    gonio_i_mixtures_free(&mixtures);
    free(values);
    return f;
}

static fixture made[KINDS];

/* A context, as BLAS is on one thread from the first one on. */
static gonio_context *context_of(int threads)
{
    const gonio_context_options options = {.size = sizeof options, .threads = threads};
    gonio_context *context = NULL;
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    return context;
}

static int set_up(void **state)
{
    (void)state;
    gonio_context *context = context_of(0);
    for (int kind = 0; kind < KINDS; kind++) {
        made[kind] = make(context, kind);
    }
    gonio_context_free(&context);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        free(made[kind].h);
        gonio_basis_free(&made[kind].basis);
        gonio_database_free(&made[kind].database);
    }
    return 0;
}

/* column(theta_h, theta_d) at a fraction of bins, of the run of phi_d that a row belongs to. */
static double between(const fixture *f, size_t column, double at_h, double at_d, size_t row)
{
    const size_t each = f->view->channels == GONIO_JOINT ? GONIO_CHANNELS : 1;
    const int32_t depth = gonio_grid_cells(f->view->representation) / GONIO_CELLS;
    double sum = 0.0;
    for (int h = 0; h < GONIO_THETA_H_BINS; h++) {
        for (int d = 0; d < GONIO_THETA_D_BINS; d++) {
            const double weight = fmax(1.0 - fabs(at_h - h), 0.0) * fmax(1.0 - fabs(at_d - d), 0.0);
            if (weight > 0.0) {
                const int32_t cell =
                    (h * GONIO_THETA_D_BINS + d) * depth + f->view->cell[row / each] % depth;
                const size_t position = gonio_basis_position(f->basis, cell);
                sum += weight * f->h[column * f->view->rows + position * each + row % each];
            }
        }
    }
    return sum;
}

/* column(theta_h / f, 90 degrees (theta_d / 90 degrees)^t) of a row. */
static double varied(const fixture *f, size_t column, double width, double tilt, size_t row)
{
    const size_t each = f->view->channels == GONIO_JOINT ? GONIO_CHANNELS : 1;
    const gonio_half_difference centre =
        gonio_bin_centre(gonio_cell_bin(f->view->representation, f->view->cell[row / each]));
    const double quarter = M_PI / 2.0;
    const double theta_h = centre.theta_h / width;
    const double theta_d = quarter * pow(centre.theta_d / quarter, tilt);
    const double at_h = 90.0 * sqrt(theta_h / quarter) - 0.5;
    const double at_d = 90.0 * theta_d / quarter - 0.5;
    return between(f, column, fmin(fmax(at_h, 0.0), 89.0), fmin(fmax(at_d, 0.0), 89.0), row);
}

static void test_the_formula(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        const fixture f = made[kind];
        for (size_t k = 0; k < f.view->mixtures; k++) {
            /* Each mixture has a stream: the share, then of each half its column, ln f, ln t. */
            gonio_i_random random;
            gonio_i_random_seed(&random, SEED, k);
            const double share = gonio_i_random_uniform(&random);
            size_t column[2];
            double width[2];
            double tilt[2];
            for (int half = 0; half < 2; half++) {
                column[half] = (size_t)gonio_i_random_below(&random, f.measured);
                assert_int_equal(f.view->parents[2 * k + (size_t)half], column[half]);
                width[half] = exp(0.3 * gonio_i_random_normal(&random));
                tilt[half] = exp(0.25 * gonio_i_random_normal(&random));
            }
            for (size_t row = k; row < f.view->rows; row += 101) {
                const double a = varied(&f, column[0], width[0], tilt[0], row);
                const double b = varied(&f, column[1], width[1], tilt[1], row);
                const double expected =
                    log(1.0 + share * (exp(a) - 1.0) + (1.0 - share) * (exp(b) - 1.0));
                assert_close(f.h[(f.measured + k) * f.view->rows + row], expected,
                             1e-6 * (1.0 + expected));
            }
        }
    }
}

static void test_the_mean_is_that_of_the_two_groups(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        const fixture f = made[kind];
        for (size_t row = 0; row < f.view->rows; row += 13) {
            double mean[2] = {0.0, 0.0};
            for (size_t j = 0; j < f.view->columns; j++) {
                mean[j >= f.measured] += f.h[j * f.view->rows + row];
            }
            assert_close(f.view->mean[row],
                         0.5 * (mean[0] / (double)f.measured + mean[1] / (double)MADE_MIXTURES),
                         1e-12);
        }
    }
}

/* m + f z_j is column j where nothing was cut off, and z has mean 0 and covariance I. */
static void test_samples_are_the_columns(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        const fixture f = made[kind];
        const size_t k = f.view->components;
        gonio_i_prior *prior = NULL;
        assert_int_equal(gonio_i_prior_create(NULL, f.basis, &prior), GONIO_OK);
        assert_int_equal(prior->samples, f.view->columns);
        double *row_f = malloc(k * sizeof *row_f);
        double largest = 0.0;
        for (size_t row = 0; row < f.view->rows; row += 7) {
            gonio_i_prior_row(prior, row, row_f);
            for (size_t j = 0; j < f.view->columns; j++) {
                double g = f.view->mean[row];
                for (size_t c = 0; c < k; c++) {
                    g += row_f[c] * prior->sample[j * k + c];
                }
                largest = fmax(largest, fabs(g - f.h[j * f.view->rows + row]));
            }
        }
        assert_close(largest, 0.0, 1e-4);
        const double n = (double)f.view->columns;
        double all = 0.0;
        for (size_t j = 0; j < prior->samples; j++) {
            all += prior->share[j];
        }
        assert_close(all, 1.0, 1e-12);
        for (size_t a = 0; a < k; a++) {
            double mean = 0.0;
            for (size_t j = 0; j < prior->samples; j++) {
                mean += prior->share[j] * prior->sample[j * k + a];
            }
            assert_close(mean, 0.0, 1e-3);
            for (size_t b = 0; b <= a; b++) {
                double sum = 0.0;
                for (size_t j = 0; j < prior->samples; j++) {
                    sum += prior->share[j] * prior->sample[j * k + a] * prior->sample[j * k + b];
                }
                assert_close(sum, a == b ? (n - 1.0) / n : 0.0, 1e-9);
            }
        }
        free(row_f);
        gonio_i_prior_free(&prior);
    }
}

static void test_threads_and_seeds(void **state)
{
    (void)state;
    const uint64_t checksum = made[0].view->checksum;
    for (int threads = 1; threads <= 2; threads++) {
        gonio_context *context = context_of(threads);
        gonio_basis *basis = made_basis(context, GONIO_SECTORED, GONIO_SEPARATE, SEED);
        assert_true(gonio_basis_describe(basis)->checksum == checksum);
        gonio_basis_free(&basis);
        gonio_context_free(&context);
    }
    gonio_basis *other = made_basis(NULL, GONIO_BIVARIATE, GONIO_SEPARATE, SEED + 1);
    assert_true(gonio_basis_describe(other)->checksum != made[2].view->checksum);
    gonio_basis_free(&other);
}

static void test_what_has_no_mixtures(void **state)
{
    (void)state;
    enum { size = sizeof(gonio_database_options) };
    static const struct {
        gonio_database_options kind;
        bool without_mean;
    } cases[] = {
        {{.size = size, .representation = GONIO_BIVARIATE, .mapping = GONIO_LOG_RELATIVE}, false},
        {{.size = size, .representation = GONIO_SECTORED}, true}};
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const gonio_basis_options options = {
            .size = sizeof options, .mixtures = 4, .without_mean = cases[k].without_mean};
        gonio_database *database = NULL;
        gonio_basis *basis = NULL;
        assert_int_equal(
            gonio_database_create(context, made_paths, MADE_MATERIALS, &cases[k].kind, &database),
            GONIO_OK);
        assert_int_equal(gonio_basis_learn(context, database, &options, &basis),
                         GONIO_ERROR_ARGUMENT);
        assert_null(basis);
        assert_non_null(strstr(support_message(), "mixtures need the log mapping with a mean"));
        gonio_database_free(&database);
    }
    gonio_context_free(&context);
}

/* ---- analytic columns ---- */

enum { ANALYTIC = 2 };

static gonio_basis *with_analytic(gonio_context *context, int kind)
{
    gonio_recipe recipe;
    gonio_basis *basis = NULL;
    gonio_recipe_for_grid(&recipe, kinds[kind].representation);
    recipe.channels = kinds[kind].channels;
    recipe.mixtures = MADE_MIXTURES;
    recipe.seed = SEED;
    recipe.analytic = ANALYTIC;
    assert_int_equal(gonio_learn(context, made_paths, MADE_MATERIALS, &recipe, &basis), GONIO_OK);
    return basis;
}

/* The columns of the random materials alone, on all cells of the grid. */
static double *random_columns(int kind, const gonio_database_view **view, gonio_database **database)
{
    static const char *const paths[ANALYTIC] = {"atlas:random-0000", "atlas:random-0001"};
    const gonio_database_options how = {.size = sizeof how,
                                        .representation = kinds[kind].representation,
                                        .channels = kinds[kind].channels};
    assert_int_equal(gonio_database_create(NULL, paths, ANALYTIC, &how, database), GONIO_OK);
    *view = gonio_database_describe(*database);
    double *h = malloc((*view)->columns * (*view)->rows * sizeof *h);
    assert_non_null(h);
    assert_int_equal(gonio_database_read_rows(NULL, *database, 0, (*view)->rows, NULL, 0, h),
                     GONIO_OK);
    return h;
}

/* column(theta_h r^(c/2)) of a random material, c the mean of cos 2 a of the two directions'
 * azimuths a from the half vector: each material has a stream, of which ln r is 0.7 times a normal
 * number. */
static double elongated(const fixture *f, size_t material, size_t column, size_t row)
{
    const size_t each = f->view->channels == GONIO_JOINT ? GONIO_CHANNELS : 1;
    const gonio_bin bin = gonio_cell_bin(f->view->representation, f->view->cell[row / each]);
    const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
    const double c = 0.5 * (cos(2.0 * pair.incident.phi) + cos(2.0 * pair.outgoing.phi));
    gonio_i_random random;
    gonio_i_random_seed(&random, 2, material);
    const double log_ratio = 0.7 * gonio_i_random_normal(&random);
    const double factor =
        f->view->representation == GONIO_BIVARIATE ? 1.0 : exp(0.5 * c * log_ratio);
    const double at_h = (bin.theta_h + 0.5) * sqrt(factor) - 0.5;
    return between(f, column, fmin(fmax(at_h, 0.0), 89.0), bin.theta_d, row);
}

/* m = 0.95 (the mean without them) + 0.05 (their own mean). */
static void test_analytic_columns_have_a_small_share(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        gonio_basis *basis = with_analytic(NULL, kind);
        const gonio_basis_view *view = gonio_basis_describe(basis);
        const gonio_database_view *of = NULL;
        gonio_database *database = NULL;
        double *h = random_columns(kind, &of, &database);
        assert_int_equal(view->analytic, of->columns);
        assert_int_equal(view->columns, made[kind].view->columns + of->columns);
        assert_int_equal(view->rows, of->rows);
        assert_true(view->fingerprint != made[kind].view->fingerprint);
        const fixture random = {.basis = basis, .view = view, .h = h};
        for (size_t row = 0; row < view->rows; row += 7) {
            double mean = 0.0;
            for (size_t j = 0; j < of->columns; j++) {
                const size_t material = j * ANALYTIC / of->columns;
                mean += elongated(&random, material, j, row) / (double)of->columns;
            }
            assert_close(view->mean[row], 0.95 * made[kind].view->mean[row] + 0.05 * mean, 1e-6);
        }
        free(h);
        gonio_database_free(&database);
        gonio_basis_free(&basis);
    }
}

static void test_the_file_keeps_analytic_columns(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/basis.gonio", folder);
    gonio_context *two = context_of(2);
    gonio_basis *basis = with_analytic(NULL, 2);
    gonio_basis *threads = with_analytic(two, 2);
    gonio_basis *again = NULL;
    assert_int_equal(gonio_basis_write(NULL, basis, "", path), GONIO_OK);
    assert_int_equal(gonio_basis_read(NULL, path, &again), GONIO_OK);
    const gonio_basis_view *a = gonio_basis_describe(basis);
    const gonio_basis_view *b = gonio_basis_describe(again);
    assert_int_equal(b->analytic, a->analytic);
    assert_true(a->fingerprint == b->fingerprint && a->checksum == b->checksum);
    assert_true(a->checksum == gonio_basis_describe(threads)->checksum);
    gonio_basis_free(&again);
    gonio_basis_free(&threads);
    gonio_basis_free(&basis);
    gonio_context_free(&two);
    support_remove(folder);
}

/* ---- the file ---- */

static void test_the_file_keeps_mixtures(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/basis.gonio", folder);
    const gonio_basis *basis = made[0].basis;
    gonio_basis *again = NULL;
    assert_int_equal(gonio_basis_write(NULL, basis, "", path), GONIO_OK);
    assert_int_equal(gonio_basis_read(NULL, path, &again), GONIO_OK);
    const gonio_basis_view *a = gonio_basis_describe(basis);
    const gonio_basis_view *b = gonio_basis_describe(again);
    assert_int_equal(b->representation, GONIO_SECTORED);
    assert_int_equal(b->channels, GONIO_SEPARATE);
    assert_int_equal(b->mixtures, MADE_MIXTURES);
    assert_int_equal(b->columns, a->columns);
    assert_int_equal(b->components, a->components);
    assert_int_equal(b->rows, a->rows);
    assert_true(a->fingerprint == b->fingerprint && a->checksum == b->checksum);
    assert_memory_equal(a->cell, b->cell, a->cells * sizeof *a->cell);
    assert_memory_equal(a->mean, b->mean, a->rows * sizeof *a->mean);
    double *vectors[2] = {support_vectors(basis), support_vectors(again)};
    assert_memory_equal(vectors[0], vectors[1], a->rows * a->components * sizeof *vectors[0]);
    free(vectors[0]);
    free(vectors[1]);
    assert_memory_equal(a->loadings, b->loadings, a->columns * a->components * sizeof *a->loadings);
    assert_memory_equal(a->parents, b->parents, 2 * a->mixtures * sizeof *a->parents);
    gonio_basis_free(&again);
    support_remove(folder);
}

/* Writes another number of mixtures into a file; removes it if it is NULL. */
static void change_mixtures(const char *path, const char *mixtures)
{
    char from[64], to[64];
    edited e = edited_load(path);
    snprintf(from, sizeof from, "\"mixtures\":\"%d\"", MADE_MIXTURES);
    snprintf(to, sizeof to, "\"%s\":\"%s\"", mixtures != NULL ? "mixtures" : "other",
             mixtures != NULL ? mixtures : "");
    edited_header(&e, from, to);
    edited_save(&e, path);
}

static void test_a_damaged_number_of_mixtures(void **state)
{
    (void)state;
    static const char *const wrong[] = {"-1",
                                        "9223372036854775807",
                                        "99999999999999999999",
                                        "2097152",
                                        "19",
                                        "21",
                                        "0",
                                        "",
                                        " 20",
                                        "20 ",
                                        "2e1",
                                        NULL};
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/basis.gonio", folder);
    gonio_context *context = support_context();
    const gonio_basis *basis = made[2].basis;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        gonio_basis *again = NULL;
        assert_int_equal(gonio_basis_write(context, basis, "", path), GONIO_OK);
        change_mixtures(path, wrong[k]);
        assert_int_equal(gonio_basis_read(context, path, &again), GONIO_ERROR_FORMAT);
        assert_null(again);
        assert_non_null(strstr(support_message(), "learn the basis again"));
    }
    gonio_context_free(&context);
    support_remove(folder);
}

/* Another parent in a file, with its checksum or without; no parents: INT32_MIN. */
static void change_parents(const char *path, int32_t parent, bool seal)
{
    edited e = edited_load(path);
    size_t size = 0;
    int32_t *parents = edited_array(&e, "mixture_parents", &size);
    assert_int_equal(size, 2 * MADE_MIXTURES * sizeof *parents);
    if (parent == INT32_MIN) {
        edited_header(&e, "\"mixture_parents\":", "\"unknown\":");
    } else {
        parents[MADE_MIXTURES] = parent;
    }
    if (seal) {
        edited_seal(&e);
    }
    edited_save(&e, path);
}

static void test_damaged_parents(void **state)
{
    (void)state;
    static const struct {
        int32_t parent;
        const char *says;
    } wrong[] = {{-1, "names a column that no material has"},
                 {MADE_MATERIALS * GONIO_CHANNELS, "names a column that no material has"},
                 {INT32_MAX, "names a column that no material has"},
                 {-1, "'xxh3.mixture_parents' does not fit the contents"}};
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/basis.gonio", folder);
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        gonio_basis *again = NULL;
        assert_int_equal(gonio_basis_write(context, made[2].basis, "", path), GONIO_OK);
        change_parents(path, wrong[k].parent, k + 1 < sizeof wrong / sizeof *wrong);
        assert_int_equal(gonio_basis_read(context, path, &again), GONIO_ERROR_FORMAT);
        assert_null(again);
        assert_non_null(strstr(support_message(), wrong[k].says));
    }
    /* As converted files of older programs are: without. */
    gonio_basis *again = NULL;
    assert_int_equal(gonio_basis_write(context, made[2].basis, "", path), GONIO_OK);
    change_parents(path, INT32_MIN, false);
    assert_int_equal(gonio_basis_read(context, path, &again), GONIO_OK);
    assert_null(gonio_basis_describe(again)->parents);
    gonio_basis_free(&again);
    gonio_context_free(&context);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_formula),
        cmocka_unit_test(test_the_mean_is_that_of_the_two_groups),
        cmocka_unit_test(test_samples_are_the_columns),
        cmocka_unit_test(test_threads_and_seeds),
        cmocka_unit_test(test_what_has_no_mixtures),
        cmocka_unit_test(test_analytic_columns_have_a_small_share),
        cmocka_unit_test(test_the_file_keeps_analytic_columns),
        cmocka_unit_test(test_the_file_keeps_mixtures),
        cmocka_unit_test(test_a_damaged_number_of_mixtures),
        cmocka_unit_test(test_damaged_parents),
    };
    return cmocka_run_group_tests_name("mixtures", tests, set_up, tear_down);
}
