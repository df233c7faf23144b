/* gonio measure: a simulated instrument reads a known material, or a run on a real one is followed.
 */
#include "command_line.h"
#include "follow/follow.h"
#include "inputs.h"
#include "json_output.h"

#include <math.h>
#include <stdio.h>

#define NOT_GIVEN (-HUGE_VAL)

typedef struct options {
    const char *output;
    const char *instrument; /* NULL: none */
    double noise;           /* per cent; NOT_GIVEN: none was given */
    double floor;           /* the same */
    double outliers;        /* per cent */
    long seed;
    follow_options follow;
} options;

/* What was written. */
typedef struct written {
    const char *material; /* its name */
    size_t channels;
} written;

/* Reports what was read. */
static int report(const tool *t, const options *o, const gonio_readings *readings, const written *w)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    if (tool_json) {
        return tool_print_json(
            t, json_pack("{s:o, s:I, s:I, s:o}", "output", tool_json_text(o->output), "readings",
                         (json_int_t)view->count, "channels", (json_int_t)w->channels, "material",
                         tool_json_text(w->material)));
    }
    if (!tool_quiet) {
        fprintf(tool_results(), "%s: %zu reading%s of %s\n", o->output, view->count,
                tool_plural(view->count), w->material);
    }
    return 0;
}

/* Reads a material or readings, of which the name goes to *name. */
static gonio_status read_input(tool *t, const options *o, const tool_input *known,
                               gonio_readings *plan, const char **name)
{
    const gonio_instrument_options instrument = {.size = sizeof instrument,
                                                 .noise = o->noise / 100.0,
                                                 .floor = o->floor,
                                                 .seed = (uint64_t)o->seed,
                                                 .outliers = o->outliers / 100.0};
    *name = known->material != NULL ? gonio_material_name(known->material) : known->path;
    return tool_take_values(t, known, &instrument, plan);
}

/* Writes the run of an instrument, and says how long it takes. */
static gonio_status rehearse(const tool *t, const options *o, const gonio_material *material,
                             const gonio_readings *plan, written *w)
{
    double duration = 0.0;
    w->material = gonio_material_name(material);
    const gonio_status status =
        gonio_rehearse(t->context, plan, material, t->instrument, (uint64_t)o->seed,
                       t->command_line, o->output, &duration, &w->channels);
    if (status == GONIO_OK && !tool_quiet && !tool_json) {
        fprintf(tool_results(), "%s: a run of %.1f min\n",
                gonio_instrument_describe(t->instrument)->name, duration / 60.0);
    }
    return status;
}

/* Reads the input by the plan, and writes what was read. */
static gonio_status read_and_write(tool *t, const options *o, const tool_input *known,
                                   gonio_readings *readings, written *w)
{
    if (t->instrument != NULL && known->material != NULL) {
        return rehearse(t, o, known->material, readings, w);
    }
    const gonio_status status = read_input(t, o, known, readings, &w->material);
    w->channels = gonio_readings_describe(readings)->channels;
    return status == GONIO_OK
               ? gonio_readings_write(t->context, readings, t->command_line, o->output)
               : status;
}

static int measure(tool *t, const options *o, const char *plan, const char *path)
{
    gonio_status status = o->instrument != NULL ? tool_read_instrument(t, o->instrument) : GONIO_OK;
    const gonio_readings_options how = {.size = sizeof how,
                                        .values_needed = false,
                                        .average_repeats = true,
                                        .negative_to_zero = true,
                                        .instrument = t->instrument};
    gonio_readings *readings = NULL;
    tool_input known = {0};
    written w = {.material = path};
    if (status == GONIO_OK) {
        status = tool_read_readings(t, plan, &how, &readings);
    }
    if (status == GONIO_OK) {
        status = tool_open_input(t, path, &known);
    }
    if (status == GONIO_OK) {
        status = read_and_write(t, o, &known, readings, &w);
    }
    const int code = status == GONIO_OK ? report(t, o, readings, &w) : tool_exit_code(status);
    tool_close_input(&known);
    gonio_readings_free(&readings);
    return code;
}

static bool check(const tool *t, const options *o, const char **arguments, size_t count)
{
    if (count != 2) {
        return tool_refuse(t, "PLAN and MATERIAL are needed");
    }
    if (!(o->outliers >= 0.0 && o->outliers <= 100.0)) {
        return tool_refuse(t, "--outliers must be 0 to 100 per cent");
    }
    if (o->instrument != NULL && (o->noise > 0.0 || o->floor > 0.0 || o->outliers > 0.0)) {
        return tool_refuse(t, "the instrument has its own noise: give --instrument, or --noise, "
                              "--floor and --outliers");
    }
    return (o->instrument == NULL || tool_check_output(t, o->output, &o->instrument, 1)) &&
           tool_check_not_negative(t, "--noise", o->noise) &&
           tool_check_not_negative(t, "--floor", o->floor) &&
           tool_check_output(t, o->output, arguments, count);
}

