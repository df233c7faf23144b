/* gonio compare: how far BRDFs are from a reference. */
#include "command_line.h"
#include "inputs.h"
#include "json_output.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

typedef struct options {
    const char *leave_out;
    int verbose;
    int render;
} options;

/* `rendered` is NULL where there is none. */
static void print_row(const char *name, const gonio_error *error, const gonio_image_error *rendered)
{
    const gonio_metric_view *metric = NULL;
    printf("%-28s", name);
    for (int m = 0; (metric = gonio_metric_describe(m)) != NULL; m++) {
        printf(" %9.*f", metric->digits, error->value[m]);
    }
    if (rendered != NULL) {
        printf(" %9.2f %9.3f", rendered->psnr, rendered->delta_e_itp);
    }
    putchar('\n');
}

static json_t *comparison_json(const char *path, const gonio_comparison *c,
                               const gonio_image_error *rendered)
{
    json_t *json = json_pack("{s:s, s:I, s:I, s:o, s:o, s:o, s:o}", "file", path, "bins",
                             (json_int_t)c->bins, "missing_bins", (json_int_t)c->missing, "all",
                             tool_error_json(&c->all), "R", tool_error_json(&c->channel[0]), "G",
                             tool_error_json(&c->channel[1]), "B", tool_error_json(&c->channel[2]));
    if (json != NULL && rendered != NULL) {
        json_object_set_new(json, "rendered",
                            json_pack("{s:o, s:o}", "psnr_db", tool_json_number(rendered->psnr),
                                      "delta_e_itp", tool_json_number(rendered->delta_e_itp)));
    }
    return json;
}

static void print_headings(bool rendered)
{
    const gonio_metric_view *metric = NULL;
    printf("%-28s", "");
    for (int m = 0; (metric = gonio_metric_describe(m)) != NULL; m++) {
        printf(" %9s", metric->heading);
    }
    puts(rendered ? "   PSNR dB    dE_ITP" : "");
}

static void print_comparison(const char *path, const gonio_comparison *c,
                             const gonio_image_error *rendered, const options *o)
{
    static const char *const channels[GONIO_CHANNELS] = {"  R", "  G", "  B"};
    print_row(path, &c->all, rendered);
    for (int k = 0; k < GONIO_CHANNELS && o->verbose; k++) {
        print_row(channels[k], &c->channel[k], NULL);
    }
    if (o->verbose) {
        printf("  %lld bins compared, %lld of the reference have no data here\n",
               (long long)c->bins, (long long)c->missing);
    } else if (c->missing > 0) {
        printf("  (%lld bins of the reference have no data here)\n", (long long)c->missing);
    }
}

/* `seen` is NULL without --render. */
static gonio_status compare_one(tool *t, const gonio_material *reference,
                                const gonio_reference *seen, const char *path, const options *o,
                                json_t *results)
{
    gonio_material *other = NULL;
    gonio_comparison comparison;
    gonio_image_error error;
    const gonio_image_error *rendered = seen != NULL ? &error : NULL;
    gonio_status status = tool_open_material(t, path, &other);
    if (status == GONIO_OK) {
        status = gonio_compare(t->context, reference, other, &comparison);
    }
    if (status == GONIO_OK && seen != NULL) {
        status = gonio_reference_compare(t->context, seen, other, &error);
    }
    gonio_material_free(&other);
    if (status == GONIO_OK && tool_json) {
        json_array_append_new(results, comparison_json(path, &comparison, rendered));
    } else if (status == GONIO_OK) {
        print_comparison(path, &comparison, rendered, o);
    }
    return status;
}

/* ---- readings ---- */

static const gonio_readings_options any_values = {.size = sizeof any_values,
                                                  .values_needed = true,
                                                  .average_repeats = true,
                                                  .negative_to_zero = true};

/* The other's values at the directions of the reference. */
static gonio_status read_like(tool *t, const char *reference, const char *path,
                              gonio_readings **other)
{
    gonio_readings *known = NULL;
    gonio_status status = tool_read_readings(t, path, &any_values, &known);
    if (status == GONIO_OK) {
        status = tool_read_readings(t, reference, &any_values, other);
    }
    if (status == GONIO_OK) {
        status = gonio_readings_look_up(t->context, *other, known);
    }
    gonio_readings_free(&known);
    return status;
}

static gonio_status compare_readings(tool *t, const char *reference_path,
                                     const gonio_readings *reference, const char *path,
                                     const bool *left_out, json_t *results)
{
    gonio_readings *other = NULL;
    gonio_error error;
    size_t compared = 0;
    gonio_status status = read_like(t, reference_path, path, &other);
    if (status == GONIO_OK) {
        status = gonio_compare_readings(t->context, reference, other, left_out, &error, &compared);
    }
    gonio_readings_free(&other);
    if (status == GONIO_OK && tool_json) {
        json_array_append_new(results,
                              json_pack("{s:s, s:I, s:o}", "file", path, "readings",
                                        (json_int_t)compared, "all", tool_error_json(&error)));
    } else if (status == GONIO_OK) {
        print_row(path, &error, NULL);
        printf("  %zu readings compared\n", compared);
    }
    return status;
}

