/* Plans for an instrument: what it reaches, in an order of little time, within a time. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "made_basis.h"

enum { READINGS = 9, MOST_EACH = 4 };

typedef struct fixture {
    gonio_context *context;
    gonio_basis *basis;
    gonio_instrument *rig;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    f.context = support_context();
    f.basis = made_basis(f.context, GONIO_BIVARIATE, GONIO_SEPARATE, 1);
    assert_int_equal(gonio_instrument_read(f.context, "four-axis", &f.rig), GONIO_OK);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_instrument_free(&f->rig);
    gonio_basis_free(&f->basis);
    gonio_context_free(&f->context);
    return 0;
}

/* ---- orders ---- */

typedef struct instance {
    gonio_setting setting[READINGS * MOST_EACH];
    size_t first[READINGS + 1];
} instance;

/* Readings drawn from what the rig offers, each at up to four settings. */
static void draw_instance(const fixture *f, const gonio_setting *offered, size_t count,
                          unsigned *seed, instance *i)
{
    const gonio_freedom all = GONIO_ALL_FREEDOM;
    memset(i, 0, sizeof *i);
    for (size_t k = 0; k < READINGS; k++) {
        *seed = *seed * 1103515245u + 12345u;
        const gonio_pair pair = offered[(*seed >> 8) % count].pair;
        const size_t n =
            gonio_instrument_settings(f->rig, pair, all, i->setting + i->first[k], MOST_EACH);
        assert_true(n > 0);
        i->first[k + 1] = i->first[k] + n;
    }
}

static size_t reading_of(const instance *i, size_t setting)
{
    size_t k = 0;
    while (setting >= i->first[k + 1]) {
        k++;
    }
    return k;
}

/* The least travel, over all orders and settings (Held and Karp 1962). */
static double least_travel(const fixture *f, const instance *i)
{
    enum { SETS = 1 << READINGS };
    const size_t n = i->first[READINGS];
    double *least = malloc(SETS * n * sizeof *least);
    gonio_setting home;
    double best = INFINITY;
    assert_non_null(least);
    gonio_instrument_home(f->rig, &home);
    for (size_t set = 1; set < SETS; set++) {
        for (size_t to = 0; to < n; to++) {
            const size_t rest = set & ~((size_t)1 << reading_of(i, to));
            double time =
                rest == 0 ? gonio_instrument_travel(f->rig, &home, &i->setting[to]) : INFINITY;
            for (size_t from = 0; from < n && rest != 0; from++) {
                if (rest >> reading_of(i, from) & 1) {
                    time = fmin(time, least[rest * n + from] +
                                          gonio_instrument_travel(f->rig, &i->setting[from],
                                                                  &i->setting[to]));
                }
            }
            least[set * n + to] = rest == set ? INFINITY : time;
        }
    }
    for (size_t to = 0; to < n; to++) {
        best = fmin(best, least[(SETS - 1) * n + to]);
    }
    free(least);
    return best;
}

static double travel_of(const fixture *f, const gonio_setting *setting, size_t count)
{
    gonio_setting at;
    double sum = 0.0;
    gonio_instrument_home(f->rig, &at);
    for (size_t k = 0; k < count; k++) {
        sum += gonio_instrument_travel(f->rig, &at, &setting[k]);
        at = setting[k];
    }
    return sum;
}

static void test_orders_of_few_readings_are_the_best(void **state)
{
    fixture *f = *state;
    const gonio_freedom all = GONIO_ALL_FREEDOM;
    gonio_setting *offered = NULL;
    size_t count = 0;
    unsigned seed = 7;
    double worst = 1.0;
    assert_int_equal(gonio_instrument_candidates(f->context, f->rig, all, 2000, &offered, &count),
                     GONIO_OK);
    for (int trial = 0; trial < (support_small() ? 3 : 12); trial++) {
        instance i;
        size_t order[READINGS];
        gonio_setting chosen[READINGS];
        bool seen[READINGS] = {false};
        draw_instance(f, offered, count, &seed, &i);
        assert_int_equal(gonio_instrument_order(f->context, f->rig, i.setting, i.first, READINGS,
                                                NULL, order, chosen),
                         GONIO_OK);
        for (size_t k = 0; k < READINGS; k++) {
            assert_false(seen[order[k]]);
            seen[order[k]] = true;
        }
        worst = fmax(worst, travel_of(f, chosen, READINGS) / least_travel(f, &i));
    }
    print_message("the worst order takes %.4f of the least time\n", worst);
    assert_true(worst > 0.999999 && worst < 1.05);
    free(offered);
}

static void test_orders_refuse_readings_without_settings(void **state)
{
    fixture *f = *state;
    const size_t first[2] = {0, 0};
    gonio_setting setting = {{{0.0, 0.0}, {0.0, 0.0}}, {0.0}};
    size_t order = 0;
    assert_int_equal(
        gonio_instrument_order(f->context, f->rig, &setting, first, 1, NULL, &order, &setting),
        GONIO_ERROR_ARGUMENT);
}

