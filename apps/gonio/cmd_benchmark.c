/* gonio benchmark: how well BRDFs are completed from n readings. */
#include "builtin_basis.h"
#include "command_line.h"
#include "group_command.h"
#include "inputs.h"
#include "json_output.h"
#include "material_list.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "benchmark/benchmark.h"
#include "benchmark/directions.h"
#include "benchmark/methods.h"

typedef struct options {
    const char *output;
    const char *learn;
    const char *numbers;
    const char *directions;
    const char *methods;
    const char *external;
    const char *splits;
    long folds;
    long draws;
    long candidates;
    long channels;
    long batch;
    double reach;    /* degrees */
    double noise;    /* per cent */
    double floor;    /* 1/sr */
    double outliers; /* per cent */
    long seed;
    int no_bands;
    int render;
} options;

/* ---- lists of words and numbers ---- */

static bool add_size(const tool *t, size_t n, benchmark_setting *s)
{
    size_t place = 0;
    while (place < s->sizes && s->size[place] < n) {
        place++;
    }
    if (place < s->sizes && s->size[place] == n) {
        return true;
    }
    if (s->sizes == BENCHMARK_MOST_SIZES) {
        return tool_refuse(t, "-n names more than %d numbers", BENCHMARK_MOST_SIZES);
    }
    memmove(s->size + place + 1, s->size + place, (s->sizes - place) * sizeof *s->size);
    s->size[place] = n;
    s->sizes++;
    return true;
}

static bool read_sizes(const tool *t, const options *o, benchmark_setting *s)
{
    s->sizes = o->numbers != NULL ? 0 : s->sizes;
    for (const char *at = o->numbers; at != NULL; at = *at == ',' ? at + 1 : NULL) {
        char *end = NULL;
        const long n = strtol(at, &end, 10);
        if (end == at || (*end != ',' && *end != '\0') || n < 1 || n > 100000) {
            return tool_refuse(t, "-n takes numbers from 1 on with commas between, not '%s'",
                               o->numbers);
        }
        if (!add_size(t, (size_t)n, s)) {
            return false;
        }
        at = end;
    }
    for (size_t k = 0; o->render && k < BENCHMARK_RENDERED_SIZES; k++) {
        if (!add_size(t, benchmark_rendered_sizes[k], s)) {
            return false;
        }
    }
    return true;
}

static const char *method_name(int index)
{
    const benchmark_method *method = benchmark_method_at(index);
    return method != NULL ? method->name : NULL;
}

static const char *directions_name(int index)
{
    const benchmark_directions *ways = benchmark_directions_at(index);
    return ways != NULL ? ways->name : NULL;
}

