/* Times of rows, and rows of the reference and the dark level: what is read, and what is corrected.
 */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_readings.h"
#include "measurement/formats/csv_names.h"
#include "measurement/formats/csv_time.h"

#define NAMES "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,"
#define SAMPLE "30,0,40,180,"
#define OTHER "30,0,50,180,"
#define STANDARD "8,0,0,0,"

static gonio_readings *read_text(const char *text)
{
    gonio_context *context = support_context();
    gonio_readings *readings = NULL;
    if (gonio_readings_read_text(context, "run", text, strlen(text), NULL, &readings) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    gonio_context_free(&context);
    return readings;
}

static bool has_note(const gonio_readings *readings, const char *part)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    bool found = false;
    for (size_t k = 0; k < view->notes; k++) {
        found = found || strstr(view->note[k], part) != NULL;
    }
    return found;
}

static void test_times(void **state)
{
    (void)state;
    static const struct {
        const char *cell;
        double seconds;
        double time;
    } cases[] = {
        {"12.5", 1.0, 12.5},
        {"2", 60.0, 120.0},
        {"12:30", 1.0, 45000.0},
        {"00:00:01.25", 1.0, 1.25},
        {"1970-01-01T00:00:00Z", 1.0, 0.0},
        {"2000-03-01 00:00:00", 1.0, 951868800.0},
        {"2026-11-28T14:05:09+01:00", 1.0, 1795874709.0},
        {"28.11.2026 14:05:09", 1.0, 1795874709.0},
        {"noon", 1.0, NAN},
        {"12:99", 1.0, NAN},
        {"", 1.0, NAN},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const double time = gonio_i_time_of(cases[k].cell, ',', cases[k].seconds);
        if (!(fabs(time - cases[k].time) < 1e-6) && !(isnan(time) && isnan(cases[k].time))) {
            fail_msg("'%s': %.17g where %.17g is expected", cases[k].cell, time, cases[k].time);
        }
    }
    assert_true(fabs(gonio_i_time_of("12,5", ';', 1.0) - 12.5) < 1e-12);
}

static void test_names_of_times(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        gonio_i_column_kind kind;
        double seconds;
    } cases[] = {{"time", GONIO_I_TIME, 1.0},           {"time_s", GONIO_I_TIME, 1.0},
                 {"Time (min)", GONIO_I_TIME, 60.0},    {"elapsed_h", GONIO_I_TIME, 3600.0},
                 {"timestamp", GONIO_I_TIME, 1.0},      {"mark", GONIO_I_MARK, 0.0},
                 {"exposure time", GONIO_I_OTHER, 0.0}, {"settling_time_s", GONIO_I_OTHER, 0.0},
                 {"date", GONIO_I_OTHER, 0.0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const gonio_i_column_name name = gonio_i_column_name_of(cases[k].name);
        if (name.kind != cases[k].kind || name.seconds != cases[k].seconds) {
            fail_msg("'%s': kind %d, %g s", cases[k].name, (int)name.kind, name.seconds);
        }
    }
}

/* A lamp that loses 10 % in 100 s: the sample, which does not change, reads the same. */
static void test_drift(void **state)
{
    (void)state;
    gonio_readings *r =
        read_text(NAMES "time_s,mark,value_per_sr\n" STANDARD "0,reference,2\n" SAMPLE
                        "50,,0.95\n" OTHER "100,sample,0.9\n" STANDARD "100,Reference,1.8\n");
    const gonio_readings_view *view = gonio_readings_describe(r);
    assert_int_equal(view->count, 2);
    assert_true(view->time[0] == 50.0 && view->time[1] == 100.0);
    assert_true(fabs(view->value[0] - 1.0) < 1e-12 && fabs(view->value[1] - 1.0) < 1e-12);
    assert_true(has_note(r, "2 reference rows: drift corrected by time (gain 0.9 to 1)"));
    gonio_readings_free(&r);
}

/* The dark level is subtracted from the sample and from the reference, in the file's own unit. */
static void test_dark_rows(void **state)
{
    (void)state;
    gonio_readings *r =
        read_text(NAMES "time_s,mark,brdf_cos\n" STANDARD "0,dark,0.1\n" STANDARD
                        "1,reference,2.1\n" SAMPLE "50,,0.6\n" OTHER "60,,0.05\n" STANDARD
                        "100,reference,1.1\n" STANDARD "101,dark,0.1\n");
    const gonio_readings_view *view = gonio_readings_describe(r);
    const double gain = 1.0 - 0.5 * 49.0 / 99.0;
    assert_true(fabs(view->value[0] - 0.5 / cos(40.0 * M_PI / 180.0) / gain) < 1e-12);
    assert_true(view->value[1] == 0.0);
    assert_true(has_note(r, "2 dark rows subtracted (0.1 to 0.1, by time); 1 value below it"));
    gonio_readings_free(&r);
}

static void test_without_times(void **state)
{
    (void)state;
    gonio_readings *r = read_text(NAMES "mark,value_per_sr\n" STANDARD "ref,2\n" SAMPLE
                                        ",0.75\n" STANDARD "ref,1\n");
    assert_true(fabs(gonio_readings_value(r, 0, 0) - 1.0) < 1e-12);
    assert_true(has_note(r, "by line, as not every row has a time"));
    gonio_readings_free(&r);
}

/* A standard that is no brighter than the dark, and one at other directions, correct nothing. */
static void test_useless_references(void **state)
{
    (void)state;
    gonio_readings *r = read_text(NAMES "mark,value_per_sr\n" STANDARD "dark,0.5\n" SAMPLE
                                        ",0.75\n" STANDARD "ref,0.4\n");
    assert_true(fabs(gonio_readings_value(r, 0, 0) - 0.25) < 1e-12);
    assert_true(has_note(r, "not brighter than the dark level"));
    gonio_readings_free(&r);
    r = read_text(NAMES "mark,value_per_sr\n" STANDARD "ref,2\n" SAMPLE ",0.75\n" OTHER "ref,1\n");
    assert_true(fabs(gonio_readings_value(r, 0, 0) - 0.75) < 1e-12);
    gonio_readings_free(&r);
}

static void test_time_runs_backwards(void **state)
{
    (void)state;
    gonio_readings *r =
        read_text(NAMES "time_s,value_per_sr\n" SAMPLE "10,1\n" OTHER "5,1\n20,0,30,180,12,1\n");
    assert_true(has_note(r, "the time runs backwards in 1 row (first in line 3)"));
    gonio_readings_free(&r);
    r = read_text(NAMES "time,value_per_sr\n" SAMPLE "23:59:50,1\n" OTHER
                        "00:00:10,1\n20,0,30,180,00:01:10,1\n");
    const gonio_readings_view *view = gonio_readings_describe(r);
    assert_false(has_note(r, "backwards"));
    assert_true(view->time[1] - view->time[0] == 20.0 && view->time[2] - view->time[0] == 80.0);
    gonio_readings *copy = NULL;
    assert_int_equal(gonio_readings_copy(NULL, r, &copy), GONIO_OK);
    assert_true(gonio_readings_describe(copy)->time[2] == view->time[2]);
    gonio_readings_free(&copy);
    gonio_readings_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_times),
        cmocka_unit_test(test_names_of_times),
        cmocka_unit_test(test_drift),
        cmocka_unit_test(test_dark_rows),
        cmocka_unit_test(test_without_times),
        cmocka_unit_test(test_useless_references),
        cmocka_unit_test(test_time_runs_backwards),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