/* ---- plans ---- */

static gonio_plan *make_plan(const fixture *f, const gonio_plan_options *options)
{
    gonio_plan *plan = NULL;
    const gonio_status status = gonio_plan_create(f->context, f->basis, options, &plan);
    if (status != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    return plan;
}

static gonio_plan_options options_of(const fixture *f)
{
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.method = "expected-error";
    options.instrument = f->rig;
    options.count = 12;
    return options;
}

static void check_run(const fixture *f, const gonio_plan *plan)
{
    const gonio_plan_run *run = plan->run;
    double share = 0.0;
    for (size_t k = 0; k < plan->count; k++) {
        assert_null(gonio_instrument_obstacle(f->rig, &run->setting[k]));
        assert_true(run->time[k] > (k > 0 ? run->time[k - 1] : 0.0));
        assert_true(k == 0 || plan->expected[k] <= plan->expected[k - 1] + 1e-9);
        assert_memory_equal(&plan->entries[k].pair, &run->setting[k].pair, sizeof(gonio_pair));
    }
    for (size_t k = 0; k < run->parts; k++) {
        share += run->part[k].share;
        assert_true(run->part[k].deviation >= 0.0);
    }
    assert_true(fabs(share - 1.0) < 1e-9);
    assert_string_equal(run->part[0].obstacle, "");
    assert_true(run->duration == run->time[plan->count - 1]);
    assert_true(run->duration <= run->unordered + 1e-9);
}

static void test_plans_keep_to_the_reach(void **state)
{
    fixture *f = *state;
    gonio_plan_options options = options_of(f);
    gonio_plan *plan = make_plan(f, &options);
    assert_int_equal(plan->count, 12);
    check_run(f, plan);
    options.nested = true;
    gonio_plan *nested = make_plan(f, &options);
    check_run(f, nested);
    assert_true(nested->run->duration >= plan->run->duration - 1e-9);
    gonio_plan_free(&nested);
    gonio_plan_free(&plan);
}

static void test_plans_keep_to_the_time(void **state)
{
    fixture *f = *state;
    gonio_plan_options options = options_of(f);
    options.count = 40;
    options.budget = 240.0;
    gonio_plan *plan = make_plan(f, &options);
    check_run(f, plan);
    print_message("%zu readings in %.0f s\n", plan->count, plan->run->duration);
    assert_true(plan->run->duration <= 240.0 && plan->count > 3 && plan->count <= 40);
    gonio_plan_free(&plan);
    options.budget = 5.0;
    assert_int_equal(gonio_plan_create(f->context, f->basis, &options, &plan),
                     GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), "no reading fits"));
}

/* Up to all that there is to read: no other number limits a run. */
static void test_plans_use_the_time(void **state)
{
    fixture *f = *state;
    const gonio_freedom all = GONIO_ALL_FREEDOM;
    gonio_setting *offered = NULL;
    gonio_instrument *rig = NULL;
    size_t count = 0;
    const char *text =
        "{\"gonio_instrument\": 1, \"kinematics\": \"in-plane\", \"axes\": {\"incidence\": "
        "{\"positions_deg\": [10, 40, 65]}, \"detector\": {\"from_deg\": -80, \"to_deg\": 80, "
        "\"step_deg\": 4, \"speed_deg_per_s\": 10}}, \"times\": {\"exposure_s\": 1, "
        "\"incidence_change_s\": 10}}";
    assert_int_equal(gonio_instrument_parse(f->context, text, "rig.json", &rig), GONIO_OK);
    assert_int_equal(gonio_instrument_candidates(f->context, rig, all, 10000, &offered, &count),
                     GONIO_OK);
    gonio_plan_options options = options_of(f);
    options.instrument = rig;
    options.count = GONIO_USUAL_COUNT;
    options.budget = 3600.0;
    gonio_plan *plan = make_plan(f, &options);
    assert_int_equal(plan->count, count);
    const double whole = plan->run->duration;
    gonio_plan_free(&plan);
    options.budget = 0.5 * whole;
    plan = make_plan(f, &options);
    print_message("%zu of %zu readings in %.1f s of %.1f\n", plan->count, count,
                  plan->run->duration, options.budget);
    assert_true(plan->run->duration <= options.budget &&
                plan->run->duration > 0.95 * options.budget);
    gonio_plan_free(&plan);
    gonio_instrument_free(&rig);
    free(offered);
}

static void test_options_that_contradict(void **state)
{
    fixture *f = *state;
    const gonio_pair pair = {{0.1, 0.0}, {0.2, 0.0}};
    gonio_plan *plan = NULL;
    gonio_plan_options options = options_of(f);
    options.candidates = &pair;
    options.candidate_count = 1;
    assert_int_equal(gonio_plan_create(f->context, f->basis, &options, &plan),
                     GONIO_ERROR_ARGUMENT);
    options = options_of(f);
    options.instrument = NULL;
    options.budget = 60.0;
    assert_int_equal(gonio_plan_create(f->context, f->basis, &options, &plan),
                     GONIO_ERROR_ARGUMENT);
    options = options_of(f);
    options.method = "random";
    assert_int_equal(gonio_plan_create(f->context, f->basis, &options, &plan),
                     GONIO_ERROR_ARGUMENT);
    options = options_of(f);
    options.budget = 60.0;
    options.target = 3.0;
    assert_int_equal(gonio_plan_create(f->context, f->basis, &options, &plan),
                     GONIO_ERROR_ARGUMENT);
    assert_null(plan);
}

