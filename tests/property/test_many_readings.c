/* What is done otherwise of many readings gives what it would give of few. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "posterior/fit_inverse.h"
#include "posterior/learned_error.h"

enum { MANY = 1000 };

static const double DEVIATION = 0.05;
static const gonio_i_model PLAIN = {1.0, 0.25, 0.0, 0.0};

/* MANY readings of a material; the first of each forty is wrong, every third is a bound. */
static gonio_i_observation *read_many(void)
{
    drawn d = draw(8, DEVIATION);
    gonio_i_observation *o = calloc(MANY, sizeof *o);
    gonio_i_random random;
    gonio_i_random_seed(&random, 8, 1);
    for (size_t i = 0; i < MANY; i++) {
        int channel = 0;
        const size_t row = (size_t)gonio_i_random_below(&random, fixture.gaussian->view->rows);
        o[i].at = gonio_i_row_coordinates(fixture.gaussian->view, row, &channel);
        o[i].g = truth_at(d.z, o[i].at) + DEVIATION * gonio_i_random_normal(&random);
        o[i].g += i % 40 == 0 ? 3.0 : 0.0;
        o[i].variance = DEVIATION * DEVIATION;
        o[i].bound = i % 3 == 1 ? -1 : 0;
        o[i].g += i % 6 == 1 ? 2.0 : 0.0; /* a bound that holds anyway */
        o[i].reading = i;
    }
    free(d.z);
    return o;
}

static gonio_i_fit settled(const gonio_i_sites *sites, const gonio_i_column *column, bool keep,
                           size_t *outlying)
{
    gonio_i_fit e;
    assert_int_equal(gonio_i_fit_begin(fixture.context, sites, true, column, &e), GONIO_OK);
    if (keep) {
        assert_int_equal(gonio_i_fit_inverse_keep(&e), GONIO_OK);
    }
    assert_int_equal(gonio_i_fit_solve(&e, &PLAIN), GONIO_OK);
    assert_int_equal(gonio_i_fit_settle(&e, true, outlying), GONIO_OK);
    return e;
}

static void assert_same(const double *value, const double *expected, size_t n, double tolerance)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(expected[i]));
    }
    for (size_t i = 0; i < n; i++) {
        assert_close(value[i], expected[i], tolerance * most);
    }
}

/* With the inverse kept, a fit settles as it does by factorising S in each round. */
static void test_kept_inverse(void **state)
{
    (void)state;
    enum { N = 240 };
    gonio_i_observation *o = read_many();
    const gonio_i_column column = {N, o};
    gonio_i_sites *sites = NULL;
    size_t outlying[2];
    double sum[2];
    assert_int_equal(gonio_i_sites_create(fixture.context, fixture.gaussian, &column, &sites),
                     GONIO_OK);
    gonio_i_fit by_factor = settled(sites, &column, false, &outlying[0]);
    gonio_i_fit by_inverse = settled(sites, &column, true, &outlying[1]);
    size_t left_out = 0;
    for (size_t i = 0; i < N; i++) {
        left_out += by_factor.left_out[i];
        assert_int_equal(by_factor.left_out[i], by_inverse.left_out[i]);
    }
    assert_in_range(left_out, N / 6, N / 3);
    assert_in_range(outlying[0], 2, N / 20);
    assert_int_equal(outlying[0], outlying[1]);
    assert_same(by_inverse.variance, by_factor.variance, N, 1e-6);
    assert_same(by_inverse.solved, by_factor.solved, N, 1e-6);
    assert_int_equal(gonio_i_fit_surprise(&by_factor, &sum[0]), GONIO_OK);
    assert_int_equal(gonio_i_fit_surprise(&by_inverse, &sum[1]), GONIO_OK);
    assert_close(sum[1], sum[0], 1e-5 * sum[0]);
    gonio_i_fit_end(&by_factor);
    gonio_i_fit_end(&by_inverse);
    gonio_i_sites_free(&sites);
    free(o);
}