/* Noise that is not given is none in a simulation, and the usual one of a real instrument. */
static void complete(options *o)
{
    o->follow.output = o->output;
    o->follow.instrument = o->instrument;
    o->follow.noise_given = o->noise != NOT_GIVEN;
    o->follow.floor_given = o->floor != NOT_GIVEN;
    o->follow.posterior.noise = o->noise == NOT_GIVEN ? o->follow.posterior.noise : o->noise;
    o->follow.posterior.floor = o->floor == NOT_GIVEN ? o->follow.posterior.floor : o->floor;
    o->noise = o->noise == NOT_GIVEN ? 0.0 : o->noise;
    o->floor = o->floor == NOT_GIVEN ? 0.0 : o->floor;
}

static int run(tool *t, void *given)
{
    options *o = given;
    size_t count = 0;
    complete(o);
    const char **arguments = tool_arguments(t, &count);
    if (o->follow.follow != NULL || o->follow.command != NULL) {
        return follow_check(t, &o->follow, arguments, count)
                   ? follow_run(t, &o->follow, arguments[0])
                   : EXIT_USAGE;
    }
    return check(t, o, arguments, count) ? measure(t, o, arguments[0], arguments[1]) : EXIT_USAGE;
}

int cmd_measure(int argc, const char **argv)
{
    options o = {
        .noise = NOT_GIVEN, .floor = NOT_GIVEN, .follow.posterior = posterior_options_default()};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "The readings to write: CSV; .json or .brdf is BRDF JSON", "READINGS"},
        {"noise", '\0', POPT_ARG_DOUBLE, &o.noise, 0,
         "Noise in per cent of each reading, standard deviation (default: 0; 1 of a run)",
         "PERCENT"},
        {"floor", '\0', POPT_ARG_DOUBLE, &o.floor, 0,
         "Additive noise in 1/sr, standard deviation (default: 0; 1e-5 of a run)", "VALUE"},
        {"outliers", '\0', POPT_ARG_DOUBLE, &o.outliers, 0,
         "Share of directions read ten times too high or too low (default: 0)", "PERCENT"},
        {"seed", '\0', POPT_ARG_LONG, &o.seed, 0, "Seed of noise and outliers (default: 0)", "N"},
        {"instrument", '\0', POPT_ARG_STRING, &o.instrument, 0,
         "Write the run of this instrument, a file or in-plane, two-arms or four-axis: apertures, "
         "noise, drift, reference and dark lines, times (CSV); in a followed run its limits, noise "
         "and times count; readings are taken as it gives them",
         "INSTRUMENT"},
        {"follow", '\0', POPT_ARG_STRING, &o.follow.follow, 0,
         "Follow a run: readings that an instrument appends to this file; - is standard input",
         "FILE"},
        {"exec", '\0', POPT_ARG_STRING, &o.follow.command, 0,
         "Make a run: COMMAND is given theta_i, phi_i, theta_o, phi_o in degrees, and the "
         "positions of the instrument's axes, and prints values",
         "COMMAND"},
        {"basis", '\0', POPT_ARG_STRING, &o.follow.basis, 0,
         "What a run is judged by (default: the basis of the built-in materials)", "BASIS"},
        {"no-basis", '\0', POPT_ARG_NONE, &o.follow.no_basis, 0,
         "Only record a run: no expected error, no outliers", NULL},
        {"journal", '\0', POPT_ARG_STRING, &o.follow.journal, 0,
         "What a run goes on from after an interruption (default: READINGS.journal)", "FILE"},
        {"adapt", '\0', POPT_ARG_NONE, &o.follow.adapt, 0,
         "Plan the rest of a run again after every five readings, as gonio next does", NULL},
        {"candidates", '\0', POPT_ARG_STRING, &o.follow.candidates, 0,
         "Adapt among the directions of this file, a plan or readings", "FILE"},
        {"remaining", '\0', POPT_ARG_STRING, &o.follow.remaining, 0,
         "Keep what is left to be read in this plan, repeats first", "PLAN"},
        {"target-error", '\0', POPT_ARG_STRING, &o.follow.target, 0,
         "End a run when the expected error (E6) is at most this", "PERCENT"},
        {"budget", '\0', POPT_ARG_STRING, &o.follow.budget, 0,
         "End a run after this time: 45min, 2h, 90s", "TIME"},
        {"idle", '\0', POPT_ARG_STRING, &o.follow.idle, 0,
         "End when no line came for this time (default: if only repeats are left, 1 min or ten "
         "times a reading's time; otherwise never)",
         "TIME"},
        {"saturation", '\0', POPT_ARG_DOUBLE, &o.follow.posterior.saturation, 0,
         "In a run, readings of this value or more, 1/sr, are saturated", "VALUE"},
        TOOL_READINGS_OPTIONS,
        TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] PLAN MATERIAL -o READINGS\n"
                 "   or: gonio measure [OPTION...] --follow FILE | --exec COMMAND PLAN -o READINGS",
        .text =
            "MATERIAL is any material that gonio reads, or readings of a real instrument.\n"
            "A run that was ended in any way goes on with the same command line.\n"
            "Example: gonio measure plan.csv gold.binary --noise 1 -o readings.csv\n"
            "Example: gonio measure --follow robot.csv plan.csv --target-error 3 -o readings.csv",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
