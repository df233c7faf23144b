/* Leave-one-out predictions against fits without the reading. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>

static void test_leaving_one_out(void **state)
{
    (void)state;
    enum { N = 15 };
    drawn d = draw(4, 0.05);
    const gonio_i_column column = {N, d.reading};
    gonio_i_sites *sites = NULL;
    gonio_i_fit e = begin_fit(fixture.gaussian, &column, &sites);
    double left[N];
    double variance[N];
    assert_int_equal(gonio_i_fit_solve(&e, &(gonio_i_model){1.0, ALPHA, PEAK, 0.0}), GONIO_OK);
    assert_int_equal(gonio_i_fit_leave_one_out(&e, left, variance), GONIO_OK);
    end_fit(&e, &sites);
    for (size_t i = 0; i < N; i++) {
        gonio_i_observation others[N - 1];
        double s[(N - 1) * (N - 1)];
        double mean = 0.0;
        double known = 0.0;
        for (size_t j = 0; j < N - 1; j++) {
            others[j] = d.reading[j < i ? j : j + 1];
        }
        invert_covariance(others, N - 1, 1.0, ALPHA, s);
        textbook(others, N - 1, s, d.reading[i].at, &mean, &known);
        assert_close(left[i], d.reading[i].g - mean, 1e-7);
        assert_close(variance[i], known + d.reading[i].variance, 1e-7 * variance[i]);
    }
    free(d.z);
}

/* Of a mixture, whose weights are the other readings' too: by solving without the reading. */
static void test_leaving_one_out_of_a_mixture(void **state)
{
    (void)state;
    enum { N = 9 };
    const gonio_i_model model = {GONIO_I_KERNEL_WIDTH, ALPHA, PEAK, 0.0};
    drawn d = draw(5, 0.1);
    const gonio_i_column column = {N, d.reading};
    gonio_i_sites *sites = NULL;
    gonio_i_fit all = begin_fit(fixture.mixture, &column, &sites);
    double left[N];
    double variance[N];
    assert_int_equal(gonio_i_fit_solve(&all, &model), GONIO_OK);
    assert_int_equal(gonio_i_fit_leave_one_out(&all, left, variance), GONIO_OK);
    for (size_t i = 0; i < N; i++) {
        gonio_i_observation other[N - 1];
        const gonio_i_column others = {N - 1, other};
        gonio_i_sites *fewer = NULL;
        for (size_t j = 0; j < N - 1; j++) {
            other[j] = d.reading[j < i ? j : j + 1];
        }
        gonio_i_fit e = begin_fit(fixture.mixture, &others, &fewer);
        assert_int_equal(gonio_i_fit_solve(&e, &model), GONIO_OK);
        double predicted = 0.0;
        for (size_t k = 0; k < e.components; k++) {
            predicted += sites->f[i * e.components + k] * e.centre[k];
        }
        for (size_t j = 0; j < N - 1; j++) {
            const size_t at = i * N + (j < i ? j : j + 1);
            const double k = sites->smooth[at] + PEAK * PEAK * sites->peaked[at];
            predicted += (model.h * model.h * sites->gram[at] + ALPHA * ALPHA * k) * e.solved[j];
        }
        assert_close(left[i], all.y[i] - predicted, 1e-7);
        end_fit(&e, &fewer);
    }
    end_fit(&all, &sites);
    free(d.z);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_leaving_one_out),
        cmocka_unit_test(test_leaving_one_out_of_a_mixture),
    };
    return cmocka_run_group_tests_name("leave_one_out", tests, fixture_set_up, fixture_tear_down);
}
