/* gonio next: where to measure next, given what was read. */
#include "builtin_basis.h"
#include "command_line.h"
#include "json_output.h"
#include "planning_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct options {
    const char *output;
    const char *candidates;
    const char *metric;
    const char *target;
    int count;
    double noise; /* per cent */
    double floor;
    double saturation;
    int no_checks;
    int json;
} options;

/* What gonio_plan_next says; plan: NULL if the target is met. */
typedef struct answer {
    double now;
    const char *suspicion;
    gonio_plan *plan;
} answer;

static int report(const tool *t, const options *o, const answer *a)
{
    const gonio_plan *plan = a->plan;
    if (o->json) {
        return tool_print_json(
            t, json_pack("{s:b, s:f, s:s?, s:I, s:o, s:s?}", "target_met", plan == NULL,
                         "expected_e6_percent", a->now, "plan", plan != NULL ? o->output : NULL,
                         "readings", (json_int_t)(plan != NULL ? plan->count : 0),
                         "expected_then_percent",
                         plan != NULL ? tool_json_number(plan->expected[plan->count - 1])
                                      : json_null(),
                         "suspicion", a->suspicion));
    }
    if (!tool_quiet && plan == NULL) {
        printf("expected error (E6) %.2f %%: the target is met, nothing more to read\n", a->now);
    } else if (!tool_quiet) {
        printf("%s: %zu more reading%s; expected error (E6) now %.2f %%, then %.2f %%\n", o->output,
               plan->count, tool_plural(plan->count), a->now, plan->expected[plan->count - 1]);
    }
    return 0;
}

static gonio_status find_next(tool *t, const options *o, const gonio_basis *basis,
                              const gonio_readings *readings, answer *a)
{
    gonio_reconstruct_options how;
    gonio_plan_options what;
    gonio_pair *candidates = NULL;
    gonio_status status = GONIO_OK;
    gonio_reconstruct_options_default(&how);
    how.noise = o->noise / 100.0;
    how.floor = o->floor;
    how.saturation = o->saturation;
    how.no_checks = o->no_checks;
    gonio_plan_options_default(&what);
    what.count = (size_t)o->count;
    what.metric = (gonio_metric)tool_metric(o->metric);
    what.target = o->target != NULL ? tool_percent(o->target) : 0.0;
    if (o->candidates != NULL) {
        status = tool_candidates(t, o->candidates, &candidates, &what.candidate_count);
        what.candidates = candidates;
    }
    if (status == GONIO_OK) {
        status = gonio_plan_next(t->context, basis, readings, &how, &what, &a->now, &a->suspicion,
                                 &a->plan);
    }
    free(candidates);
    return status;
}

static int next(tool *t, const options *o, const char *basis_path, const char *path)
{
    const gonio_readings_options any = {.values_needed = true, .average_repeats = true};
    gonio_readings *readings = NULL;
    gonio_basis *basis = NULL;
    answer a = {0};
    gonio_status status = gonio_readings_read(t->context, path, &any, &readings);
    if (status == GONIO_OK) {
        status = tool_basis(t, basis_path, NULL, &basis);
    }
    if (status == GONIO_OK) {
        status = find_next(t, o, basis, readings, &a);
    }
    if (status == GONIO_OK) {
        tool_note_suspicion("next", path, a.suspicion);
    }
    if (status == GONIO_OK && a.plan != NULL) {
        status = gonio_plan_write(t->context, a.plan, t->command_line, o->output);
    }
    const int code = status == GONIO_OK ? report(t, o, &a) : tool_exit_code(status);
    gonio_plan_free(&a.plan);
    gonio_basis_free(&basis);
    gonio_readings_free(&readings);
    return code;
}

static int check(const tool *t, const options *o, const char *const *inputs, size_t count)
{
    if (count == 0 || count > 2) {
        return tool_usage_error(t, "READINGS, and before it a BASIS if you have one, are needed");
    }
    int code = tool_check_output(t, o->output, inputs, count);
    if (code == 0) {
        code = tool_check_count(t, "-n", o->count, 1);
    }
    if (code == 0 && tool_metric(o->metric) < 0) {
        code =
            tool_usage_error(t, "--metric: '%s' is none of e6, cube-root, log-relative", o->metric);
    }
    if (code == 0 && o->target != NULL && tool_percent(o->target) < 0.0) {
        code =
            tool_usage_error(t, "--target-error: '%s' is no error in per cent above 0", o->target);
    }
    if (code == 0 && (!(o->noise >= 0.0) || !(o->floor >= 0.0) || !(o->saturation >= 0.0))) {
        code = tool_usage_error(t, "--noise, --floor and --saturation cannot be negative");
    }
    return code == 0 && o->candidates != NULL ? tool_check_output(t, o->output, &o->candidates, 1)
                                              : code;
}

static int run(tool *t, const options *o)
{
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    const int code = check(t, o, arguments, count);
    return code != 0 ? code : next(t, o, count > 1 ? arguments[0] : NULL, arguments[count - 1]);
}

int cmd_next(int argc, const char **argv)
{
    options o = {.count = 5, .metric = "e6", .noise = 1.0, .floor = 1e-5};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0, "The plan to write (CSV)", "PLAN"},
        {"number", 'n', POPT_ARG_INT, &o.count, 0, "How many readings to propose (default: 5)",
         "N"},
        {"target-error", '\0', POPT_ARG_STRING, &o.target, 0,
         "Say so, and propose nothing, once the expected error (E6) is no more than this",
         "PERCENT"},
        {"candidates", '\0', POPT_ARG_STRING, &o.candidates, 0,
         "Choose among the directions of this file", "FILE"},
        {"metric", '\0', POPT_ARG_STRING, &o.metric, 0,
         "The error that is to be small: e6 (default), cube-root or log-relative", "METRIC"},
        {"noise", '\0', POPT_ARG_DOUBLE, &o.noise, 0,
         "Standard deviation of a reading, in per cent of its value (default: 1)", "PERCENT"},
        {"floor", '\0', POPT_ARG_DOUBLE, &o.floor, 0,
         "Standard deviation of a reading of darkness, 1/sr (default: 1e-5)", "VALUE"},
        {"saturation", '\0', POPT_ARG_DOUBLE, &o.saturation, 0,
         "Readings of this value or more mean at least it, 1/sr", "VALUE"},
        {"no-checks", '\0', POPT_ARG_NONE, &o.no_checks, 0,
         "Do not look for usual mistakes nor for a dark level", NULL},
        {"json", '\0', POPT_ARG_NONE, &o.json, 0, "Print the result as JSON", NULL},
        TOOL_OPTIONS};
    tool t;
    int code =
        tool_begin(&t, argc, argv, table, "[OPTION...] [BASIS] READINGS -o PLAN",
                   "Without BASIS, the basis of the built-in materials serves. What was read "
                   "tells what the material is like; the proposed directions are those that "
                   "leave the least expected error of such materials.\n"
                   "Example: gonio next merl.gonio readings.csv -n 5 --target-error 3% "
                   "-o more.csv");
    if (code < 0) {
        code = run(&t, &o);
    }
    tool_end(&t);
    return code;
}
