/* The posterior against the textbook's formulas for Gaussians, computed densely; evidence, the mean
 * over the models, and reconstructions by it. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../unit/made_basis.h"
#include "../unit/made_readings.h"
#include "core/random.h"

static const double OPEN = 0.01; /* variance.c: the deviation that always remains */

/* The deviations of all rows may be widened alike, so that they fit what is true. */
static void test_the_textbooks_posterior(void **state)
{
    (void)state;
    static const size_t counts[] = {1, 2, 12, 50};
    for (size_t c = 0; c < 4; c++) {
        drawn d = draw(c, 0.05);
        const size_t n = counts[c];
        double *s = malloc(n * n * sizeof *s);
        found r = find(fixture.gaussian, d.reading, n, ALPHA);
        assert_int_equal(r.posterior.outlying, 0);
        invert_covariance(d.reading, n, 1.0, ALPHA, s);
        double widened = 0.0;
        for (size_t row = 11; row < fixture.gaussian->view->rows; row += 41) {
            if (!is_whole(row)) {
                continue;
            }
            int channel = 0;
            double mean = 0.0;
            double variance = 0.0;
            textbook(d.reading, n, s,
                     gonio_i_row_coordinates(fixture.gaussian->view, row, &channel), &mean,
                     &variance);
            assert_close(r.field[row], mean, 1e-6);
            /* What the model leaves open, and a factor for the column: its misfit. */
            const double ratio = (r.deviation[row] * r.deviation[row] - OPEN * OPEN) / variance;
            widened = widened == 0.0 ? ratio : widened;
            assert_close(ratio / widened, 1.0, 1e-5);
        }
        assert_true(widened > 0.5 && widened < 6.0);
        drop(&r);
        free(s);
        free(d.z);
    }
}

/* Places read again and again, as they are and merged: the same but for what is left open of each
 * reading. */
static void test_merged_readings(void **state)
{
    (void)state;
    enum { TIMES = 20 };
    static const double noise = 0.3;
    drawn d = draw(8, noise);
    gonio_i_observation *all = malloc(sizeof *all * MOST * TIMES);
    gonio_i_random random;
    gonio_i_random_seed(&random, 8, 1);
    for (size_t i = 0; i < MOST * TIMES; i++) {
        all[i] = d.reading[i % MOST];
        all[i].g = truth_at(d.z, all[i].at) + noise * gonio_i_random_normal(&random);
        all[i].variance += GONIO_I_MODEL_DEVIATION * GONIO_I_MODEL_DEVIATION;
    }
    found direct = find(fixture.gaussian, all, MOST * TIMES, ALPHA);
    found merged = find_of(fixture.gaussian, all, MOST * TIMES, ALPHA, MOST * TIMES - 1);
    found once = find(fixture.gaussian, all, MOST, ALPHA);
    assert_true(difference(&direct, &merged) < 0.01);
    assert_true(difference(&direct, &once) > 0.05);
    drop(&direct);
    drop(&merged);
    drop(&once);
    free(all);
    free(d.z);
}

/* ln sum_j share_j N(y; a F z_j, h^2 F F' + alpha^2 k + D); of a Gaussian, j = 1 and z = 0. */
static void test_the_evidence(void **state)
{
    (void)state;
    enum { N = 9 };
    const gonio_i_prior *const priors[2] = {fixture.gaussian, fixture.mixture};
    drawn d = draw(6, 0.1);
    const gonio_i_column column = {N, d.reading};
    for (int p = 0; p < 2; p++) {
        const double h = p == 0 ? 1.0 : GONIO_I_KERNEL_WIDTH;
        double s[N * N];
        const double logarithm = invert_covariance(d.reading, N, h, ALPHA, s);
        double density = 0.0;
        const size_t samples = p == 0 ? 1 : fixture.mixture->samples;
        for (size_t j = 0; j < samples; j++) {
            double rest[N];
            double square = 0.0;
            for (size_t i = 0; i < N; i++) {
                const double mean = mean_at(d.reading[i].at);
                const double *z = fixture.mixture->sample + j * fixture.mixture->components;
                const double centre =
                    p == 0 ? 0.0 : sqrt(1.0 - h * h) * (truth_at(z, d.reading[i].at) - mean);
                rest[i] = d.reading[i].g - mean - centre;
            }
            for (size_t i = 0; i < N * N; i++) {
                square += rest[i / N] * s[i] * rest[i % N];
            }
            density += (p == 0 ? 1.0 : fixture.mixture->share[j]) * exp(-0.5 * square);
        }
        const double expected = log(density) - 0.5 * (logarithm + N * log(2.0 * M_PI));
        const gonio_i_model model = {GONIO_I_KERNEL_WIDTH, ALPHA, 0.0, 0.0};
        size_t outlying = 0;
        gonio_i_sites *sites = NULL;
        gonio_i_fit e;
        assert_int_equal(gonio_i_sites_create(fixture.context, priors[p], &column, &sites),
                         GONIO_OK);
        assert_int_equal(gonio_i_fit_begin(fixture.context, sites, false, &column, &e), GONIO_OK);
        assert_int_equal(gonio_i_fit_solve(&e, &model), GONIO_OK);
        assert_int_equal(gonio_i_fit_settle(&e, true, &outlying), GONIO_OK);
        assert_int_equal(outlying, 0);
        assert_close(e.evidence, expected, 1e-6 * fabs(expected));
        gonio_i_fit_end(&e);
        gonio_i_sites_free(&sites);
    }
    free(d.z);
}

