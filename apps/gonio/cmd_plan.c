/* gonio plan: where to measure. */
#include "builtin_basis.h"
#include "command_line.h"
#include "json_output.h"
#include "inputs.h"
#include "plan_run.h"
#include "planning_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct options {
    const char *output;
    const char *history;
    const char *method;
    const char *start;
    int components;
    int restarts;
    long seed;
    double phi_d; /* degrees */
    planning_options planning;
} options;

static int report(const tool *t, const gonio_plan *plan, const options *o)
{
    if (tool_json) {
        const double expected = plan->expected != NULL ? plan->expected[plan->count - 1] : INFINITY;
        json_t *json =
            json_pack("{s:o, s:s, s:I, s:I, s:o, s:o}", "plan", tool_json_text(o->output), "method",
                      plan->method, "readings", (json_int_t)plan->count, "components",
                      (json_int_t)plan->components, "condition_number",
                      tool_json_number(plan->condition_number), "expected_e6_percent",
                      tool_json_number(expected));
        plan_run_add_json(plan, json);
        return tool_print_json(t, json);
    }
    if (!tool_quiet && plan->run != NULL) {
        plan_run_print(plan, o->output);
    } else if (!tool_quiet && plan->expected != NULL) {
        fprintf(tool_results(), "%s: %zu reading%s, in order of use; expected error (E6) %.2f %%\n",
                o->output, plan->count, tool_plural(plan->count), plan->expected[plan->count - 1]);
    } else if (!tool_quiet) {
        fprintf(tool_results(), "%s: %zu reading%s for %zu component%s, condition number %.3f\n",
                o->output, plan->count, tool_plural(plan->count), plan->components,
                tool_plural(plan->components), plan->condition_number);
    }
    return 0;
}

static gonio_status make_plan(tool *t, const options *o, const char *basis_path, gonio_plan **plan)
{
    gonio_basis *basis = NULL;
    gonio_plan_options how;
    gonio_plan_options_default(&how);
    how.method = o->method;
    how.start = o->start;
    how.components = (size_t)o->components;
    how.restarts = o->restarts;
    how.seed = (uint64_t)o->seed;
    how.keep_history = o->history != NULL;
    how.phi_d = o->phi_d * M_PI / 180.0;
    planning_inputs inputs;
    gonio_status status = planning_options_apply(t, &o->planning, &how, &inputs);
    if (status == GONIO_OK) {
        status = tool_basis(t, basis_path, o->method, &basis);
    }
    if (status == GONIO_OK) {
        status = gonio_plan_create(t->context, basis, &how, plan);
    }
    gonio_basis_free(&basis);
    planning_inputs_free(&inputs);
    return status;
}

static bool check(const tool *t, const options *o, size_t count, const char **arguments)
{
    if (count > 1) {
        return tool_refuse(t, "give at most one BASIS, not %zu", count);
    }
    if (!tool_check_output(t, o->output, arguments, count) ||
        (o->history != NULL && (!tool_check_output(t, o->history, arguments, count) ||
                                !tool_check_output(t, o->history, &o->planning.candidates, 1)))) {
        return false;
    }
    if (o->history != NULL && tool_is_one_output(o->history, o->output)) {
        return tool_refuse(t, "--history and -o name the same file");
    }
    if (o->planning.anisotropic && o->method != NULL && strcmp(o->method, "expected-error") != 0) {
        return tool_refuse(t, "--anisotropic needs --method expected-error");
    }
    return planning_options_check(t, &o->planning, o->output) &&
           tool_check_count(t, "--restarts", o->restarts, 1) &&
           tool_check_count(t, "--components", o->components, 0);
}

/* The plan and its history, both or none. */
static gonio_status write_files(tool *t, const options *o, const gonio_plan *plan)
{
    gonio_status status = gonio_outputs_hold(t->context);
    if (status == GONIO_OK && o->history != NULL) {
        status = gonio_plan_write_history(t->context, plan, t->command_line, o->history);
    }
    if (status == GONIO_OK) {
        status = gonio_plan_write(t->context, plan, t->command_line, o->output);
    }
    return gonio_outputs_release(t->context, status);
}

static int run(tool *t, void *given)
{
    const options *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (!check(t, o, count, arguments)) {
        return EXIT_USAGE;
    }
    gonio_plan *plan = NULL;
    gonio_status status = make_plan(t, o, count > 0 ? arguments[0] : NULL, &plan);
    if (status == GONIO_OK) {
        status = write_files(t, o, plan);
    }
    const int code = status == GONIO_OK ? report(t, plan, o) : tool_exit_code(status);
    gonio_plan_free(&plan);
    return code;
}

int cmd_plan(int argc, const char **argv)
{
    gonio_plan_options usual;
    gonio_plan_options_default(&usual);
    options o = {.planning = {.count = PLANNING_USUAL_COUNT},
                 .start = usual.start,
                 .restarts = usual.restarts,
                 .phi_d = usual.phi_d * 180.0 / M_PI};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0, "The plan to write (CSV)", "PLAN"},
        PLANNING_OPTIONS(&o.planning,
                         "Number of readings (default: 80; with --target-error at most 300)",
                         "Plan the fewest readings with at most this expected error (E6), e.g. 3%"),
        {"components", 'K', POPT_ARG_INT, &o.components, 0,
         "Use the first K components (default: all of the basis; nielsen, frost: at most N)", "K"},
        {"method", '\0', POPT_ARG_STRING, &o.method, 0,
         "expected-error (least expected error; the default), condition (lowest condition number, "
         "the paper's; the default for bases without mixtures), random, matusik, nielsen or frost",
         "METHOD"},
        {"start", '\0', POPT_ARG_STRING, &o.start, 0,
         "Readings that the swaps begin with: random (default), qr or volume", "START"},
        {"restarts", '\0', POPT_ARG_INT, &o.restarts, 0,
         "Number of random starts; the best is kept (default: 5)", "N"},
        {"seed", '\0', POPT_ARG_LONG, &o.seed, 0, "Seed of random choices (default: 0)", "N"},
        {"phi-d", '\0', POPT_ARG_DOUBLE, &o.phi_d, 0,
         "phi_d of the readings, if the basis is bivariate (default: 90; 0 is in the plane of "
         "incidence)",
         "DEGREES"},
        {"history", '\0', POPT_ARG_STRING, &o.history, 0,
         "Write the condition number after each swap (CSV)", "FILE"},
        TOOL_READINGS_OPTIONS,
        TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] [BASIS] -o PLAN",
        .text = "Without BASIS, the basis of the built-in materials is used.\n"
                "Example: gonio plan merl.gonio -n 20 -o plan.csv",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
