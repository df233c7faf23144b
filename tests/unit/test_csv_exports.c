/* Tables as other programs and laboratories export them. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_readings.h"

static gonio_status read_text(gonio_context *context, const char *text, gonio_readings **readings)
{
    gonio_readings_options options;
    char *folder = support_folder();
    gonio_readings_options_default(&options);
    const gonio_status status = made_readings(context, folder, "r.csv", text, &options, readings);
    support_remove(folder);
    return status;
}

static void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-8 * fmax(1.0, fabs(expected)))) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
}

/* A table: how many readings it has, the first, what is said. */
typedef struct table {
    const char *text;
    size_t count;
    double degrees[4]; /* of the first reading */
    double value;      /* NaN: not read */
    const char *note;
} table;

static void check_table(const table *t)
{
    gonio_context *context = support_context();
    gonio_readings *readings = NULL;
    print_message("%s", t->text);
    assert_int_equal(read_text(context, t->text, &readings), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, t->count);
    const double radians[4] = {view->pair[0].incident.theta, view->pair[0].incident.phi,
                               view->pair[0].outgoing.theta, view->pair[0].outgoing.phi};
    for (int k = 0; k < 4; k++) {
        assert_near(radians[k] * 180.0 / M_PI, t->degrees[k]);
    }
    if (isnan(t->value)) {
        assert_true(isnan(gonio_readings_value(readings, 0, 0)));
    } else {
        assert_near(gonio_readings_value(readings, 0, 0), t->value);
    }
    bool noted = false;
    for (size_t k = 0; k < view->notes; k++) {
        noted = noted || strstr(view->note[k], t->note) != NULL;
    }
    assert_true(noted);
    gonio_readings_free(&readings);
    gonio_context_free(&context);
}

#define NAMES "theta_i,phi_i,theta_r,phi_r,BRDF\n"
#define ROW "10,0,20,180,0.3\n"
#define DEGREE "\xc2\xb0"

static void test_tables(void **state)
{
    (void)state;
    static const table tables[] = {
        /* lines that are no rows */
        {NAMES ROW "\nEnd of measurement\n", 1, {10, 0, 20, 180}, 0.3, "1 line of words among"},
        {NAMES ROW "saved 12:05 by me\n", 1, {10, 0, 20, 180}, 0.3, "left out (first: line 3)"},
        {NAMES ROW NAMES "30,0,20,180,0.2\n", 2, {10, 0, 20, 180}, 0.3, "1 line of words"},
        {"theta_i;phi_i;theta_r;phi_r;BRDF\ndeg;deg;deg;deg;1/sr\n10;0;20;180;0,3\n"
         "theta_i;phi_i;theta_r;phi_r;BRDF\n30;0;20;180;0,2\nDone;;\n",
         2,
         {10, 0, 20, 180},
         0.3,
         "2 lines of words among the rows left out (first: line 4)"},
        /* cells in place of values */
        {NAMES "15,0,20,180,---\n" ROW, 2, {15, 0, 20, 180}, NAN, "1 cell such as '---' taken as"},
        {NAMES ROW "1,0,2,0,<LOD>\n2,0,2,0,OVRFLW\n3,0,2,0,#N/A\n4,0,2,0,-\n5,0,2,0,#DIV/0!\n",
         6,
         {10, 0, 20, 180},
         0.3,
         "5 cells such as '<LOD>' taken as not read"},
        {"theta_i,phi_i,theta_r,phi_r,BRDF,sd\n10,0,20,180,0.3,n/a\n",
         1,
         {10, 0, 20, 180},
         0.3,
         "1 cell such as 'n/a'"},
        {NAMES ROW "1,0,2,0,-999\n", 2, {10, 0, 20, 180}, 0.3, "1 cell such as '-999' taken as"},
        /* angles with signs */
        {NAMES "10" DEGREE ",0" DEGREE ",20" DEGREE ",180" DEGREE ",1\n15,0,20,180,0.3\n",
         2,
         {10, 0, 20, 180},
         1.0,
         "angles in degrees"},
        {NAMES "\"10" DEGREE "30'36\"\"\",0 deg,-20.5 deg,0" DEGREE ",0.3\n",
         1,
         {10.51, 0, 20.5, 180},
         0.3,
         "theta below zero"},
        {"theta_i;phi_i;theta_r;phi_r;BRDF\n10,5" DEGREE ";0;20;180;0,3\n",
         1,
         {10.5, 0, 20, 180},
         0.3,
         "degrees"},
        {"theta_i,theta_r,BRDF\n10,\xe2\x88\x92"
         "20,1e\xe2\x88\x92"
         "2\n",
         1,
         {10, 0, 20, 0},
         0.01,
         "theta below zero"},
        /* other languages */
        {"Einfallswinkel [" DEGREE "];Ausfallswinkel [" DEGREE "];Azimut [" DEGREE "];BRDF [1/sr]\n"
         "10;20;170;0,3\n",
         1,
         {10, 0, 20, 170},
         0.3,
         "'Azimut"},
        {"angle incidence,angle observation,azimut,FRDB (sr-1)\n10,20,170,0.3\n",
         1,
         {10, 0, 20, 170},
         0.3,
         "'FRDB (sr-1)'"},
        /* an angle of incidence above the table */
        {"Sample: S1\nAngle of incidence: 30" DEGREE "\nWavelength: 633 nm\n\n"
         "Detector angle (" DEGREE ");BRDF (1/sr)\n40;0,31\n-10;0,3\n",
         2,
         {30, 0, 40, 180},
         0.31,
         "'Detector angle"},
        /* names in two lines */
        {"Incident,,Reflected,,BRDF,\ntheta,phi,theta,phi,450 nm,550 nm\n"
         "deg,deg,deg,deg,1/sr,1/sr\n10,0,20,180,0.3,0.4\n",
         1,
         {10, 0, 20, 180},
         0.3,
         "'Incident theta (deg)'"},
        {"Lamp 3\nIncident;;Reflected;;;\nZenith [" DEGREE "];Azimuth [" DEGREE "];Zenith [" DEGREE
         "];Azimuth [" DEGREE "];BRDF [1/sr];u(BRDF) [%]\n10;0;20;180;0,3;1\n",
         1,
         {10, 0, 20, 180},
         0.3,
         "values 'BRDF [1/sr]'; deviations 'u(BRDF) [%]'"},
        {"aoi,aos,azimuth,BRDF mean,BRDF std,n\n10,20,170,0.3,0.01,5\n",
         1,
         {10, 0, 20, 170},
         0.3,
         "values 'BRDF mean'; deviations 'BRDF std'"},
        /* the difference of sines */
        {"theta_i,beta-beta0,BSDF\n30,0.25,12\n30,0.6,1\n",
         1,
         {30, 0, 48.590377891, 180},
         12,
         "left out: 1 at or below the horizon"},
        {"theta_i,sin(theta_s)-sin(theta_i),BSDF\n30,-0.5,12\n", 1, {30, 0, 0, 0}, 12, "sin"},
        {"AOI: 30 deg\n\xce\xb2-\xce\xb2\xe2\x82\x80,log10(BSDF)\n-0.75,0\n",
         1,
         {30, 0, 14.477512186, 0},
         1,
         "positive away from the normal"},
        {"AOI: 0 deg\n|B-B0|,BSDF\n0.5,1.2\n", 1, {0, 0, 30, 180}, 1.2, "at normal incidence"},
    };
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) {
        check_table(&tables[k]);
    }
}

