/* The posterior against the textbook's formulas for Gaussians, computed densely; leaving out,
 * evidence, bounds, wrong readings, dark levels, what comes out. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../unit/made_basis.h"
#include "../unit/made_readings.h"
#include "core/random.h"
#include "posterior/wrong_directions.h"
#include "posterior/models.h"

enum { MOST = 60 };

static const double OPEN = 0.01; /* spread.c, FOR_BANDS */
static const double ALPHA = 0.1;
static const double PEAK = 0.0; /* what a given alpha goes with */

static gonio_context *context;
static gonio_basis *small;      /* bivariate, of which the priors are */
static gonio_basis *basis;      /* sectored */
static gonio_i_prior *gaussian; /* without samples: h = 1 */
static gonio_i_prior *mixture;

static int set_up(void **state)
{
    (void)state;
    context = support_context();
    small = made_basis(context, GONIO_BIVARIATE, GONIO_SEPARATE, 0);
    basis = made_basis(context, GONIO_SECTORED, GONIO_SEPARATE, 0);
    assert_int_equal(gonio_i_prior_create(context, small, &gaussian), GONIO_OK);
    assert_int_equal(gonio_i_prior_create(context, small, &mixture), GONIO_OK);
    gaussian->samples = 0;
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    gonio_i_prior_free(&gaussian);
    gonio_i_prior_free(&mixture);
    gonio_basis_free(&small);
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    return 0;
}

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

/* A material drawn from the prior, read at random rows. */
typedef struct drawn {
    double *z;
    size_t row[MOST];
    gonio_i_observation reading[MOST];
} drawn;

static double truth_at(const double *z, gonio_half_difference at)
{
    const size_t k = gaussian->components;
    double f[64];
    double g = 0.0;
    assert_true(k <= 64);
    gonio_i_prior_at(gaussian, at, 0, &g, f);
    for (size_t j = 0; j < k; j++) {
        g += f[j] * z[j];
    }
    return g;
}

/* Whether a row's coordinates are those of its cell: not where a part of it is below the horizon.
 */
static bool is_whole(size_t row)
{
    int channel = 0;
    double mean = 0.0;
    double own[64];
    double there[64];
    gonio_i_prior_row(gaussian, row, own);
    gonio_i_prior_at(gaussian, gonio_i_row_coordinates(gaussian->view, row, &channel), 0, &mean,
                     there);
    return fabs(own[0] - there[0]) <= 1e-9 * fabs(own[0]);
}

static drawn draw(uint64_t seed, double deviation)
{
    drawn d = {.z = calloc(gaussian->components, sizeof *d.z)};
    gonio_i_random random;
    gonio_i_random_seed(&random, seed, 0);
    for (size_t j = 0; j < gaussian->components; j++) {
        d.z[j] = gonio_i_random_normal(&random);
    }
    for (size_t i = 0; i < MOST; i++) {
        int channel = 0;
        gonio_i_observation *o = &d.reading[i];
        do {
            d.row[i] = (size_t)gonio_i_random_below(&random, gaussian->view->rows);
        } while (!is_whole(d.row[i]));
        o->at = gonio_i_row_coordinates(gaussian->view, d.row[i], &channel);
        o->g = truth_at(d.z, o->at) + deviation * gonio_i_random_normal(&random);
        o->variance = deviation * deviation;
    }
    return d;
}

/* What is found of one column: the caller frees both. */
typedef struct found {
    double *field;
    double *deviation;
    gonio_i_posterior posterior;
} found;

static found find_of(const gonio_i_prior *prior, gonio_i_observation *readings, size_t count,
                     double alpha, size_t most)
{
    double coefficients[64];
    found r = {.field = malloc(prior->view->rows * sizeof *r.field),
               .deviation = malloc(prior->view->rows * sizeof *r.deviation)};
    const gonio_i_column column = {count, readings};
    const gonio_i_posterior_options options = {
        .smoothness = alpha, .deviation = true, .most = most};
    r.posterior = (gonio_i_posterior){
        .coefficients = coefficients, .field = r.field, .deviation = r.deviation};
    assert_int_equal(gonio_i_posterior_find(context, prior, &column, 1, &options, &r.posterior),
                     GONIO_OK);
    r.posterior.coefficients = NULL;
    return r;
}

static found find(const gonio_i_prior *prior, gonio_i_observation *readings, size_t count,
                  double alpha)
{
    return find_of(prior, readings, count, alpha, 0);
}

static void drop(found *r)
{
    free(r->field);
    free(r->deviation);
}

