/* gonio reconstruct: BRDFs from a few readings. */
#include "anisotropic_result.h"
#include "aperture_options.h"
#include "builtin_basis.h"
#include "command_line.h"
#include "correction_options.h"
#include "inputs.h"
#include "json_output.h"
#include "posterior_options.h"
#include "reconstruction_report.h"
#include "write_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct options {
    const char *output;
    const char *method;
    double eta;
    posterior_options posterior;
    correction_options corrections;
    aperture_options aperture;
    const char *albedo_at;
    tool_reflectances reflectances; /* of albedo_at */
    const char *predict_at;
    int bands;
    const char *deviation;
    int components;
    int all_channels;
    int other_basis;
    int average_repeats;
    int negative_to_zero;
    int anisotropic;
    int symmetry;
    write_options write;
    gonio_write_options how; /* of write */
} options;

static gonio_reconstruct_options settings(const options *o)
{
    gonio_reconstruct_options how = {.size = sizeof how,
                                     .components = (size_t)o->components,
                                     .all_channels = o->all_channels,
                                     .other_basis = o->other_basis,
                                     .method = o->method,
                                     .eta = o->eta,
                                     .deviation =
                                         o->deviation != NULL || o->albedo_at != NULL || o->bands,
                                     .symmetry = o->symmetry,
                                     .source_aperture = o->aperture.source * M_PI / 180.0,
                                     .detector_aperture = o->aperture.detector * M_PI / 180.0};
    posterior_options_apply(&o->posterior, &how);
    return how;
}

/* Reads where the BRDF is to be predicted. */
static gonio_status read_directions(tool *t, const options *o, gonio_readings **at)
{
    const gonio_readings_options any = {.size = sizeof any,
                                        .average_repeats = true,
                                        .negative_to_zero = true,
                                        .instrument = o->aperture.made};
    return tool_read_readings(t, o->predict_at, &any, at);
}

/* Writes the deviations as a table, or the values at the directions of a file, which `at` then has.
 */
static gonio_status write_more(tool *t, const options *o, const gonio_basis *basis,
                               const gonio_reconstruction *made, gonio_readings *at)
{
    gonio_material *deviation = NULL;
    gonio_status status = GONIO_OK;
    if (o->deviation != NULL) {
        status = gonio_reconstruction_deviation_material(t->context, basis, made, &deviation);
    }
    if (status == GONIO_OK && at != NULL) {
        status = gonio_reconstruction_predict_readings(t->context, basis, made, at);
    }
    if (status == GONIO_OK && at != NULL && !o->bands) {
        status = gonio_readings_set_deviations(t->context, at, NULL);
    }
    if (status == GONIO_OK && deviation != NULL) {
        status = gonio_material_write_merl(t->context, deviation, o->deviation);
    }
    if (status == GONIO_OK && at != NULL) {
        status = gonio_readings_write(t->context, at, t->command_line, o->output);
    }
    gonio_material_free(&deviation);
    return status;
}

/* Whether the output is a MERL table of colours under light of equal energy. */
static bool is_merl(const options *o, const char *output)
{
    const int writer = gonio_material_writer_find(output, o->how.format);
    return strcmp(gonio_material_writer_name(writer), "merl") == 0 && o->write.illuminant == NULL;
}

/* Opens the result as a material, in the channels of the output: MERL tables have R, G, B. */
static gonio_status open_made(tool *t, const options *o, const gonio_basis *basis,
                              const gonio_reconstruction *made, const char *output,
                              gonio_material **material)
{
    if (is_merl(o, output)) {
        return gonio_reconstruction_material(t->context, basis, made, "reconstruction", material);
    }
    gonio_status status =
        gonio_reconstruction_spectral_material(t->context, basis, made, "reconstruction", material);
    if (status == GONIO_OK) {
        status = write_options_apply(t, &o->write, *material);
    }
    return status;
}

/* Writes the output and what is wanted besides, both or none. material: NULL where `write_more`
 * writes the output. */
static gonio_status write_both(tool *t, const options *o, const gonio_basis *basis,
                               const gonio_reconstruction *made, const gonio_material *material,
                               gonio_readings *at, const char *output)
{
    gonio_status status = gonio_outputs_hold(t->context);
    if (status == GONIO_OK) {
        status = write_more(t, o, basis, made, at);
    }
    if (status == GONIO_OK && material != NULL) {
        status = gonio_material_write(t->context, material, output, &o->how);
    }
    return gonio_outputs_release(t->context, status);
}

