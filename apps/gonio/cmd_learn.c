/* gonio learn: a basis from measured materials. */
#include "command_line.h"
#include "json_output.h"
#include "material_list.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { UNSET = INT_MIN };

typedef struct options {
    const char *output;
    const char *representation;
    const char *channels;
    const char *mapping;
    const char *without;
    int no_mean;
    int components;
    int mixtures; /* UNSET: the default of the recipe */
    int analytic; /* the same */
    long seed;
} options;

/* The material's name in a path: the text after "atlas:", or the base name without its extension.
 */
static size_t name_in(const char *path, const char **name)
{
    const char *slash = strrchr(path, '/');
    *name = strncmp(path, "atlas:", 6) == 0 ? path + 6 : slash != NULL ? slash + 1 : path;
    const char *dot = strrchr(*name, '.');
    return dot != NULL && dot != *name ? (size_t)(dot - *name) : strlen(*name);
}

/* Removes the materials of a comma-separated list of names from the paths. */
static bool leave_out(const tool *t, material_list *list, const char *without)
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
            return tool_refuse(t, "--without: no material is called '%.*s'", (int)length, next);
        }
        next += length + (next[length] == ',' ? 1 : 0);
    }
    return true;
}

static int report(const tool *t, const gonio_basis *basis, const options *o)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const double share = gonio_basis_cumulative_variance(basis, view->components);
    if (tool_json) {
        return tool_print_json(t, json_pack("{s:o, s:I, s:I, s:I, s:f}", "basis",
                                            tool_json_text(o->output), "materials",
                                            (json_int_t)view->materials, "components",
                                            (json_int_t)view->components, "cells",
                                            (json_int_t)view->cells, "explained_variance", share));
    }
    if (!tool_quiet) {
        fprintf(tool_results(),
                "%s: %zu components from %zu materials on %zu cells, %.2f %% of the variance\n",
                o->output, view->components, view->materials, view->cells, 100.0 * share);
    }
    return 0;
}

static int learn(tool *t, const options *o, const material_list *list, const gonio_recipe *recipe)
{
    gonio_basis *basis = NULL;
    gonio_status status =
        gonio_learn(t->context, (const char *const *)list->path, list->count, recipe, &basis);
    if (status == GONIO_OK) {
        status = gonio_basis_write(t->context, basis, t->command_line, o->output);
    }
    const int code = status == GONIO_OK ? report(t, basis, o) : tool_exit_code(status);
    gonio_basis_free(&basis);
    return code;
}

/* Finds a word in a list that ends with NULL. Without a word the choice stays. */
static bool choose(const tool *t, const char *option, const char *word, const char *const *words,
                   int *choice)
{
    return word == NULL || tool_check_word(t, option, word, words, choice);
}

/* Makes the recipe. Missing options have the defaults of the grid. */
static bool choose_recipe(const tool *t, const options *o, gonio_recipe *recipe)
{
    const char *const representations[] = {gonio_representation_name(GONIO_BIVARIATE),
                                           gonio_representation_name(GONIO_FULL),
                                           gonio_representation_name(GONIO_SECTORED), NULL};
    const char *const channel_models[] = {gonio_channel_model_name(GONIO_JOINT),
                                          gonio_channel_model_name(GONIO_SEPARATE), NULL};
    const char *const mappings[] = {gonio_mapping_name(GONIO_LOG),
                                    gonio_mapping_name(GONIO_LOG_RELATIVE), NULL};
    int representation = GONIO_SECTORED;
    if (!choose(t, "--grid", o->representation, representations, &representation)) {
        return false;
    }
    gonio_recipe_for_grid(recipe, (gonio_representation)representation);
    int channels = (int)recipe->channels;
    int mapping = (int)recipe->mapping;
    if (!choose(t, "--channels", o->channels, channel_models, &channels) ||
        !choose(t, "--mapping", o->mapping, mappings, &mapping)) {
        return false;
    }
    recipe->channels = (gonio_channel_model)channels;
    recipe->mapping = (gonio_mapping)mapping;
    recipe->without_mean = o->no_mean;
    recipe->components = (size_t)o->components;
    recipe->mixtures = o->mixtures != UNSET ? (size_t)o->mixtures : recipe->mixtures;
    recipe->analytic = o->analytic != UNSET ? (size_t)o->analytic : recipe->analytic;
    recipe->seed = (uint64_t)o->seed;
    return true;
}

