/* Plans and their histories as files: what is written is what is read again. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <gonio/gonio.h>

#include "made_basis.h"

enum { COUNT = 6, RESTARTS = 2 };

typedef struct fixture {
    gonio_context *context;
    gonio_basis *basis;
    char *folder;
    char path[256];
} fixture;

static int set_up(void **state)
{
    static fixture f;
    f.context = support_context();
    f.basis = made_basis(f.context, GONIO_BIVARIATE, GONIO_SEPARATE, 1);
    f.folder = support_folder();
    snprintf(f.path, sizeof f.path, "%s/plan.csv", f.folder);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    support_remove(f->folder);
    gonio_basis_free(&f->basis);
    gonio_context_free(&f->context);
    return 0;
}

static gonio_plan *make_plan(const fixture *f, const char *method)
{
    gonio_plan_options options;
    gonio_plan *plan = NULL;
    gonio_plan_options_default(&options);
    options.method = method;
    options.count = COUNT;
    options.components = strcmp(method, "condition") == 0 ? 3 : 0;
    options.restarts = RESTARTS;
    assert_int_equal(gonio_plan_create(f->context, f->basis, &options, &plan), GONIO_OK);
    return plan;
}

static void assert_same_directions(const gonio_readings_view *view, const gonio_plan *plan)
{
    assert_int_equal(view->count, plan->count);
    for (size_t k = 0; k < view->count; k++) {
        const gonio_pair *planned = &plan->entries[k].pair;
        assert_true(fabs(view->pair[k].incident.theta - planned->incident.theta) < 1e-10);
        assert_true(fabs(view->pair[k].incident.phi - planned->incident.phi) < 1e-10);
        assert_true(fabs(view->pair[k].outgoing.theta - planned->outgoing.theta) < 1e-10);
        assert_true(fabs(view->pair[k].outgoing.phi - planned->outgoing.phi) < 1e-10);
        assert_int_equal(view->planned[k], plan->entries[k].channel);
    }
}

static void test_plans_come_back(void **state)
{
    fixture *f = *state;
    static const char *const methods[] = {"condition", "expected-error"};
    const gonio_readings_options how = {.size = sizeof how, .average_repeats = true};
    for (size_t k = 0; k < 2; k++) {
        gonio_plan *plan = make_plan(f, methods[k]);
        gonio_readings *readings = NULL;
        assert_int_equal(gonio_plan_write(f->context, plan, "a command", f->path), GONIO_OK);
        assert_int_equal(gonio_readings_read(f->context, f->path, &how, &readings), GONIO_OK);
        const gonio_readings_view *view = gonio_readings_describe(readings);
        assert_same_directions(view, plan);
        assert_true(view->basis == gonio_basis_describe(f->basis)->fingerprint);
        assert_int_equal(view->components, k == 0 ? 3 : 0);
        assert_string_equal(view->method, methods[k]);
        gonio_readings_free(&readings);
        gonio_plan_free(&plan);
    }
}

/* A line a step, the best of them the plan's own condition number. */
static void test_the_history_of_a_plan(void **state)
{
    fixture *f = *state;
    gonio_plan *plan = make_plan(f, "condition");
    assert_int_equal(gonio_plan_write_history(f->context, plan, NULL, f->path), GONIO_OK);
    FILE *file = fopen(f->path, "r");
    assert_non_null(file);
    char line[256];
    size_t steps = 0;
    int last = -1;
    double best = INFINITY;
    while (fgets(line, sizeof line, file) != NULL) {
        int restart = -1, swap = -1;
        double condition = -1.0;
        if (sscanf(line, "%d,%d,%lf", &restart, &swap, &condition) == 3) {
            assert_true(restart >= last && restart < RESTARTS && swap >= 0 && condition >= 1.0);
            best = fmin(best, condition);
            last = restart;
            steps++;
        }
    }
    fclose(file);
    assert_int_equal(steps, plan->steps);
    assert_int_equal(last, RESTARTS - 1);
    assert_true(fabs(best / plan->condition_number - 1.0) < 1e-8);
    gonio_plan_free(&plan);
}

static void test_files_that_cannot_be_written(void **state)
{
    fixture *f = *state;
    gonio_plan *plan = make_plan(f, "condition");
    const char *nowhere = "/nonexistent/plan.csv";
    assert_int_equal(gonio_plan_write(f->context, plan, NULL, nowhere), GONIO_ERROR_IO);
    assert_int_equal(gonio_plan_write_history(f->context, plan, NULL, nowhere), GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), nowhere));
    plan->entries[1].channel = GONIO_CHANNELS;
    assert_int_equal(gonio_plan_write(f->context, plan, NULL, f->path), GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), "entry 2 of the plan reads channel 3"));
    gonio_plan_free(&plan);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plans_come_back),
        cmocka_unit_test(test_the_history_of_a_plan),
        cmocka_unit_test(test_files_that_cannot_be_written),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
