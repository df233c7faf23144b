/* Tables with polarisations in rows, powers of ten in units, elevations, and names in other
 * languages. */
#include "../support.h"

#include <stdlib.h>
#include <time.h>

#include "csv_tables.h"

/* A table: how many readings it has, and the last of them. */
typedef struct table {
    const char *text;
    size_t count;
    double theta_i, theta_o;
    double value;     /* in the last channel */
    double deviation; /* 0: none */
    const char *note;
} table;

static const table tables[] = {
    {"theta_i,theta_o,pol,brdf\n30,20,s,0.3\n30,20,p,0.5\n30,40,unpolarised,1\n30,50,TE,1\n"
     "30,50,TM,3\n",
     3, 30, 50, 2.0, 0.0,
     "the values of s and of p polarisation are averaged, where there are both"},
    {"theta_i,theta_o,polarization,400nm,500nm\n30,20,s,0.3,1\n30,20,p,0.5,3\n", 1, 30, 20, 2.0,
     0.0, "with a line for each polarisation"},
    {"theta_i,theta_o,pol,wavelength,brdf,sigma\n30,20,s,400,0.3,0.3\n30,20,p,400,0.5,0.4\n", 1, 30,
     20, 0.4, 0.25, "averaged"},
    {"theta_i,theta_o,pol,BRDF [dB]\n30,20,s,-10\n30,20,p,0\n", 1, 30, 20, 0.55, 0.0, "averaged"},
    {"theta_i,theta_o,pol,R,G,B\n30,20,s,1,2,3\n30,40,s,3,4,5\n", 2, 30, 40, 5.0, 0.0,
     "of one polarisation only"},
    {"theta_i,theta_o,channel,brdf,sigma\n30,20,B,0.3,0.1\n30,20,G,0.5,0.1\n30,20,R,0.7,0.1\n"
     "40,20,R,0.1,0.2\n40,20,B,0.4,0.2\n",
     2, 40, 20, 0.4, 0.2, "with a line for each colour"},
    {"theta_i;theta_o;farbe;brdf\n30;20;rot;0,3\n30;20;gr\xc3\xbcn;0,5\n30;20;blau;0,7\n", 1, 30,
     20, 0.7, 0.0, "with a line for each colour"},
    {"theta_i,theta_o,colour,pol,brdf\n30,20,red,s,1\n30,20,blue,s,2\n30,20,blue,p,4\n", 1, 30, 20,
     3.0, 0.0, "with a line for each colour"},
    {"theta_i,theta_o,channel,brdf\n30,20,R,0.3\n40,20,R,0.5\n", 2, 40, 20, 0.5, 0.0,
     "values 'brdf'"}, /* one colour is the only channel */
    {"theta_i,theta_o,BRDF [10^-3 sr^-1]\n30,20,350\n", 1, 30, 20, 0.35, 0.0, "10^-3"},
    {"theta_i,theta_o,BRDF (e-3/sr),sigma\n30,20,350,10\n", 1, 30, 20, 0.35, 0.01, "e-3"},
    {"theta_i,theta_o,BRDF (\xc3\x97"
     "10\xe2\x81\xbb\xc2\xb3 sr\xe2\x81\xbb\xc2\xb9)\n30,20,350\n",
     1, 30, 20, 0.35, 0.0, "BRDF"},
    {"theta_i,theta_o,BRDF 550nm [2E-03 1/sr],u(550nm) [1/sr]\n30,20,350,0.01\n", 1, 30, 20, 0.7,
     0.01, "2E-03"},
    {"theta_i,theta_o,brdf\ndeg,deg,10^-3 1/sr\n30,20,350\n", 1, 30, 20, 0.35, 0.0, "10^-3"},
    {"# unit: 1e-3 1/sr\ntheta_i,theta_o,brdf\n30,20,350\n", 1, 30, 20, 0.35, 0.0, "brdf"},
    {"elevation_i,detector elevation,BRDF\n60,75,1\n", 1, 30, 15, 1.0, 0.0, "elevation"},
    {"theta_i,sensor elevation,theta_o,BRDF\n30,75,20,1\n", 1, 30, 20, 1.0, 0.0,
     "sensor elevation"},
    {"Angle d'incidence (\xc2\xb0);Angle de r\xc3\xa9"
     "flexion (\xc2\xb0);BRDF\n30;20;0,35\n",
     1, 30, 20, 0.35, 0.0, "incidence"},
    {"\xe5\x85\xa5\xe5\xb0\x84\xe8\xa7\x92,\xe5\x8f\x97\xe5\x85\x89\xe8\xa7\x92[deg],brdf\n30,20,"
     "1\n",
     1, 30, 20, 1.0, 0.0, "plane"},
    {"ux_i,uy_i,uz_i,ux_o,uy_o,uz_o,brdf\n1,0,1,0,0,1,2\n", 1, 45, 0, 2.0, 0.0, "vectors"},
    {"theta_i,theta_o,Blue_450,Red_650\n30,20,1,2\n", 1, 30, 20, 2.0, 0.0, "'Blue_450', 'Red_650'"},
    {"AOI: 30\nphi theta value\n0 10 0.2\n90 15 0.3\n", 2, 30, 15, 0.3, 0.0, "phi_o"},
    {"sample,theta_i,theta_o,brdf\n1,30,20,0.3\n2,30,25,0.4\n", 2, 30, 25, 0.4, 0.0, "'sample'"},
    {"AOI 30\nbrdf,angle\n0.5,20\n", 1, 30, 20, 0.5, 0.0, "theta_o"},
    {"theta_i,theta_o,brdf,flag\n30,20,1,ok\n30,25,2,bad\n", 2, 30, 25, 2.0, 0.0,
     "'flag' is not heeded"},
    {"theta_i,theta_o,BRDF,date\n30,20,0.3,3/12/2024\n", 1, 30, 20, 0.3, 0.0, "plane"},
};

