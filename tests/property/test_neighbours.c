/* Columns of a spectrum that are found with the fits of their neighbours. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>

#include "posterior/neighbours.h"

enum { SITES = 9, COLUMNS = 40, ODD = 13 };

/* A spectrum whose logarithm changes evenly from one wavelength to the next. */
typedef struct spectrum {
    gonio_i_observation reading[COLUMNS][SITES];
    gonio_i_column column[COLUMNS];
    double wavelength[COLUMNS];
    size_t member[COLUMNS];
} spectrum;

static void make_spectrum(spectrum *s)
{
    drawn a = draw(7, 0.1);
    drawn b = draw(8, 0.1);
    for (size_t c = 0; c < COLUMNS; c++) {
        s->column[c] = (gonio_i_column){SITES, s->reading[c]};
        s->wavelength[c] = 400.0 + 5.0 * (double)c;
        s->member[c] = c;
        for (size_t i = 0; i < SITES; i++) {
            const double at = (double)c / (COLUMNS - 1);
            s->reading[c][i] = a.reading[i];
            s->reading[c][i].g = a.reading[i].g + at * 0.3 * (b.reading[i].g - a.reading[i].g);
        }
    }
    free(a.z);
    free(b.z);
}

static size_t choose(const spectrum *s, gonio_i_neighbours *neighbours)
{
    size_t fitted = 0;
    gonio_i_neighbours_none(neighbours, COLUMNS);
    assert_int_equal(gonio_i_neighbours_choose(fixture.context, s->column, s->wavelength, s->member,
                                               COLUMNS, neighbours),
                     GONIO_OK);
    for (size_t c = 0; c < COLUMNS; c++) {
        fitted += gonio_i_is_fitted(neighbours, c);
        assert_close(neighbours[c].weight[0] + neighbours[c].weight[1], 1.0, 1e-12);
        assert_true(gonio_i_is_fitted(neighbours, neighbours[c].fit[0]));
        assert_true(gonio_i_is_fitted(neighbours, neighbours[c].fit[1]));
    }
    return fitted;
}

/* The first and the last column are enough for an even spectrum; what stands out has its own fit.
 */
static void test_choice(void **state)
{
    (void)state;
    spectrum s;
    gonio_i_neighbours neighbours[COLUMNS];
    make_spectrum(&s);
    assert_int_equal(choose(&s, neighbours), 2);
    assert_close(gonio_i_neighbour_weight(neighbours, 0, ODD), 1.0 - ODD / 39.0, 1e-12);
    assert_close(gonio_i_neighbour_weight(neighbours, COLUMNS - 1, ODD), ODD / 39.0, 1e-12);
    s.reading[ODD][4].g += 0.04; /* less than noise */
    assert_int_equal(choose(&s, neighbours), 2);
    s.reading[ODD][4].g += 0.3;
    assert_true(choose(&s, neighbours) > 2);
    assert_true(gonio_i_is_fitted(neighbours, ODD));
    s.reading[ODD][4].g -= 0.34;
    s.reading[ODD][2].bound = 1;
    assert_true(choose(&s, neighbours) > 2);
    assert_true(gonio_i_is_fitted(neighbours, ODD));
}

/* Few columns are all fitted. */
static void test_few_columns(void **state)
{
    (void)state;
    spectrum s;
    gonio_i_neighbours neighbours[COLUMNS];
    make_spectrum(&s);
    gonio_i_neighbours_none(neighbours, COLUMNS);
    assert_int_equal(gonio_i_neighbours_choose(fixture.context, s.column, s.wavelength, s.member,
                                               16, neighbours),
                     GONIO_OK);
    for (size_t c = 0; c < 16; c++) {
        assert_true(gonio_i_is_fitted(neighbours, c));
    }
}

static gonio_i_posterior find_spectrum(const gonio_i_prior *prior, const spectrum *s,
                                       const double *wavelength)
{
    const gonio_i_posterior_options options = {
        .smoothness = ALPHA, .deviation = true, .wavelength = wavelength};
    const size_t rows = COLUMNS * prior->view->rows;
    gonio_i_posterior p = {.coefficients = calloc(COLUMNS * prior->components, sizeof(double)),
                           .field = calloc(rows, sizeof(double)),
                           .deviation = calloc(rows, sizeof(double))};
    assert_int_equal(
        gonio_i_posterior_find(fixture.context, prior, s->column, COLUMNS, &options, &p), GONIO_OK);
    return p;
}

static void free_posterior(gonio_i_posterior *p)
{
    free(p->coefficients);
    free(p->field);
    free(p->deviation);
}

/* The largest difference of two fields, in deviations of the second. */
static double farthest(const gonio_i_prior *prior, const gonio_i_posterior *a,
                       const gonio_i_posterior *b)
{
    double most = 0.0;
    for (size_t k = 0; k < COLUMNS * prior->view->rows; k++) {
        most = fmax(most, fabs(a->field[k] - b->field[k]) / b->deviation[k]);
    }
    return most;
}

/* Of a Gaussian a column is found with its neighbours as it is by itself, noise included; of a
 * mixture nearly so. */
static void test_fields(void **state)
{
    (void)state;
    const gonio_i_prior *priors[] = {fixture.gaussian, fixture.mixture};
    const double tolerance[] = {1e-9, 0.1};
    spectrum s;
    make_spectrum(&s);
    s.reading[ODD][4].g += 0.04;
    for (int k = 0; k < 2; k++) {
        gonio_i_posterior each = find_spectrum(priors[k], &s, NULL);
        gonio_i_posterior some = find_spectrum(priors[k], &s, s.wavelength);
        assert_true(farthest(priors[k], &some, &each) <= tolerance[k]);
        assert_close(some.predicted, each.predicted, 0.05 * each.predicted);
        assert_close(some.residual, each.residual, 0.1 * each.residual);
        assert_int_equal(some.outlying, each.outlying);
        free_posterior(&each);
        free_posterior(&some);
    }
}

/* The order of the columns has no effect. */
static void test_order(void **state)
{
    (void)state;
    const size_t rows = fixture.mixture->view->rows;
    spectrum s;
    spectrum reversed;
    make_spectrum(&s);
    make_spectrum(&reversed);
    for (size_t c = 0; c < COLUMNS; c++) {
        reversed.column[c] = (gonio_i_column){SITES, reversed.reading[COLUMNS - 1 - c]};
        reversed.wavelength[c] = s.wavelength[COLUMNS - 1 - c];
    }
    gonio_i_posterior a = find_spectrum(fixture.mixture, &s, s.wavelength);
    gonio_i_posterior b = find_spectrum(fixture.mixture, &reversed, reversed.wavelength);
    for (size_t c = 0; c < COLUMNS; c++) {
        assert_memory_equal(a.field + c * rows, b.field + (COLUMNS - 1 - c) * rows,
                            rows * sizeof(double));
    }
    free_posterior(&a);
    free_posterior(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_choice),
        cmocka_unit_test(test_few_columns),
        cmocka_unit_test(test_fields),
        cmocka_unit_test(test_order),
    };
    return cmocka_run_group_tests_name("neighbours", tests, fixture_set_up, fixture_tear_down);
}
