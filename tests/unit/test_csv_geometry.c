/* Columns of angles that are not theta and phi of both directions: phase angles, half/difference
 * angles, vectors. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <gonio/measurement.h>

static const double DEGREE = M_PI / 180.0;

typedef struct sample {
    const char *names;
    const char *cells;
    double degrees[4];
} sample;

static gonio_status read_row(const char *names, const char *cells, gonio_readings **readings)
{
    const gonio_readings_options how = {.size = sizeof how, .values_needed = true};
    char text[512];
    gonio_context *context = support_context();
    const int size = snprintf(text, sizeof text, "%s,value_per_sr\n%s,0.5\n", names, cells);
    const gonio_status status =
        gonio_readings_read_text(context, "run", text, (size_t)size, &how, readings);
    gonio_context_free(&context);
    return status;
}

static void assert_directions(const sample *s)
{
    gonio_readings *r = NULL;
    if (read_row(s->names, s->cells, &r) != GONIO_OK) {
        fail_msg("%s: %s", s->names, support_message());
    }
    const gonio_pair *pair = gonio_readings_describe(r)->pair;
    const double found[4] = {pair->incident.theta, pair->incident.phi, pair->outgoing.theta,
                             pair->outgoing.phi};
    for (int k = 0; k < 4; k++) {
        if (!(fabs(found[k] / DEGREE - s->degrees[k]) < 1e-4)) {
            fail_msg("%s: angle %d is %g, not %g", s->names, k, found[k] / DEGREE, s->degrees[k]);
        }
    }
    gonio_readings_free(&r);
}

/* At 90 degrees of azimuth between 30 and 40 degrees cos g = cos 30 cos 40. */
static void test_directions(void **state)
{
    (void)state;
    static const sample samples[] = {
        {"incidence,emission,phase", "30,40,48.4392374", {30, 0, 40, 90}},
        {"Incidence angle (deg),Emission angle (deg),Phase angle (deg)",
         "30,40,70",
         {30, 0, 40, 180}},
        {"theta_i,theta_r,phase", "30,40,10", {30, 0, 40, 0}},
        {"theta_i,theta_r,phase", "0,40,40", {0, 0, 40, 0}},
        {"theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,phase", "30,10,40,60,1", {30, 10, 40, 60}},
        {"theta_i,theta_o,dphi,phase", "30,40,60,1", {30, 0, 40, 60}},
        {"theta_h,theta_d,phi_d", "0,30,0", {30, 0, 30, 180}},
        {"thetaHalf,thetaDiff,phiDiff", "10,20,180", {10, 180, 30, 0}},
        {"theta_h,phi_h,theta_d,phi_d", "20,50,0,0", {20, 50, 20, 50}},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z", "0.5,0,0.8660254,0,2,2", {30, 0, 45, 90}},
        {"lightX,lightY,lightZ,viewX,viewY,viewZ", "0,0,1,-1,0,1", {0, 0, 45, 180}},
        {"vx,vy,vz,lx,ly,lz", "0,0,1,0,-1,1", {45, 270, 0, 0}},
        {"theta_i,phi_i,theta_o,phi_o,lx,ly,lz,vx,vy,vz", "5,6,7,8,0,0,1,0,0,1", {5, 6, 7, 8}},
    };
    for (size_t k = 0; k < sizeof samples / sizeof *samples; k++) {
        assert_directions(&samples[k]);
    }
}

/* Half/difference angles of any pair give its theta, and its difference of azimuths. */
static void test_half_difference_round_trip(void **state)
{
    (void)state;
    for (int k = 0; k < 50; k++) {
        const gonio_pair pair = {{0.03 * k, 0.0}, {1.4 - 0.025 * k, 0.12 * k}};
        const gonio_half_difference at = gonio_half_difference_from_pair(pair);
        gonio_readings *r = NULL;
        char cells[128];
        snprintf(cells, sizeof cells, "%.12g,%.12g,%.12g", at.theta_h / DEGREE, at.theta_d / DEGREE,
                 at.phi_d / DEGREE);
        assert_int_equal(read_row("theta_h,theta_d,phi_d", cells, &r), GONIO_OK);
        const gonio_half_difference back =
            gonio_half_difference_from_pair(gonio_readings_describe(r)->pair[0]);
        assert_true(fabs(back.theta_h - at.theta_h) < 1e-7);
        assert_true(fabs(back.theta_d - at.theta_d) < 1e-7);
        assert_true(fabs(remainder(back.phi_d - at.phi_d, M_PI)) < 1e-6);
        gonio_readings_free(&r);
    }
}

static void test_what_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *names, *cells, *words;
        gonio_status status;
    } bad[] = {
        {"theta_i,theta_o,phase", "30,40,80", "run:2: the phase angle is impossible",
         GONIO_ERROR_DATA},
        {"theta_i,theta_o,phase", "30,40,x", "'x' is not a finite number", GONIO_ERROR_FORMAT},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z", "0,0,0,0,0,1", "run:2: 0, 0, 0 is no direction",
         GONIO_ERROR_DATA},
        {"wi_x,wi_y,wi_z,wo_x,wo_y", "0,0,1,0,0", "no column 'theta_i_deg'", GONIO_ERROR_FORMAT},
        {"wi_x,wi_y,wi_z,wo_x,wo_y,wo_z", "0,0,-1,0,0,1", "reading above the horizon",
         GONIO_ERROR_DATA},
        {"theta_h,theta_d", "0,10", "no column 'theta_i_deg'", GONIO_ERROR_FORMAT},
        {"theta_h,theta_d,phi_d", "89,89,0", "reading above the horizon", GONIO_ERROR_DATA},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        gonio_readings *r = NULL;
        assert_int_equal(read_row(bad[k].names, bad[k].cells, &r), bad[k].status);
        if (strstr(support_message(), bad[k].words) == NULL) {
            fail_msg("%s: '%s' is not in '%s'", bad[k].names, bad[k].words, support_message());
        }
        assert_null(r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_directions),
        cmocka_unit_test(test_half_difference_round_trip),
        cmocka_unit_test(test_what_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