static void test_deviations_shrink(void **state)
{
    (void)state;
    static const size_t counts[] = {1, 3, 10, 30, MOST};
    drawn d = draw(8, 1e-3);
    found before = find(fixture.gaussian, d.reading, 1, ALPHA);
    for (size_t c = 0; c < 5; c++) {
        found r = find(fixture.gaussian, d.reading, counts[c], ALPHA);
        double sums[2] = {0.0, 0.0};
        for (size_t row = 0; row < fixture.gaussian->view->rows; row++) {
            assert_true(r.deviation[row] >= 0.0 && isfinite(r.deviation[row]));
            sums[0] += before.deviation[row];
            sums[1] += r.deviation[row];
        }
        /* Not row by row: the misfit, one factor for all of them, goes up and down. */
        assert_true(c == 0 || sums[1] < sums[0]);
        for (size_t i = 0; i < counts[c]; i++) {
            assert_true(r.deviation[d.row[i]] < 0.06);
            assert_close(r.field[d.row[i]], d.reading[i].g, 0.02);
        }
        assert_true(c == 0 || r.posterior.predicted < before.posterior.predicted);
        drop(&before);
        before = r;
    }
    drop(&before);
    free(d.z);
}

/* The reconstruction is the mean over the models, and nothing else. */
static void test_the_mean_over_the_models(void **state)
{
    (void)state;
    enum { N = 30 };
    drawn d = draw(40, 0.05);
    const gonio_i_column column = {N, d.reading};
    gonio_i_models models;
    for (size_t i = 0, taken = 0; taken < N; i++) {
        assert_in_range(i, 0, MOST - 1);
        const gonio_half_difference at = d.reading[i].at;
        if (at.theta_h > 0.3 && at.theta_d > 0.15) { /* where a remainder has no peak */
            d.reading[taken++] = d.reading[i];
        }
    }
    gonio_i_subset subset;
    assert_int_equal(gonio_i_subset_begin(fixture.context, fixture.gaussian, &column, 1, &subset),
                     GONIO_OK);
    assert_int_equal(gonio_i_models_weigh(fixture.context, fixture.gaussian, &subset, &models),
                     GONIO_OK);
    gonio_i_subset_end(&subset);
    assert_in_range(models.count, 2, GONIO_I_MOST_MODELS);
    found mixed = find(fixture.gaussian, d.reading, N, -1.0);
    found mean = {.field = calloc(fixture.gaussian->view->rows, sizeof *mean.field)};
    double sum = 0.0;
    bool best = false;
    for (size_t k = 0; k < models.count; k++) {
        const gonio_i_model *m = &models.model[k];
        found one = find(fixture.gaussian, d.reading, N, m->alpha);
        for (size_t row = 0; row < fixture.gaussian->view->rows; row++) {
            mean.field[row] += models.weight[k] * one.field[row];
        }
        sum += models.weight[k];
        best = best || (m->alpha == models.best.alpha && m->h == models.best.h);
        drop(&one);
    }
    assert_close(sum, 1.0, 1e-12);
    assert_true(best);
    assert_true(difference(&mean, &mixed) < 1e-9);
    drop(&mean);
    drop(&mixed);
    free(d.z);
}

/* Every valid bin has data, finite and not negative. */
static void assert_sane(const gonio_reconstruction *made)
{
    gonio_material *material = NULL;
    double *rho = malloc(GONIO_CHANNELS * GONIO_SLAB_BINS * sizeof *rho);
    assert_int_equal(
        gonio_reconstruction_material(fixture.context, fixture.basis, made, "made", &material),
        GONIO_OK);
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
        assert_int_equal(gonio_material_read_slab(fixture.context, material, theta_h, rho),
                         GONIO_OK);
        for (int k = 0; k < GONIO_CHANNELS * GONIO_SLAB_BINS; k++) {
            const int inside = k % GONIO_SLAB_BINS;
            const gonio_bin bin = {theta_h, inside / GONIO_PHI_D_BINS, inside % GONIO_PHI_D_BINS};
            if (gonio_bin_is_valid(bin)) {
                assert_true(rho[k] >= 0.0 && isfinite(rho[k]));
            }
        }
    }
    free(rho);
    gonio_material_free(&material);
}

