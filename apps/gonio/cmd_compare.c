/* gonio compare: the errors of materials or readings relative to a reference, which is either. */
#include "command_line.h"
#include "inputs.h"
#include "json_output.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct options {
    const char *leave_out;
    int verbose;
    int render;
} options;

/* Prints a row of errors. `rendered`: NULL without --render. */
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
    json_t *json =
        json_pack("{s:o, s:I, s:I, s:o, s:o, s:o, s:o}", "file", tool_json_text(path), "bins",
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

/* what: "bins", or "directions" of materials that depend on the azimuth. */
static void print_comparison(const char *path, const char *what, const gonio_comparison *c,
                             const gonio_image_error *rendered, const options *o)
{
    static const char *const channels[GONIO_CHANNELS] = {"  R", "  G", "  B"};
    print_row(path, &c->all, rendered);
    for (int k = 0; k < GONIO_CHANNELS && o->verbose; k++) {
        print_row(channels[k], &c->channel[k], NULL);
    }
    if (o->verbose) {
        printf("  %lld %s compared, %lld of the reference have no data here\n", (long long)c->bins,
               what, (long long)c->missing);
    } else if (c->missing > 0) {
        printf("  (%lld %s of the reference have no data here)\n", (long long)c->missing, what);
    }
}

/* ---- two materials ---- */

/* What the others are compared with. */
typedef struct comparing {
    const options *o;
    tool_input reference;
    gonio_reference *seen; /* the rendered reference; NULL without --render */
    tool_input used;       /* readings of --leave-out; none without */
    bool left_out_said;
    json_t *results;
} comparing;

static gonio_status compare_materials(tool *t, comparing *c, const tool_input *other)
{
    gonio_comparison comparison;
    gonio_image_error error;
    const gonio_image_error *rendered = c->seen != NULL ? &error : NULL;
    const bool turned = gonio_material_describe(c->reference.material)->anisotropic ||
                        gonio_material_describe(other->material)->anisotropic;
    gonio_status status =
        gonio_compare(t->context, c->reference.material, other->material, &comparison);
    if (status == GONIO_OK && c->seen != NULL) {
        status = gonio_reference_compare(t->context, c->seen, other->material, &error);
    }
    if (status == GONIO_OK && tool_json) {
        json_array_append_new(c->results, comparison_json(other->path, &comparison, rendered));
    } else if (status == GONIO_OK) {
        print_comparison(other->path, turned ? "directions" : "bins", &comparison, rendered, c->o);
    }
    return status;
}

/* ---- readings with readings or materials ---- */

/* Values of the reference and of the other at the same directions, in the same channels. */
typedef struct paired {
    const gonio_readings *reference; /* those of the input, or copied */
    gonio_readings *copied;          /* NULL: the input's serve */
    gonio_readings *other;
    bool *left_out; /* [count] */
    size_t left_out_count;
} paired;

static void free_paired(paired *p)
{
    gonio_readings_free(&p->copied);
    gonio_readings_free(&p->other);
    free(p->left_out);
}

static bool have_same_channels(const gonio_readings *a, const gonio_readings *b)
{
    const gonio_readings_view *x = gonio_readings_describe(a);
    const gonio_readings_view *y = gonio_readings_describe(b);
    bool same = x->channels == y->channels && (x->wavelength == NULL) == (y->wavelength == NULL);
    for (size_t k = 0; same && x->wavelength != NULL && k < x->channels; k++) {
        same = x->wavelength[k] == y->wavelength[k];
    }
    return same;
}

/* The values of the other at the directions of the reference, which is readings. The other's own
 * readings are then not needed: there may be millions. */
static gonio_status pair_at_reference(tool *t, const comparing *c, tool_input *other, paired *p)
{
    p->reference = c->reference.readings;
    gonio_status status = gonio_readings_copy(t->context, p->reference, &p->other);
    if (status == GONIO_OK) {
        status = tool_take_values(t, other, NULL, p->other);
    }
    tool_close_input(other);
    if (status != GONIO_OK || have_same_channels(p->reference, p->other)) {
        return status;
    }
    status = gonio_readings_copy(t->context, p->reference, &p->copied);
    p->reference = p->copied;
    return status == GONIO_OK ? gonio_readings_share_channels(t->context, p->copied, p->other)
                              : status;
}

/* The values of the reference, a material, at the directions of the other. */
static gonio_status pair_at_other(tool *t, const comparing *c, const tool_input *other, paired *p)
{
    gonio_status status = gonio_readings_copy(t->context, other->readings, &p->copied);
    if (status == GONIO_OK) {
        status = gonio_readings_copy(t->context, other->readings, &p->other);
    }
    if (status == GONIO_OK) {
        status = tool_take_values(t, &c->reference, NULL, p->copied);
    }
    p->reference = p->copied;
    return status == GONIO_OK ? gonio_readings_share_channels(t->context, p->copied, p->other)
                              : status;
}

/* Counts the used directions that are among the readings. Reports it unless all of them are. */
static gonio_status check_used(tool *t, comparing *c, const gonio_readings *readings)
{
    const gonio_readings_view *used = gonio_readings_describe(c->used.readings);
    bool *found = calloc(used->count, sizeof *found);
    size_t count = 0;
    const gonio_status status =
        found != NULL ? gonio_readings_find(t->context, c->used.readings, readings, found)
                      : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < used->count && status == GONIO_OK; k++) {
        count += found[k];
    }
    if (status == GONIO_OK && count < used->count && !c->left_out_said) {
        char text[512];
        snprintf(text, sizeof text,
                 "--leave-out: %zu of %zu directions of %s are among the readings", count,
                 used->count, c->used.path);
        tool_say(&t->messages, count == 0 ? GONIO_MESSAGE_WARNING : GONIO_MESSAGE_NOTE, text);
        c->left_out_said = true;
    }
    free(found);
    return status;
}

