/* What the tests of the posterior share: see posterior_fixture.h. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>

#include "../unit/made_basis.h"
#include "core/random.h"

posterior_fixture fixture;

int fixture_set_up(void **state)
{
    (void)state;
    fixture.context = support_context();
    fixture.small = made_basis(fixture.context, GONIO_BIVARIATE, GONIO_SEPARATE, 0);
    fixture.basis = made_basis(fixture.context, GONIO_SECTORED, GONIO_SEPARATE, 0);
    assert_int_equal(gonio_i_prior_create(fixture.context, fixture.small, &fixture.gaussian),
                     GONIO_OK);
    assert_int_equal(gonio_i_prior_create(fixture.context, fixture.small, &fixture.mixture),
                     GONIO_OK);
    fixture.gaussian->samples = 0;
    return 0;
}

int fixture_tear_down(void **state)
{
    (void)state;
    gonio_i_prior_free(&fixture.gaussian);
    gonio_i_prior_free(&fixture.mixture);
    gonio_basis_free(&fixture.small);
    gonio_basis_free(&fixture.basis);
    gonio_context_free(&fixture.context);
    return 0;
}

void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

double truth_at(const double *z, gonio_half_difference at)
{
    const size_t k = fixture.gaussian->components;
    double f[64];
    double g = 0.0;
    assert_true(k <= 64);
    gonio_i_prior_at(fixture.gaussian, at, 0, &g, f);
    for (size_t j = 0; j < k; j++) {
        g += f[j] * z[j];
    }
    return g;
}

bool is_whole(size_t row)
{
    int channel = 0;
    double mean = 0.0;
    double own[64];
    double there[64];
    gonio_i_prior_row(fixture.gaussian, row, own);
    gonio_i_prior_at(fixture.gaussian,
                     gonio_i_row_coordinates(fixture.gaussian->view, row, &channel), 0, &mean,
                     there);
    return fabs(own[0] - there[0]) <= 1e-9 * fabs(own[0]);
}

drawn draw(uint64_t seed, double deviation)
{
    drawn d = {.z = calloc(fixture.gaussian->components, sizeof *d.z)};
    gonio_i_random random;
    gonio_i_random_seed(&random, seed, 0);
    for (size_t j = 0; j < fixture.gaussian->components; j++) {
        d.z[j] = gonio_i_random_normal(&random);
    }
    for (size_t i = 0; i < MOST; i++) {
        int channel = 0;
        gonio_i_observation *o = &d.reading[i];
        do {
            d.row[i] = (size_t)gonio_i_random_below(&random, fixture.gaussian->view->rows);
        } while (!is_whole(d.row[i]));
        o->at = gonio_i_row_coordinates(fixture.gaussian->view, d.row[i], &channel);
        o->g = truth_at(d.z, o->at) + deviation * gonio_i_random_normal(&random);
        o->variance = deviation * deviation;
    }
    return d;
}

found find_of(const gonio_i_prior *prior, gonio_i_observation *readings, size_t count, double alpha,
              size_t most)
{
    double coefficients[64];
    found r = {.field = malloc(prior->view->rows * sizeof *r.field),
               .deviation = malloc(prior->view->rows * sizeof *r.deviation)};
    const gonio_i_column column = {count, readings};
    const gonio_i_posterior_options options = {
        .smoothness = alpha, .deviation = true, .most = most};
    r.posterior = (gonio_i_posterior){
        .coefficients = coefficients, .field = r.field, .deviation = r.deviation};
    assert_int_equal(
        gonio_i_posterior_find(fixture.context, prior, &column, 1, &options, &r.posterior),
        GONIO_OK);
    r.posterior.coefficients = NULL;
    return r;
}

found find(const gonio_i_prior *prior, gonio_i_observation *readings, size_t count, double alpha)
{
    return find_of(prior, readings, count, alpha, 0);
}

void drop(found *r)
{
    free(r->field);
    free(r->deviation);
}

double difference(const found *a, const found *b)
{
    double sum = 0.0;
    for (size_t row = 0; row < fixture.gaussian->view->rows; row++) {
        const double d = a->field[row] - b->field[row];
        sum += d * d;
    }
    return sqrt(sum / (double)fixture.gaussian->view->rows);
}

/* ---- dense algebra ---- */

double invert(double *a, size_t n)
{
    double logarithm = 0.0;
    for (size_t c = 0; c < n; c++) {
        const double pivot = a[c * n + c];
        assert_true(pivot > 0.0);
        logarithm += log(pivot);
        a[c * n + c] = 1.0;
        for (size_t j = 0; j < n; j++) {
            a[c * n + j] /= pivot;
        }
        for (size_t i = 0; i < n; i++) {
            const double factor = a[i * n + c];
            if (i != c) {
                a[i * n + c] = 0.0;
                for (size_t j = 0; j < n; j++) {
                    a[i * n + j] -= factor * a[c * n + j];
                }
            }
        }
    }
    return logarithm;
}

double covariance(gonio_half_difference a, gonio_half_difference b, double h, double alpha)
{
    double mean = 0.0;
    double f[2][64];
    const gonio_i_place x = gonio_i_place_of(a);
    const gonio_i_place y = gonio_i_place_of(b);
    double sum = 0.0;
    gonio_i_prior_at(fixture.gaussian, a, 0, &mean, f[0]);
    gonio_i_prior_at(fixture.gaussian, b, 0, &mean, f[1]);
    for (size_t j = 0; j < fixture.gaussian->components; j++) {
        sum += f[0][j] * f[1][j];
    }
    return h * h * sum + alpha * alpha * gonio_i_remainder(&x, &y, PEAK, 0.0);
}

double mean_at(gonio_half_difference at)
{
    double mean = 0.0;
    double f[64];
    gonio_i_prior_at(fixture.gaussian, at, 0, &mean, f);
    return mean;
}

double invert_covariance(const gonio_i_observation *readings, size_t n, double h, double alpha,
                         double *s)
{
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            s[i * n + j] = covariance(readings[i].at, readings[j].at, h, alpha) +
                           (i == j ? readings[i].variance : 0.0);
        }
    }
    return invert(s, n);
}

void textbook(const gonio_i_observation *readings, size_t n, const double *s,
              gonio_half_difference at, double *mean, double *variance)
{
    double c[MOST];
    *mean = mean_at(at);
    *variance = covariance(at, at, 1.0, ALPHA);
    for (size_t i = 0; i < n; i++) {
        c[i] = covariance(at, readings[i].at, 1.0, ALPHA);
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            *mean += c[i] * s[i * n + j] * (readings[j].g - mean_at(readings[j].at));
            *variance -= c[i] * s[i * n + j] * c[j];
        }
    }
}

/* ---- fits ---- */

gonio_i_fit begin_fit(const gonio_i_prior *prior, const gonio_i_column *column,
                      gonio_i_sites **sites)
{
    gonio_i_fit e;
    assert_int_equal(gonio_i_sites_create(fixture.context, prior, column, sites), GONIO_OK);
    assert_int_equal(gonio_i_fit_begin(fixture.context, *sites, false, column, &e), GONIO_OK);
    return e;
}

void end_fit(gonio_i_fit *e, gonio_i_sites **sites)
{
    gonio_i_fit_end(e);
    gonio_i_sites_free(sites);
}