static void test_what_comes_out_is_sane(void **state)
{
    (void)state;
    static const double rows[][7] = {{30, 0, 30, 180, 0.2, 0.1, 0.05},
                                     {0, 0, 45, 90, 0.05, 0.02, 0},
                                     {60, 0, 60, 180, 1e6, 1e5, 1e4},
                                     {10, 0, 70, 20, 0, 0, 0}};
    for (size_t count = 1; count <= 4; count++) {
        gonio_readings *readings = made_colours(rows, count);
        gonio_reconstruct_options options;
        gonio_reconstruct_options_default(&options);
        options.method = "posterior";
        gonio_reconstruction *made = NULL;
        assert_int_equal(
            gonio_reconstruct(fixture.context, fixture.basis, readings, &options, &made), GONIO_OK);
        assert_int_equal(made->readings, count);
        assert_int_equal(made->columns, GONIO_CHANNELS);
        assert_true(isfinite(made->predicted_e6) && made->predicted_e6 > 0.0);
        assert_sane(made);
        gonio_reconstruction_free(&made);
        gonio_readings_free(&readings);
    }
}

/* Of a detector that saturates, peaks are at least what it says. */
static void test_saturation(void **state)
{
    (void)state;
    static const double rows[][7] = {{0, 0, 30, 180, 0.05, 0.05, 0.05},
                                     {40, 0, 20, 180, 0.06, 0.06, 0.06},
                                     {30, 0, 30, 180, 0.1, 0.1, 0.1}};
    gonio_readings *readings = made_colours(rows, 3);
    double value[2][GONIO_CHANNELS];
    for (int k = 0; k < 2; k++) {
        gonio_reconstruct_options options;
        gonio_reconstruct_options_default(&options);
        options.method = "posterior";
        options.no_checks = true;
        options.saturation = k == 0 ? 0.0 : 0.1;
        gonio_reconstruction *made = NULL;
        assert_int_equal(
            gonio_reconstruct(fixture.context, fixture.basis, readings, &options, &made), GONIO_OK);
        gonio_reconstruction_predict(
            fixture.basis, made,
            gonio_half_difference_from_pair(gonio_readings_describe(readings)->pair[2]), value[k],
            NULL);
        gonio_reconstruction_free(&made);
    }
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        assert_true(value[1][c] >= value[0][c] * (1.0 - 1e-9));
        assert_true(value[1][c] >= 0.08);
    }
    gonio_readings_free(&readings);
}

static void test_what_is_refused(void **state)
{
    (void)state;
    static const struct {
        double noise, floor, saturation;
    } cases[] = {{-1.0, 0.0, 0.0},     {NAN, 0.0, 0.0},  {INFINITY, 0.0, 0.0}, {0.0, -1.0, 0.0},
                 {0.0, INFINITY, 0.0}, {0.0, 0.0, -1.0}, {0.0, 0.0, NAN}};
    static const double rows[][7] = {{30, 0, 30, 180, 0.2, 0.1, 0.05}};
    gonio_readings *readings = made_colours(rows, 1);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const gonio_reconstruct_options options = {.size = sizeof options,
                                                   .method = "posterior",
                                                   .noise = cases[k].noise,
                                                   .floor = cases[k].floor,
                                                   .saturation = cases[k].saturation};
        gonio_reconstruction *made = NULL;
        assert_int_equal(
            gonio_reconstruct(fixture.context, fixture.basis, readings, &options, &made),
            GONIO_ERROR_ARGUMENT);
        assert_null(made);
        assert_non_null(strstr(support_message(), "noise, floor and saturation"));
    }
    gonio_readings_free(&readings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_textbooks_posterior),
        cmocka_unit_test(test_merged_readings),
        cmocka_unit_test(test_the_evidence),
        cmocka_unit_test(test_deviations_shrink),
        cmocka_unit_test(test_the_mean_over_the_models),
        cmocka_unit_test(test_what_comes_out_is_sane),
        cmocka_unit_test(test_saturation),
        cmocka_unit_test(test_what_is_refused),
    };
    return cmocka_run_group_tests_name("posterior", tests, fixture_set_up, fixture_tear_down);
}
