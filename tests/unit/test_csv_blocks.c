/* Scans in blocks: a line that names the angle of incidence, then rows of the detector. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include <gonio/measurement.h>

static const double DEGREE = M_PI / 180.0;

static gonio_status read(const char *text, gonio_readings **readings)
{
    const gonio_readings_options how = {.size = sizeof how, .values_needed = true};
    gonio_context *context = support_context();
    const gonio_status status =
        gonio_readings_read_text(context, "scan", text, strlen(text), &how, readings);
    gonio_context_free(&context);
    return status;
}

typedef struct expected {
    size_t line;
    double theta_i, theta_o, difference; /* degrees */
    double value;
} expected;

static void assert_readings(const char *text, const expected *e, size_t count)
{
    gonio_readings *r = NULL;
    if (read(text, &r) != GONIO_OK) {
        fail_msg("%s: %s", text, support_message());
    }
    const gonio_readings_view *view = gonio_readings_describe(r);
    assert_int_equal(view->count, count);
    for (size_t k = 0; k < count; k++) {
        const gonio_pair *p = &view->pair[k];
        const double turned = remainder(p->outgoing.phi - p->incident.phi, 2.0 * M_PI) / DEGREE;
        assert_int_equal(view->line[k], e[k].line);
        assert_true(fabs(p->incident.theta / DEGREE - e[k].theta_i) < 1e-9);
        assert_true(fabs(p->outgoing.theta / DEGREE - e[k].theta_o) < 1e-9);
        assert_true(fabs(fabs(turned) - e[k].difference) < 1e-9);
        assert_true(view->value[k] == e[k].value);
    }
    gonio_readings_free(&r);
}

static void test_angles_alone(void **state)
{
    (void)state;
    static const expected e[] = {{2, 20, 10, 0, 0.5}, {3, 20, 30, 180, 0.75}, {5, 40, 40, 180, 2}};
    assert_readings("AOI 20\n-10 0.5\n30 0.75\nAOI 40\n40 2\n", e, 3);
    assert_readings("# AOI: 20 deg\n-10,0.5\n30,0.75\n# AOI: 40 deg\n40,2\n", e, 3);
    assert_readings("theta_i=20\n-10\t0.5\n30\t0.75\ntheta_i=40\n40\t2\n", e, 3);
}

static void test_names_and_other_lines(void **state)
{
    (void)state;
    static const expected e[] = {{4, 20, 10, 0, 0.5}, {5, 20, 30, 180, 0.75}, {9, 40, 40, 180, 2}};
    assert_readings("Sample: black\nIncidence angle: 20 deg\nangle,BRDF\n-10,0.5\n30,0.75\n\n"
                    "Incidence angle: 40 deg\nangle,BRDF\n40,2\n",
                    e, 3);
    static const expected around[] = {{3, 20, 10, 60, 0.5}, {6, 40, 40, 180, 2}};
    assert_readings("theta_i = 20\ntheta_s phi_s BRDF\n10 60 0.5\ntheta_i = 40\ntheta_s phi_s "
                    "BRDF\n40 180 2\n",
                    around, 2);
}

static void test_what_is_refused(void **state)
{
    (void)state;
    gonio_readings *r = NULL;
    assert_int_equal(read("AOI 20\n-10 0.5\n30 x\n", &r), GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "scan:3: value 'x' is not a finite number"));
    assert_int_equal(read("AOI 20\n-10 0.5 0.7\n", &r), GONIO_ERROR_FORMAT);
    assert_int_equal(read("AOI -20\n10 0.5\n", &r), GONIO_ERROR_DATA);
    assert_non_null(strstr(support_message(), "scan:2: theta_i below zero without azimuths"));
    assert_null(r);
}

/* A table of its own below such a comment stays one. */
static void test_tables_are_no_blocks(void **state)
{
    (void)state;
    static const expected e[] = {{3, 30, 10, 50, 0.5}};
    assert_readings("# AOI: 20\ntheta_i,phi_i,theta_o,phi_o,brdf\n30,0,10,50,0.5\n", e, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_angles_alone),
        cmocka_unit_test(test_names_and_other_lines),
        cmocka_unit_test(test_what_is_refused),
        cmocka_unit_test(test_tables_are_no_blocks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
