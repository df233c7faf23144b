/* gonio measure: a simulated instrument reads a known material. */
#include "command_line.h"
#include "file_kinds.h"

#include <stdio.h>

typedef struct options {
    const char *output;
    double noise; /* per cent */
    double floor;
    double outliers; /* per cent */
    long seed;
} options;

static void report(const options *o, const gonio_readings *readings, const char *material)
{
    const size_t count = gonio_readings_describe(readings).count;
    if (!tool_quiet) {
        printf("%s: %zu reading%s of %s\n", o->output, count, tool_plural(count), material);
    }
}

/* Takes the values from readings that were made at more directions. */
static gonio_status look_up(tool *t, const options *o, gonio_readings *plan, const char *path)
{
    const gonio_readings_options any = {
        .values_needed = true, .average_repeats = true, .negative_to_zero = true};
    gonio_readings *known = NULL;
    gonio_status status = gonio_readings_read(t->context, path, &any, &known);
    if (status == GONIO_OK) {
        status = gonio_readings_look_up(t->context, plan, known);
    }
    if (status == GONIO_OK) {
        status = gonio_readings_write(t->context, plan, t->command_line, o->output);
    }
    if (status == GONIO_OK) {
        report(o, plan, path);
    }
    gonio_readings_free(&known);
    return status;
}

static gonio_status measure(tool *t, const options *o, const char *plan, const char *path)
{
    gonio_readings_options how = {.values_needed = false, .negative_to_zero = true};
    const gonio_instrument_options instrument = {o->noise / 100.0, o->floor, (uint64_t)o->seed,
                                                 o->outliers / 100.0};
    gonio_readings *readings = NULL;
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    gonio_status status = gonio_readings_read(t->context, plan, &how, &readings);
    if (status == GONIO_OK && tool_is_readings(path)) {
        status = look_up(t, o, readings, path);
        gonio_readings_free(&readings);
        return status;
    }
    if (status == GONIO_OK) {
        status = gonio_material_open(t->context, path, &material);
    }
    if (status == GONIO_OK) {
        status = gonio_table_load(t->context, material, &table);
    }
    if (status == GONIO_OK) {
        status = gonio_measure(t->context, readings, table, &instrument);
    }
    if (status == GONIO_OK) {
        status = gonio_readings_write(t->context, readings, t->command_line, o->output);
    }
    if (status == GONIO_OK) {
        report(o, readings, gonio_material_name(material));
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
    gonio_readings_free(&readings);
    return status;
}

static int run(tool *t, const options *o)
{
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count != 2) {
        return tool_usage_error(t, "PLAN and MATERIAL are needed");
    }
    if (!(o->noise >= 0.0) || !(o->floor >= 0.0)) {
        return tool_usage_error(t, "--noise and --floor cannot be negative");
    }
    if (!(o->outliers >= 0.0 && o->outliers <= 100.0)) {
        return tool_usage_error(t, "--outliers is a share in per cent, 0 to 100");
    }
    const int code = tool_check_output(t, o->output, arguments, count);
    return code != 0 ? code : tool_exit_code(measure(t, o, arguments[0], arguments[1]));
}

int cmd_measure(int argc, const char **argv)
{
    options o = {0};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0, "The readings to write (CSV)", "READINGS"},
        {"noise", '\0', POPT_ARG_DOUBLE, &o.noise, 0,
         "Noise in per cent of each reading, standard deviation (default: 0)", "PERCENT"},
        {"floor", '\0', POPT_ARG_DOUBLE, &o.floor, 0,
         "Additive noise in 1/sr, standard deviation (default: 0)", "VALUE"},
        {"outliers", '\0', POPT_ARG_DOUBLE, &o.outliers, 0,
         "Share of directions read ten times too high or too low (default: 0)", "PERCENT"},
        {"seed", '\0', POPT_ARG_LONG, &o.seed, 0, "Same seed, same noise (default: 0)", "N"},
        TOOL_OPTIONS};
    tool t;
    int code = tool_begin(&t, argc, argv, table, "[OPTION...] PLAN MATERIAL -o READINGS",
                          "MATERIAL is a MERL .binary table, a neural BRDF .h5 or atlas:NAME.\n"
                          "Example: gonio measure plan.csv gold.binary --noise 1 -o readings.csv");
    if (code < 0) {
        code = run(&t, &o);
    }
    tool_end(&t);
    return code;
}
