/* gonio next: where to measure next, given what was read. */
#include "builtin_basis.h"
#include "command_line.h"
#include "correction_options.h"
#include "duration.h"
#include "inputs.h"
#include "interpretation.h"
#include "json_output.h"
#include "plan_run.h"
#include "planning_options.h"
#include "posterior_options.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct options {
    const char *output;
    planning_options planning;
    posterior_options posterior;
    correction_options corrections;
} options;

/* The result of gonio_plan_next. plan: NULL if the target is met. */
typedef struct answer {
    double now;
    gonio_interpretation interpretation;
    gonio_plan *plan;
} answer;

static int report(const tool *t, const options *o, const answer *a)
{
    const gonio_plan *plan = a->plan;
    if (tool_json) {
        json_t *json = json_pack(
            "{s:b, s:f, s:o, s:I, s:o}", "target_met", plan == NULL, "expected_e6_percent", a->now,
            "plan", tool_json_text(plan != NULL ? o->output : NULL), "readings",
            (json_int_t)(plan != NULL ? plan->count : 0), "expected_then_percent",
            plan != NULL ? tool_json_number(plan->expected[plan->count - 1]) : json_null());
        tool_add_interpretation(json, &a->interpretation);
        if (plan != NULL) {
            plan_run_add_json(plan, json);
        }
        return tool_print_json(t, json);
    }
    if (!tool_quiet && plan == NULL) {
        fprintf(tool_results(),
                "expected error (E6) %.2f %%: the target is met, no more readings are needed\n",
                a->now);
    } else if (!tool_quiet) {
        fprintf(tool_results(),
                "%s: %zu more reading%s; expected error (E6) now %.2f %%, then %.2f %%", o->output,
                plan->count, tool_plural(plan->count), a->now, plan->expected[plan->count - 1]);
        if (plan->run != NULL) {
            fputs("; a run of ", tool_results());
            tool_print_duration(tool_results(), plan->run->duration);
        }
        fputc('\n', tool_results());
    }
    return 0;
}

/* How the readings were made: by the instrument that is to go on, if one is named. */
static gonio_reconstruct_options how_of(const options *o, const gonio_instrument *instrument)
{
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    posterior_options_apply(&o->posterior, &how);
    if (instrument != NULL && !o->planning.anisotropic) {
        how.source_aperture = gonio_instrument_describe(instrument)->source_aperture;
        how.detector_aperture = gonio_instrument_describe(instrument)->detector_aperture;
    }
    return how;
}

/* What `next` works on. */
typedef struct next_inputs {
    const char *basis_path, *path;
    gonio_plan_options what;
    planning_inputs planning;
} next_inputs;

static gonio_status find_next(tool *t, const options *o, const next_inputs *in, answer *a)
{
    const gonio_readings_options any = {.size = sizeof any,
                                        .values_needed = true,
                                        .average_repeats = true,
                                        .instrument = in->planning.instrument};
    const gonio_reconstruct_options how = how_of(o, in->planning.instrument);
    gonio_readings *readings = NULL;
    gonio_basis *basis = NULL;
    gonio_status status =
        tool_read_corrected(t, in->path, &any, &o->corrections, o->posterior.noise / 100.0,
                            o->posterior.floor, &readings);
    if (status == GONIO_OK) {
        status = tool_basis(t, in->basis_path, NULL, &basis);
    }
    if (status == GONIO_OK) {
        status = tool_keep_read_channels(t, basis, readings);
    }
    if (status == GONIO_OK) {
        status = gonio_plan_next(t->context, basis, readings, &how, &in->what, &a->now,
                                 &a->interpretation, &a->plan);
    }
    gonio_basis_free(&basis);
    gonio_readings_free(&readings);
    return status;
}

static int next(tool *t, const options *o, const next_inputs *in)
{
    answer a = {0};
    gonio_status status = find_next(t, o, in, &a);
    if (status == GONIO_OK) {
        tool_note_interpretation("next", in->path, &a.interpretation);
    }
    if (status == GONIO_OK && a.plan != NULL) {
        status = gonio_plan_write(t->context, a.plan, t->command_line, o->output);
    }
    const int code = status == GONIO_OK ? report(t, o, &a) : tool_exit_code(status);
    gonio_plan_free(&a.plan);
    return code;
}

static bool check(const tool *t, const options *o, const char *const *inputs, size_t count)
{
    if (count == 0 || count > 2) {
        return tool_refuse(t, "READINGS are needed; give a BASIS before them if you have one");
    }
    return tool_check_output(t, o->output, inputs, count) &&
           planning_options_check(t, &o->planning, o->output);
}

/* Sets what the instrument says and no option does. */
static bool settle(const tool *t, options *o, const gonio_instrument *instrument)
{
    posterior_options_settle(&o->posterior,
                             instrument != NULL ? gonio_instrument_describe(instrument) : NULL);
    return posterior_options_check(t, &o->posterior);
}

static int run(tool *t, void *given)
{
    options *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (!check(t, o, arguments, count)) {
        return EXIT_USAGE;
    }
    next_inputs in = {.basis_path = count > 1 ? arguments[0] : NULL, .path = arguments[count - 1]};
    gonio_plan_options_default(&in.what);
    const gonio_status status = planning_options_apply(t, &o->planning, &in.what, &in.planning);
    const int code = status != GONIO_OK                      ? tool_exit_code(status)
                     : !settle(t, o, in.planning.instrument) ? EXIT_USAGE
                                                             : next(t, o, &in);
    planning_inputs_free(&in.planning);
    return code;
}

int cmd_next(int argc, const char **argv)
{
    options o = {.planning = {.count = PLANNING_USUAL_COUNT},
                 .posterior = posterior_options_open()};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0, "The plan to write (CSV)", "PLAN"},
        PLANNING_OPTIONS(&o.planning, "Number of readings to propose (default: 5)",
                         "If the expected error (E6) is at most this, say so and propose nothing"),
        POSTERIOR_OPTIONS(&o.posterior),
        CORRECTION_OPTIONS(&o.corrections),
        TOOL_READINGS_OPTIONS,
        TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] [BASIS] READINGS -o PLAN",
        .text =
            "Without BASIS, the basis of the built-in materials is used. The proposed directions "
            "are those that leave the least expected error, given the readings so far.\n"
            "Example: gonio next merl.gonio readings.csv -n 5 --target-error 3% "
            "-o more.csv",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
