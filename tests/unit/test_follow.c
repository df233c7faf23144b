/* Runs on a real instrument: the journal, lines of a file that grows, the output of commands, and
 * what lines mean to a run. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/random.h"
#include "follow/command_source.h"
#include "follow/journal.h"
#include "follow/line_source.h"
#include "follow/run.h"
#include "made_readings.h"

static void write_file(const char *path, const char *mode, const char *text)
{
    FILE *file = fopen(path, mode);
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* ---- the journal ---- */

static gonio_status gather(void *user, const char *kind, const char *text)
{
    char *all = user;
    snprintf(all + strlen(all), 512 - strlen(all), "[%s|%s]", kind, text);
    return GONIO_OK;
}

static journal *open_good(const char *path, char *all, journal_found *found)
{
    journal *j = NULL;
    char *problem = NULL;
    *all = '\0';
    assert_int_equal(journal_open(path, gather, all, found, &j, &problem), GONIO_OK);
    return j;
}

static void test_journal(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    char all[512];
    journal_found found;
    snprintf(path, sizeof path, "%s/run.journal", folder);
    journal *j = open_good(path, all, &found);
    assert_true(journal_append(j, "line", "2 0.5 1,2,3") && journal_append(j, "ask", "7"));
    assert_true(journal_flush(j));
    journal *second = NULL;
    char *problem = NULL;
    assert_int_equal(journal_open(path, gather, all, &found, &second, &problem), GONIO_ERROR_IO);
    assert_non_null(strstr(problem, "another gonio"));
    free(problem);
    journal_close(&j);
    write_file(path, "a", "0123 li");
    j = open_good(path, all, &found);
    assert_string_equal(all, "[line|2 0.5 1,2,3][ask|7]");
    assert_true(found.records == 2 && found.cut == 7 && found.damaged == 0);
    assert_true(journal_append(j, "ask", "8"));
    journal_close(&j);
    write_file(path, "a", "00000000 ask 9\n");
    j = open_good(path, all, &found);
    assert_string_equal(all, "[line|2 0.5 1,2,3][ask|7][ask|8]");
    assert_true(found.records == 3 && found.cut == 0 && found.damaged == 1);
    journal_close(&j);
    support_remove(folder);
}

/* A journal that is cut at any byte has the records before the cut. */
static void test_journal_cut_anywhere(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    char all[512];
    journal_found found;
    snprintf(path, sizeof path, "%s/run.journal", folder);
    for (off_t size = 0; size < 60; size++) {
        unlink(path);
        journal *j = open_good(path, all, &found);
        journal_append(j, "a", "first text");
        journal_append(j, "b", "second text");
        journal_append(j, "c", "third text");
        journal_close(&j);
        assert_int_equal(truncate(path, size), 0);
        j = open_good(path, all, &found);
        journal_append(j, "d", "x");
        journal_close(&j);
        j = open_good(path, all, &found);
        const size_t whole = (size >= 22) + (size >= 45);
        assert_true(found.records == whole + 1 && found.damaged == 0 && found.cut == 0);
        journal_close(&j);
    }
    support_remove(folder);
}

static void test_not_a_journal(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    char all[512] = "";
    char *problem = NULL;
    journal *j = NULL;
    journal_found found;
    snprintf(path, sizeof path, "%s/readings.csv", folder);
    write_file(path, "w", "theta_i,phi_i\n1,2\n");
    assert_int_equal(journal_open(path, gather, all, &found, &j, &problem), GONIO_ERROR_FORMAT);
    assert_non_null(strstr(problem, "not the journal"));
    free(problem);
    /* Nor is a file without a line end, which stays as it is. */
    static const char *const others[] = {"{\"a\": 1}", "12345678", "0123abcd{",
                                         "abcdef01 li\x01ne"};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        write_file(path, "w", others[k]);
        const bool begun = k == 1; /* only this may be the beginning of a journal */
        problem = NULL;
        assert_int_equal(journal_open(path, gather, all, &found, &j, &problem),
                         begun ? GONIO_OK : GONIO_ERROR_FORMAT);
        struct stat about;
        assert_int_equal(stat(path, &about), 0);
        assert_int_equal(about.st_size, begun ? 0 : strlen(others[k]));
        if (begun) {
            journal_close(&j);
        }
        free(problem);
    }
    support_remove(folder);
}