/* Finds the readings that are left out, because they were used to make the others. */
static gonio_status find_left_out(tool *t, comparing *c, paired *p)
{
    const size_t count = gonio_readings_describe(p->reference)->count;
    p->left_out = calloc(count, sizeof *p->left_out);
    if (p->left_out == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    if (c->used.readings == NULL) {
        return GONIO_OK;
    }
    gonio_status status =
        gonio_readings_find(t->context, p->reference, c->used.readings, p->left_out);
    for (size_t k = 0; k < count; k++) {
        p->left_out_count += p->left_out[k];
    }
    return status == GONIO_OK ? check_used(t, c, p->reference) : status;
}

static void report_readings(const comparing *c, const char *path, const paired *p,
                            const gonio_error *error, size_t compared)
{
    const size_t missing =
        gonio_readings_describe(p->reference)->count - p->left_out_count - compared;
    if (tool_json) {
        json_array_append_new(c->results,
                              json_pack("{s:o, s:I, s:I, s:I, s:o}", "file", tool_json_text(path),
                                        "readings", (json_int_t)compared, "left_out",
                                        (json_int_t)p->left_out_count, "missing",
                                        (json_int_t)missing, "all", tool_error_json(error)));
        return;
    }
    print_row(path, error, NULL);
    printf("  %zu readings compared", compared);
    if (missing > 0) {
        printf(", %zu without a value in both", missing);
    }
    putchar('\n');
}

static gonio_status compare_readings(tool *t, comparing *c, tool_input *other)
{
    paired p = {0};
    gonio_error error;
    size_t compared = 0;
    gonio_status status = c->reference.readings != NULL ? pair_at_reference(t, c, other, &p)
                                                        : pair_at_other(t, c, other, &p);
    if (status == GONIO_OK) {
        status = find_left_out(t, c, &p);
    }
    if (status == GONIO_OK) {
        status =
            gonio_compare_readings(t->context, p.reference, p.other, p.left_out, &error, &compared);
    }
    if (status == GONIO_OK) {
        report_readings(c, other->path, &p, &error, compared);
    }
    free_paired(&p);
    return status;
}

/* ---- any two ---- */

/* Opens an input. Repeats get one value, so that readings do not differ from themselves. */
static gonio_status open_input(tool *t, const char *path, tool_input *input)
{
    const gonio_status status = tool_open_input(t, path, input);
    return status == GONIO_OK && input->readings != NULL
               ? gonio_readings_average_repeats(t->context, input->readings)
               : status;
}

static gonio_status compare_one(tool *t, comparing *c, const char *path)
{
    tool_input other = {0};
    gonio_status status = open_input(t, path, &other);
    if (status == GONIO_OK && c->seen != NULL && other.material == NULL) {
        tool_refuse(t, "--render needs whole materials, but %s is a readings file", path);
        status = GONIO_ERROR_ARGUMENT;
    }
    if (status == GONIO_OK && c->used.readings != NULL && c->reference.readings == NULL &&
        other.readings == NULL) {
        tool_refuse(t, "--leave-out needs readings, but %s is not a readings file", path);
        status = GONIO_ERROR_ARGUMENT;
    }
    if (status == GONIO_OK) {
        status = c->reference.readings != NULL || other.readings != NULL
                     ? compare_readings(t, c, &other)
                     : compare_materials(t, c, &other);
    }
    tool_close_input(&other);
    return status;
}

/* Opens the reference and the readings of --leave-out before anything is compared. */
static gonio_status prepare(tool *t, comparing *c, const char *path)
{
    const gonio_readings_options directions = {.size = sizeof directions,
                                               .average_repeats = true,
                                               .negative_to_zero = true,
                                               .instrument = t->instrument};
    gonio_status status = open_input(t, path, &c->reference);
    if (status == GONIO_OK && c->o->render && c->reference.material == NULL) {
        tool_refuse(t, "--render needs whole materials, but %s is a readings file", path);
        return GONIO_ERROR_ARGUMENT;
    }
    if (status == GONIO_OK && c->o->leave_out != NULL) {
        c->used.path = c->o->leave_out;
        status = tool_read_readings(t, c->o->leave_out, &directions, &c->used.readings);
    }
    if (status == GONIO_OK && c->o->render) {
        status = gonio_reference_create(t->context, c->reference.material, NULL, &c->seen);
    }
    return status;
}

static int compare_all(tool *t, comparing *c, const char **paths, size_t count)
{
    gonio_status status = prepare(t, c, paths[0]);
    if (status == GONIO_OK && !tool_json) {
        print_headings(c->o->render);
    }
    for (size_t k = 1; k < count && status == GONIO_OK; k++) {
        status = compare_one(t, c, paths[k]);
    }
    gonio_reference_free(&c->seen);
    tool_close_input(&c->used);
    tool_close_input(&c->reference);
    return tool_exit_code(status);
}

static int run(tool *t, void *given)
{
    comparing c = {.o = given};
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count < 2) {
        tool_refuse(t, "REFERENCE and at least one OTHER are needed");
        return EXIT_USAGE;
    }
    c.results = json_array();
    const int code = compare_all(t, &c, arguments, count);
    if (code == 0 && tool_json) {
        return tool_print_json(t, json_pack("{s:o, s:o}", "reference", tool_json_text(arguments[0]),
                                            "comparisons", c.results));
    }
    json_decref(c.results);
    return code;
}

/* The help text on the errors, which the caller frees. */
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
        {"verbose", 'v', POPT_ARG_NONE, &o.verbose, 0,
         "Also print each channel, and the number of bins", NULL},
        {"leave-out", '\0', POPT_ARG_STRING, &o.leave_out, 0,
         "Leave out the directions of these readings, because they were used", "FILE"},
        {"render", '\0', POPT_ARG_NONE, &o.render, 0, "Also render both and compare the renderings",
         NULL},
        TOOL_INSTRUMENT_OPTION,
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