/* Root mean square of the difference of two fields. */
static double difference(const found *a, const found *b)
{
    double sum = 0.0;
    for (size_t row = 0; row < gaussian->view->rows; row++) {
        const double d = a->field[row] - b->field[row];
        sum += d * d;
    }
    return sqrt(sum / (double)gaussian->view->rows);
}

/* ---- dense algebra ---- */

/* a becomes its inverse (Gauss and Jordan), and the logarithm of its determinant is returned. */
static double invert(double *a, size_t n)
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

/* h^2 f f' + alpha^2 k of two directions. */
static double covariance(gonio_half_difference a, gonio_half_difference b, double h, double alpha)
{
    double mean = 0.0;
    double f[2][64];
    const gonio_i_place x = gonio_i_place_of(a);
    const gonio_i_place y = gonio_i_place_of(b);
    double sum = 0.0;
    gonio_i_prior_at(gaussian, a, 0, &mean, f[0]);
    gonio_i_prior_at(gaussian, b, 0, &mean, f[1]);
    for (size_t j = 0; j < gaussian->components; j++) {
        sum += f[0][j] * f[1][j];
    }
    return h * h * sum + alpha * alpha * gonio_i_remainder(&x, &y, PEAK);
}

static double mean_at(gonio_half_difference at)
{
    double mean = 0.0;
    double f[64];
    gonio_i_prior_at(gaussian, at, 0, &mean, f);
    return mean;
}

/* The inverse of the covariance of readings; ln of its determinant before. */
static double invert_covariance(const gonio_i_observation *readings, size_t n, double h,
                                double alpha, double *s)
{
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            s[i * n + j] = covariance(readings[i].at, readings[j].at, h, alpha) +
                           (i == j ? readings[i].variance : 0.0);
        }
    }
    return invert(s, n);
}