/* Reconstructs one file of readings when more than the table is wanted. */
static gonio_status reconstruct_one(tool *t, const options *o, const gonio_basis *basis,
                                    const gonio_readings *readings, char *output, json_t *results)
{
    gonio_reconstruct_options how = settings(o);
    gonio_reconstruction *made = NULL;
    gonio_material *material = NULL;
    gonio_readings *at = NULL;
    gonio_status status = o->predict_at != NULL ? read_directions(t, o, &at) : GONIO_OK;
    if (at != NULL) {
        how.expected_at = gonio_readings_describe(at)->pair;
        how.expected_count = gonio_readings_describe(at)->count;
    }
    if (status == GONIO_OK) {
        status = gonio_reconstruct(t->context, basis, readings, &how, &made);
    }
    if (status == GONIO_OK && o->predict_at == NULL) {
        status = open_made(t, o, basis, made, output, &material);
    }
    if (status == GONIO_OK) {
        status = write_both(t, o, basis, made, material, at, output);
    }
    if (status == GONIO_OK) {
        status = reconstruction_report(t, &o->reflectances, basis, &made, &output, 1, results);
    }
    gonio_readings_free(&at);
    gonio_material_free(&material);
    gonio_reconstruction_free(&made);
    return status;
}

static gonio_status reconstruct_anisotropic(tool *t, const options *o, const gonio_basis *basis,
                                            gonio_readings *const *readings, char *const *outputs,
                                            size_t count, json_t *results)
{
    const gonio_reconstruct_options how = settings(o);
    const anisotropic_task task = {basis, &how, &o->write, &o->how, o->predict_at};
    gonio_status status = GONIO_OK;
    if ((how.source_aperture > 0.0 || how.detector_aperture > 0.0) && !tool_quiet) {
        fprintf(stderr,
                "gonio reconstruct: note: %s: its apertures do not count with "
                "--anisotropic\n",
                o->aperture.instrument);
    }
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = anisotropic_result_write(t, &task, readings[k], outputs[k], results);
    }
    return status;
}

static gonio_status reconstruct(tool *t, const options *o, const gonio_basis *basis,
                                gonio_readings *const *readings, char *const *outputs, size_t count,
                                json_t *results)
{
    if (o->anisotropic) {
        return reconstruct_anisotropic(t, o, basis, readings, outputs, count, results);
    }
    bool merl = o->predict_at == NULL && o->deviation == NULL;
    for (size_t k = 0; k < count; k++) {
        merl = merl && is_merl(o, outputs[k]);
    }
    if (!merl) {
        gonio_status status = GONIO_OK;
        for (size_t k = 0; k < count && status == GONIO_OK; k++) {
            status = reconstruct_one(t, o, basis, readings[k], outputs[k], results);
        }
        return status;
    }
    const gonio_reconstruct_options how = settings(o);
    gonio_reconstruction **made = calloc(count, sizeof(gonio_reconstruction *));
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status =
        gonio_reconstruct_tables(t->context, basis, (const gonio_readings *const *)readings,
                                 (const char *const *)outputs, count, &how, made);
    const gonio_status reported =
        reconstruction_report(t, &o->reflectances, basis, made, outputs, count, results);
    status = status == GONIO_OK ? reported : status;
    for (size_t k = 0; k < count; k++) {
        gonio_reconstruction_free(&made[k]);
    }
    free(made);
    return status;
}

/* FOLDER/NAME.binary for readings NAME.csv, or the extension of another format. */
static char *path_in_folder(const options *o, const char *folder, const char *file)
{
    const char *extension =
        gonio_material_writer_extension(gonio_material_writer_find("", o->how.format));
    const char *slash = strrchr(file, '/');
    const char *name = slash != NULL ? slash + 1 : file;
    const char *dot = strrchr(name, '.');
    const int length = dot != NULL && dot != name ? (int)(dot - name) : (int)strlen(name);
    char *path = NULL;
    return asprintf(&path, "%s/%.*s%s", folder, length, name, extension) < 0 ? NULL : path;
}

/* Reads readings before the basis, which takes longer, so that their errors appear at once. */
static int reconstruct_all(tool *t, const options *o, const char *basis_path,
                           const char *const *paths, char *const *outputs, size_t count,
                           json_t *results)
{
    const gonio_readings_options how = {.size = sizeof how,
                                        .values_needed = true,
                                        .average_repeats = o->average_repeats,
                                        .negative_to_zero = o->negative_to_zero,
                                        .instrument = o->aperture.made};
    gonio_readings **readings = calloc(count, sizeof *readings);
    gonio_basis *basis = NULL;
    gonio_status status = readings == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = tool_read_corrected(t, paths[k], &how, &o->corrections, o->posterior.noise / 100.0,
                                     o->posterior.floor, &readings[k]);
    }
    if (status == GONIO_OK) {
        const char *planned = gonio_readings_describe(readings[0])->method;
        status = tool_basis(t, basis_path, o->method != NULL ? o->method : planned, &basis);
    }
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = tool_keep_read_channels(t, basis, readings[k]);
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