static bool check(const tool *t, const options *o, size_t count, gonio_recipe *recipe)
{
    if (count == 0) {
        return tool_refuse(t, "no materials given");
    }
    return tool_check_count(t, "--components", o->components, o->components == 0 ? 0 : 1) &&
           (o->mixtures == UNSET || tool_check_count(t, "--mixtures", o->mixtures, 0)) &&
           (o->analytic == UNSET || tool_check_count(t, "--analytic", o->analytic, 0)) &&
           choose_recipe(t, o, recipe);
}

static gonio_status expect_materials(const tool *t, const material_list *list)
{
    gonio_status status = GONIO_OK;
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    for (size_t k = 0; k < list->count && status == GONIO_OK; k++) {
        status = gonio_file_expect(t->context, list->path[k], GONIO_KIND_MATERIAL, &kind);
    }
    return status;
}

static int run(tool *t, void *given)
{
    const options *o = given;
    size_t count = 0;
    gonio_recipe recipe;
    const char **arguments = tool_arguments(t, &count);
    if (!check(t, o, count, &recipe)) {
        return EXIT_USAGE;
    }
    material_list list = {0};
    int code = material_list_add_all(t, &list, arguments, count);
    if (code == 0 &&
        !(leave_out(t, &list, o->without) &&
          tool_check_output(t, o->output, (const char *const *)list.path, list.count))) {
        code = EXIT_USAGE;
    }
    if (code == 0) {
        code = tool_exit_code(expect_materials(t, &list));
    }
    if (code == 0) {
        code = learn(t, o, &list, &recipe);
    }
    material_list_free(&list);
    return code;
}

int cmd_learn(int argc, const char **argv)
{
    options o = {.mixtures = UNSET, .analytic = UNSET};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0, "The basis file to write", "BASIS"},
        {"components", 'K', POPT_ARG_INT, &o.components, 0,
         "Number of components to keep (default: 300; 45 without mixtures; all with --no-mean; at "
         "most as many as there are)",
         "K"},
        {"grid", '\0', POPT_ARG_STRING, &o.representation, 0,
         "sectored (theta_h, theta_d, 12 sectors of phi_d; the default), bivariate (no phi_d; the "
         "paper's) or full (every phi_d)",
         "GRID"},
        {"channels", '\0', POPT_ARG_STRING, &o.channels, 0,
         "separate (each colour of a material is a column; the default of the sectored grid) or "
         "joint (a material is one column; the default of the other grids)",
         "MODEL"},
        {"mixtures", '\0', POPT_ARG_INT, &o.mixtures, 0,
         "Number of computed columns, each a mixture of two measured ones (default: 1000 on the "
         "sectored grid, otherwise 0)",
         "N"},
        {"analytic", '\0', POPT_ARG_INT, &o.analytic, 0,
         "Number of random analytic materials to learn from, with a small weight (default: 200 "
         "beside the default mixtures, otherwise 0)",
         "N"},
        {"seed", '\0', POPT_ARG_LONG, &o.seed, 0, "Seed of the mixtures (default: 0)", "N"},
        {"mapping", '\0', POPT_ARG_STRING, &o.mapping, 0,
         "log (the default) or relative (weighted by the cosines; nielsen and frost use it)",
         "MAPPING"},
        {"no-mean", '\0', POPT_ARG_NONE, &o.no_mean, 0,
         "Do not subtract the mean material (matusik needs this)", NULL},
        {"without", '\0', POPT_ARG_STRING, &o.without, 0,
         "Leave these materials out, to test on them", "NAME[,NAME...]"},
        TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] DIR|FILE... -o BASIS",
        .text = "DIR stands for the *.binary and *.h5 files in it, 'atlas:' for all built-in "
                "materials.\nExample: gonio learn merl/*.binary -o merl.gonio",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
