/* gonio reconstruct: the whole BRDF from a few readings. */
#include "tool.h"

#include <stdio.h>

typedef struct options {
    const char *output;
    int components;
    int all_channels;
    int other_basis;
    int average_repeats;
    int negative_to_zero;
    int json;
} options;

static int report(const tool *t, const gonio_reconstruction *r, const options *o)
{
    if (o->json) {
        return tool_print_json(t, json_pack("{s:s, s:I, s:I, s:o, s:o}", "output", o->output,
                                            "components", (json_int_t)r->components, "readings",
                                            (json_int_t)r->readings, "condition_number",
                                            tool_json_number(r->condition_number), "residual_log",
                                            tool_json_number(r->residual)));
    }
    if (!tool_quiet) {
        printf("%s: %zu coefficients from %zu readings, condition number %.3f, residual %.4f "
               "(log units)\n",
               o->output, r->components, r->readings, r->condition_number, r->residual);
    }
    return 0;
}

static gonio_status write_result(tool *t, const options *o, const gonio_basis *basis,
                                 const gonio_reconstruction *reconstruction)
{
    gonio_material *material = NULL;
    gonio_status status = gonio_reconstruction_material(t->context, basis, reconstruction,
                                                        "reconstruction", &material);
    if (status == GONIO_OK) {
        status = gonio_material_write_merl(t->context, material, o->output);
    }
    gonio_material_free(&material);
    return status;
}

static int reconstruct(tool *t, const options *o, const char *basis_path, const char *path)
{
    const gonio_readings_options reading = {.values_needed = true,
                                            .average_repeats = o->average_repeats,
                                            .negative_to_zero = o->negative_to_zero};
    const gonio_reconstruct_options how = {.components = (size_t)o->components,
                                           .all_channels = o->all_channels,
                                           .other_basis = o->other_basis};
    gonio_readings *readings = NULL;
    gonio_basis *basis = NULL;
    gonio_reconstruction *reconstruction = NULL;
    gonio_status status = gonio_readings_read(t->context, path, &reading, &readings);
    if (status == GONIO_OK) {
        status = tool_basis(t, basis_path, &basis);
    }
    if (status == GONIO_OK) {
        status = gonio_reconstruct(t->context, basis, readings, &how, &reconstruction);
    }
    if (status == GONIO_OK) {
        status = write_result(t, o, basis, reconstruction);
    }
    const int code = status == GONIO_OK ? report(t, reconstruction, o) : tool_exit_code(status);
    gonio_reconstruction_free(&reconstruction);
    gonio_basis_free(&basis);
    gonio_readings_free(&readings);
    return code;
}

static int run(tool *t, const options *o)
{
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count != 1 && count != 2) {
        return tool_usage_error(t, "READINGS, and before it a BASIS if you have one, are needed");
    }
    int code = tool_check_output(t, o->output, arguments, count);
    if (code == 0) {
        code = tool_check_count(t, "--basis", o->components, 0);
    }
    const char *basis = count == 2 ? arguments[0] : NULL;
    return code != 0 ? code : reconstruct(t, o, basis, arguments[count - 1]);
}

int cmd_reconstruct(int argc, const char **argv)
{
    options o = {0};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0, "The MERL .binary table to write", "OUT"},
        {"basis", 'K', POPT_ARG_INT, &o.components, 0,
         "Use the first K components (default: as the plan says, or all)", "K"},
        {"all-channels", '\0', POPT_ARG_NONE, &o.all_channels, 0,
         "Use every channel that was read, not only the planned one", NULL},
        {"average-repeats", '\0', POPT_ARG_NONE, &o.average_repeats, 0,
         "Accept directions that were read more than once", NULL},
        {"negative-to-zero", '\0', POPT_ARG_NONE, &o.negative_to_zero, 0,
         "Take negative readings as 0", NULL},
        {"other-basis", '\0', POPT_ARG_NONE, &o.other_basis, 0,
         "Accept readings that were planned with another basis", NULL},
        {"json", '\0', POPT_ARG_NONE, &o.json, 0, "Print the result as JSON", NULL},
        TOOL_OPTIONS};
    tool t;
    int code = tool_begin(
        &t, argc, argv, table, "[OPTION...] [BASIS] READINGS -o OUT",
        "READINGS is CSV with the columns theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg, "
        "R_per_sr, G_per_sr, B_per_sr in any order, and channel if only one was planned.\n"
        "Without BASIS, the basis of the built-in materials serves.\n"
        "Example: gonio reconstruct merl.gonio readings.csv -o new.binary");
    if (code < 0) {
        code = run(&t, &o);
    }
    tool_end(&t);
    return code;
}