/* Mean and variance of g at a direction, given readings. */
static void textbook(const gonio_i_observation *readings, size_t n, const double *s,
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

/* The deviations of all rows may be widened alike, so that they fit what is true. */
static void test_the_textbooks_posterior(void **state)
{
    (void)state;
    static const size_t counts[] = {1, 2, 12, 50};
    for (size_t c = 0; c < 4; c++) {
        drawn d = draw(c, 0.05);
        const size_t n = counts[c];
        double *s = malloc(n * n * sizeof *s);
        found r = find(gaussian, d.reading, n, ALPHA);
        assert_int_equal(r.posterior.outlying, 0);
        invert_covariance(d.reading, n, 1.0, ALPHA, s);
        double widened = 0.0;
        for (size_t row = 11; row < gaussian->view->rows; row += 41) {
            if (!is_whole(row)) {
                continue;
            }
            int channel = 0;
            double mean = 0.0;
            double variance = 0.0;
            textbook(d.reading, n, s, gonio_i_row_coordinates(gaussian->view, row, &channel), &mean,
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
    found direct = find(gaussian, all, MOST * TIMES, ALPHA);
    found merged = find_of(gaussian, all, MOST * TIMES, ALPHA, MOST * TIMES - 1);
    found once = find(gaussian, all, MOST, ALPHA);
    assert_true(difference(&direct, &merged) < 0.01);
    assert_true(difference(&direct, &once) > 0.05);
    drop(&direct);
    drop(&merged);
    drop(&once);
    free(all);
    free(d.z);
}

/* A fit over sites of its own. */
static gonio_i_fit begin_fit(const gonio_i_prior *prior, const gonio_i_column *column,
                             gonio_i_sites **sites)
{
    gonio_i_fit e;
    assert_int_equal(gonio_i_sites_create(context, prior, column, sites), GONIO_OK);
    assert_int_equal(gonio_i_fit_begin(context, *sites, false, column, &e), GONIO_OK);
    return e;
}

static void end_fit(gonio_i_fit *e, gonio_i_sites **sites)
{
    gonio_i_fit_end(e);
    gonio_i_sites_free(sites);
}

static void test_leaving_one_out(void **state)
{
    (void)state;
    enum { N = 15 };
    drawn d = draw(4, 0.05);
    const gonio_i_column column = {N, d.reading};
    gonio_i_sites *sites = NULL;
    gonio_i_fit e = begin_fit(gaussian, &column, &sites);
    double left[N];
    double variance[N];
    assert_int_equal(gonio_i_fit_solve(&e, &(gonio_i_model){1.0, ALPHA, PEAK}), GONIO_OK);
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
    const gonio_i_model model = {GONIO_I_KERNEL_WIDTH, ALPHA, PEAK};
    drawn d = draw(5, 0.1);
    const gonio_i_column column = {N, d.reading};
    gonio_i_sites *sites = NULL;
    gonio_i_fit all = begin_fit(mixture, &column, &sites);
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
        gonio_i_fit e = begin_fit(mixture, &others, &fewer);
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

/* ---- sites ---- */

enum { SITES = 9, SHARING = 7 };

/* The readings of a material as columns of other values; the last one lacks a reading. */
typedef struct shared {
    gonio_i_observation reading[SHARING][SITES];
    gonio_i_column column[SHARING];
} shared;

static void share(const drawn *d, shared *s)
{
    for (size_t c = 0; c < SHARING; c++) {
        s->column[c] = (gonio_i_column){c + 1 < SHARING ? SITES : SITES - 1, s->reading[c]};
        for (size_t i = 0; i < SITES; i++) {
            s->reading[c][i] = d->reading[i];
            s->reading[c][i].g *= 1.0 + 0.1 * (double)c;
            s->reading[c][i].variance *= 1.0 + 0.3 * (double)c;
            s->reading[c][i].channel = (int)c;
        }
    }
    s->reading[2][3].bound = 1;
    s->reading[3][4].bound = -1;
}

/* Columns that were read at the same directions share their sites, whatever was read. */
static void test_sites_are_shared(void **state)
{
    (void)state;
    drawn d = draw(7, 0.1);
    shared s;
    gonio_i_sites *sites[SHARING];
    size_t group[SHARING];
    share(&d, &s);
    s.reading[1][5].at.phi_d += 1e-12; /* not the same direction */
    assert_int_equal(gonio_i_sites_share(context, mixture, s.column, SHARING, sites), GONIO_OK);
    assert_int_equal(gonio_i_sites_group(mixture, s.column, SHARING, group), 3);
    for (size_t c = 0; c < SHARING; c++) {
        const bool alone = c == 1 || c == SHARING - 1;
        assert_int_equal(group[c], c == 1 ? 1 : alone ? 2 : 0);
        assert_true((sites[c] == sites[0]) == !alone);
        assert_int_equal(sites[c]->n, s.column[c].count);
        for (size_t j = 0; j < c; j++) {
            assert_true((sites[c] == sites[j]) == (group[c] == group[j]));
        }
    }
    gonio_i_sites_release(sites, SHARING);
    for (size_t c = 0; c < SHARING; c++) {
        assert_null(sites[c]);
    }
    free(d.z);
}

static void assert_same_fit(const gonio_i_fit *a, const gonio_i_fit *b)
{
    assert_int_equal(a->n, b->n);
    assert_memory_equal(a->y, b->y, a->n * sizeof *a->y);
    assert_memory_equal(a->variance, b->variance, a->n * sizeof *a->variance);
    assert_memory_equal(a->left_out, b->left_out, a->n * sizeof *a->left_out);
    assert_memory_equal(a->lower, b->lower, a->n * a->n * sizeof *a->lower);
    assert_memory_equal(a->weight, b->weight, a->samples * sizeof *a->weight);
    assert_memory_equal(a->centre, b->centre, a->components * sizeof *a->centre);
    assert_memory_equal(a->solved, b->solved, a->n * sizeof *a->solved);
    assert_memory_equal(&a->evidence, &b->evidence, sizeof a->evidence);
}

/* A fit over shared sites, in which other values were before, is bit for bit one over sites of its
 * own; and it leaves the sites as they were. */
static void test_fits_of_shared_sites(void **state)
{
    (void)state;
    const gonio_i_model models[] = {{GONIO_I_KERNEL_WIDTH, ALPHA, PEAK}, {1.0, 0.5, 0.0}};
    drawn d = draw(7, 0.1);
    shared s;
    share(&d, &s);
    gonio_i_sites *sites = NULL;
    gonio_i_sites *untouched = NULL;
    gonio_i_fit fit = begin_fit(mixture, &s.column[0], &sites);
    assert_int_equal(gonio_i_sites_create(context, mixture, &s.column[0], &untouched), GONIO_OK);
    for (size_t c = 0; c + 1 < SHARING; c++) {
        gonio_i_sites *own = NULL;
        gonio_i_fit alone = begin_fit(mixture, &s.column[c], &own);
        gonio_i_fit_read(&fit, &s.column[c]);
        for (int m = 0; m < 2; m++) {
            size_t outlying[2];
            assert_int_equal(gonio_i_fit_solve(&fit, &models[m]), GONIO_OK);
            assert_int_equal(gonio_i_fit_solve(&alone, &models[m]), GONIO_OK);
            assert_same_fit(&fit, &alone);
            assert_int_equal(gonio_i_fit_settle(&fit, true, &outlying[0]), GONIO_OK);
            assert_int_equal(gonio_i_fit_settle(&alone, true, &outlying[1]), GONIO_OK);
            assert_same_fit(&fit, &alone);
            assert_int_equal(outlying[0], outlying[1]);
        }
        end_fit(&alone, &own);
    }
    assert_memory_equal(sites->f, untouched->f, SITES * sites->components * sizeof *sites->f);
    assert_memory_equal(sites->seen, untouched->seen,
                        SITES * mixture->samples * sizeof *sites->seen);
    assert_memory_equal(sites->gram, untouched->gram, SITES * SITES * sizeof *sites->gram);
    assert_memory_equal(sites->smooth, untouched->smooth, SITES * SITES * sizeof *sites->smooth);
    assert_memory_equal(sites->peaked, untouched->peaked, SITES * SITES * sizeof *sites->peaked);
    gonio_i_sites_free(&untouched);
    end_fit(&fit, &sites);
    free(d.z);
}

/* Columns found together, some over the same sites, are bit for bit those found one by one. */
static void test_columns_together(void **state)
{
    (void)state;
    const size_t rows = mixture->view->rows;
    const size_t components = mixture->components;
    const gonio_i_posterior_options options = {.smoothness = ALPHA, .deviation = true};
    drawn d = draw(8, 0.1);
    shared s;
    share(&d, &s);
    gonio_i_posterior all = {.coefficients = calloc(SHARING * components, sizeof(double)),
                             .field = calloc(SHARING * rows, sizeof(double)),
                             .deviation = calloc(SHARING * rows, sizeof(double))};
    gonio_i_posterior one = {.coefficients = calloc(components, sizeof(double)),
                             .field = calloc(rows, sizeof(double)),
                             .deviation = calloc(rows, sizeof(double))};
    assert_int_equal(gonio_i_posterior_find(context, mixture, s.column, SHARING, &options, &all),
                     GONIO_OK);
    for (size_t c = 0; c < SHARING; c++) {
        assert_int_equal(gonio_i_posterior_find(context, mixture, &s.column[c], 1, &options, &one),
                         GONIO_OK);
        assert_memory_equal(one.field, all.field + c * rows, rows * sizeof(double));
        assert_memory_equal(one.deviation, all.deviation + c * rows, rows * sizeof(double));
        assert_memory_equal(one.coefficients, all.coefficients + c * components,
                            components * sizeof(double));
    }
    gonio_i_posterior *both[] = {&all, &one};
    for (int k = 0; k < 2; k++) {
        free(both[k]->coefficients);
        free(both[k]->field);
        free(both[k]->deviation);
    }
    free(d.z);
}

/* ln sum_j share_j N(y; a F z_j, h^2 F F' + alpha^2 k + D); of a Gaussian, j = 1 and z = 0. */
static void test_the_evidence(void **state)
{
    (void)state;
    enum { N = 9 };
    const gonio_i_prior *const priors[2] = {gaussian, mixture};
    drawn d = draw(6, 0.1);
    const gonio_i_column column = {N, d.reading};
    for (int p = 0; p < 2; p++) {
        const double h = p == 0 ? 1.0 : GONIO_I_KERNEL_WIDTH;
        double s[N * N];
        const double logarithm = invert_covariance(d.reading, N, h, ALPHA, s);
        double density = 0.0;
        const size_t samples = p == 0 ? 1 : mixture->samples;
        for (size_t j = 0; j < samples; j++) {
            double rest[N];
            double square = 0.0;
            for (size_t i = 0; i < N; i++) {
                const double mean = mean_at(d.reading[i].at);
                const double *z = mixture->sample + j * mixture->components;
                const double centre =
                    p == 0 ? 0.0 : sqrt(1.0 - h * h) * (truth_at(z, d.reading[i].at) - mean);
                rest[i] = d.reading[i].g - mean - centre;
            }
            for (size_t i = 0; i < N * N; i++) {
                square += rest[i / N] * s[i] * rest[i % N];
            }
            density += (p == 0 ? 1.0 : mixture->share[j]) * exp(-0.5 * square);
        }
        const double expected = log(density) - 0.5 * (logarithm + N * log(2.0 * M_PI));
        double evidence = 0.0;
        gonio_i_sites *sites = NULL;
        assert_int_equal(gonio_i_sites_create(context, priors[p], &column, &sites), GONIO_OK);
        assert_int_equal(gonio_i_fit_evidence(context, sites, &column, ALPHA, 0.0, &evidence),
                         GONIO_OK);
        gonio_i_sites_free(&sites);
        assert_close(evidence, expected, 1e-6 * fabs(expected));
    }
    free(d.z);
}

static void test_deviations_shrink(void **state)
{
    (void)state;
    static const size_t counts[] = {1, 3, 10, 30, MOST};
    drawn d = draw(8, 1e-3);
    found before = find(gaussian, d.reading, 1, ALPHA);
    for (size_t c = 0; c < 5; c++) {
        found r = find(gaussian, d.reading, counts[c], ALPHA);
        double sums[2] = {0.0, 0.0};
        for (size_t row = 0; row < gaussian->view->rows; row++) {
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

/* ---- bounds and wrong readings ---- */

/* Fewer readings of a material than determine it, and one more that is a bound. */
static void check_bound(int sense, uint64_t seed)
{
    enum { N = 6 };
    drawn d = draw(seed, 0.02);
    gonio_i_observation *bound = &d.reading[N];
    found without = find(gaussian, d.reading, N, ALPHA);
    const double said = without.field[d.row[N]];
    const double open = without.deviation[d.row[N]];
    bound->bound = sense;
    /* One that holds anyway says nothing, however far off it is. */
    bound->g = said - sense * (3.0 + 2.0 * open);
    found kept = find(gaussian, d.reading, N + 1, ALPHA);
    assert_int_equal(kept.posterior.outlying, 0);
    assert_true(difference(&kept, &without) < 1e-3);
    drop(&kept);
    /* One that does not is a reading. */
    bound->g = said + sense * 1.5 * open;
    found broken = find(gaussian, d.reading, N + 1, ALPHA);
    assert_true(sense * (broken.field[d.row[N]] - said) > 0.5 * open);
    drop(&broken);
    drop(&without);
    free(d.z);
}

static void test_bounds(void **state)
{
    (void)state;
    for (uint64_t seed = 10; seed < 13; seed++) {
        check_bound(-1, seed); /* darkness */
        check_bound(1, seed);  /* saturation */
    }
}

static void test_a_reading_ten_times_too_large(void **state)
{
    (void)state;
    enum { N = 40 };
    for (uint64_t seed = 20; seed < 23; seed++) {
        drawn d = draw(seed, 0.05);
        found clean = find(gaussian, d.reading, N, ALPHA);
        for (int sense = -1; sense <= 1; sense += 2) {
            d.reading[7].g += sense * log(10.0);
            found wrong = find(gaussian, d.reading, N, ALPHA);
            double sum = 0.0;
            for (size_t row = 0; row < gaussian->view->rows; row++) {
                sum += clean.field[row] * clean.field[row];
            }
            assert_true(difference(&wrong, &clean) <
                        0.01 * sqrt(sum / (double)gaussian->view->rows));
            assert_in_range(wrong.posterior.outlying, 1, 2); /* its neighbour may go with it */
            d.reading[7].g -= sense * log(10.0);
            drop(&wrong);
        }
        assert_int_equal(clean.posterior.outlying, 0);
        drop(&clean);
        free(d.z);
    }
}

/* ---- directions that were read wrongly ---- */

enum { COLUMNS = 3, WRONG = 24 };

static const double TENFOLD = 2.302585;

/* Three columns of WRONG readings in the same directions, each drawn from the prior. */
typedef struct drawn_columns {
    gonio_i_observation reading[COLUMNS][WRONG];
    gonio_i_column column[COLUMNS];
} drawn_columns;

static void draw_columns(uint64_t seed, drawn_columns *d)
{
    const drawn first = draw(seed, 0.02);
    for (size_t c = 0; c < COLUMNS; c++) {
        const drawn other = draw(seed + 100 * c, 0.02);
        for (size_t i = 0; i < WRONG; i++) {
            d->reading[c][i] = first.reading[i];
            d->reading[c][i].g +=
                truth_at(other.z, first.reading[i].at) - truth_at(first.z, first.reading[i].at);
        }
        d->column[c] = (gonio_i_column){WRONG, d->reading[c]};
        free(other.z);
    }
    free(first.z);
}

/* How many readings are of wrong directions. */
static size_t find_wrong(gonio_i_column *columns, size_t count)
{
    gonio_i_subset subset;
    size_t wrong = 0;
    assert_int_equal(gonio_i_subset_begin(context, mixture, columns, count, &subset), GONIO_OK);
    assert_int_equal(gonio_i_wrong_directions_find(context, &subset, columns, count, &wrong),
                     GONIO_OK);
    gonio_i_subset_end(&subset);
    return wrong;
}

/* directions that are found wrong; of all columns alike. */
static size_t found_wrong(drawn_columns *d, bool *is)
{
    const size_t wrong = find_wrong(d->column, COLUMNS);
    size_t directions = 0;
    for (size_t i = 0; i < WRONG; i++) {
        is[i] = d->reading[0][i].variance > 1.0;
        directions += is[i];
        for (size_t c = 1; c < COLUMNS; c++) {
            assert_int_equal(d->reading[c][i].variance > 1.0, is[i]);
        }
    }
    assert_int_equal(wrong, COLUMNS * directions);
    return directions;
}

static void mistake(drawn_columns *d, size_t i, double by)
{
    for (size_t c = 0; c < COLUMNS; c++) {
        d->reading[c][i].g += by;
    }
}

static void test_directions_that_were_read_wrongly(void **state)
{
    (void)state;
    bool is[WRONG];
    size_t twos = 0;
    for (uint64_t seed = 40; seed < 48; seed++) {
        drawn_columns d;
        draw_columns(seed, &d);
        assert_int_equal(found_wrong(&d, is), 0);
        mistake(&d, seed % WRONG, TENFOLD);
        assert_int_equal(found_wrong(&d, is), 1);
        assert_true(is[seed % WRONG]);
        /* Two, of which the second is too low: one can hide the other. */
        draw_columns(seed, &d);
        mistake(&d, seed % WRONG, TENFOLD);
        mistake(&d, (seed + 7) % WRONG, -TENFOLD);
        const size_t of_two = found_wrong(&d, is);
        assert_int_equal(of_two, is[seed % WRONG] + is[(seed + 7) % WRONG]);
        twos += of_two;
        /* So many that the material may as well be unusual: a tenth and one at most. */
        draw_columns(seed, &d);
        for (size_t i = 0; i < WRONG; i += 2) {
            mistake(&d, i, i % 4 == 0 ? TENFOLD : -TENFOLD);
        }
        assert_true(found_wrong(&d, is) <= 1 + WRONG / 10);
    }
    /* Nobody else to say so. */
    for (size_t n = 1; n < 5; n++) {
        drawn_columns d;
        draw_columns(40, &d);
        mistake(&d, 0, 3.0 * TENFOLD);
        for (size_t c = 0; c < COLUMNS; c++) {
            d.column[c].count = n;
        }
        assert_int_equal(find_wrong(d.column, COLUMNS), 0);
    }
    print_message("%zu of 16 found where there are two\n", twos);
    assert_true(twos >= 12);
}

/* Whole reconstructions: with a wrong direction as good as without it. */
static void test_a_wrong_direction_hardly_counts(void **state)
{
    (void)state;
    int alone = 0; /* found in a single column */
    for (uint64_t seed = 40; seed < 48; seed++) {
        drawn_columns d;
        draw_columns(seed, &d);
        const size_t i = seed % WRONG;
        const found before = find(mixture, d.reading[0], WRONG, -1.0);
        mistake(&d, i, 2.0 * TENFOLD);
        const found with = find(mixture, d.reading[0], WRONG, -1.0);
        const size_t wrong = find_wrong(d.column, 1);
        alone += wrong == 1 && d.reading[0][i].variance > 1.0;
        d.reading[0][i] = d.reading[0][WRONG - 1];
        const found without = find(mixture, d.reading[0], WRONG - 1, -1.0);
        assert_true(with.posterior.outlying >= 1);
        assert_true(difference(&with, &without) < 0.02 + difference(&before, &without));
        found all[] = {before, with, without};
        for (int k = 0; k < 3; k++) {
            drop(&all[k]);
        }
    }
    assert_true(alone >= 6);
}

/* ---- models ---- */

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
        if (d.reading[i].at.theta_h > 0.1) { /* where a remainder has no peak */
            d.reading[taken++] = d.reading[i];
        }
    }
    gonio_i_subset subset;
    assert_int_equal(gonio_i_subset_begin(context, gaussian, &column, 1, &subset), GONIO_OK);
    assert_int_equal(gonio_i_models_weigh(context, gaussian, &subset, &models), GONIO_OK);
    gonio_i_subset_end(&subset);
    assert_in_range(models.count, 2, GONIO_I_MOST_MODELS);
    found mixed = find(gaussian, d.reading, N, -1.0);
    found mean = {.field = calloc(gaussian->view->rows, sizeof *mean.field)};
    double sum = 0.0;
    bool best = false;
    for (size_t k = 0; k < models.count; k++) {
        const gonio_i_model *m = &models.model[k];
        found one = find(gaussian, d.reading, N, m->alpha);
        for (size_t row = 0; row < gaussian->view->rows; row++) {
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

/* A lobe around the mirror direction that no material of the database has. */
static double strange_at(gonio_half_difference at)
{
    return 4.0 * exp(-0.5 * pow(at.theta_h / 0.2, 2.0));
}

/* Of such a material the readings in the lobe are right, and are used. */
static void test_an_unusual_material(void **state)
{
    (void)state;
    enum { N = 40 };
    for (uint64_t seed = 50; seed < 54; seed++) {
        drawn d = draw(seed, 0.02);
        double square = 0.0;
        size_t unusual = 0;
        size_t rows = 0;
        for (size_t i = 0; i < N; i++) {
            const double strange = strange_at(d.reading[i].at);
            d.reading[i].g += strange;
            unusual += strange > 0.5;
        }
        assert_in_range(unusual, 2, N);
        found r = find(gaussian, d.reading, N, -1.0);
        for (size_t row = 0; row < gaussian->view->rows; row++) {
            int channel = 0;
            const gonio_half_difference at = gonio_i_row_coordinates(gaussian->view, row, &channel);
            const double error = r.field[row] - truth_at(d.z, at) - strange_at(at);
            square += strange_at(at) > 0.5 ? error * error : 0.0;
            rows += strange_at(at) > 0.5;
        }
        assert_int_equal(r.posterior.outlying, 0);
        assert_true(sqrt(square / (double)rows) < 0.3); /* set aside: 0.41 of the last one */
        drop(&r);
        free(d.z);
    }
}

/* ---- the dark level ---- */

enum { DIRECTIONS = 40 };

/* A grey material of the prior, read by an instrument that subtracts dark / cos theta_i too much.
 */
static gonio_readings *read_in_the_dark(const double *z, uint64_t seed, double dark)
{
    gonio_pair pair[DIRECTIONS];
    double read[DIRECTIONS][GONIO_CHANNELS];
    gonio_i_random random;
    gonio_i_random_seed(&random, seed, 1);
    for (size_t i = 0; i < DIRECTIONS; i++) {
        const double theta_i = 1.4 * gonio_i_random_uniform(&random);
        const double theta_o = 1.4 * gonio_i_random_uniform(&random);
        const double phi_o = M_PI * gonio_i_random_uniform(&random);
        pair[i] = (gonio_pair){{theta_i, 0.0}, {theta_o, phi_o}};
        const double g = truth_at(z, gonio_half_difference_from_pair(pair[i]));
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            read[i][c] = fmax(gonio_log_scale(c) * expm1(fmax(g, 0.0)) - dark / cos(theta_i), 0.0);
        }
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = DIRECTIONS,
                                          .channels = GONIO_CHANNELS,
                                          .pair = pair,
                                          .value = &read[0][0]};
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_create(context, &arrays, NULL, &readings), GONIO_OK);
    return readings;
}

/* Root mean square of g - truth over the rows, first channel. */
static double error_of_field(const gonio_reconstruction *r, const double *z)
{
    double sum = 0.0;
    for (size_t row = 0; row < gaussian->view->rows; row++) {
        int channel = 0;
        const gonio_half_difference at = gonio_i_row_coordinates(gaussian->view, row, &channel);
        const double error = fmax(r->field[row], 0.0) - fmax(truth_at(z, at), 0.0);
        sum += error * error;
    }
    return sqrt(sum / (double)gaussian->view->rows);
}

static gonio_reconstruction *reconstruct_in_the_dark(const gonio_readings *readings, bool no_checks)
{
    gonio_reconstruct_options options;
    gonio_reconstruction *r = NULL;
    gonio_reconstruct_options_default(&options);
    options.method = "posterior";
    options.no_checks = no_checks;
    assert_int_equal(gonio_reconstruct(context, small, readings, &options, &r), GONIO_OK);
    return r;
}

/* What is predicted where it was read is what was read, zeros too; root mean square, log units. */
static double error_of_predictions(const gonio_reconstruction *r, gonio_readings *readings)
{
    double read[DIRECTIONS];
    double sum = 0.0;
    for (size_t i = 0; i < DIRECTIONS; i++) {
        read[i] = gonio_log_from_brdf(gonio_readings_value(readings, i, 0), 0);
    }
    assert_int_equal(gonio_reconstruction_predict_readings(context, small, r, readings), GONIO_OK);
    for (size_t i = 0; i < DIRECTIONS; i++) {
        const double g = gonio_log_from_brdf(gonio_readings_value(readings, i, 0), 0);
        assert_true(g >= 0.0);
        sum += (g - read[i]) * (g - read[i]);
    }
    return sqrt(sum / DIRECTIONS);
}

/* Whether no more than half of the readings of the first channel are zero: of all zeros only the
 * least level can be told. */
static bool tells_its_level(const gonio_readings *readings)
{
    size_t zeros = 0;
    for (size_t i = 0; i < DIRECTIONS; i++) {
        zeros += gonio_readings_value(readings, i, 0) <= 0.0;
    }
    return 2 * zeros <= DIRECTIONS;
}

static void check_level(const gonio_reconstruction *made, const gonio_reconstruction *unchecked,
                        const double *z, double dark, gonio_readings *readings)
{
    const double before = error_of_field(unchecked, z);
    const double after = error_of_field(made, z);
    print_message("a level of %.2g is found; error %.2f, before %.2f\n", made->dark[0], after,
                  before);
    assert_true(after < before);
    if (tells_its_level(readings)) {
        assert_true(made->dark[0] > 0.6 * dark && made->dark[0] < 1.2 * dark);
        assert_true(after < 0.6 * before);
    }
    assert_true(error_of_predictions(made, readings) < 0.1);
}

/* Where some readings are zero it is found, and the material is nearer to the true one. */
static void test_the_dark_level(void **state)
{
    (void)state;
    const double dark = 0.002;
    int found_levels = 0;
    for (uint64_t seed = 60; seed < 68; seed++) {
        const drawn d = draw(seed, 0.02);
        gonio_readings *readings = read_in_the_dark(d.z, seed, dark);
        gonio_reconstruction *unchecked = reconstruct_in_the_dark(readings, true);
        gonio_reconstruction *made = reconstruct_in_the_dark(readings, false);
        assert_null(unchecked->dark);
        assert_null(made->suspicion);
        if (made->dark != NULL) {
            check_level(made, unchecked, d.z, dark, readings);
            found_levels++;
        }
        gonio_reconstruction_free(&unchecked);
        gonio_reconstruction_free(&made);
        gonio_readings_free(&readings);
        free(d.z);
    }
    assert_true(found_levels >= 6);
}

/* Readings that lack nothing are as they are, and so are some that are zero for another reason. */
static void test_no_dark_level(void **state)
{
    (void)state;
    for (uint64_t seed = 60; seed < 68; seed++) {
        const drawn d = draw(seed, 0.02);
        gonio_readings *readings = read_in_the_dark(d.z, seed, 0.0);
        for (size_t i = 0; i < DIRECTIONS; i += 10) {
            for (size_t c = 0; c < GONIO_CHANNELS; c++) {
                assert_int_equal(gonio_readings_set_value(context, readings, i, c, 0.0), GONIO_OK);
            }
        }
        gonio_reconstruction *unchecked = reconstruct_in_the_dark(readings, true);
        gonio_reconstruction *made = reconstruct_in_the_dark(readings, false);
        assert_null(made->dark);
        assert_memory_equal(made->field, unchecked->field,
                            made->columns * gaussian->view->rows * sizeof *made->field);
        gonio_reconstruction_free(&unchecked);
        gonio_reconstruction_free(&made);
        gonio_readings_free(&readings);
        free(d.z);
    }
}

/* ---- from readings to a material ---- */

/* Every valid bin has data, finite and not negative. */
static void assert_sane(const gonio_reconstruction *made)
{
    gonio_material *material = NULL;
    double *rho = malloc(GONIO_CHANNELS * GONIO_SLAB_BINS * sizeof *rho);
    assert_int_equal(gonio_reconstruction_material(context, basis, made, "made", &material),
                     GONIO_OK);
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
        assert_int_equal(gonio_material_read_slab(context, material, theta_h, rho), GONIO_OK);
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
        assert_int_equal(gonio_reconstruct(context, basis, readings, &options, &made), GONIO_OK);
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
        assert_int_equal(gonio_reconstruct(context, basis, readings, &options, &made), GONIO_OK);
        gonio_reconstruction_predict(
            basis, made,
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
        assert_int_equal(gonio_reconstruct(context, basis, readings, &options, &made),
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
        cmocka_unit_test(test_leaving_one_out),
        cmocka_unit_test(test_leaving_one_out_of_a_mixture),
        cmocka_unit_test(test_sites_are_shared),
        cmocka_unit_test(test_fits_of_shared_sites),
        cmocka_unit_test(test_columns_together),
        cmocka_unit_test(test_the_evidence),
        cmocka_unit_test(test_deviations_shrink),
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_a_reading_ten_times_too_large),
        cmocka_unit_test(test_directions_that_were_read_wrongly),
        cmocka_unit_test(test_a_wrong_direction_hardly_counts),
        cmocka_unit_test(test_the_mean_over_the_models),
        cmocka_unit_test(test_an_unusual_material),
        cmocka_unit_test(test_the_dark_level),
        cmocka_unit_test(test_no_dark_level),
        cmocka_unit_test(test_what_comes_out_is_sane),
        cmocka_unit_test(test_saturation),
        cmocka_unit_test(test_what_is_refused),
    };
    return cmocka_run_group_tests_name("posterior", tests, set_up, tear_down);
}