static void test_what_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *message;
    } cases[] = {
        {NAMES ROW "Total,,,,2\n", "r.csv:3: theta_i 'Total' is not a finite number"},
        {NAMES ROW "10,20\n", "r.csv:3: 2 cells where the header names 5 columns"},
        {NAMES "10,---,20,180,0.3\n", "phi_i '---' is not a finite number"},
        {NAMES "10' ,0,20,180,0.3\n", "theta_i '10'' is not a finite number"},
        {NAMES "10" DEGREE "5" DEGREE ",0,20,180,0.3\n", "is not a finite number"},
        {"theta_i (rad),phi_i,theta_r,phi_r,BRDF\n1" DEGREE ",0,1,1,0.3\n", "is not a finite"},
        {NAMES "10,0,20,180,-998\n", "BRDF '-998' is negative"},
        {"theta_i,phi_i,theta_r,phi_r,BRDF\nmotor stalled\n", "r.csv:2: words, not a reading"},
        {"theta_i,phi_i,theta_t,phi_t,BTDF\n10,0,20,180,0.3\n",
         "no column 'theta_o_deg', but one of transmission; gonio reads reflection"},
        {"theta_i,phi_i,theta_r,phi_r,L*,a*,b*\n10,0,20,180,50,1,2\n", "'L*' is not understood"},
        {"theta_i,|beta-beta0|,BSDF\n5,0.02,12\n", "r.csv:2: |beta - beta0| does not say on which"},
        {"theta_i,abs(beta-beta0),BSDF\n5,0.02,12\n", "give beta-beta0 with its sign"},
        {"theta_i,beta-beta0,BSDF\n-5,0.02,12\n", "theta_i below zero beside beta - beta0"},
    };
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        gonio_readings *readings = NULL;
        if (read_text(context, cases[k].text, &readings) == GONIO_OK ||
            strstr(support_message(), cases[k].message) == NULL) {
            fail_msg("%s%s", cases[k].text, support_message());
        }
        assert_null(readings);
    }
    gonio_context_free(&context);
}

/* Written again, the rows are those that were read. */
static void test_rows_are_written_without_words(void **state)
{
    (void)state;
    char path[256];
    char *folder = support_folder();
    gonio_context *context = support_context();
    gonio_readings_options options;
    gonio_readings *readings = NULL;
    gonio_readings *again = NULL;
    gonio_readings_options_default(&options);
    assert_int_equal(made_readings(context, folder, "r.csv",
                                   NAMES ROW "stopped\n" NAMES "30" DEGREE ",0,20,180,---\n"
                                             "40,0,20,180,0.2\n",
                                   &options, &readings),
                     GONIO_OK);
    snprintf(path, sizeof path, "%s/again.csv", folder);
    assert_int_equal(gonio_readings_write(context, readings, NULL, path), GONIO_OK);
    assert_int_equal(gonio_readings_read(context, path, &options, &again), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(again);
    assert_int_equal(view->count, 3);
    assert_near(view->pair[1].incident.theta, M_PI / 6.0);
    assert_true(isnan(view->value[1]));
    assert_near(view->value[2], 0.2);
    gonio_readings_free(&again);
    gonio_readings_free(&readings);
    gonio_context_free(&context);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tables),
        cmocka_unit_test(test_what_is_refused),
        cmocka_unit_test(test_rows_are_written_without_words),
    };
    return cmocka_run_group_tests_name("csv exports", tests, NULL, NULL);
}
