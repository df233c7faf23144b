/* Columns of values as laboratories name them: with the cosine, as logarithms. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "made_readings.h"
#include "measurement/formats/csv_keys.h"

#define ANGLES "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg"

static gonio_readings *read_as(const char *text, const char *as, bool directions_only)
{
    gonio_readings_options options;
    gonio_context *context = support_context();
    gonio_readings *readings = NULL;
    char *folder = support_folder();
    gonio_readings_options_default(&options);
    options.directions_only = directions_only;
    options.values_needed = !directions_only;
    options.average_repeats = directions_only;
    assert_int_equal(gonio_convention_parse(NULL, as, &options.as), GONIO_OK);
    if (made_readings(context, folder, "r.csv", text, &options, &readings) != GONIO_OK) {
        fail_msg("%s\n%s", support_message(), text);
    }
    gonio_context_free(&context);
    support_remove(folder);
    return readings;
}

static gonio_readings *read_text(const char *text, bool directions_only)
{
    return read_as(text, "", directions_only);
}

static void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fmax(1e-3, fabs(expected)))) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
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
        "BRDF\xc2\xb7 cos\xce\xb8_r",
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

/* Of columns for the same thing the plain one is read. */
static void test_the_plain_values_come_first(void **state)
{
    (void)state;
    static const char *const columns[] = {"log10(BRDF),BRDF,-1,0.5", "BRDF*cos,BRDF,0.25,0.5",
                                          "BRDF,BRDF [dB],0.5,-3"};
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++) {
        char text[256];
        const char *row = strchr(strchr(columns[k], ',') + 1, ',');
        snprintf(text, sizeof text, ANGLES ",%.*s\n10,0,60,180%s\n", (int)(row - columns[k]),
                 columns[k], row);
        print_message("%s\n", columns[k]);
        gonio_readings *readings = read_text(text, false);
        assert_near(gonio_readings_value(readings, 0, 0), 0.5);
        assert_note(readings, "columns of numbers that are not read");
        gonio_readings_free(&readings);
    }
}

/* ---- logarithms ---- */