/* ---- a file that grows ---- */

static void test_growing_file(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    line_source s;
    snprintf(path, sizeof path, "%s/robot.csv", folder);
    line_source_begin(&s, path);
    assert_int_equal(line_source_read(&s), LINE_NONE);
    write_file(path, "w", "one\r\ntw");
    assert_int_equal(line_source_read(&s), LINE_READY);
    assert_string_equal(line_source_next(&s), "one");
    assert_null(line_source_next(&s));
    assert_int_equal(line_source_pending(&s), 2);
    assert_int_equal(line_source_read(&s), LINE_NONE);
    write_file(path, "a", "o\nthree\n");
    assert_int_equal(line_source_read(&s), LINE_READY);
    assert_string_equal(line_source_next(&s), "two");
    assert_string_equal(line_source_next(&s), "three");
    assert_int_equal(s.line, 3);
    write_file(path, "w", "new\n");
    assert_int_equal(line_source_read(&s), LINE_READY);
    assert_true(s.renewed);
    assert_string_equal(line_source_next(&s), "new");
    assert_int_equal(s.line, 1);
    line_source_end(&s);
    support_remove(folder);
}

/* ---- commands ---- */

static void test_values_of_commands(void **state)
{
    (void)state;
    static const struct {
        const char *output;
        const char *names;
        const char *values;
        const char *problem;
    } cases[] = {
        {"0.25\n", "value_per_sr", "0.25", NULL},
        {" 0.1 0.2\t0.3 \r\n", "R_per_sr;G_per_sr;B_per_sr", "0.1;0.2;0.3", NULL},
        {"0.1, 0.2, 0.3\n", "R_per_sr;G_per_sr;B_per_sr", "0.1;0.2;0.3", NULL},
        {"0,1;0,2;0,3\n", "R_per_sr;G_per_sr;B_per_sr", "0,1;0,2;0,3", NULL},
        {"0,1 0,2 0,3\n", "R_per_sr;G_per_sr;B_per_sr", "0,1;0,2;0,3", NULL},
        {"400nm_per_sr 500nm_per_sr\n1e-3 2e-3\n", "400nm_per_sr;500nm_per_sr", "1e-3;2e-3", NULL},
        {"0,25\n", NULL, NULL, "neither one value nor R, G, B"},
        {"door open\n", NULL, NULL, "no values"},
        {"a;b\nc;d\n", NULL, NULL, "no numbers"},
        {"", NULL, NULL, "no values"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *names = NULL;
        char *values = NULL;
        char *problem = NULL;
        command_source_values(cases[k].output, &names, &values, &problem);
        if (cases[k].problem != NULL) {
            assert_true(problem != NULL && strstr(problem, cases[k].problem) != NULL);
            assert_true(names == NULL && values == NULL);
        } else {
            assert_null(problem);
            assert_string_equal(names, cases[k].names);
            assert_string_equal(values, cases[k].values);
        }
        free(names);
        free(values);
        free(problem);
    }
}

static void test_commands(void **state)
{
    (void)state;
    static const double at[4] = {30.0, 0.0, 45.5, 180.0};
    char *output = NULL;
    char *problem = NULL;
    command_source_run("echo value: ", at, NULL, 0, &output, &problem);
    assert_string_equal(output, "value: 30.000000000 0.000000000 45.500000000 180.000000000\n");
    assert_null(problem);
    free(output);
    command_source_run("echo", at, at, 2, &output, &problem);
    assert_string_equal(output, "30.000000000 0.000000000 45.500000000 180.000000000 "
                                "30.000000000 0.000000000\n");
    assert_null(problem);
    free(output);
    command_source_run("exit 3;", at, NULL, 0, &output, &problem);
    assert_non_null(strstr(problem, "code 3"));
    free(output);
    free(problem);
}

/* ---- runs ---- */

static const double PLAN[4][4] = {
    {30, 0, 30, 180}, {30, 0, 50, 180}, {60, 0, 20, 90}, {10, 0, 70, 170}};

#define NAMES "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value_per_sr,time_s"

static void begin(run *r)
{
    gonio_readings *plan = made_directions(PLAN, 4);
    const gonio_readings_options how = {
        .size = sizeof how, .values_needed = true, .negative_to_zero = true};
    assert_int_equal(run_begin(r, plan, &how, "robot.csv"), GONIO_OK);
    gonio_readings_free(&plan);
}

static run_fate take(run *r, size_t line, const char *text)
{
    gonio_status status = GONIO_OK;
    const run_fate fate = run_take(r, line, (double)line, text, &status);
    assert_int_equal(status, GONIO_OK);
    return fate;
}

static void test_run(void **state)
{
    (void)state;
    run r;
    begin(&r);
    assert_true(run_left(&r) == 4 && run_next(&r) == 0);
    assert_int_equal(take(&r, 1, "# robot 7"), RUN_KNOWN);
    assert_int_equal(take(&r, 2, NAMES), RUN_KNOWN);
    assert_int_equal(take(&r, 3, "deg,deg,deg,deg,1/sr,s"), RUN_KNOWN);
    assert_int_equal(take(&r, 4, "30,90,30,270,0.5,10"), RUN_READING); /* turned */
    assert_true(r.row[0].wanted == 0 && run_next(&r) == 1);
    assert_int_equal(take(&r, 5, "60,0,20.3,-90,0.2,20"), RUN_READING); /* mirrored */
    assert_true(r.row[1].wanted == 2 && r.unordered == 1);
    assert_int_equal(take(&r, 6, "30,0,50,180,half"), RUN_UNCLEAR);
    if (strstr(r.problem, "robot.csv:6") == NULL) {
        fail_msg("%s", r.problem);
    }
    assert_int_equal(take(&r, 7, "60,0,20.3,-90,0.2,20"), RUN_COPY);
    assert_int_equal(take(&r, 5, "60,0,20.3,-90,0.2,20"), RUN_KNOWN);
    assert_int_equal(take(&r, 8, "5,0,5,0,0.3,15"), RUN_READING);
    assert_true(r.row[2].wanted == RUN_NOWHERE && r.backwards == 1);
    assert_true(run_left(&r) == 2 && run_counted(&r) == 3);
    assert_true(r.unclear == 1 && r.copies == 1);
    run_end(&r);
}

/* A direction that is read again unasked counts twice, and other values are noted. */
static void test_read_again(void **state)
{
    (void)state;
    run r;
    size_t open[4];
    begin(&r);
    take(&r, 1, NAMES);
    take(&r, 2, "30,0,30,180,0.5,10");
    take(&r, 3, "30,0,30,180,0.51,20");
    assert_true(r.row[1].unlike == RUN_NOWHERE && run_unread(&r) == 3);
    take(&r, 4, "30,0,30,180,0.7,30");
    assert_true(r.row[2].unlike == 1 && run_counted(&r) == 3);
    assert_true(run_ask(&r, 0) && run_left(&r) == 4 && run_unread(&r) == 3);
    assert_int_equal(run_list_open(&r, open), 4);
    assert_true(open[0] == 0 && open[1] == 1 && open[2] == 2 && open[3] == 3);
    run_end(&r);
}

/* A reading that is asked for again takes the place of the first if it differs. */
static void test_repeats(void **state)
{
    (void)state;
    run r;
    begin(&r);
    take(&r, 1, NAMES);
    take(&r, 2, "30,0,30,180,5,1");
    take(&r, 3, "30,0,50,180,1,2");
    assert_true(run_ask(&r, 0) && run_ask(&r, 1) && !run_ask(&r, 0));
    assert_true(run_left(&r) == 4 && run_next(&r) == 0);
    take(&r, 4, "30,0,30,180,0.5,3");
    assert_true(r.row[0].set_aside && run_next(&r) == 1);
    take(&r, 5, "30,0,50,180,1,2"); /* the same numbers, as an answer */
    assert_true(!r.row[1].set_aside && run_next(&r) == 2 && r.rows == 4);
    assert_true(!run_ask(&r, 1) && run_counted(&r) == 3);
    size_t size = 0;
    char *text = run_text(&r, &size, NULL);
    assert_string_equal(text, NAMES "\n30,0,50,180,1,2\n30,0,30,180,0.5,3\n30,0,50,180,1,2\n");
    free(text);
    static const double other[1][4] = {{45, 0, 45, 180}};
    assert_int_equal(run_replace(&r, other, 1), GONIO_OK);
    assert_true(run_left(&r) == 1 && run_next(&r) == 4);
    run_end(&r);
}

/* Names that cannot be understood end a run. Marked rows are no readings of a direction. */
static void test_names_and_marks(void **state)
{
    (void)state;
    run r;
    begin(&r);
    assert_int_equal(take(&r, 1, "alpha,beta,value_per_sr"), RUN_USELESS);
    assert_non_null(strstr(r.problem, "theta_i_deg"));
    run_end(&r);
    begin(&r);
    take(&r, 1, "sep=;");
    take(&r, 2, "theta_i;phi_i;theta_o;phi_o;mark;brdf");
    assert_int_equal(take(&r, 3, "30;0;30;180;reference;0,9"), RUN_READING);
    assert_int_equal(take(&r, 4, "30;0;30;180;;0,25"), RUN_READING);
    assert_true(run_left(&r) == 3 && run_counted(&r) == 1 && r.row[1].value[0] == 0.25);
    run_end(&r);
}

/* ---- runs of many lines ---- */

/* The largest difference of an angle, degrees; the azimuth between counts by the sines. */
static double off(const double a[4], const double b[4])
{
    const double between_a = fabs(remainder(a[3] - a[1], 360.0));
    const double between_b = fabs(remainder(b[3] - b[1], 360.0));
    const double sine = fmin(sin(a[0] * M_PI / 180.0), sin(a[2] * M_PI / 180.0));
    return fmax(sine * fabs(between_a - between_b), fmax(fabs(a[0] - b[0]), fabs(a[2] - b[2])));
}

static double least_off(const double (*plan)[4], size_t count, const double at[4])
{
    double least = INFINITY;
    for (size_t k = 0; k < count; k++) {
        least = fmin(least, off(at, plan[k]));
    }
    return least;
}

/* Each line of many finds the nearest of many directions, wherever in the plan that is. */
static void test_nearest_of_many(void **state)
{
    (void)state;
    enum { WANTED = 500, LINES = 1500 };
    static double plan[WANTED][4];
    gonio_i_random random;
    size_t reached = 0;
    run r;
    gonio_i_random_seed(&random, 7, 0);
    for (size_t k = 0; k < WANTED; k++) {
        plan[k][0] = 12.0 * gonio_i_random_uniform(&random);
        plan[k][2] = 77.5 + 12.0 * gonio_i_random_uniform(&random);
        plan[k][3] = 30.0 * gonio_i_random_uniform(&random);
    }
    gonio_readings *directions = made_directions((const double(*)[4])plan, WANTED);
    const gonio_readings_options how = {.size = sizeof how, .values_needed = true};
    assert_int_equal(run_begin(&r, directions, &how, "robot.csv"), GONIO_OK);
    take(&r, 1, NAMES);
    for (size_t k = 0; k < LINES; k++) {
        const double at[4] = {13.0 * gonio_i_random_uniform(&random), 0.0,
                              76.5 + 13.0 * gonio_i_random_uniform(&random), 15.0};
        char line[128];
        snprintf(line, sizeof line, "%.15g,0,%.15g,15,%zu,%zu", at[0], at[2], k + 1, k);
        assert_int_equal(take(&r, k + 2, line), RUN_READING);
        const double least = least_off((const double(*)[4])plan, WANTED, at);
        const size_t wanted = r.row[k].wanted;
        assert_true(wanted == RUN_NOWHERE ? least > 1.0 : off(at, plan[wanted]) < least + 1e-5);
        reached += wanted != RUN_NOWHERE;
    }
    assert_true(reached > LINES / 10 && reached < LINES && r.copies == 0 && r.backwards == 0);
    assert_int_equal(take(&r, 2 * LINES, r.row[LINES / 2].text), RUN_COPY);
    gonio_readings_free(&directions);
    run_end(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_journal),
        cmocka_unit_test(test_journal_cut_anywhere),
        cmocka_unit_test(test_not_a_journal),
        cmocka_unit_test(test_growing_file),
        cmocka_unit_test(test_values_of_commands),
        cmocka_unit_test(test_commands),
        cmocka_unit_test(test_run),
        cmocka_unit_test(test_read_again),
        cmocka_unit_test(test_repeats),
        cmocka_unit_test(test_names_and_marks),
        cmocka_unit_test(test_nearest_of_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
