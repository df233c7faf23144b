/* Readings from CSV files of others, written again: what was left out stays out, other columns and
 * comments stay, angles and values are gonio's, and reading them again says nothing new. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_readings.h"

#define ANGLES "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg"

static char *read_back(const char *path)
{
    char *text = calloc(1, 8192);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_non_null(text);
    assert_true(fread(text, 1, 8191, file) > 0);
    fclose(file);
    return text;
}

static void assert_same_readings(const gonio_readings *a, const gonio_readings *b)
{
    const gonio_readings_view *x = gonio_readings_describe(a);
    const gonio_readings_view *y = gonio_readings_describe(b);
    assert_int_equal(x->count, y->count);
    assert_int_equal(x->channels, y->channels);
    for (size_t k = 0; k < x->count; k++) {
        assert_true(fabs(x->pair[k].incident.theta - y->pair[k].incident.theta) < 1e-9);
        assert_true(fabs(x->pair[k].incident.phi - y->pair[k].incident.phi) < 1e-9);
        assert_true(fabs(x->pair[k].outgoing.theta - y->pair[k].outgoing.theta) < 1e-9);
        assert_true(fabs(x->pair[k].outgoing.phi - y->pair[k].outgoing.phi) < 1e-9);
    }
    for (size_t k = 0; k < x->count * x->channels; k++) {
        const bool none = isnan(x->value[k]) && isnan(y->value[k]);
        assert_true(none || fabs(x->value[k] - y->value[k]) <= 1e-9 * x->value[k]);
    }
}

typedef struct written_case {
    const char *text;
    const char *as;
    const char *table; /* what is written, behind the comments */
    const char *note;  /* a comment that is written; "" for none */
} written_case;

static void check(const char *folder, const written_case *c)
{
    gonio_readings_options how;
    gonio_readings *readings = NULL;
    gonio_readings *again = NULL;
    char path[256];
    snprintf(path, sizeof path, "%s/w.csv", folder);
    gonio_readings_options_default(&how);
    assert_int_equal(gonio_convention_parse(NULL, c->as, &how.as), GONIO_OK);
    assert_int_equal(made_readings(NULL, folder, "r.csv", c->text, &how, &readings), GONIO_OK);
    assert_int_equal(gonio_readings_write(NULL, readings, NULL, path), GONIO_OK);
    char *text = read_back(path);
    const char *table = strstr(text, "# program: ");
    assert_non_null(table);
    table = strchr(table, '\n') + 1;
    if (strcmp(table, c->table) != 0 || strstr(text, c->note) == NULL) {
        fail_msg("%s\nis written as\n%s", c->text, text);
    }
    assert_int_equal(gonio_readings_read(NULL, path, NULL, &again), GONIO_OK);
    assert_same_readings(readings, again);
    gonio_readings_free(&readings);
    /* once more: nothing is added */
    assert_int_equal(gonio_readings_write(NULL, again, NULL, path), GONIO_OK);
    char *twice = read_back(path);
    assert_string_equal(twice, text);
    gonio_readings_free(&again);
    free(twice);
    free(text);
}

static void test_written_again(void **state)
{
    (void)state;
    static const written_case cases[] = {
        /* rows that were left out, in front, between and behind */
        {ANGLES ",place,R_per_sr\n95,0,1,0,a,1\n10,0,20.50,180,b,2\n\n10,0,90,0,c,3\n"
                "10,0,30,180,d,4\n10,0,120,0,e,5\n",
         "", ANGLES ",place,R_per_sr,G_per_sr,B_per_sr\n10,0,20.50,180,b,2,,\n10,0,30,180,d,4,,\n",
         "left out: 3 at or below the horizon"},
        /* a theta below zero in gonio's own columns stays as it is */
        {ANGLES ",550nm_per_sr\n25,180,-78,0,0.2248\n25,180,60,0,0.2971\n", "",
         ANGLES ",550nm_per_sr\n25,180,-78,0,0.2248\n25,180,60,0,0.2971\n",
         "1 with theta below zero"},
        /* other names and units; what a comment said of them is gone, other comments are not */
        {"# lamp: old\n# angles: radians\n# values: reflectance factor\n"
         "place,theta_i,phi_i,theta_o,phi_o,550nm\nx,0.5,0,1,3,0.5\n",
         "", "place," ANGLES ",550nm_per_sr\nx,28.6478898,0,57.2957795,171.887339,0.1591549431\n",
         "# lamp: old\n# note: taken as CSV"},
        {"theta_i_deg,theta_o_deg,dphi,R,G,B,u(G)\n10,-20,170,1,2,3,0.5\n", "",
         ANGLES ",R_per_sr,G_per_sr,B_per_sr,G_deviation_per_sr,R_deviation_per_sr,"
                "B_deviation_per_sr\n10,0,20,350,1,2,3,0.5,,\n",
         "angles 'theta_i_deg', 'theta_o_deg', 'dphi'"},
        /* a line of units */
        {"theta_i;phi_i;theta_o;phi_o;brdf;exposure\ndeg;deg;deg;deg;1/sr;s\n10;0;20,5;180;0,5;7\n",
         "",
         "theta_i_deg;phi_i_deg;theta_o_deg;phi_o_deg;value_per_sr;exposure (s)\n"
         "10;0;20.5;180;0.5;7\n",
         "not read: 'exposure (s)'"},
        /* what the user said */
        {ANGLES ",R_per_sr,G_per_sr,B_per_sr\n0.5,0,1,3,0.5,1,2\n", "angles=radians,values=percent",
         ANGLES ",R_per_sr,G_per_sr,B_per_sr\n28.6478898,0,57.2957795,171.887339,0.001591549431,"
                "0.003183098862,0.006366197724\n",
         "per cent"},
        /* planned, but not read */
        {ANGLES ",R_per_sr,G_per_sr,B_per_sr\n10,0,20,180,,,\n10,0,30,180,1,2,3\n", "",
         ANGLES ",R_per_sr,G_per_sr,B_per_sr\n10,0,20,180,,,\n10,0,30,180,1,2,3\n", ""},
        /* a deviation without its value */
        {ANGLES ",R_per_sr,R_deviation_per_sr,B_deviation_per_sr\n10,0,20,180,1,0.5,\n", "",
         ANGLES ",R_per_sr,R_deviation_per_sr,G_per_sr,B_per_sr,G_deviation_per_sr,"
                "B_deviation_per_sr\n10,0,20,180,1,0.5,,,,\n",
         ""},
        /* a line for each wavelength */
        {ANGLES ",wavelength_nm,brdf\n10,0,20.5,180,650,2\n10,0,20.5,180,550,1\n"
                "10,0,30,180,550,3\n",
         "", ANGLES ",550nm_per_sr,650nm_per_sr\n10,0,20.5,180,1,2\n10,0,30,180,3,\n",
         "# note: taken as CSV with a line for each wavelength"},
        /* wavelengths in micrometres */
        {ANGLES ",0.55um,0.6um,0.55um sd\n10,0,20,180,1,2,0.5\n", "",
         ANGLES ",550nm_per_sr,600nm_per_sr,550nm_deviation_per_sr,600nm_deviation_per_sr\n"
                "10,0,20,180,1,2,0.5,\n",
         "wavelengths in micrometres"},
    };
    char *folder = support_folder();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        check(folder, &cases[k]);
    }
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_written_again),
    };
    return cmocka_run_group_tests_name("csv written again", tests, NULL, NULL);
}