static void test_logarithms(void **state)
{
    (void)state;
    static const struct {
        const char *before; /* comment lines */
        const char *columns;
        const char *row;
        const char *as;
        double value;
        double deviation; /* 0: none */
        const char *note;
    } cases[] = {
        {"", "log10(BRDF)", "-1", "", 0.1, 0, "values in 1/sr, as logarithms (base 10)"},
        {"", "log BRDF", "1", "", 10.0, 0, "base 10"},
        {"", "logBRDF (1/sr)", "0", "", 1.0, 0, "base 10"},
        {"", "LOG10BRDF", "-inf", "", 0.0, 0, "base 10"},
        {"", "ln(BRDF)", "-1", "", 1.0 / M_E, 0, "as natural logarithms"},
        {"", "BRDF [dB]", "-10", "", 0.1, 0, "in decibels (10 log10)"},
        {"", "10*log10(BRDF)", "-20", "", 0.01, 0, "in decibels"},
        {"", "log10 BRF", "0", "", 1.0 / M_PI, 0, "reflectance factors (divided by pi), as log"},
        {"", "log10(BRDF*cos theta_s)", "-1", "", 0.2, 0, "cos theta_o (divided by it), as log"},
        {"", "log10(BRDF) 550nm", "-1", "", 0.1, 0, "'log10(BRDF) 550nm'"},
        {"", "log10_550nm", "-1", "", 0.1, 0, "'log10_550nm'"},
        {"", "brdf", "-1", "scale=log10", 0.1, 0, "base 10"},
        {"", "log10(BRDF)", "0.5", "scale=linear", 0.5, 0, "values in 1/sr; 1 reading"},
        {"", "log10(BRDF)", "-1", "scale=ln", 1.0 / M_E, 0, "natural"},
        {"# values: log10 BRDF\n", "R", "-1", "", 0.1, 0, "base 10"},
        {"# unit: dB\n", "550nm", "-10", "", 0.1, 0, "in decibels"},
        {"# values: see log file\n", "R", "0.5", "", 0.5, 0, "not understood"},
        {"", "log10(BRDF),sd", "-1,0.02", "", 0.1, 0.1 * 0.02 * M_LN10, "deviations 'sd'"},
        {"", "ln(BRDF),u(ln(BRDF))", "-1,0.02", "", 1.0 / M_E, 1.0 / M_E * 0.02, "'u(ln(BRDF))'"},
        {"", "log10(BRDF),u(BRDF)", "-1,0.02", "", 0.1, 0.02, "'u(BRDF)'"},
        {"", "BRDF [dB],u (%)", "-10,2", "", 0.1, 0.002, "'u (%)'"},
        {"", "log10 BRF,u", "0,0.1", "", 1.0 / M_PI, 0.1 * M_LN10 / M_PI, "'u'"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[256];
        snprintf(text, sizeof text, "%s" ANGLES ",%s\n10,0,60,180,%s\n", cases[k].before,
                 cases[k].columns, cases[k].row);
        print_message("%s %s\n", text, cases[k].as);
        gonio_readings *readings = read_as(text, cases[k].as, false);
        const gonio_readings_view *view = gonio_readings_describe(readings);
        assert_near(gonio_readings_value(readings, 0, 0), cases[k].value);
        assert_true((view->deviation != NULL) == (cases[k].deviation > 0.0));
        if (view->deviation != NULL) {
            assert_near(view->deviation[0], cases[k].deviation);
        }
        bool noted = false;
        for (size_t n = 0; n < view->notes; n++) {
            noted = noted || strstr(view->note[n], cases[k].note) != NULL;
        }
        assert_true(noted);
        gonio_readings_free(&readings);
    }
}

/* Rows of a wavelength each, and those of the reference, are logarithms too. */
static void test_logarithms_in_other_rows(void **state)
{
    (void)state;
    gonio_readings *readings = read_text(ANGLES ",wavelength,log10(BRDF)\n10,0,60,180,550,-1\n"
                                                "10,0,60,180,450,-2\n",
                                         false);
    assert_near(gonio_readings_value(readings, 0, 0), 0.01);
    assert_near(gonio_readings_value(readings, 0, 1), 0.1);
    gonio_readings_free(&readings);

    readings = read_text(ANGLES ",time_s,mark,log10(BRDF)\n0,0,45,0,0,reference,0\n"
                                "10,0,60,180,50,,-1\n0,0,45,0,100,reference,0.04139268516\n",
                         false);
    assert_near(gonio_readings_describe(readings)->value[0], 0.1 / 1.05);
    gonio_readings_free(&readings);
}

/* What is written again is the BRDF, and is read as that. */
static void test_logarithms_are_written_as_values(void **state)
{
    (void)state;
    char path[256];
    char *folder = support_folder();
    gonio_context *context = support_context();
    const gonio_readings_options how = {.size = sizeof how, .values_needed = true};
    gonio_readings *again = NULL;
    gonio_readings *readings =
        read_text("# values: log10\n" ANGLES ",R,sd\n10,0,60,180,-1,0.01\n", false);
    snprintf(path, sizeof path, "%s/again.csv", folder);
    assert_int_equal(gonio_readings_write(context, readings, NULL, path), GONIO_OK);
    assert_int_equal(gonio_readings_read(context, path, &how, &again), GONIO_OK);
    assert_near(gonio_readings_value(again, 0, 0), 0.1);
    assert_near(gonio_readings_describe(again)->deviation[0],
                gonio_readings_describe(readings)->deviation[0]);
    gonio_readings_free(&again);
    gonio_readings_free(&readings);
    gonio_context_free(&context);
    support_remove(folder);
}

static void refuse(const char *text, const char *message)
{
    gonio_context *context = support_context();
    gonio_readings *readings = NULL;
    gonio_readings_options options;
    char *folder = support_folder();
    gonio_readings_options_default(&options);
    assert_true(made_readings(context, folder, "r.csv", text, &options, &readings) != GONIO_OK);
    if (strstr(support_message(), message) == NULL) {
        fail_msg("'%s' is not in '%s'", message, support_message());
    }
    assert_null(readings);
    support_remove(folder);
    gonio_context_free(&context);
}

static void test_logarithms_that_are_refused(void **state)
{
    (void)state;
    refuse(ANGLES ",log2(BRDF)\n10,0,60,180,-1\n", "'log2(BRDF)' is not understood");
    refuse(ANGLES ",log10\n10,0,60,180,-1\n", "'log10' is not understood");
    refuse(ANGLES ",log time\n10,0,60,180,1\n", "'log time' is not understood");
    refuse(ANGLES ",log10(BRDF)\n10,0,60,180,400\n", "log10(BRDF) '400' is not a finite number");
    refuse(ANGLES ",log10(BRDF)\n10,0,60,180,x\n", "log10(BRDF) 'x' is not a finite number");
}

/* ---- polarised light ---- */

static void test_polarised_light(void **state)
{
    (void)state;
    static const char averaged[] = "the values of s and of p polarisation are averaged";
    static const char one[] = "the values are of one polarisation only";
    static const struct {
        const char *columns;
        const char *row;
        size_t channels;
        double value; /* NaN: none */
        const char *note;
    } cases[] = {
        {"BRDF_s,BRDF_p", "0.3,0.2", 1, 0.25, averaged},
        {"BRDF (p-pol),BRDF (s-pol)", "0.3,0.2", 1, 0.25, averaged},
        {"BRDF TE,BRDF TM", "0.3,", 1, NAN, averaged},
        {"BRDF TE,BRDF TM", ",0.3", 1, NAN, averaged},
        {"550nm s,600nm s,550nm p,600nm p", "0.3,9,0.2,9", 2, 0.25, averaged},
        {"550nm s,600nm s,550nm p", "0.3,9,0.2", 2, 0.25, "averaged, where there are both"},
        {"R_s,R_p,G_s,G_p", "0.3,0.2,1,1", 3, 0.25, averaged},
        {"BRDF*cos s,BRDF*cos p", "0.3,0.2", 1, 0.5, averaged},
        {"log10 BRDF (s),log10 BRDF (p)", "-1,0", 1, 0.55, averaged},
        {"BRDF perpendicular", "0.3", 1, 0.3, one},
        {"BRDF_s,BRDF_p,BRDF", "0.3,0.2,0.4", 1, 0.4, "not read: 'BRDF_s', 'BRDF_p'"},
        {"unpolarised BRDF", "0.3", 1, 0.3, "values in 1/sr"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[256];
        snprintf(text, sizeof text, ANGLES ",%s\n10,0,60,180,%s\n", cases[k].columns, cases[k].row);
        print_message("%s", text);
        gonio_readings *readings = read_text(text, false);
        const double value = gonio_readings_value(readings, 0, 0);
        assert_int_equal(gonio_readings_describe(readings)->channels, cases[k].channels);
        assert_true(isnan(value) == isnan(cases[k].value));
        if (!isnan(value)) {
            assert_near(value, cases[k].value);
        }
        assert_note(readings, cases[k].note);
        gonio_readings_free(&readings);
    }
    refuse(ANGLES ",BRDF_s,BRDF_p,BRDF p-pol\n10,0,60,180,1,1,1\n", "two columns of values");
    refuse(ANGLES ",BRDF_s,BRDF s-pol\n10,0,60,180,1,1\n", "two columns of values");
    refuse(ANGLES ",counts/s\n10,0,60,180,1\n", "'counts/s' is not understood");
    refuse(ANGLES ",BRDF_s,BRDF_p\n10,0,60,180,1,-1\n", "BRDF_p '-1' is negative");
}

static bool is_any(const gonio_i_csv_finder *f, size_t column)
{
    return column < f->r->columns;
}

/* Columns of s polarised light of very many wavelengths, then of p polarised light. Comparing each
 * with all others would take minutes. */
static void test_polarised_light_of_many_wavelengths(void **state)
{
    (void)state;
    enum { WAVELENGTHS = 150000, COLUMNS = 2 * WAVELENGTHS };
    const gonio_i_csv_reader reader = {.columns = COLUMNS};
    gonio_i_column_name *name = calloc(COLUMNS, sizeof *name);
    size_t *other = calloc(COLUMNS, sizeof *other);
    const gonio_i_csv_finder f = {.r = &reader, .name = name};
    gonio_i_csv_keys keys;
    assert_true(name != NULL && other != NULL);
    for (int k = 0; k < COLUMNS; k++) {
        name[k] = (gonio_i_column_name){.family = GONIO_I_WAVELENGTH,
                                        .wavelength = 400.0 + k % WAVELENGTHS,
                                        .polarisation = 1 + k / WAVELENGTHS};
    }
    const clock_t begin = clock();
    assert_int_equal(gonio_i_csv_list_keys(&f, is_any, &keys), GONIO_OK);
    gonio_i_csv_find_partners(&f, &keys, other);
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < 5.0);
    for (size_t k = 0; k < COLUMNS; k++) {
        assert_int_equal(other[k], k < WAVELENGTHS ? COLUMNS : k - WAVELENGTHS);
    }
    free(keys.item);
    free(other);
    free(name);
}

/* ---- angles in gon ---- */

static void test_angles_in_gon(void **state)
{
    (void)state;
    static const char *const names[] = {"theta_i [gon],phi_i [gon],theta_o [gon],phi_o [gon]",
                                        "theta_i gradians,phi_i,theta_o,phi_o",
                                        "theta_i [grad],phi_i,theta_o,phi_o"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char text[256];
        snprintf(text, sizeof text, "%s,brdf\n50,0,60,200,0.5\n", names[k]);
        gonio_readings *readings = read_as(text, k == 2 ? "angles=gon" : "", false);
        const gonio_pair *pair = gonio_readings_describe(readings)->pair;
        assert_near(pair->incident.theta, M_PI / 4.0);
        assert_near(pair->outgoing.theta, 0.3 * M_PI);
        assert_near(pair->outgoing.phi, M_PI);
        assert_note(readings, "angles in gon, values in 1/sr");
        gonio_readings_free(&readings);
    }
    refuse("theta_i [Grad],phi_i,theta_o,phi_o,brdf\n50,0,60,200,0.5\n",
           "angles in 'grad' are degrees or gradians: use --as angles=degrees or");
    refuse("theta_i [gon],phi_i,theta_o,phi_o,brdf\n250,0,60,200,0.5\n",
           "theta_i = 250 is impossible in gon");
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
        cmocka_unit_test(test_the_plain_values_come_first),
        cmocka_unit_test(test_logarithms),
        cmocka_unit_test(test_logarithms_in_other_rows),
        cmocka_unit_test(test_logarithms_are_written_as_values),
        cmocka_unit_test(test_logarithms_that_are_refused),
        cmocka_unit_test(test_polarised_light),
        cmocka_unit_test(test_polarised_light_of_many_wavelengths),
        cmocka_unit_test(test_angles_in_gon),
        cmocka_unit_test(test_directions_of_any_table),
        cmocka_unit_test(test_directions_without_reference_lines),
    };
    return cmocka_run_group_tests_name("csv values", tests, NULL, NULL);
}
