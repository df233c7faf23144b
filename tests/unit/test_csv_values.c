/* Columns of values as laboratories name them: with the cosine. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_readings.h"

#define ANGLES "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg"

static gonio_readings *read_text(const char *text, bool directions_only)
{
    gonio_readings_options options;
    gonio_context *context = support_context();
    gonio_readings *readings = NULL;
    char *folder = support_folder();
    gonio_readings_options_default(&options);
    options.directions_only = directions_only;
    options.values_needed = !directions_only;
    options.average_repeats = directions_only;
    if (made_readings(context, folder, "r.csv", text, &options, &readings) != GONIO_OK) {
        fail_msg("%s\n%s", support_message(), text);
    }
    gonio_context_free(&context);
    support_remove(folder);
    return readings;
}

static void assert_note(const gonio_readings *readings, const char *part)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_true(view->notes > 0);
    if (strstr(view->note[0], part) == NULL) {
        fail_msg("'%s' is not in '%s'", part, view->note[0]);
    }
}

/* ---- the cosine ---- */

static void test_values_with_the_cosine(void **state)
{
    (void)state;
    static const char *const names[] = {
        "BRDF*cos(theta)",
        "BRDF x cos",
        "BRDF.cos(theta_r)",
        "cos-corrected BRDF",
        "BRDFcos",
        "BRDF\xc2\xb7"
        "cos\xce\xb8_r",
        "BRDF \xc3\x97 cos \xce\xb8s",
        "f_r cosTheta",
        "cos(theta_o) * brdf [1/sr]",
        "ccBSDF",
        "CC-BRDF",
        "R*cos",
    };
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char text[256];
        snprintf(text, sizeof text, ANGLES ",%s\n10,0,60,180,0.5\n", names[k]);
        print_message("%s\n", names[k]);
        gonio_readings *readings = read_text(text, false);
        assert_true(fabs(gonio_readings_value(readings, 0, 0) - 1.0) < 1e-9);
        assert_note(readings, "values with cos theta_o");
        gonio_readings_free(&readings);
    }
}

/* That of the light belongs to no BRDF: the column is named as one that is not read. */
static void test_the_cosine_of_the_light(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_text(ANGLES ",R_per_sr,BRDF*cos(theta_i)\n10,0,60,180,0.5,3\n", false);
    assert_note(readings, "not read: 'BRDF*cos(theta_i)'");
    gonio_readings_free(&readings);
}

/* ---- directions alone ---- */

/* Where only directions are wanted, what values are does not matter. */
static void test_directions_of_any_table(void **state)
{
    (void)state;
    static const char *const columns[] = {"counts,1200", "voltage,0.3",          "R_percent,x",
                                          "BRDF,-5",     "deviation,-1",         "wavelength,none",
                                          "channel,X",   "# unit: bananas\nR,1", "brdf,5e300"};
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++) {
        char text[256];
        const char *comma = strrchr(columns[k], ',');
        const char *name =
            strrchr(columns[k], '\n') != NULL ? strrchr(columns[k], '\n') + 1 : columns[k];
        snprintf(text, sizeof text, "%.*stheta_i,phi_i,theta_o,phi_o,%.*s\n10,0,60,180%s\n",
                 (int)(name - columns[k]), columns[k], (int)(comma - name), name, comma);
        print_message("%s", text);
        gonio_readings *readings = read_text(text, true);
        const gonio_readings_view *view = gonio_readings_describe(readings);
        assert_int_equal(view->count, 1);
        assert_int_equal(view->notes, 1);
        assert_string_equal(view->note[0], "taken as CSV (angles 'theta_i', 'phi_i', 'theta_o', "
                                           "'phi_o'): angles in degrees; 1 reading");
        assert_true(fabs(view->pair[0].outgoing.theta - M_PI / 3.0) < 1e-12);
        gonio_readings_free(&readings);
    }
}

static void test_directions_without_reference_lines(void **state)
{
    (void)state;
    gonio_readings *readings =
        read_text(ANGLES ",mark,counts\n0,0,45,0,reference,9\n10,0,60,180,,5\n", true);
    assert_int_equal(gonio_readings_describe(readings)->count, 1);
    assert_note(readings, "left out: 1 of the reference or the dark level");
    gonio_readings_free(&readings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values_with_the_cosine),
        cmocka_unit_test(test_the_cosine_of_the_light),
        cmocka_unit_test(test_directions_of_any_table),
        cmocka_unit_test(test_directions_without_reference_lines),
    };
    return cmocka_run_group_tests_name("csv values", tests, NULL, NULL);
}
