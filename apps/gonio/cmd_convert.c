/* gonio convert: materials to any format that gonio writes, readings to CSV or BRDF JSON, bases of
 * an older gonio to the present format. */
#include <string.h>
#include <strings.h>

#include "command_line.h"
#include "correction_options.h"
#include "inputs.h"
#include "json_output.h"
#include "write_options.h"

typedef struct options {
    write_options write;
    correction_options corrections;
} options;

/* Prints the result with --json, otherwise nothing. */
static int report(const tool *t, const gonio_material *material, const char *output)
{
    return tool_json ? tool_print_json(t, json_pack("{s:o, s:o, s:s}", "output",
                                                    tool_json_text(output), "material",
                                                    tool_json_text(gonio_material_name(material)),
                                                    "from", gonio_material_format(material)))
                     : 0;
}

static int convert_material(tool *t, const write_options *write, const gonio_write_options *how,
                            const char *input, const char *output)
{
    gonio_material *material = NULL;
    gonio_status status = tool_open_material(t, input, &material);
    if (status == GONIO_OK) {
        status = write_options_apply(t, write, material);
    }
    if (status == GONIO_OK) {
        status = gonio_material_write(t->context, material, output, how);
    }
    if (status == GONIO_OK) {
        status = write_options_state_loss(t, how, material, output);
    }
    const int code = status == GONIO_OK ? report(t, material, output) : tool_exit_code(status);
    gonio_material_free(&material);
    return code;
}

static int convert_basis(tool *t, const char *input, const char *format, const char *output)
{
    const gonio_status status = gonio_basis_convert(t->context, input, output);
    return status == GONIO_OK && tool_json
               ? tool_print_json(t, json_pack("{s:o, s:o, s:s}", "output", tool_json_text(output),
                                              "basis", tool_json_text(input), "from", format))
               : tool_exit_code(status);
}

/* Whether a file name is that of a format of readings. */
static bool names_readings(const char *output)
{
    static const char *const extensions[] = {".csv", ".json", ".brdf"};
    const char *dot = strrchr(output, '.');
    bool found = false;
    for (size_t k = 0; dot != NULL && k < sizeof extensions / sizeof *extensions; k++) {
        found = found || strcasecmp(dot, extensions[k]) == 0;
    }
    return found;
}

static int convert_readings(tool *t, const correction_options *corrections, const char *input,
                            const char *output)
{
    const gonio_readings_options any = {.size = sizeof any,
                                        .average_repeats = true,
                                        .negative_to_zero = true,
                                        .instrument = t->instrument};
    gonio_readings *readings = NULL;
    gonio_reconstruct_options usual;
    gonio_reconstruct_options_default(&usual);
    gonio_status status =
        tool_read_corrected(t, input, &any, corrections, usual.noise, usual.floor, &readings);
    if (status == GONIO_OK) {
        status = gonio_readings_write(t->context, readings, t->command_line, output);
    }
    gonio_readings_free(&readings);
    return status == GONIO_OK && tool_json
               ? tool_print_json(t, json_pack("{s:s, s:s}", "output", output, "readings", input))
               : tool_exit_code(status);
}

/* Readings become other readings. Those on a grid become a material too, by the name of OUT. */
static int convert_readings_or_grid(tool *t, const options *o, const gonio_write_options *how,
                                    const char *input, const char *output)
{
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    if (how->format == NULL && names_readings(output)) {
        return convert_readings(t, &o->corrections, input, output);
    }
    if (gonio_file_expect(NULL, input, GONIO_KIND_MATERIAL, &kind) == GONIO_OK) {
        return convert_material(t, &o->write, how, input, output);
    }
    tool_refuse(
        t,
        "%s: these are readings; 'gonio reconstruct %s -o %s' makes a material of them. OUT "
        "can be .csv, or .json or .brdf (BRDF JSON)",
        input, input, output);
    return EXIT_DATA;
}

static int run(tool *t, void *given)
{
    const options *o = given;
    gonio_write_options how;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count != 2) {
        tool_refuse(t, "IN and OUT are needed");
        return EXIT_USAGE;
    }
    if (!tool_check_output(t, arguments[1], arguments, 1) ||
        !write_options_check(t, &o->write, &how)) {
        return EXIT_USAGE;
    }
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    const char *format = NULL;
    const gonio_status status = gonio_file_kind(t->context, arguments[0], &kind, &format);
    if (status != GONIO_OK) {
        return tool_exit_code(status);
    }
    if (kind == GONIO_KIND_UNKNOWN && !tool_has_convention(arguments[0])) {
        return tool_exit_code(gonio_file_expect(t->context, arguments[0],
                                                GONIO_KIND_MATERIAL | GONIO_KIND_READINGS, &kind));
    }
    if (kind == GONIO_KIND_READINGS || tool_has_convention(arguments[0])) {
        return convert_readings_or_grid(t, o, &how, arguments[0], arguments[1]);
    }
    return kind == GONIO_KIND_BASIS
               ? convert_basis(t, arguments[0], format, arguments[1])
               : convert_material(t, &o->write, &how, arguments[0], arguments[1]);
}

int cmd_convert(int argc, const char **argv)
{
    options o = {0};
    const struct poptOption table[] = {WRITE_OPTIONS(&o.write), CORRECTION_OPTIONS(&o.corrections),
                                       TOOL_INSTRUMENT_OPTION, TOOL_READINGS_OPTIONS, TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] IN OUT",
        .text =
            "IN is a MERL .binary table, a neural BRDF .h5, an RGL .bsdf, a KAIST .pbsdf, a UTIA "
            ".bin, a BSDF-XML matrix, a gonio BRDF table .h5 or atlas:NAME (a built-in material; "
            "'gonio info atlas:' lists them).\n"
            "OUT becomes an RGL .bsdf, for Mitsuba 3 and pbrt-v4, if its name ends in .bsdf; a "
            "table of all channels in HDF5 (.h5); BSDF-XML (.xml), for Radiance; readings on a "
            "grid (.csv); a MERL .binary table otherwise.\n"
            "If IN is readings, in any format that gonio reads, OUT becomes CSV (.csv) or BRDF "
            "JSON (.json, .brdf); those of a Zemax .bsdf become a material by any other name.\n"
            "If IN is a basis of an older gonio (HDF5), OUT becomes the same basis in the present "
            "format.",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