/* Which of the reference's readings were used to make the others. */
static gonio_status find_left_out(tool *t, const gonio_readings *reference, const char *used_path,
                                  bool **left_out)
{
    gonio_readings *used = NULL;
    const gonio_readings_options directions = {
        .size = sizeof directions, .average_repeats = true, .negative_to_zero = true};
    *left_out = calloc(gonio_readings_describe(reference)->count, sizeof **left_out);
    gonio_status status = *left_out == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK && used_path != NULL) {
        status = tool_read_readings(t, used_path, &directions, &used);
    }
    if (status == GONIO_OK && used != NULL) {
        status = gonio_readings_find(t->context, reference, used, *left_out);
    }
    gonio_readings_free(&used);
    return status;
}

static gonio_status compare_all_readings(tool *t, const options *o, const char **paths,
                                         size_t count, json_t *results)
{
    gonio_readings *reference = NULL;
    bool *left_out = NULL;
    gonio_status status = tool_read_readings(t, paths[0], &any_values, &reference);
    if (status == GONIO_OK) {
        status = find_left_out(t, reference, o->leave_out, &left_out);
    }
    for (size_t k = 1; k < count && status == GONIO_OK; k++) {
        status = compare_readings(t, paths[0], reference, paths[k], left_out, results);
    }
    free(left_out);
    gonio_readings_free(&reference);
    return status;
}

/* ---- tables ---- */

static gonio_status compare_all_tables(tool *t, const options *o, const char **paths, size_t count,
                                       json_t *results)
{
    gonio_material *reference = NULL;
    gonio_reference *seen = NULL;
    gonio_status status = tool_open_material(t, paths[0], &reference);
    if (status == GONIO_OK && o->render) {
        status = gonio_reference_create(t->context, reference, NULL, &seen);
    }
    for (size_t k = 1; k < count && status == GONIO_OK; k++) {
        status = compare_one(t, reference, seen, paths[k], o, results);
    }
    gonio_reference_free(&seen);
    gonio_material_free(&reference);
    return status;
}

static bool is_pipe(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode);
}

static bool check(const tool *t, const options *o, const char *reference, bool readings)
{
    if (readings && is_pipe(reference)) {
        return tool_refuse(t, "%s: REFERENCE is read more than once: give a file, not a pipe",
                           reference);
    }
    if (o->leave_out != NULL && !readings) {
        return tool_refuse(t, "--leave-out needs readings, but %s is not a readings file",
                           reference);
    }
    if (o->render && readings) {
        return tool_refuse(t, "--render needs whole materials, but %s is a readings file",
                           reference);
    }
    return true;
}

static int run(tool *t, void *given)
{
    const options *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    if (count < 2) {
        tool_refuse(t, "REFERENCE and at least one OTHER are needed");
        return EXIT_USAGE;
    }
    gonio_status status = gonio_file_expect(t->context, arguments[0],
                                            GONIO_KIND_MATERIAL | GONIO_KIND_READINGS, &kind);
    if (status != GONIO_OK) {
        return tool_exit_code(status);
    }
    const bool readings = kind == GONIO_KIND_READINGS;
    if (!check(t, o, arguments[0], readings)) {
        return EXIT_USAGE;
    }
    json_t *results = json_array();
    if (!tool_json) {
        print_headings(o->render);
    }
    status = readings ? compare_all_readings(t, o, arguments, count, results)
                      : compare_all_tables(t, o, arguments, count, results);
    if (status == GONIO_OK && tool_json) {
        return tool_print_json(
            t, json_pack("{s:s, s:o}", "reference", arguments[0], "comparisons", results));
    }
    json_decref(results);
    return tool_exit_code(status);
}

/* What the errors are; to be released with free(). */
static char *help_text(void)
{
    char *text = NULL;
    size_t size = 0;
    const gonio_metric_view *metric = NULL;
    FILE *stream = open_memstream(&text, &size);
    if (stream == NULL) {
        return NULL;
    }
    for (int m = 0; (metric = gonio_metric_describe(m)) != NULL; m++) {
        fprintf(stream, "%s: %s.\n", metric->heading, metric->summary);
    }
    fputs(
        "With --render, of tone-mapped spheres in the built-in studio: PSNR, and dE_ITP, the mean\n"
        "Delta E_ITP (BT.2124; 1 can just be seen).",
        stream);
    fclose(stream);
    return text;
}

int cmd_compare(int argc, const char **argv)
{
    options o = {0};
    const struct poptOption table[] = {
        {"verbose", 'v', POPT_ARG_NONE, &o.verbose, 0, "Each channel, and the bins compared", NULL},
        {"leave-out", '\0', POPT_ARG_STRING, &o.leave_out, 0,
         "Of readings: leave out the directions of this file (those that were used)", "FILE"},
        {"render", '\0', POPT_ARG_NONE, &o.render, 0, "Also render both and compare the renderings",
         NULL},
        TOOL_READINGS_OPTIONS,
        TOOL_OPTIONS};
    char *text = help_text();
    const tool_command_line line = {.table = table,
                                    .usage = "[OPTION...] REFERENCE OTHER...",
                                    .text = text != NULL ? text : "",
                                    .work = run,
                                    .options = &o};
    const int code = tool_run(argc, argv, &line);
    free(text);
    return code;
}
