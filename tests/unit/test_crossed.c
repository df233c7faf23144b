/* Tables with angles, geometries or wavelengths along both sides. */
#include "../support.h"

#include "csv_tables.h"

/* A table: how many readings and channels it has, and the last of them. */
typedef struct table {
    const char *text;
    size_t count;
    size_t channels;
    double degrees[4];
    double value; /* in the last channel */
    const char *note;
} table;

#define AOI "Instrument: X\ntheta_i = 30\n"
#define CELLS "0,0.1,0.1,0.1\n30,0.1,0.2,0.9\n"

static const table tables[] = {
    {AOI "theta\\phi,0,90,180\n" CELLS, 4, 1, {30, 0, 30, 180}, 0.9, "theta_o in rows, phi_o in"},
    {"# AOI: 30 deg\n# rows: theta_o\n# columns: phi_o\n;0;90;180\n0;0,1;0,1;0,1\n30;0,1;0,2;0,9\n",
     4,
     1,
     {30, 0, 30, 180},
     0.9,
     "the light at phi 0"},
    {AOI "theta\\phi,0,90\n9,1,2\ntheta\\phi,0,90\n10,3,4\ntheta\\phi,120,180\n10,5,6\n",
     6,
     1,
     {30, 0, 10, 180},
     6.0,
     "phi_o in columns"},
    {"AOI,20,,\nphi_o/theta_o,0,30,60,\n180,0.1,0.2,0.9,\nAOI,40,,\nphi_o/theta_o,0,30,60,\n"
     "180,0.1,,0.8,\n",
     5,
     1,
     {40, 0, 60, 180},
     0.8,
     "1 not measured"},
    {"BRF\nwavelength: 550 nm\ntheta_i (deg)\\theta_o (deg)\t-30\t30\n10\t0.1\t0.1\n"
     "wavelength: 650 nm\ntheta_i (deg)\\theta_o (deg)\t-30\t30\n10\t0.1\t0.5\n",
     2,
     2,
     {10, 0, 30, 180},
     0.5 / M_PI,
     "reflectance factors (divided by pi)"},
    {"wavelength_nm,45/0,45:-15\n400,0.1,0.2\n500,0.1,0.3\n", 2, 2, {45, 0, 15, 0}, 0.3, "plane"},
    {"unit: %\nwavelength_nm,45as15,r45as75\n400,10,20\n500,11,12\n",
     2,
     2,
     {45, 0, 30, 0},
     0.12 / M_PI,
     "per cent"},
    {"theta_i,45,,30\nphi_i,0,0,0\n# x\ntheta_o,0,15,30\nphi_o,0,180,90\nwavelength [nm],R [%],R "
     "[%],"
     "R [%]\n400,10,20,30\n500,10,20,40\n",
     3,
     2,
     {30, 0, 30, 90},
     0.4 / M_PI,
     "wavelength in rows, geometries"},
    {"unit: %\nnm;45:0;45\xc2\xb0:as 15\xc2\xb0\n400;1;2\n",
     2,
     1,
     {45, 0, 30, 180},
     0.02 / M_PI,
     "plane"},
    {"\xef\xbb\xbftheta_i=30\ntheta/phi\t0\t90\r\n10\t0.1\t0.2\r\n",
     2,
     1,
     {30, 0, 10, 90},
     0.2,
     "phi_o"},
    {"theta_i,45,,30\ntheta_o,0,15,30\n400,0.1,0.2,0.3\n", 3, 1, {30, 0, 30, 180}, 0.3, "plane"},
    {"geometry,wavelength,brdf\n45/0,400,0.5\n30:-10,400,0.1\n",
     2,
     1,
     {30, 0, 10, 0},
     0.1,
     "first"},
    {"# unit: %\ngeometry,400nm\n45as15,0.3\n15as-15,10\n",
     2,
     1,
     {15, 0, 30, 180},
     0.1 / M_PI,
     "first"},
};

static void test_tables(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) {
        const table *t = &tables[k];
        gonio_context *context = support_context();
        gonio_readings *readings = read_table(context, t->text, true);
        assert_non_null(readings);
        const gonio_readings_view *view = gonio_readings_describe(readings);
        assert_int_equal(view->count, t->count);
        assert_int_equal(view->channels, t->channels);
        const gonio_pair *last = &view->pair[view->count - 1];
        assert_near(last->incident.theta * 180.0 / M_PI, t->degrees[0]);
        assert_near(last->incident.phi * 180.0 / M_PI, t->degrees[1]);
        assert_near(last->outgoing.theta * 180.0 / M_PI, t->degrees[2]);
        assert_near(last->outgoing.phi * 180.0 / M_PI, t->degrees[3]);
        assert_near(view->value[view->count * view->channels - 1], t->value);
        assert_true(view->notes > 0);
        if (strstr(view->note[0], t->note) == NULL) {
            fail_msg("%s", view->note[0]);
        }
        gonio_readings_free(&readings);
        gonio_context_free(&context);
    }
}

/* What is not told is not guessed: the message says what to add. */
static void test_what_is_refused(void **state)
{
    static const refused_text cases[] = {
        {"theta_o\\phi_o,0,90,180\n" CELLS, "r.csv:2: no angle of incidence: give it in a line"},
        {AOI ",0,90,180\n" CELLS, "r.csv:3: a table of values with numbers along both sides"},
        {AOI "theta_o,0,30,60\n" CELLS, "name rows and columns in its corner cell"},
        {AOI "wavelength,0,10,20\n400,1,1,1\n", "name rows and columns in its corner cell"},
        {"theta_i,45,30\ntheta_o,0,15\n10,0.1,0.2\n", "name rows and columns in its corner cell"},
        {AOI "theta\\phi,0,90\n9,1,2\nuncertainty\ntheta\\phi,0,90\n9,.1,.2\n",
         "r.csv:7: the directions of the table of line 4 again"},
        {AOI "theta\\phi,0,90\n0,0.1,x\n", "r.csv:4: 'x' is not a finite number"},
        {AOI "theta\\phi,0,90\n0,0.1\n", "r.csv:4: 2 cells where the line of columns has 3"},
        {AOI "theta\\phi,0,90\n0,0.1,1,1\n", "r.csv:4: 4 cells where the line of columns has 3"},
        {AOI "BTDF\ntheta\\phi,0,90\n0,0.1,1\n", "r.csv:3: a table of transmission"},
        {"theta_i = 0.5 rad\ntheta (deg)\\phi (deg),0,90\n0,1,1\n", "r.csv:2: another unit"},
        {"wavelength_nm,45as15,45as25\n400,0.1,0.2\n", "reflectance factors or per cent?"},
        {"geometry,400nm\n45as15,0.1\n", "reflectance factors or per cent?"},
        {"geometry,brdf\n45as15az90,0.1\n", "'45as15az90' is not a geometry"},
    };
    (void)state;
    assert_refused(cases, sizeof cases / sizeof *cases);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tables),
        cmocka_unit_test(test_what_is_refused),
    };
    return cmocka_run_group_tests_name("crossed tables", tests, NULL, NULL);
}
