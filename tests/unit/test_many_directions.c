/* Looking up directions in tens of thousands of readings: the search is bounded, and ends when the
 * user asks for it. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>

#include "made_readings.h"
#include "measurement/readings.h"

enum { MANY = 3000 };

/* Readings at the same polar angles, which a look-up compares one with another. */
static gonio_readings *at_equal_polar_angles(void)
{
    double *row = calloc((size_t)MANY * 5, sizeof *row);
    assert_non_null(row);
    for (int k = 0; k < MANY; k++) {
        double *r = row + (ptrdiff_t)k * 5;
        r[0] = r[2] = 45.0;
        r[1] = 0.05 * k;
        r[3] = 0.05 * k + 20.0 + 0.02 * k;
        r[4] = 1.0 + k;
    }
    gonio_readings *made = made_spectra(row, MANY, 1, NULL, true);
    free(row);
    return made;
}

static void test_the_search_is_bounded(void **state)
{
    (void)state;
    gonio_readings *readings = at_equal_polar_angles();
    const gonio_pair *pair = gonio_readings_describe(readings)->pair;
    size_t *found = calloc(MANY, sizeof *found);
    assert_non_null(found);
    assert_int_equal(
        gonio_i_find_readings(NULL, readings, false, pair, MANY, (size_t)10 * MANY, found),
        GONIO_OK);
    for (size_t k = 0; k < MANY; k++) {
        assert_int_equal(found[k], k < 10 ? k : MANY); /* each takes MANY comparisons */
    }
    assert_int_equal(
        gonio_i_find_readings(NULL, readings, false, pair, MANY, (size_t)MANY * MANY, found),
        GONIO_OK);
    for (size_t k = 0; k < MANY; k++) {
        assert_int_equal(found[k], k);
    }
    free(found);
    gonio_readings_free(&readings);
}

static int stop(void *user, const char *task, double fraction)
{
    (void)user;
    (void)task;
    return fraction > 0.5;
}

static void test_the_user_ends_a_search(void **state)
{
    (void)state;
    gonio_context *context = NULL;
    gonio_context_options options;
    gonio_context_options_default(&options);
    options.progress = stop;
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    gonio_readings *readings = at_equal_polar_angles();
    gonio_readings *plan = at_equal_polar_angles();
    bool *same = calloc(MANY, sizeof *same);
    assert_non_null(same);
    assert_int_equal(gonio_readings_find(context, readings, readings, same), GONIO_ERROR_CANCELLED);
    gonio_context_resume(context);
    assert_int_equal(gonio_readings_look_up(context, plan, readings), GONIO_ERROR_CANCELLED);
    free(same);
    gonio_readings_free(&plan);
    gonio_readings_free(&readings);
    gonio_context_free(&context);
}

/* Azimuths on both sides of 0 are near each other. */
static void test_azimuths_around_zero(void **state)
{
    (void)state;
    static const double row[3][5] = {
        {30, 0.002, 50, 40, 1.0}, {20, 359.998, 70, 5, 2.0}, {60, 180, 40, 359.999, 3.0}};
    static const double asked[3][4] = {{30, 359.999, 50, 40}, {20, 0, 70, 5}, {60, 180, 40, 0.001}};
    gonio_readings *known = made_spectra(row[0], 3, 1, NULL, true);
    gonio_readings *plan = made_spectra(asked[0], 3, 1, NULL, false);
    gonio_context *context = support_context();
    if (gonio_readings_look_up(context, plan, known) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    gonio_context_free(&context);
    for (size_t k = 0; k < 3; k++) {
        assert_true(gonio_readings_value(plan, k, 0) == row[k][4]);
    }
    gonio_readings_free(&plan);
    gonio_readings_free(&known);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_search_is_bounded),
        cmocka_unit_test(test_the_user_ends_a_search),
        cmocka_unit_test(test_azimuths_around_zero),
    };
    return cmocka_run_group_tests_name("many directions", tests, NULL, NULL);
}
