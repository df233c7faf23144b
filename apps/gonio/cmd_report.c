/* gonio report: a page for a browser. */
#include "command_line.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

typedef struct options {
    const char *output;
    const char *readings;
    const char *deviation;
} options;

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* Opens a material if there is a path. */
static gonio_status open_material(const tool *t, const char *path, gonio_material **material)
{
    return path == NULL ? GONIO_OK : gonio_material_open(t->context, path, material);
}

static gonio_status read_readings(const tool *t, const char *path, gonio_readings **readings)
{
    const gonio_readings_options how = {
        .values_needed = false, .average_repeats = true, .negative_to_zero = true};
    return path == NULL ? GONIO_OK : gonio_readings_read(t->context, path, &how, readings);
}

/* Paths may be NULL. */
static gonio_status report(const tool *t, const options *o, const char *folder,
                           const char *reference, const char *reconstruction)
{
    gonio_material *materials[3] = {NULL, NULL, NULL};
    gonio_readings *readings = NULL;
    gonio_status status = open_material(t, reference, &materials[0]);
    if (status == GONIO_OK) {
        status = open_material(t, reconstruction, &materials[1]);
    }
    if (status == GONIO_OK) {
        status = open_material(t, o->deviation, &materials[2]);
    }
    if (status == GONIO_OK) {
        status = read_readings(t, o->readings, &readings);
    }
    const gonio_report_content content = {materials[0], materials[1], materials[2], readings,
                                          folder};
    if (status == GONIO_OK) {
        status = gonio_report_write(t->context, &content, o->output);
    }
    if (status == GONIO_OK && !tool_quiet) {
        printf("%s: open it in a browser\n", o->output);
    }
    gonio_readings_free(&readings);
    for (int k = 0; k < 3; k++) {
        gonio_material_free(&materials[k]);
    }
    return status;
}

static int run(const tool *t, const options *o)
{
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count < 1 || count > 2) {
        return tool_usage_error(
            t, "a REFERENCE, perhaps with a RECONSTRUCTION, or the folder of a reproduction is "
               "needed");
    }
    const bool folder = is_folder(arguments[0]);
    if (folder && (count > 1 || o->readings != NULL || o->deviation != NULL)) {
        return tool_usage_error(t, "%s is a folder, which is shown on its own", arguments[0]);
    }
    if (o->deviation != NULL && count < 2) {
        return tool_usage_error(t, "--deviation needs a RECONSTRUCTION that it is of");
    }
    const char *const inputs[4] = {arguments[0], count > 1 ? arguments[1] : NULL, o->readings,
                                   o->deviation};
    const int code = tool_check_output(t, o->output, inputs, 4);
    return code != 0 ? code
                     : tool_exit_code(report(t, o, folder ? arguments[0] : NULL,
                                             folder ? NULL : arguments[0], inputs[1]));
}

int cmd_report(int argc, const char **argv)
{
    options o = {NULL, NULL, NULL};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0, "The page to write (HTML)", "PAGE"},
        {"readings", '\0', POPT_ARG_STRING, &o.readings, 0,
         "Show these directions, a plan's or readings'", "FILE"},
        {"deviation", '\0', POPT_ARG_STRING, &o.deviation, 0,
         "Standard deviations of ln(1 + rho/s) of the reconstruction, a MERL table", "FILE"},
        TOOL_OPTIONS};
    tool t;
    int code = tool_begin(
        &t, argc, argv, table, "[OPTION...] REFERENCE [RECONSTRUCTION] | OUTDIR  -o PAGE",
        "Writes a page for a browser, one file that needs no network: spheres to light and turn,\n"
        "where was measured, the image slice, lobes and errors. OUTDIR is a folder of 'gonio\n"
        "reproduce', whose figures become charts.\n"
        "Example: gonio report gold.binary gold-80.binary --readings readings.csv -o gold.html");
    if (code < 0) {
        code = run(&t, &o);
    }
    tool_end(&t);
    return code;
}