/* The completed inverse is that of S: its trace with S without noise, by solving. */
static void test_trace(void **state)
{
    (void)state;
    enum { N = 120 };
    gonio_i_observation *o = read_many();
    const gonio_i_column column = {N, o};
    gonio_i_sites *sites = NULL;
    size_t outlying = 0;
    double expected = 0.0;
    assert_int_equal(gonio_i_sites_create(fixture.context, fixture.gaussian, &column, &sites),
                     GONIO_OK);
    gonio_i_fit e = settled(sites, &column, true, &outlying);
    assert_int_equal(gonio_i_fit_inverse_complete(&e), GONIO_OK);
    double *s = calloc((size_t)N * N, sizeof *s);
    for (size_t i = 0; i < (size_t)N * N; i++) {
        s[i] = sites->gram[i] + PLAIN.alpha * PLAIN.alpha * sites->smooth[i];
        s[i] += i % (N + 1) == 0 ? gonio_i_fit_noise(&e, i / N) : 0.0;
    }
    (void)invert(s, N);
    for (size_t i = 0; i < (size_t)N * N; i++) {
        expected += s[i] * sites->smooth[i];
    }
    assert_close(gonio_i_fit_inverse_trace(&e, sites->smooth), expected, 1e-7 * expected);
    free(s);
    gonio_i_fit_end(&e);
    gonio_i_sites_free(&sites);
    free(o);
}

/* Readings that are left out have next to no say: without them the solution is the same. */
static void test_kept_readings(void **state)
{
    (void)state;
    enum { N = 240 };
    const gonio_i_model other = {1.0, 0.5, 8.0, 0.0};
    gonio_i_observation *o = read_many();
    const gonio_i_column column = {N, o};
    gonio_i_sites *sites = NULL;
    size_t outlying = 0;
    double solved[N];
    assert_int_equal(gonio_i_sites_create(fixture.context, fixture.gaussian, &column, &sites),
                     GONIO_OK);
    gonio_i_fit e = settled(sites, &column, true, &outlying);
    assert_int_equal(gonio_i_fit_solve(&e, &other), GONIO_OK);
    memcpy(solved, e.solved, sizeof solved);
    assert_int_equal(gonio_i_fit_solve_kept(&e, &other), GONIO_OK);
    assert_same(e.solved, solved, N, 1e-4);
    gonio_i_fit_end(&e);
    gonio_i_sites_free(&sites);
    free(o);
}

/* Models that differ in the width of their kernels only are one without kernels. */
static void test_plain_models(void **state)
{
    (void)state;
    gonio_i_models models = {.count = 4,
                             .model = {{0.9, 0.1, 0.0, 0.0},
                                       {0.9, 0.1, 0.0, 8.0},
                                       {1.0, 0.1, 0.0, 0.0},
                                       {1.0, 0.1, 8.0, 0.0}},
                             .weight = {0.1, 0.2, 0.3, 0.4},
                             .best = {0.9, 0.1, 0.0, 8.0}};
    gonio_i_models_make_plain(&models);
    assert_int_equal(models.count, 3);
    assert_close(models.weight[0], 0.4, 1e-15);
    assert_close(models.weight[1], 0.2, 1e-15);
    assert_close(models.weight[2], 0.4, 1e-15);
    assert_true(models.model[1].h == 1.0 && models.model[1].retro == 8.0);
    assert_true(models.best.h == 1.0 && models.best.retro == 8.0);
}

/* One reading more makes the fits plain, and changes next to nothing. */
static void test_one_reading_more(void **state)
{
    (void)state;
    gonio_i_observation *o = read_many();
    for (size_t i = 0; i < MANY; i++) {
        o[i].variance = i % 40 == 0 ? 1.0 : o[i].variance;
    }
    found few = find(fixture.mixture, o, MANY - 1, -1.0);
    found many = find(fixture.mixture, o, MANY, -1.0);
    double square = 0.0;
    for (size_t row = 0; row < fixture.mixture->view->rows; row++) {
        square += few.field[row] * few.field[row];
    }
    const double size = sqrt(square / (double)fixture.mixture->view->rows);
    assert_true(difference(&few, &many) < 1e-3 * size);
    assert_true(difference(&few, &many) > 0.0);
    assert_close(many.posterior.predicted, few.posterior.predicted, 0.03 * few.posterior.predicted);
    drop(&few);
    drop(&many);
    free(o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kept_inverse),     cmocka_unit_test(test_trace),
        cmocka_unit_test(test_kept_readings),    cmocka_unit_test(test_plain_models),
        cmocka_unit_test(test_one_reading_more),
    };
    return cmocka_run_group_tests_name("many_readings", tests, fixture_set_up, fixture_tear_down);
}
