/* What a survey says of readings that are known in closed form. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "made_readings.h"

enum { RINGS = 17, AROUND = 24, READINGS = RINGS * AROUND + 1 };

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

/* A scan of the hemisphere at 30 degrees: the normal, and every 5 and 15 degrees. row[READINGS][7],
 * white of rho = 0.8 in R and half of it in G, B was not read. */
static double (*made_scan(void))[7]
{
    double(*row)[7] = calloc(READINGS, sizeof *row);
    assert_non_null(row);
    for (int k = 0; k < READINGS; k++) {
        const int ring = k == 0 ? 0 : 1 + (k - 1) / AROUND;
        const double made[7] = {
            30.0,       0.0,        5.0 * ring, k == 0 ? 0.0 : 15.0 * (k - 1 - (ring - 1) * AROUND),
            0.8 / M_PI, 0.4 / M_PI, NAN};
        memcpy(row[k], made, sizeof made);
    }
    return row;
}

static gonio_survey *survey_of(const gonio_readings *readings)
{
    gonio_survey *survey = NULL;
    assert_int_equal(gonio_readings_survey(NULL, readings, &survey), GONIO_OK);
    return survey;
}

static void test_a_white_hemisphere(void **state)
{
    (void)state;
    double(*row)[7] = made_scan();
    gonio_readings *readings = made_colours((const double(*)[7])row, READINGS);
    gonio_survey *s = survey_of(readings);
    assert_int_equal(s->measured, READINGS);
    assert_int_equal(s->empty, READINGS);
    assert_int_equal(s->incidences, 1);
    assert_int_equal(s->incidence[0].count, READINGS);
    assert_close(s->incidence[0].theta_i, M_PI / 6.0, 1e-12);
    assert_true(s->incidence[0].covered > 0.99);
    assert_close(s->incidence[0].albedo[0], 0.8 * s->incidence[0].covered, 1e-9);
    assert_close(s->incidence[0].albedo[1], 0.4 * s->incidence[0].covered, 1e-9);
    assert_true(isnan(s->incidence[0].albedo[2]));
    assert_true(s->incidence[0].peak < 0.05);
    assert_int_equal(s->in_plane, 2 * RINGS + 1);
    assert_close(s->theta_o[1], 85.0 * M_PI / 180.0, 1e-12);
    assert_close(s->theta_h[0], 0.0, 1e-9);
    assert_int_equal(s->channel[0].read, READINGS);
    assert_int_equal(s->channel[2].read, 0);
    assert_close(s->channel[1].median, 0.4 / M_PI, 0.0);
    assert_true(isnan(s->channel[2].most));
    assert_int_equal(s->outliers, 0);
    gonio_survey_free(&s);
    gonio_readings_free(&readings);
    free(row);
}

/* One value ten times too high, one too low; a zero. */
static void test_values_that_are_far_off(void **state)
{
    (void)state;
    double(*row)[7] = made_scan();
    row[100][4] *= 10.0;
    row[200][5] /= 10.0;
    row[300][4] = 0.0;
    gonio_readings *readings = made_colours((const double(*)[7])row, READINGS);
    gonio_survey *s = survey_of(readings);
    assert_int_equal(s->outliers, 3);
    assert_int_equal(s->outlier[0], 100);
    assert_int_equal(s->outlier[1], 200);
    assert_int_equal(s->outlier[2], 300);
    assert_int_equal(s->channel[0].zero, 1);
    assert_close(s->channel[0].least, 0.8 / M_PI, 0.0);
    gonio_survey_free(&s);
    gonio_readings_free(&readings);
    free(row);
}

static void test_half_a_plane_is_not_covered(void **state)
{
    (void)state;
    double(*row)[7] = made_scan();
    size_t count = 0;
    for (int k = 0; k < READINGS; k++) {
        if (row[k][3] == 0.0) {
            memcpy(row[count++], row[k], sizeof row[k]);
        }
    }
    row[1][4] = 100.0; /* a peak in one reading */
    gonio_readings *readings = made_colours((const double(*)[7])row, count);
    gonio_survey *s = survey_of(readings);
    assert_int_equal(count, RINGS + 1);
    assert_null(s->incidence[0].albedo); /* too few */
    gonio_survey_free(&s);
    gonio_readings_free(&readings);
    free(row);
}

static void test_readings_against_each_other(void **state)
{
    (void)state;
    static const double rows[][7] = {{30, 0, 50, 40, 1.0, NAN, 0}, {50, 10, 30, 330, 1.1, NAN, 0},
                                     {30, 0, 50, 40, 1.2, NAN, 0}, {20, 0, 20, 180, 5, NAN, 0},
                                     {0, 0, 30, 0, 2, NAN, 0},     {30, 0, 0, 0, 2, NAN, 0}};
    gonio_readings *readings = made_colours(rows, 6);
    gonio_survey *s = survey_of(readings);
    assert_int_equal(s->repeats, 1);
    assert_close(s->repeats_percent, 100.0 * 0.2 / 1.1, 1e-9);
    /* {50, 10, 30, 330} is 40 degrees apart the other way round: the reciprocal one, turned. */
    assert_int_equal(s->reciprocal_pairs, 2);
    assert_close(s->reciprocity_percent, 100.0 * 0.1 / 1.05 / sqrt(2.0), 1e-9);
    assert_int_equal(s->incidences, 4);
    gonio_survey_free(&s);
    gonio_readings_free(&readings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_white_hemisphere),
        cmocka_unit_test(test_values_that_are_far_off),
        cmocka_unit_test(test_half_a_plane_is_not_covered),
        cmocka_unit_test(test_readings_against_each_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