/* The file has the axes and the time, and is read as any plan. */
static void test_plan_files_have_axes(void **state)
{
    fixture *f = *state;
    char *folder = support_folder();
    char path[256];
    char text[4096];
    gonio_readings *readings = NULL;
    const gonio_readings_options how = {.size = sizeof how};
    const gonio_plan_options options = options_of(f);
    gonio_plan *plan = make_plan(f, &options);
    snprintf(path, sizeof path, "%s/plan.csv", folder);
    assert_int_equal(gonio_plan_write(f->context, plan, NULL, path), GONIO_OK);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    assert_non_null(strstr(text, "# instrument: four-axis goniometer\n"));
    assert_non_null(strstr(text, "axis_beta_deg,axis_gamma_deg,axis_delta_deg,time_s\n"));
    assert_int_equal(gonio_readings_read(f->context, path, &how, &readings), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, plan->count);
    assert_non_null(view->time);
    assert_true(fabs(view->time[3] - plan->run->time[3]) < 0.06);
    gonio_readings_free(&readings);
    gonio_plan_free(&plan);
    support_remove(folder);
}

/* Without noise the readings of a matt material come back, in the instrument's unit; the mirror
 * peak is flattened by the apertures. */
static void test_rehearsed_runs(void **state)
{
    fixture *f = *state;
    char *folder = support_folder();
    char path[256];
    gonio_instrument *rig = NULL;
    gonio_readings *plan = NULL;
    gonio_readings *read = NULL;
    gonio_readings *plain = NULL;
    gonio_material *gold = NULL;
    size_t channels = 0;
    double duration = 0.0;
    const gonio_pair pairs[2] = {{{0.5, 0.0}, {0.9, 0.0}}, {{0.5, 0.0}, {0.5, M_PI}}};
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = 2, .channels = 3, .pair = pairs};
    const gonio_readings_options how = {.size = sizeof how, .values_needed = true};
    const char *text =
        "{\"gonio_instrument\": 1, \"kinematics\": \"in-plane\", \"values\": \"factor-cosine\", "
        "\"axes\": {\"incidence\": {\"from_deg\": 0, \"to_deg\": 80}, \"detector\": "
        "{\"from_deg\": -80, \"to_deg\": 80, \"speed_deg_per_s\": 10}}, "
        "\"apertures\": {\"detector_half_angle_deg\": 2}, \"times\": {\"exposure_s\": 1}}";
    snprintf(path, sizeof path, "%s/run.csv", folder);
    assert_int_equal(gonio_instrument_parse(f->context, text, "rig.json", &rig), GONIO_OK);
    assert_int_equal(gonio_material_open(f->context, "atlas:gold-polished", &gold), GONIO_OK);
    assert_int_equal(gonio_readings_create(f->context, &arrays, NULL, &plan), GONIO_OK);
    assert_int_equal(
        gonio_rehearse(f->context, plan, gold, rig, 1, NULL, path, &duration, &channels), GONIO_OK);
    assert_int_equal(channels, 3);
    assert_true(duration > 2.0);
    assert_int_equal(gonio_readings_read(f->context, path, &how, &read), GONIO_OK);
    assert_int_equal(gonio_readings_copy(f->context, plan, &plain), GONIO_OK);
    assert_int_equal(gonio_measure_material(f->context, plain, gold, NULL), GONIO_OK);
    const double away = gonio_readings_value(read, 0, 0) / gonio_readings_value(plain, 0, 0);
    const double peak = gonio_readings_value(read, 1, 0) / gonio_readings_value(plain, 1, 0);
    print_message("away from the peak %.3f, at the peak %.3f\n", away, peak);
    assert_true(fabs(away - 1.0) < 0.2 && peak < 0.9);
    assert_true(gonio_readings_describe(read)->time[1] > gonio_readings_describe(read)->time[0]);
    gonio_readings_free(&plain);
    gonio_readings_free(&read);
    gonio_readings_free(&plan);
    gonio_material_free(&gold);
    gonio_instrument_free(&rig);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orders_of_few_readings_are_the_best),
        cmocka_unit_test(test_orders_refuse_readings_without_settings),
        cmocka_unit_test(test_plans_keep_to_the_reach),
        cmocka_unit_test(test_plans_keep_to_the_time),
        cmocka_unit_test(test_plans_use_the_time),
        cmocka_unit_test(test_options_that_contradict),
        cmocka_unit_test(test_plan_files_have_axes),
        cmocka_unit_test(test_rehearsed_runs)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