/* Checks that no two outputs are the same file. */
static bool check_different(const tool *t, const char *const *paths, char *const *outputs,
                            size_t count)
{
    for (size_t k = 1; k < count; k++) {
        for (size_t j = 0; j < k; j++) {
            if (tool_is_one_output(outputs[j], outputs[k])) {
                return tool_refuse(t, "%s and %s would both be written to %s; rename one", paths[j],
                                   paths[k], outputs[k]);
            }
        }
    }
    return true;
}

/* Chooses the outputs: in a folder if there are several results or if OUT is a folder. Returns an
 * exit code. */
static int choose_outputs(const options *o, const char *const *paths, size_t count, char **outputs)
{
    const bool folder = is_folder(o->output);
    for (size_t k = 0; k < count; k++) {
        outputs[k] = folder ? path_in_folder(o, o->output, paths[k]) : strdup(o->output);
        if (outputs[k] == NULL) {
            return EXIT_DATA;
        }
    }
    return 0;
}

/* Checks the outputs besides OUT. */
static bool check_more(const tool *t, const options *o, const char *const *inputs, size_t count)
{
    if (o->predict_at != NULL && !tool_check_output(t, o->output, &o->predict_at, 1)) {
        return false;
    }
    if (o->bands && o->predict_at == NULL) {
        return tool_refuse(t, "--bands needs --predict-at FILE");
    }
    if (o->deviation != NULL && tool_is_one_output(o->deviation, o->output)) {
        return tool_refuse(t, "--deviation and -o name the same file");
    }
    return o->deviation == NULL || (tool_check_output(t, o->deviation, inputs, count) &&
                                    tool_check_output(t, o->deviation, &o->predict_at, 1));
}

/* Checks what goes with --anisotropic. */
static bool check_anisotropic(const tool *t, const options *o)
{
    if (o->method != NULL && strcmp(o->method, "posterior") != 0) {
        return tool_refuse(t, "--anisotropic needs --method posterior");
    }
    if (o->deviation != NULL) {
        return tool_refuse(t, "--deviation is a table of an isotropic material; with --anisotropic "
                              "--predict-at has the deviations");
    }
    if (o->albedo_at != NULL) {
        return tool_refuse(t, "--albedo-at is of isotropic materials; 'gonio info' of what "
                              "--anisotropic writes has its albedo");
    }
    if (o->aperture.aperture != NULL) {
        return tool_refuse(t, "--aperture does not go with --anisotropic");
    }
    return anisotropic_check_symmetry(t, o->symmetry);
}

static bool check(const tool *t, const options *o, const char *const *inputs, size_t count)
{
    if (count == 0) {
        return tool_refuse(t, "READINGS are needed; give a BASIS before them if you have one");
    }
    if (count > 2 && !is_folder(o->output)) {
        return tool_refuse(t, "several READINGS need a folder that exists: -o DIR");
    }
    if ((o->predict_at != NULL || o->deviation != NULL) && count > 2) {
        return tool_refuse(t, "--predict-at and --deviation take one READINGS");
    }
    if (o->anisotropic && !check_anisotropic(t, o)) {
        return false;
    }
    if (!(o->eta > 0.0)) {
        return tool_refuse(t, "--eta must be above 0");
    }
    return tool_check_output(t, o->output, inputs, count) &&
           tool_check_count(t, "--components", o->components, 0) &&
           posterior_options_check(t, &o->posterior) && check_more(t, o, inputs, count);
}

static bool check_outputs(const tool *t, const char *const *inputs, size_t count,
                          const char *const *paths, char *const *outputs, size_t outputs_count)
{
    for (size_t k = 0; k < outputs_count; k++) {
        if (!tool_check_output(t, outputs[k], inputs, count)) {
            return false;
        }
    }
    return check_different(t, paths, outputs, outputs_count);
}

/* Prints one object, or an array with an object for each file of readings. */
static int print_results(const tool *t, json_t *results)
{
    return tool_print_json(t, json_array_size(results) > 1
                                  ? json_incref(results)
                                  : json_incref(json_array_get(results, 0)));
}

