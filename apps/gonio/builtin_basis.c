/* The basis of the built-in materials, kept in the cache folder: see builtin_basis.h. */
#include "builtin_basis.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool make_folder(const char *path)
{
    return mkdir(path, 0777) == 0 || errno == EEXIST;
}

/* $XDG_CACHE_HOME/gonio or ~/.cache/gonio, created if necessary; NULL if that fails. */
static char *cache_folder(void)
{
    const char *cache = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    char *folder = NULL;
    int length = -1;
    if (cache != NULL && cache[0] == '/') {
        length = asprintf(&folder, "%s/gonio", cache);
    } else if (home != NULL && home[0] != '\0') {
        length = asprintf(&folder, "%s/.cache/gonio", home);
    }
    if (length < 0) {
        return NULL;
    }
    for (char *slash = strchr(folder + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        const bool made = make_folder(folder);
        *slash = '/';
        if (!made) {
            break;
        }
    }
    if (!make_folder(folder)) {
        free(folder);
        return NULL;
    }
    return folder;
}

static gonio_status learn_atlas(tool *t, bool paper, gonio_basis **basis)
{
    gonio_recipe recipe;
    gonio_recipe_default(&recipe);
    if (paper) {
        gonio_recipe_paper(&recipe);
    }
    const int count = gonio_atlas_count();
    char **paths = calloc((size_t)count, sizeof *paths);
    gonio_status status = paths == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (int k = 0; k < count && status == GONIO_OK; k++) {
        status = asprintf(&paths[k], "atlas:%s", gonio_atlas_name(k)) < 0 ? GONIO_ERROR_MEMORY
                                                                          : GONIO_OK;
    }
    if (status == GONIO_OK) {
        status = gonio_learn(t->context, (const char *const *)paths, (size_t)count, &recipe, basis);
    }
    for (int k = 0; paths != NULL && k < count; k++) {
        free(paths[k]);
    }
    free(paths);
    return status;
}

static gonio_status make_builtin(tool *t, const char *path, bool paper)
{
    gonio_basis *basis = NULL;
    if (!tool_quiet) {
        tool_say(&t->messages, GONIO_MESSAGE_NOTE,
                 "no BASIS given: learning one from the built-in materials (once; kept in the "
                 "cache)");
    }
    gonio_status status = learn_atlas(t, paper, &basis);
    if (status == GONIO_OK) {
        status = gonio_basis_write(
            t->context, basis,
            paper ? "gonio learn atlas: --grid bivariate" : "gonio learn atlas:", path);
    }
    gonio_basis_free(&basis);
    return status;
}

/* Increment it when gonio learn makes another basis of the same materials. Bases of earlier builds
 * in the cache are then not used. */
enum { RECIPE = 4 };

gonio_status tool_builtin_basis(tool *t, bool paper, char **path)
{
    char *folder = cache_folder();
    if (folder == NULL) {
        tool_say(&t->messages, GONIO_MESSAGE_ERROR,
                 "no cache folder for the built-in basis: set XDG_CACHE_HOME, or make a basis "
                 "with 'gonio learn atlas: -o FILE' and give it as BASIS");
        return GONIO_ERROR_IO;
    }
    const int length = asprintf(path, "%s/atlas-%s-%d%s.gonio", folder, gonio_version(), RECIPE,
                                paper ? "-bivariate" : "");
    free(folder);
    if (length < 0) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = access(*path, F_OK) == 0 ? GONIO_OK : make_builtin(t, *path, paper);
    if (status != GONIO_OK) {
        free(*path);
    }
    return status;
}

/* Whether a method of planning or reconstructing works on the paper's kind of basis. */
static bool is_papers(const char *method)
{
    if (method == NULL || *method == '\0') {
        return false;
    }
    const char *planned = gonio_plan_method_reconstruction(method);
    return !gonio_reconstruct_method_suits_mixtures(planned != NULL ? planned : method);
}

gonio_status tool_basis(tool *t, const char *path, const char *method, gonio_basis **basis)
{
    if (path != NULL) {
        gonio_kind kind = GONIO_KIND_UNKNOWN;
        const gonio_status known = gonio_file_expect(t->context, path, GONIO_KIND_BASIS, &kind);
        return known == GONIO_OK ? gonio_basis_read(t->context, path, basis) : known;
    }
    char *builtin = NULL;
    gonio_status status = tool_builtin_basis(t, is_papers(method), &builtin);
    if (status == GONIO_OK) {
        status = gonio_basis_read(t->context, builtin, basis);
        free(builtin);
    }
    return status;
}
