/* gonio learn: a basis from measured materials. */
#include "paths.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct options {
    const char *output;
    const char *representation;
    const char *channels;
    const char *mapping;
    const char *without;
    int no_mean;
    int components;
    int json;
} options;

/* A path's material name: what follows "atlas:", or the base name without its extension. */
static size_t name_in(const char *path, const char **name)
{
    const char *slash = strrchr(path, '/');
    *name = strncmp(path, "atlas:", 6) == 0 ? path + 6 : slash != NULL ? slash + 1 : path;
    const char *dot = strrchr(*name, '.');
    return dot != NULL && dot != *name ? (size_t)(dot - *name) : strlen(*name);
}

/* Takes the materials of a comma-separated list of names out of the paths. */
static int leave_out(const tool *t, tool_paths *list, const char *without)
{
    for (const char *next = without; next != NULL && *next != '\0';) {
        const size_t length = strcspn(next, ",");
        size_t kept = 0;
        const size_t before = list->count;
        for (size_t k = 0; k < before; k++) {
            const char *name = NULL;
            const size_t size = name_in(list->path[k], &name);
            if (size == length && strncmp(name, next, length) == 0) {
                free(list->path[k]);
            } else {
                list->path[kept++] = list->path[k];
            }
        }
        list->count = kept;
        if (kept == before) {
            return tool_usage_error(t, "--without: no material is called '%.*s'", (int)length,
                                    next);
        }
        next += length + (next[length] == ',' ? 1 : 0);
    }
    return 0;
}

static int choose(const tool *t, const char *option, const char *text, const char *const words[2],
                  int *choice)
{
    for (int k = 0; k < 2; k++) {
        if (strcmp(text, words[k]) == 0) {
            *choice = k;
            return 0;
        }
    }
    return tool_usage_error(t, "%s: '%s' is neither '%s' nor '%s'", option, text, words[0],
                            words[1]);
}

static int report(const tool *t, const gonio_basis *basis, const options *o)
{
    const gonio_basis_view view = gonio_basis_describe(basis);
    const double share = gonio_basis_cumulative_variance(basis, view.components);
    if (o->json) {
        return tool_print_json(t, json_pack("{s:s, s:I, s:I, s:I, s:f}", "basis", o->output,
                                            "materials", (json_int_t)view.materials, "components",
                                            (json_int_t)view.components, "cells",
                                            (json_int_t)view.cells, "explained_variance", share));
    }
    if (!tool_quiet) {
        printf("%s: %zu components from %zu materials on %zu cells, %.2f %% of the variance\n",
               o->output, view.components, view.materials, view.cells, 100.0 * share);
    }
    return 0;
}

static int learn(tool *t, const options *o, const tool_paths *list,
                 const gonio_database_options *how)
{
    gonio_database *database = NULL;
    gonio_basis *basis = NULL;
    const gonio_basis_options settings = {.components = (size_t)o->components,
                                          .without_mean = o->no_mean};
    gonio_status status = gonio_database_create(t->context, (const char *const *)list->path,
                                                list->count, how, &database);
    if (status == GONIO_OK) {
        status = gonio_basis_learn(t->context, database, &settings, &basis);
    }
    if (status == GONIO_OK) {
        status = gonio_basis_write(t->context, basis, t->command_line, o->output);
    }
    const int code = status == GONIO_OK ? report(t, basis, o) : tool_exit_code(status);
    gonio_basis_free(&basis);
    gonio_database_free(&database);
    return code;
}

static int run(tool *t, const options *o)
{
    static const char *const representations[2] = {"bivariate", "full"};
    static const char *const channel_models[2] = {"joint", "separate"};
    static const char *const mappings[2] = {"log", "relative"};
    size_t count = 0;
    int representation = 0;
    int channels = 0;
    int mapping = 0;
    const char **arguments = tool_arguments(t, &count);
    tool_paths list = {0};
    int code = count == 0 ? tool_usage_error(t, "no materials given") : 0;
    if (code == 0) {
        code = tool_check_count(t, "--basis", o->components, o->components == 0 ? 0 : 1);
    }
    if (code == 0) {
        code = choose(t, "--grid", o->representation, representations, &representation);
    }
    if (code == 0) {
        code = choose(t, "--channels", o->channels, channel_models, &channels);
    }
    if (code == 0) {
        code = choose(t, "--mapping", o->mapping, mappings, &mapping);
    }
    for (size_t k = 0; k < count && code == 0; k++) {
        code = tool_add_materials(t, &list, arguments[k]);
    }
    if (code == 0) {
        code = leave_out(t, &list, o->without);
    }
    if (code == 0) {
        code = tool_check_output(t, o->output, (const char *const *)list.path, list.count);
    }
    if (code == 0) {
        const gonio_database_options how = {.representation = (gonio_representation)representation,
                                            .channels = (gonio_channel_model)channels,
                                            .mapping = (gonio_mapping)mapping};
        code = learn(t, o, &list, &how);
    }
    tool_free_paths(&list);
    return code;
}

int cmd_learn(int argc, const char **argv)
{
    options o = {.representation = "bivariate", .channels = "joint", .mapping = "log"};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0, "The basis file to write", "BASIS"},
        {"basis", 'K', POPT_ARG_INT, &o.components, 0,
         "How many components to keep (default: 45, or one less than the materials; with "
         "--no-mean all)",
         "K"},
        {"grid", '\0', POPT_ARG_STRING, &o.representation, 0,
         "bivariate (theta_h, theta_d; the default) or full (phi_d too)", "GRID"},
        {"channels", '\0', POPT_ARG_STRING, &o.channels, 0,
         "joint (a material is a column; the default) or separate (each colour is one)", "MODEL"},
        {"mapping", '\0', POPT_ARG_STRING, &o.mapping, 0,
         "log (the default) or relative (weighted by the cosines; nielsen and frost use it)",
         "MAPPING"},
        {"no-mean", '\0', POPT_ARG_NONE, &o.no_mean, 0,
         "Do not take the mean material out (matusik needs this)", NULL},
        {"without", '\0', POPT_ARG_STRING, &o.without, 0,
         "Leave these materials out (for testing on them)", "NAME[,NAME...]"},
        {"json", '\0', POPT_ARG_NONE, &o.json, 0, "Print the result as JSON", NULL},
        TOOL_OPTIONS};
    tool t;
    int code =
        tool_begin(&t, argc, argv, table, "[OPTION...] DIR|FILE... -o BASIS",
                   "DIR stands for the *.binary and *.h5 files in it, 'atlas:' for all built-in "
                   "materials.\nExample: gonio learn merl/*.binary -o merl.gonio");
    if (code < 0) {
        code = run(&t, &o);
    }
    tool_end(&t);
    return code;
}