/* Works by the instrument's noise, once it is known. */
static int run_settled(tool *t, options *o)
{
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (!check(t, o, arguments, count) ||
        !tool_check_albedo_at(t, o->albedo_at, &o->reflectances) ||
        !write_options_check(t, &o->write, &o->how)) {
        return EXIT_USAGE;
    }
    const char *basis = count > 1 ? arguments[0] : NULL;
    const char *const *paths = count > 1 ? arguments + 1 : arguments;
    const size_t readings = count > 1 ? count - 1 : 1;
    char **outputs = calloc(readings, sizeof *outputs);
    json_t *results = tool_json ? json_array() : NULL;
    int code = outputs == NULL ? EXIT_DATA : choose_outputs(o, paths, readings, outputs);
    if (code == 0 && !check_outputs(t, arguments, count, paths, outputs, readings)) {
        code = EXIT_USAGE;
    }
    if (code == 0) {
        code = reconstruct_all(t, o, basis, paths, outputs, readings, results);
    }
    if (code == 0 && results != NULL) {
        code = print_results(t, results);
    }
    json_decref(results);
    for (size_t k = 0; outputs != NULL && k < readings; k++) {
        free(outputs[k]);
    }
    free(outputs);
    return code;
}

static int run(tool *t, void *given)
{
    options *o = given;
    if (!aperture_options_check(t, &o->aperture, o->output)) {
        return EXIT_USAGE;
    }
    const gonio_status status = aperture_options_apply(t, &o->aperture, &o->posterior);
    const int code = status == GONIO_OK ? run_settled(t, o) : tool_exit_code(status);
    aperture_options_end(&o->aperture);
    return code;
}

int cmd_reconstruct(int argc, const char **argv)
{
    gonio_reconstruct_options usual;
    gonio_reconstruct_options_default(&usual);
    options o = {.eta = usual.eta, .posterior = posterior_options_open()};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "The MERL .binary table or file of another format to write, or a folder for NAME.binary",
         "OUT"},
        WRITE_OPTIONS(&o.write),
        {"components", 'K', POPT_ARG_INT, &o.components, 0,
         "Use the first K components (default: as many as the plan is for, or all)", "K"},
        {"method", '\0', POPT_ARG_STRING, &o.method, 0,
         "posterior, least-squares or ridge (default: what the plan was made for, or posterior for "
         "a basis with mixtures and least-squares for others)",
         "METHOD"},
        {"eta", '\0', POPT_ARG_DOUBLE, &o.eta, 0,
         "Weight of the penalty of ridge on large coefficients (default: 40)", "ETA"},
        {"all-channels", '\0', POPT_ARG_NONE, &o.all_channels, 0,
         "Use every channel that was read, not only the planned one", NULL},
        POSTERIOR_OPTIONS(&o.posterior),
        CORRECTION_OPTIONS(&o.corrections),
        APERTURE_OPTIONS(&o.aperture),
        TOOL_ALBEDO_AT(&o.albedo_at),
        {"deviation", '\0', POPT_ARG_STRING, &o.deviation, 0,
         "Also write the standard deviation of ln(1 + rho/s), as a table (posterior)", "FILE"},
        {"predict-at", '\0', POPT_ARG_STRING, &o.predict_at, 0,
         "Predict readings at the directions of this file, as CSV, in place of a table (posterior)",
         "FILE"},
        {"bands", '\0', POPT_ARG_NONE, &o.bands, 0,
         "Predict readings with their standard deviations, in columns of their own", NULL},
        {"anisotropic", '\0', POPT_ARG_NONE, &o.anisotropic, 0,
         "The material changes as the sample turns: azimuths of all directions count (posterior)",
         NULL},
        SYMMETRY_OPTION(&o.symmetry),
        {"average-repeats", '\0', POPT_ARG_NONE, &o.average_repeats, 0,
         "Accept directions that were read more than once", NULL},
        {"negative-to-zero", '\0', POPT_ARG_NONE, &o.negative_to_zero, 0,
         "Take negative readings as 0", NULL},
        {"other-basis", '\0', POPT_ARG_NONE, &o.other_basis, 0,
         "Accept readings that were planned with another basis", NULL},
        TOOL_READINGS_OPTIONS,
        TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] [BASIS] READINGS... -o OUT",
        .text = "READINGS is CSV with the columns theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg, "
                "R_per_sr, G_per_sr, B_per_sr in any order, and a column channel if only one "
                "channel of each direction was planned.\n"
                "Without BASIS, the basis of the built-in materials is used. With BASIS, several "
                "READINGS may follow; OUT is then a folder.\n"
                "Example: gonio reconstruct merl.gonio readings.csv -o new.binary",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
