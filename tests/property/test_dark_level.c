/* Dark levels that the instrument subtracts too much. */
#include "posterior_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../unit/made_readings.h"
#include "core/random.h"

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
    assert_int_equal(gonio_readings_create(fixture.context, &arrays, NULL, &readings), GONIO_OK);
    return readings;
}

/* Root mean square of g - truth over the rows, first channel. */
static double error_of_field(const gonio_reconstruction *r, const double *z)
{
    double sum = 0.0;
    for (size_t row = 0; row < fixture.gaussian->view->rows; row++) {
        int channel = 0;
        const gonio_half_difference at =
            gonio_i_row_coordinates(fixture.gaussian->view, row, &channel);
        const double error = fmax(r->field[row], 0.0) - fmax(truth_at(z, at), 0.0);
        sum += error * error;
    }
    return sqrt(sum / (double)fixture.gaussian->view->rows);
}

static gonio_reconstruction *reconstruct_in_the_dark(const gonio_readings *readings, bool no_checks)
{
    gonio_reconstruct_options options;
    gonio_reconstruction *r = NULL;
    gonio_reconstruct_options_default(&options);
    options.method = "posterior";
    options.no_checks = no_checks;
    assert_int_equal(gonio_reconstruct(fixture.context, fixture.small, readings, &options, &r),
                     GONIO_OK);
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
    assert_int_equal(
        gonio_reconstruction_predict_readings(fixture.context, fixture.small, r, readings),
        GONIO_OK);
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
        assert_int_equal(made->interpretation.alternatives, 0);
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

static void set_all_channels(gonio_readings *readings, size_t reading, double value)
{
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        assert_int_equal(gonio_readings_set_value(fixture.context, readings, reading, c, value),
                         GONIO_OK);
    }
}

/* The readings that were taken for unmeasured are not read any more. */
static void take_out(const gonio_interpretation *by, gonio_readings *readings)
{
    assert_true(by->unmeasured <= GONIO_MOST_UNMEASURED_LINES);
    for (size_t k = 0; k < by->unmeasured; k++) {
        assert_int_equal((by->unmeasured_line[k] - 1) % 10, 0); /* line 1 is reading 0 */
        set_all_channels(readings, by->unmeasured_line[k] - 1, NAN);
    }
}

static void assert_same_field(const gonio_reconstruction *a, const gonio_reconstruction *b)
{
    assert_memory_equal(a->field, b->field,
                        a->columns * fixture.gaussian->view->rows * sizeof *a->field);
}

/* Readings that lack nothing are as they are. Of some that are zero for another reason no level is
 * found: most are left out, and the result is that of the other readings. */
static void test_no_dark_level(void **state)
{
    (void)state;
    size_t unmeasured = 0;
    for (uint64_t seed = 60; seed < 68; seed++) {
        const drawn d = draw(seed, 0.02);
        gonio_readings *readings = read_in_the_dark(d.z, seed, 0.0);
        gonio_reconstruction *all = reconstruct_in_the_dark(readings, true);
        gonio_reconstruction *lacking = reconstruct_in_the_dark(readings, false);
        for (size_t i = 0; i < DIRECTIONS; i += 10) {
            set_all_channels(readings, i, 0.0);
        }
        gonio_reconstruction *made = reconstruct_in_the_dark(readings, false);
        take_out(&made->interpretation, readings);
        gonio_reconstruction *without = reconstruct_in_the_dark(readings, true);
        assert_null(lacking->dark);
        assert_int_equal(lacking->interpretation.unmeasured, 0);
        assert_same_field(lacking, all);
        assert_null(made->dark);
        assert_same_field(made, without);
        unmeasured += made->interpretation.unmeasured;
        gonio_reconstruction_free(&all);
        gonio_reconstruction_free(&lacking);
        gonio_reconstruction_free(&made);
        gonio_reconstruction_free(&without);
        gonio_readings_free(&readings);
        free(d.z);
    }
    print_message("%zu of %d zeros are left out\n", unmeasured, 8 * ((DIRECTIONS + 9) / 10));
    assert_true(2 * unmeasured >= 8 * ((DIRECTIONS + 9) / 10));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_dark_level),
        cmocka_unit_test(test_no_dark_level),
    };
    return cmocka_run_group_tests_name("dark_level", tests, fixture_set_up, fixture_tear_down);
}