/* The places of the words of a text in the list that `name` has. */
static bool read_words(const tool *t, const char *option, const char *text,
                       const char *(*name)(int index), int *place, size_t *count)
{
    const char *words[BENCHMARK_MOST_WORDS + 1] = {NULL};
    for (int k = 0; k < BENCHMARK_MOST_WORDS && name(k) != NULL; k++) {
        words[k] = name(k);
    }
    *count = 0;
    for (const char *at = text; at != NULL;) {
        char word[64];
        const size_t length = strcspn(at, ",");
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        if (*count == BENCHMARK_MOST_WORDS) {
            return tool_refuse(t, "%s names more than %d", option, BENCHMARK_MOST_WORDS);
        }
        if (!tool_check_word(t, option, word, words, &place[(*count)++])) {
            return false;
        }
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    return true;
}

static bool read_methods(const tool *t, const options *o, benchmark_setting *s)
{
    const char *usual = "posterior,interpolation,lambert-ggx";
    const int external = benchmark_method_find("external");
    bool named = false;
    if (!read_words(t, "--methods", o->methods != NULL ? o->methods : usual, method_name, s->method,
                    &s->method_count)) {
        return false;
    }
    for (size_t k = 0; k < s->method_count; k++) {
        named = named || s->method[k] == external;
    }
    if (named && o->external == NULL) {
        return tool_refuse(t, "--methods external needs --external COMMAND");
    }
    if (!named && o->external != NULL && s->method_count < BENCHMARK_MOST_WORDS) {
        s->method[s->method_count++] = external;
    }
    s->external = o->external;
    return true;
}

/* ---- the setting ---- */

static bool check_numbers(const tool *t, const options *o)
{
    if (!(o->reach > 0.0 && o->reach <= 90.0)) {
        return tool_refuse(t, "--reach must be above 0 and at most 90 degrees");
    }
    if (!(o->outliers >= 0.0 && o->outliers <= 100.0)) {
        return tool_refuse(t, "--outliers must be 0 to 100 per cent");
    }
    return tool_check_count(t, "--folds", o->folds, 2) &&
           tool_check_count(t, "--draws", o->draws, 1) &&
           tool_check_count(t, "--candidates", o->candidates, 0) &&
           tool_check_count(t, "--wavelengths", o->channels, 0) &&
           tool_check_count(t, "--batch", o->batch, 1) &&
           tool_check_count(t, "--seed", o->seed, 0) &&
           tool_check_not_negative(t, "--noise", o->noise) &&
           tool_check_not_negative(t, "--floor", o->floor);
}

static bool read_setting(const tool *t, const options *o, benchmark_setting *s)
{
    benchmark_setting_default(s);
    if (!check_numbers(t, o) || !read_sizes(t, o, s) || !read_methods(t, o, s)) {
        return false;
    }
    s->splits = o->splits;
    s->folds = (size_t)o->folds;
    s->draws = (size_t)o->draws;
    s->candidates = (size_t)o->candidates;
    s->channels = (size_t)o->channels;
    s->batch = (size_t)o->batch;
    s->no_bands = o->no_bands != 0;
    s->reach = o->reach * M_PI / 180.0;
    s->noise = o->noise / 100.0;
    s->floor = o->floor;
    s->outliers = o->outliers / 100.0;
    s->seed = (uint64_t)o->seed;
    s->render = o->render != 0;
    return read_words(t, "--directions", o->directions != NULL ? o->directions : "planned,random",
                      directions_name, s->directions, &s->direction_count);
}

/* ---- the work ---- */

static int report(const tool *t, const options *o, size_t materials)
{
    if (tool_json) {
        return tool_print_json(t, json_pack("{s:s, s:s+, s:s+, s:I}", "folder", o->output, "report",
                                            o->output, "/report.md", "results", o->output,
                                            "/results.json", "materials", (json_int_t)materials));
    }
    if (!tool_quiet) {
        printf("%s: see report.md, figures, tables and results.json in it\n", o->output);
    }
    return 0;
}

/* A basis file, or materials to learn from. */
static int take_lesson(const tool *t, const options *o, benchmark_setting *s, material_list *list)
{
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    if (o->learn == NULL) {
        return 0;
    }
    if (gonio_file_kind(NULL, o->learn, &kind, NULL) == GONIO_OK && kind == GONIO_KIND_BASIS) {
        s->basis = o->learn;
        return 0;
    }
    const int code = material_list_add_all(t, list, &o->learn, 1);
    s->learn = (const char *const *)list->path;
    s->learn_count = list->count;
    return code;
}

static bool any_scattered(const benchmark_subjects *subjects)
{
    bool any = false;
    for (size_t k = 0; k < subjects->count; k++) {
        any = any || subjects->subject[k].scattered;
    }
    return any;
}

/* Of a table without candidates there is nothing to draw from. */
static bool can_draw(const tool *t, const benchmark_setting *s, const benchmark_subjects *subjects)
{
    bool tables = false;
    for (size_t k = 0; k < subjects->count; k++) {
        tables = tables || !subjects->subject[k].scattered;
    }
    for (size_t k = 0; k < s->direction_count && tables && s->candidates == 0; k++) {
        const benchmark_directions *ways = benchmark_directions_at(s->directions[k]);
        if (ways->drawn) {
            return tool_refuse(t, "--directions %s needs --candidates", ways->name);
        }
    }
    return true;
}

static gonio_status run_on(tool *t, const options *o, benchmark_setting *s,
                           const benchmark_subjects *subjects)
{
    char *builtin = NULL;
    gonio_status status = GONIO_OK;
    if (!can_draw(t, s, subjects)) {
        return GONIO_ERROR_ARGUMENT;
    }
    if (o->learn == NULL && any_scattered(subjects)) {
        status = tool_builtin_basis(t, false, &builtin);
    }
    s->builtin = builtin;
    if (status == GONIO_OK) {
        status = benchmark(t->context, s, subjects, o->output);
        free(builtin);
    }
    return status;
}

/* Finds what is to be tested and tests it; returns an exit code. */
static int run_benchmark(tool *t, const options *o, benchmark_setting *s)
{
    benchmark_subjects subjects = {0};
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    gonio_status status = GONIO_OK;
    s->reading.instrument = t->instrument;
    s->instrument_hash = tool_instrument != NULL ? benchmark_hash(tool_instrument) : 0;
    if (tool_as != NULL) { /* of all files alike */
        status = gonio_convention_parse(t->context, tool_as, &s->reading.as);
    }
    if (status == GONIO_OK) {
        status = benchmark_subjects_find(t->context, arguments, count, &s->reading, &subjects);
    }
    if (status == GONIO_OK) {
        status = run_on(t, o, s, &subjects);
    }
    int code = tool_exit_code(status);
    if (code == 0 && s->group->rank == 0) {
        code = report(t, o, subjects.count);
    }
    benchmark_subjects_free(&subjects);
    return code;
}

static bool check(const tool *t, const options *o)
{
    size_t count = 0;
    tool_arguments(t, &count);
    if (count == 0) {
        return tool_refuse(t, "materials or readings to test are needed");
    }
    return (o->output != NULL && *o->output != '\0') || tool_refuse(t, "no output: give -o FOLDER");
}

static int run(tool *t, const void *given, const process_group *group)
{
    const options *o = given;
    benchmark_setting s;
    material_list list = {0};
    if (!read_setting(t, o, &s) || !check(t, o)) {
        return EXIT_USAGE;
    }
    s.group = group;
    int code = take_lesson(t, o, &s, &list);
    if (code == 0) {
        code = run_benchmark(t, o, &s);
    }
    material_list_free(&list);
    return code;
}

/* The words that options take; to be released with free(). */
static char *help_text(void)
{
    char *text = NULL;
    size_t size = 0;
    const benchmark_directions *ways = NULL;
    const benchmark_method *method = NULL;
    FILE *stream = open_memstream(&text, &size);
    if (stream == NULL) {
        return NULL;
    }
    fputs("Completes materials from n readings, and compares. DIR stands for all materials and\n"
          "readings in it. Without --learn, the materials of a set teach each other by folds, and\n"
          "scattered readings are completed by the built-in basis.\n\nDirections:\n",
          stream);
    for (int k = 0; (ways = benchmark_directions_at(k)) != NULL; k++) {
        fprintf(stream, "  %-14s %s\n", ways->name, ways->summary);
    }
    fputs("Methods:\n", stream);
    for (int k = 0; (method = benchmark_method_at(k)) != NULL; k++) {
        fprintf(stream, "  %-14s %s\n", method->name, method->summary);
    }
    fputs("A run that was stopped resumes when the command is given again.\n"
          "Example: gonio benchmark --learn merl.gonio rgl instruments -n 20,40 -o bench",
          stream);
    fclose(stream);
    return text;
}

int cmd_benchmark(int argc, const char **argv)
{
    options o = {
        .folds = 10, .draws = 3, .candidates = 20000, .channels = 8, .batch = 5, .reach = 80.0};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "The folder to write: a new one, or one to go on with", "OUT"},
        {"learn", '\0', POPT_ARG_STRING, &o.learn, 0,
         "Learn from these materials, or take this basis", "DIR|BASIS"},
        {"number", 'n', POPT_ARG_STRING, &o.numbers, 0, "Readings (default: 5,10,20,40,80,160)",
         "N[,N...]"},
        {"directions", '\0', POPT_ARG_STRING, &o.directions, 0,
         "How directions are chosen, see below (default: planned,random)", "WORD[,WORD...]"},
        {"methods", '\0', POPT_ARG_STRING, &o.methods, 0,
         "What completes the BRDF, see below (default: posterior,interpolation,lambert-ggx)",
         "WORD[,WORD...]"},
        {"external", '\0', POPT_ARG_STRING, &o.external, 0,
         "A program as a method: run as COMMAND READINGS DIRECTIONS PREDICTIONS", "COMMAND"},
        {"render", '\0', POPT_ARG_NONE, &o.render, 0,
         "Compare renderings of tables too, from 8, 16 and 32 readings", NULL},
        {"folds", '\0', POPT_ARG_LONG, &o.folds, 0,
         "Without --learn: parts of a set of materials, tested by turns (default: 10)", "K"},
        {"splits", '\0', POPT_ARG_STRING, &o.splits, 0,
         "Instead of folds, the splits of this JSON file", "FILE"},
        {"draws", '\0', POPT_ARG_LONG, &o.draws, 0, "Draws of random directions (default: 3)", "N"},
        {"candidates", '\0', POPT_ARG_LONG, &o.candidates, 0,
         "Random directions that tables can be read at; 0: any (default: 20000)", "N"},
        {"reach", '\0', POPT_ARG_DOUBLE, &o.reach, 0,
         "Largest polar angle that is read and compared of tables (default: 80)", "DEGREES"},
        {"wavelengths", '\0', POPT_ARG_LONG, &o.channels, 0,
         "Wavelengths of scattered spectra that are tested, evenly spread; 0: all (default: 8)",
         "N"},
        {"no-bands", '\0', POPT_ARG_NONE, &o.no_bands, 0, "Do without 95 % bands, which take time",
         NULL},
        {"batch", '\0', POPT_ARG_LONG, &o.batch, 0,
         "Readings that are chosen at a time on the way (default: 5)", "N"},
        {"noise", '\0', POPT_ARG_DOUBLE, &o.noise, 0,
         "Noise of readings of tables in per cent, standard deviation (default: 0)", "PERCENT"},
        {"floor", '\0', POPT_ARG_DOUBLE, &o.floor, 0,
         "Additive noise of readings of tables in 1/sr (default: 0)", "VALUE"},
        {"outliers", '\0', POPT_ARG_DOUBLE, &o.outliers, 0,
         "Share of directions of tables read ten times too high or too low (default: 0)",
         "PERCENT"},
        {"seed", '\0', POPT_ARG_LONG, &o.seed, 0, "Of all that is random (default: 0)", "N"},
        TOOL_INSTRUMENT_OPTION,
        TOOL_READINGS_OPTIONS,
        TOOL_OPTIONS};
    char *text = help_text();
    tool_group_work work = {run, &o};
    const tool_command_line line = {.table = table,
                                    .usage = "[OPTION...] DIR|FILE... -o OUT",
                                    .text = text != NULL ? text : "",
                                    .work = tool_run_in_group,
                                    .options = &work};
    const int code = tool_run(argc, argv, &line);
    free(text);
    return code;
}
