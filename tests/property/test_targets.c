/* Where an error is expected: the rows that directions stand for, and what is expected there. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>

#include "posterior/targets.h"

enum { READ = 20, ASKED = 30 };

static double sum_of(const double *value, size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; k++) {
        sum += value[k];
    }
    return sum;
}

static gonio_half_difference centre_of(size_t row)
{
    int channel = 0;
    return gonio_i_row_coordinates(fixture.gaussian->view, row, &channel);
}

static void test_rows_of_directions(void **state)
{
    (void)state;
    const gonio_basis_view *view = fixture.gaussian->view;
    size_t row = view->rows / 3;
    while (!is_whole(row)) {
        row++;
    }
    gonio_half_difference at[2] = {centre_of(row), centre_of(row)};
    at[1].theta_d += 0.2 * M_PI / 180.0;
    gonio_i_targets t;
    assert_int_equal(gonio_i_targets_create(fixture.context, fixture.gaussian, at, 1, &t),
                     GONIO_OK);
    assert_int_equal(t.count, 1);
    assert_int_equal(t.row[0], row);
    assert_close(t.weight[0], 1.0, 1e-9);
    gonio_i_targets_free(&t);
    assert_int_equal(gonio_i_targets_create(fixture.context, fixture.gaussian, at, 2, &t),
                     GONIO_OK);
    assert_close(sum_of(t.weight, t.count), 2.0, 1e-9);
    assert_close(sum_of(t.all, view->rows), 2.0, 1e-9);
    gonio_i_targets_free(&t);
}

static void test_the_grid(void **state)
{
    (void)state;
    const gonio_basis_view *view = fixture.gaussian->view;
    gonio_i_targets t;
    assert_int_equal(gonio_i_targets_create(fixture.context, fixture.gaussian, NULL, 0, &t),
                     GONIO_OK);
    for (size_t row = 0; row < view->rows; row++) {
        assert_true(t.all[row] == gonio_i_row_bins(view, row));
    }
    assert_true(t.count > 0 && t.count <= view->rows);
    assert_close(sum_of(t.weight, t.count) / sum_of(t.all, view->rows), 1.0, 1e-9);
    gonio_i_targets_free(&t);
}

/* The error expected by the variance over directions, and what the stated deviations say there:
 * bands are 1.5 variances and 0.01 squared, squares 1.44 and 0.05 squared (docs/method.md). */
static void test_the_error_there(void **state)
{
    (void)state;
    const size_t rows = fixture.gaussian->view->rows;
    drawn d = draw(5, 0.01);
    gonio_half_difference at[ASKED];
    double *field = calloc(rows, sizeof *field);
    double *deviation = calloc(rows, sizeof *deviation);
    double *c = calloc(fixture.gaussian->components, sizeof *c);
    double error = 0.0;
    double square = 0.0;
    for (size_t k = 0; k < ASKED; k++) {
        at[k] = centre_of(k * rows / ASKED);
    }
    const gonio_i_column column = {READ, d.reading};
    gonio_i_posterior_options how = {
        .smoothness = ALPHA, .deviation = true, .expected_at = at, .expected_count = ASKED};
    gonio_i_posterior p = {.coefficients = c, .field = field, .deviation = deviation};
    assert_int_equal(
        gonio_i_posterior_find(fixture.context, fixture.gaussian, &column, 1, &how, &p), GONIO_OK);
    gonio_i_targets t;
    assert_int_equal(gonio_i_targets_create(fixture.context, fixture.gaussian, at, ASKED, &t),
                     GONIO_OK);
    for (size_t row = 0; row < rows; row++) {
        const double variance = (deviation[row] * deviation[row] - 1e-4) / 1.5;
        error += t.all[row] * (1.44 * variance + 0.05 * 0.05);
        square += t.all[row] * field[row] * field[row];
    }
    const double expected = 100.0 * sqrt(error / (square + error));
    assert_close(p.predicted_by_variance / expected, 1.0, 1e-3);
    /* The same without deviations, and not the same over the grid. */
    gonio_i_posterior q = {.coefficients = c, .field = field};
    how.deviation = false;
    assert_int_equal(
        gonio_i_posterior_find(fixture.context, fixture.gaussian, &column, 1, &how, &q), GONIO_OK);
    assert_close(q.predicted_by_variance / expected, 1.0, 1e-3);
    how.expected_count = 0;
    assert_int_equal(
        gonio_i_posterior_find(fixture.context, fixture.gaussian, &column, 1, &how, &q), GONIO_OK);
    assert_true(fabs(q.predicted_by_variance / expected - 1.0) > 1e-3);
    gonio_i_targets_free(&t);
    free(c);
    free(deviation);
    free(field);
    free(d.z);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_of_directions),
        cmocka_unit_test(test_the_grid),
        cmocka_unit_test(test_the_error_there),
    };
    return cmocka_run_group_tests_name("targets", tests, fixture_set_up, fixture_tear_down);
}
