/* Instruments of a table of directions: rows are found as by looking at all of them. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/instrument.h>

enum { ROWS = 400, AXES = 2, NUMBERS = 4 + AXES };

static const double DEGREE = M_PI / 180.0;
static const double SAME = 1e-3;

typedef struct fixture {
    gonio_context *context;
    gonio_instrument *rig;
    double row[ROWS][NUMBERS]; /* degrees */
} fixture;

static double draw(unsigned *seed, double most)
{
    *seed = *seed * 1664525U + 1013904223U;
    return most * (double)(*seed >> 8U) / (double)(1U << 24U);
}

/* Directions on a coarse grid, so that many rows have the same angles or axes. */
static void draw_rows(fixture *f)
{
    unsigned seed = 7;
    for (size_t k = 0; k < ROWS; k++) {
        double *row = f->row[k];
        row[0] = 15.0 * floor(draw(&seed, 5.0));
        row[1] = 30.0 * floor(draw(&seed, 3.0));
        row[2] = 10.0 * floor(draw(&seed, 8.0));
        row[3] = 30.0 * floor(draw(&seed, 12.0));
        row[4] = floor(draw(&seed, 20.0));
        row[5] = floor(draw(&seed, 20.0));
    }
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    char *text = malloc((size_t)ROWS * 64 + 512);
    int used =
        sprintf(text, "{\"gonio_instrument\": 1, \"kinematics\": \"table\", \"axes\": {"
                      "\"lamp\": {\"from_deg\": -90, \"to_deg\": 90}, \"arm\": {\"from_deg\": "
                      "-90, \"to_deg\": 90}}, \"directions\": [");
    draw_rows(f);
    for (size_t k = 0; k < ROWS; k++) {
        const double *row = f->row[k];
        used += sprintf(text + used, "%s[%g, %g, %g, %g, %g, %g]", k > 0 ? ", " : "", row[0],
                        row[1], row[2], row[3], row[4], row[5]);
    }
    strcpy(text + used, "]}");
    f->context = support_context();
    if (gonio_instrument_parse(f->context, text, "table", &f->rig) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    free(text);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_instrument_free(&f->rig);
    gonio_context_free(&f->context);
    free(f);
    return 0;
}

static gonio_pair pair_of_row(const double *row)
{
    return (gonio_pair){{row[0] * DEGREE, row[1] * DEGREE}, {row[2] * DEGREE, row[3] * DEGREE}};
}

static double turn(double a, double b)
{
    return fabs(remainder(a - b, 2.0 * M_PI));
}

static bool reads(const double *row, gonio_pair pair, double same)
{
    const gonio_pair there = pair_of_row(row);
    return fabs(there.incident.theta - pair.incident.theta) < same &&
           fabs(there.outgoing.theta - pair.outgoing.theta) < same &&
           turn(there.incident.phi, pair.incident.phi) * sin(there.incident.theta) < same &&
           turn(there.outgoing.phi, pair.outgoing.phi) * sin(there.outgoing.theta) < same;
}

/* The settings of a pair are its rows, in their order. */
static void test_settings_are_rows(void **state)
{
    const fixture *f = *state;
    const gonio_freedom none = {false, false, false};
    for (size_t k = 0; k < ROWS; k++) {
        const gonio_pair pair = pair_of_row(f->row[k]);
        gonio_setting found[GONIO_MOST_SETTINGS];
        const size_t count =
            gonio_instrument_settings(f->rig, pair, none, found, GONIO_MOST_SETTINGS);
        size_t next = 0;
        for (size_t row = 0; row < ROWS && next < count; row++) {
            const bool is_next = reads(f->row[row], pair, SAME) &&
                                 fabs(found[next].axis[0] / DEGREE - f->row[row][4]) < 1e-9 &&
                                 fabs(found[next].axis[1] / DEGREE - f->row[row][5]) < 1e-9;
            next += is_next;
        }
        assert_true(count > 0);
        assert_int_equal(next, count);
    }
}

/* Axes read a row that is nearest to them. */
static void test_the_nearest_row(void **state)
{
    const fixture *f = *state;
    unsigned seed = 11;
    for (int k = 0; k < 300; k++) {
        double axis[GONIO_MOST_AXES] = {0.0};
        for (int a = 0; a < AXES; a++) {
            axis[a] = (k % 2 == 0 ? floor(draw(&seed, 20.0)) : draw(&seed, 24.0)) * DEGREE;
        }
        const gonio_pair pair = gonio_instrument_pair(f->rig, axis);
        double least = INFINITY;
        double reached = INFINITY;
        for (size_t row = 0; row < ROWS; row++) {
            const double away =
                fabs(f->row[row][4] * DEGREE - axis[0]) + fabs(f->row[row][5] * DEGREE - axis[1]);
            least = fmin(least, away);
            reached = reads(f->row[row], pair, 1e-9) ? fmin(reached, away) : reached;
        }
        assert_true(reached <= least + 1e-12);
    }
}

/* What is near a row counts as a reached region, but is not read. */
static void test_regions(void **state)
{
    const fixture *f = *state;
    const gonio_freedom none = {false, false, false};
    gonio_pair near = pair_of_row(f->row[0]);
    near.incident.theta += 6.0 * DEGREE;
    near.outgoing.theta += 4.0 * DEGREE;
    assert_non_null(gonio_instrument_pair_obstacle(f->rig, near, none));
    assert_null(gonio_instrument_region_obstacle(f->rig, near, none));
    near.incident.theta = 85.0 * DEGREE;
    assert_non_null(gonio_instrument_region_obstacle(f->rig, near, none));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_settings_are_rows),
        cmocka_unit_test(test_the_nearest_row),
        cmocka_unit_test(test_regions),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
