/* gonio reconstruct: the whole BRDF from a few readings. */
#include "tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct options {
    const char *output;
    const char *method;
    double eta;
    int components;
    int all_channels;
    int other_basis;
    int average_repeats;
    int negative_to_zero;
    int json;
} options;

/* Says what was made: a line, or an object appended to `results`. */
static void report(const gonio_reconstruction *r, const char *output, json_t *results)
{
    if (results != NULL) {
        json_array_append_new(
            results, json_pack("{s:s, s:I, s:I, s:o, s:f}", "output", output, "components",
                               (json_int_t)r->components, "readings", (json_int_t)r->readings,
                               "condition_number", tool_json_number(r->condition_number),
                               "residual_log", r->residual));
    } else if (!tool_quiet) {
        printf("%s: %zu coefficients from %zu readings, condition number %.3f, residual %.4f "
               "(log units)\n",
               output, r->components, r->readings, r->condition_number, r->residual);
    }
}

static gonio_status reconstruct(tool *t, const options *o, const gonio_basis *basis,
                                gonio_readings *const *readings, char *const *outputs, size_t count,
                                json_t *results)
{
    const gonio_reconstruct_options how = {.components = (size_t)o->components,
                                           .all_channels = o->all_channels,
                                           .other_basis = o->other_basis,
                                           .method = o->method,
                                           .eta = o->eta};
    gonio_reconstruction **made = calloc(count, sizeof(gonio_reconstruction *));
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status =
        gonio_reconstruct_tables(t->context, basis, (const gonio_readings *const *)readings,
                                 (const char *const *)outputs, count, &how, made);
    for (size_t k = 0; k < count; k++) {
        if (made[k] != NULL) {
            report(made[k], outputs[k], results);
        }
        gonio_reconstruction_free(&made[k]);
    }
    free(made);
    return status;
}

/* FOLDER/NAME.binary for readings FILE of the same name. */
static char *path_in_folder(const char *folder, const char *file)
{
    const char *slash = strrchr(file, '/');
    const char *name = slash != NULL ? slash + 1 : file;
    const char *dot = strrchr(name, '.');
    const int length = dot != NULL && dot != name ? (int)(dot - name) : (int)strlen(name);
    char *path = NULL;
    return asprintf(&path, "%s/%.*s.binary", folder, length, name) < 0 ? NULL : path;
}

/* Reads readings before the basis, which takes longer: so that their errors come at once. */
static int reconstruct_all(tool *t, const options *o, const char *basis_path,
                           const char *const *paths, char *const *outputs, size_t count,
                           json_t *results)
{
    const gonio_readings_options how = {.values_needed = true,
                                        .average_repeats = o->average_repeats,
                                        .negative_to_zero = o->negative_to_zero};
    gonio_readings **readings = calloc(count, sizeof *readings);
    gonio_basis *basis = NULL;
    gonio_status status = readings == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = gonio_readings_read(t->context, paths[k], &how, &readings[k]);
    }
    if (status == GONIO_OK) {
        status = tool_basis(t, basis_path, &basis);
    }
    if (status == GONIO_OK) {
        status = reconstruct(t, o, basis, readings, outputs, count, results);
    }
    for (size_t k = 0; readings != NULL && k < count; k++) {
        gonio_readings_free(&readings[k]);
    }
    free(readings);
    gonio_basis_free(&basis);
    return tool_exit_code(status);
}

static bool is_folder(const char *path)
{
    struct stat status;
    return path != NULL && stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* Where each result goes: into a folder if there are several, or if OUT is one. */
static int choose_outputs(const tool *t, const options *o, const char *const *inputs,
                          size_t inputs_count, const char *const *paths, size_t count,
                          char **outputs)
{
    const bool folder = is_folder(o->output);
    if (count > 1 && !folder) {
        return tool_usage_error(t, "several READINGS need a folder that exists: -o DIR");
    }
    int code = o->output == NULL ? tool_check_output(t, NULL, inputs, inputs_count) : 0;
    for (size_t k = 0; k < count && code == 0; k++) {
        outputs[k] = folder ? path_in_folder(o->output, paths[k]) : strdup(o->output);
        code =
            outputs[k] == NULL ? EXIT_DATA : tool_check_output(t, outputs[k], inputs, inputs_count);
        for (size_t j = 0; j < k && code == 0; j++) {
            if (strcmp(outputs[j], outputs[k]) == 0) {
                code = tool_usage_error(t, "%s and %s would both become %s", paths[j], paths[k],
                                        outputs[k]);
            }
        }
    }
    return code;
}

static int run(tool *t, const options *o)
{
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count == 0) {
        return tool_usage_error(t, "READINGS, and before it a BASIS if you have one, are needed");
    }
    const char *basis = count > 1 ? arguments[0] : NULL;
    const char *const *paths = count > 1 ? arguments + 1 : arguments;
    const size_t readings = count > 1 ? count - 1 : 1;
    char **outputs = calloc(readings, sizeof *outputs);
    int code = outputs == NULL ? EXIT_DATA
                               : choose_outputs(t, o, arguments, count, paths, readings, outputs);
    if (code == 0) {
        code = tool_check_count(t, "--basis", o->components, 0);
    }
    if (code == 0 && !(o->eta > 0.0)) {
        code = tool_usage_error(t, "--eta has to be above 0");
    }
    json_t *results = o->json ? json_array() : NULL;
    if (code == 0) {
        code = reconstruct_all(t, o, basis, paths, outputs, readings, results);
    }
    if (code == 0 && results != NULL) {
        code = tool_print_json(t, readings > 1 ? json_incref(results)
                                               : json_incref(json_array_get(results, 0)));
    }
    json_decref(results);
    for (size_t k = 0; outputs != NULL && k < readings; k++) {
        free(outputs[k]);
    }
    free(outputs);
    return code;
}

int cmd_reconstruct(int argc, const char **argv)
{
    options o = {.eta = 40.0};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "The MERL .binary table to write, or a folder for NAME.binary", "OUT"},
        {"basis", 'K', POPT_ARG_INT, &o.components, 0,
         "Use the first K components (default: as the plan says, or all)", "K"},
        {"method", '\0', POPT_ARG_STRING, &o.method, 0,
         "least-squares or ridge (default: what the plan was made for, or least-squares)",
         "METHOD"},
        {"eta", '\0', POPT_ARG_DOUBLE, &o.eta, 0,
         "How much ridge holds against large coefficients (default: 40)", "ETA"},
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
        &t, argc, argv, table, "[OPTION...] [BASIS] READINGS... -o OUT",
        "READINGS is CSV with the columns theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg, "
        "R_per_sr, G_per_sr, B_per_sr in any order, and channel if only one was planned.\n"
        "Without BASIS, the basis of the built-in materials serves. With BASIS, several READINGS "
        "may follow, and "
        "OUT is a folder.\n"
        "Example: gonio reconstruct merl.gonio readings.csv -o new.binary");
    if (code < 0) {
        code = run(&t, &o);
    }
    tool_end(&t);
    return code;
}
