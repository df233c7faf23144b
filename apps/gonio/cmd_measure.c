/* gonio measure: a simulated instrument reads a known material. */
#include "command_line.h"
#include "inputs.h"
#include "json_output.h"

#include <stdio.h>

typedef struct options {
    const char *output;
    double noise; /* per cent */
    double floor;
    double outliers; /* per cent */
    long seed;
} options;

/* Reports what was read. */
static int report(const tool *t, const options *o, const gonio_readings *readings,
                  const char *material)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    if (tool_json) {
        return tool_print_json(
            t, json_pack("{s:o, s:I, s:I, s:o}", "output", tool_json_text(o->output), "readings",
                         (json_int_t)view->count, "channels", (json_int_t)view->channels,
                         "material", tool_json_text(material)));
    }
    if (!tool_quiet) {
        fprintf(tool_results(), "%s: %zu reading%s of %s\n", o->output, view->count,
                tool_plural(view->count), material);
    }
    return 0;
}

/* Reads a material, whose name goes to *name. */
static gonio_status read_material(const tool *t, const options *o, const gonio_material *material,
                                  gonio_readings *plan, const char **name)
{
    const gonio_instrument_options instrument = {.size = sizeof instrument,
                                                 .noise = o->noise / 100.0,
                                                 .floor = o->floor,
                                                 .seed = (uint64_t)o->seed,
                                                 .outliers = o->outliers / 100.0};
    *name = gonio_material_name(material);
    return gonio_measure_material(t->context, plan, material, &instrument);
}

static int measure(const tool *t, const options *o, const char *plan, const char *path)
{
    const gonio_readings_options how = {
        .size = sizeof how, .values_needed = false, .negative_to_zero = true};
    gonio_readings *readings = NULL;
    tool_input known = {0};
    const char *name = path;
    gonio_status status = tool_read_readings(t, plan, &how, &readings);
    if (status == GONIO_OK) {
        status = tool_open_input(t, path, &known);
    }
    if (status == GONIO_OK) {
        status = known.readings != NULL
                     ? gonio_readings_look_up(t->context, readings, known.readings)
                     : read_material(t, o, known.material, readings, &name);
    }
    if (status == GONIO_OK) {
        status = gonio_readings_write(t->context, readings, t->command_line, o->output);
    }
    const int code = status == GONIO_OK ? report(t, o, readings, name) : tool_exit_code(status);
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
    return tool_check_not_negative(t, "--noise", o->noise) &&
           tool_check_not_negative(t, "--floor", o->floor) &&
           tool_check_output(t, o->output, arguments, count);
}

static int run(tool *t, void *given)
{
    const options *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    return check(t, o, arguments, count) ? measure(t, o, arguments[0], arguments[1]) : EXIT_USAGE;
}

int cmd_measure(int argc, const char **argv)
{
    options o = {0};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "The readings to write: CSV; .json or .brdf is BRDF JSON", "READINGS"},
        {"noise", '\0', POPT_ARG_DOUBLE, &o.noise, 0,
         "Noise in per cent of each reading, standard deviation (default: 0)", "PERCENT"},
        {"floor", '\0', POPT_ARG_DOUBLE, &o.floor, 0,
         "Additive noise in 1/sr, standard deviation (default: 0)", "VALUE"},
        {"outliers", '\0', POPT_ARG_DOUBLE, &o.outliers, 0,
         "Share of directions read ten times too high or too low (default: 0)", "PERCENT"},
        {"seed", '\0', POPT_ARG_LONG, &o.seed, 0, "Seed of noise and outliers (default: 0)", "N"},
        TOOL_READINGS_OPTIONS,
        TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] PLAN MATERIAL -o READINGS",
        .text = "MATERIAL is any material that gonio reads, or readings of a real instrument.\n"
                "Example: gonio measure plan.csv gold.binary --noise 1 -o readings.csv",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
