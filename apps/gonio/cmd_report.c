/* gonio report: a page for a browser that shows a material and its reconstruction. */
#include "command_line.h"
#include "inputs.h"
#include "json_output.h"

#include <stdio.h>
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
    return path == NULL ? GONIO_OK : tool_open_material(t, path, material);
}

static gonio_status read_readings(const tool *t, const char *path, gonio_readings **readings)
{
    const gonio_readings_options how = {.size = sizeof how,
                                        .values_needed = false,
                                        .average_repeats = true,
                                        .negative_to_zero = true,
                                        .instrument = t->instrument};
    return path == NULL ? GONIO_OK : tool_read_readings(t, path, &how, readings);
}

/* The content of the page; NULL for missing parts. */
typedef struct shown {
    const char *folder;
    const char *reference;
    const char *reconstruction;
} shown;

static gonio_status write_page(const tool *t, const options *o, const shown *s)
{
    gonio_material *materials[3] = {NULL, NULL, NULL};
    gonio_readings *readings = NULL;
    gonio_status status = open_material(t, s->reference, &materials[0]);
    if (status == GONIO_OK) {
        status = open_material(t, s->reconstruction, &materials[1]);
    }
    if (status == GONIO_OK) {
        status = open_material(t, o->deviation, &materials[2]);
    }
    if (status == GONIO_OK) {
        status = read_readings(t, o->readings, &readings);
    }
    const gonio_page_content content = {.size = sizeof content,
                                        .reference = materials[0],
                                        .reconstruction = materials[1],
                                        .deviation = materials[2],
                                        .readings = readings,
                                        .folder = s->folder};
    if (status == GONIO_OK) {
        status = gonio_page_write(t->context, &content, o->output);
    }
    gonio_readings_free(&readings);
    for (int k = 0; k < 3; k++) {
        gonio_material_free(&materials[k]);
    }
    return status;
}

static bool check(const tool *t, const options *o, const char **arguments, size_t count)
{
    if (count < 1 || count > 2) {
        return tool_refuse(
            t, "give a REFERENCE and optionally a RECONSTRUCTION, or the folder of a reproduction");
    }
    if (is_folder(arguments[0]) && (count > 1 || o->readings != NULL || o->deviation != NULL)) {
        return tool_refuse(t, "%s is a folder: give it alone", arguments[0]);
    }
    if (o->deviation != NULL && count < 2) {
        return tool_refuse(t, "--deviation needs the RECONSTRUCTION that it belongs to");
    }
    const char *const inputs[] = {o->readings, o->deviation};
    return tool_check_output(t, o->output, arguments, count) &&
           tool_check_output(t, o->output, inputs, 2);
}

/* Prints the page's path and its content. */
static int print_result(const tool *t, const options *o, const shown *s)
{
    if (tool_json) {
        return tool_print_json(
            t, json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "output", tool_json_text(o->output),
                         "folder", tool_json_text(s->folder), "reference",
                         tool_json_text(s->reference), "reconstruction",
                         tool_json_text(s->reconstruction), "readings", tool_json_text(o->readings),
                         "deviation", tool_json_text(o->deviation)));
    }
    if (!tool_quiet) {
        fprintf(tool_results(), "%s: open it in a browser\n", o->output);
    }
    return 0;
}

static int run(tool *t, void *given)
{
    const options *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (!check(t, o, arguments, count)) {
        return EXIT_USAGE;
    }
    const bool folder = is_folder(arguments[0]);
    const shown s = {.folder = folder ? arguments[0] : NULL,
                     .reference = folder ? NULL : arguments[0],
                     .reconstruction = count > 1 ? arguments[1] : NULL};
    const gonio_status status = write_page(t, o, &s);
    return status == GONIO_OK ? print_result(t, o, &s) : tool_exit_code(status);
}

int cmd_report(int argc, const char **argv)
{
    options o = {NULL, NULL, NULL};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0, "The page to write (HTML)", "PAGE"},
        {"readings", '\0', POPT_ARG_STRING, &o.readings, 0,
         "Show the directions of this plan or of these readings", "FILE"},
        {"deviation", '\0', POPT_ARG_STRING, &o.deviation, 0,
         "Standard deviations of ln(1 + rho/s) of the reconstruction, as a MERL table", "FILE"},
        TOOL_INSTRUMENT_OPTION,
        TOOL_READINGS_OPTIONS,
        TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] REFERENCE [RECONSTRUCTION] | OUTDIR  -o PAGE",
        .text =
            "Writes a page for a browser, one file that needs no network: spheres to light and "
            "turn,\n"
            "the measured directions, the image slice, lobes and errors. OUTDIR is a folder of "
            "'gonio\n"
            "reproduce', whose figures become charts.\n"
            "Example: gonio report gold.binary gold-80.binary --readings readings.csv -o gold.html",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