static bool is_noted(const gonio_readings_view *view, const char *note)
{
    bool found = false;
    for (size_t k = 0; k < view->notes; k++) {
        found = found || strstr(view->note[k], note) != NULL;
    }
    return found;
}

static void test_tables(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) {
        const table *t = &tables[k];
        gonio_context *context = support_context();
        gonio_readings *readings = read_table(context, t->text, false);
        assert_non_null(readings);
        const gonio_readings_view *view = gonio_readings_describe(readings);
        assert_int_equal(view->count, t->count);
        const size_t last = view->count - 1;
        assert_near(view->pair[last].incident.theta * 180.0 / M_PI, t->theta_i);
        assert_near(view->pair[last].outgoing.theta * 180.0 / M_PI, t->theta_o);
        assert_near(view->value[view->count * view->channels - 1], t->value);
        assert_int_equal(view->deviation != NULL, t->deviation > 0.0);
        if (view->deviation != NULL) {
            assert_near(view->deviation[view->count * view->channels - 1], t->deviation);
        }
        assert_true(is_noted(view, t->note));
        gonio_readings_free(&readings);
        gonio_context_free(&context);
    }
}

/* Whether a factor was applied or is to be applied is not guessed. */
static void test_what_is_refused(void **state)
{
    static const refused_text cases[] = {
        {"theta_i,theta_o,BRDF x1e-3 [1/sr]\n30,20,350\n", "put the factor into the unit"},
        {"theta_i,theta_o,BRDF x 1000\n30,20,350\n", "put the factor into the unit"},
        {"theta_i,theta_o,BRDF*1000\n30,20,350\n", "put the factor into the unit"},
        {"theta_i,theta_o,1000*BRDF\n30,20,350\n", "put the factor into the unit"},
        {"theta_i,theta_o,BRDF/1000\n30,20,350\n", "put the factor into the unit"},
        {"# unit: 1e-3 1/sr\ntheta_i,theta_o,brdf [1/sr]\n30,20,350\n", "into the column's unit"},
        {"# values: BRDF x 1000\ntheta_i,theta_o,brdf\n30,20,350\n", "into the column's unit"},
        {"unit: 1e-3 1/sr\ntheta_i = 30\ntheta\\phi,0,90\n0,1,1\n",
         "r.csv:1: values with a factor"},
        {"sample,theta_i,theta_o,brdf\nA,30,20,0.3\nB,30,25,0.4\n",
         "r.csv:3: sample 'B', but rows above"},
        {"theta_i,theta_o,filter,brdf\n30,20,red,1\n30,20,blue,2\n",
         "filter 'blue', but rows above"},
        {"theta_i,theta_o,type,value\n30,20,BRDF,1\n30,20,BTDF,2\n", "r.csv:3: a value of transm"},
        {"AOI 30\nWavelength (um),brdf\n0.4,0.3\n", "no column 'theta_o_deg'"},
        {"theta_i,theta_o,X,Y,Z\n30,20,0.3,0.3,0.3\n", "give tristimulus values as linear sRGB"},
        {"theta_i,theta_o,CIE_X,CIE_Y,CIE_Z\n30,20,1,1,1\n", "Y alone as value_per_sr"},
        {"theta_i,theta_o,pol_i,pol_o,brdf\n30,20,s,p,1\n", "add the values of s and of p"},
        {"theta_i,theta_o,wavenumber,brdf\n30,20,20000,1\n", "give wavelengths"},
        {"theta_i,theta_o,log10(brdf)\n30,20,400\n",
         "'400' is not a finite number when its logarithm is undone: larger"},
        {"theta_i,theta_o,channel,brdf\n30,20,R,1\n30,20,G,1\n30,20,all,1\n",
         "r.csv:4: channel 'all' is not R, G or B"},
        {"theta_i,theta_o,filter,brdf\n30,20,V,1\n30,20,X,1\n", "keep the rows of one"},
        {"theta_i,theta_o,pol,brdf\n30,20,45,1\n", "r.csv:2: pol '45' is not a polarisation"},
    };
    (void)state;
    assert_refused(cases, sizeof cases / sizeof *cases);
}

/* A name of a million blanks takes as long as its length, not its square: some minutes. */
static void test_long_names(void **state)
{
    static const char begin[] = "theta_i,theta_o,brdf";
    static const char end[] = "x\n30,20,1\n";
    const size_t blanks = support_small() ? 20000 : 1000000;
    const clock_t start = clock();
    char *text = malloc(sizeof begin + blanks + sizeof end);
    gonio_context *context = support_context();
    gonio_readings_options options;
    gonio_readings *readings = NULL;
    (void)state;
    assert_non_null(text);
    memset(text, ' ', sizeof begin + blanks + sizeof end);
    memcpy(text, begin, sizeof begin - 1);
    memcpy(text + sizeof begin - 1 + blanks, end, sizeof end);
    gonio_readings_options_default(&options);
    options.values_needed = false;
    assert_int_equal(
        gonio_readings_read_text(context, "r.csv", text, strlen(text), &options, &readings),
        GONIO_OK);
    gonio_readings_free(&readings);
    options.values_needed = true;
    assert_int_equal(
        gonio_readings_read_text(context, "r.csv", text, strlen(text), &options, &readings),
        GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "no column of values: 'brdf"));
    assert_true(clock() - start < 20 * CLOCKS_PER_SEC); /* 0.1 s; the square takes minutes */
    gonio_context_free(&context);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tables),
        cmocka_unit_test(test_what_is_refused),
        cmocka_unit_test(test_long_names),
    };
    return cmocka_run_group_tests_name("csv laboratories", tests, NULL, NULL);
}
