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

/* Increment it when gonio learn makes another basis of the same materials. Bases of earlier builds
 * in the cache are then not used. */
enum { RECIPE = 6 };

/* The file in the cache; NULL, after a warning, if there is no folder for it. */
static char *cached_path(tool *t, bool paper)
{
    char *path = NULL;
    char *folder = cache_folder();
    if (folder == NULL) {
        tool_say(&t->messages, GONIO_MESSAGE_WARNING,
                 "no cache folder for the built-in basis, which is learned again each time: set "
                 "XDG_CACHE_HOME, or make a basis with 'gonio learn atlas: -o FILE' and give it as "
                 "BASIS");
        return NULL;
    }
    if (asprintf(&path, "%s/atlas-%s-%d%s.gonio", folder, gonio_version(), RECIPE,
                 paper ? "-bivariate" : "") < 0) {
        path = NULL;
    }
    free(folder);
    return path;
}

/* What a message of the cache's context is kept in. */
typedef struct kept_message {
    char text[512];
} kept_message;

static void keep_message(void *user, gonio_message_level level, const char *text)
{
    kept_message *kept = user;
    if (level == GONIO_MESSAGE_ERROR) {
        snprintf(kept->text, sizeof kept->text, "%s", text);
    }
}

/* Says that the cache is of no use, which does not end the work. */
static void warn_of_cache(tool *t, const char *problem, const char *consequence)
{
    char text[640];
    snprintf(text, sizeof text, "%s; %s", problem, consequence);
    tool_say(&t->messages, GONIO_MESSAGE_WARNING, text);
}

/* Reads the basis from the cache; false, with a warning if need be, if that has none. */
static bool read_cached(tool *t, const char *path, gonio_basis **basis)
{
    kept_message kept = {""};
    gonio_context *context = NULL;
    const gonio_context_options options = {
        .size = sizeof options, .message = keep_message, .user = &kept, .threads = tool_threads};
    if (access(path, F_OK) != 0 || gonio_context_create(&context, &options) != GONIO_OK) {
        return false;
    }
    const bool read = gonio_basis_read(context, path, basis) == GONIO_OK;
    if (!read) {
        warn_of_cache(t, kept.text, "it is made again");
    }
    gonio_context_free(&context);
    return read;
}

static void write_cached(tool *t, const char *path, bool paper, const gonio_basis *basis)
{
    kept_message kept = {""};
    gonio_context *context = NULL;
    const gonio_context_options options = {
        .size = sizeof options, .message = keep_message, .user = &kept, .threads = tool_threads};
    if (gonio_context_create(&context, &options) != GONIO_OK) {
        return;
    }
    if (gonio_basis_write(context, basis,
                          paper ? "gonio learn atlas: --grid bivariate" : "gonio learn atlas:",
                          path) != GONIO_OK) {
        warn_of_cache(t, kept.text, "the built-in basis is learned again each time");
    }
    gonio_context_free(&context);
}

/* A cache that is damaged or cannot be written costs time only. */
static gonio_status builtin_basis(tool *t, bool paper, gonio_basis **basis)
{
    char *path = cached_path(t, paper);
    if (path != NULL && read_cached(t, path, basis)) {
        free(path);
        return GONIO_OK;
    }
    tool_say(&t->messages, GONIO_MESSAGE_NOTE,
             path != NULL ? "no BASIS given: learning one from the built-in materials (once; kept "
                            "in the cache)"
                          : "no BASIS given: learning one from the built-in materials");
    const gonio_status status = learn_atlas(t, paper, basis);
    if (status == GONIO_OK && path != NULL) {
        write_cached(t, path, paper, *basis);
    }
    free(path);
    return status;
}

gonio_status tool_builtin_basis(tool *t, bool paper, char **path)
{
    gonio_basis *basis = NULL;
    const gonio_status status = builtin_basis(t, paper, &basis);
    gonio_basis_free(&basis);
    if (status != GONIO_OK) {
        return status;
    }
    char *cached = cached_path(t, paper);
    if (cached == NULL || access(cached, R_OK) != 0) {
        tool_say(&t->messages, GONIO_MESSAGE_ERROR, "the built-in basis cannot be kept in a file");
        free(cached);
        return GONIO_ERROR_IO;
    }
    *path = cached;
    return GONIO_OK;
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
    return builtin_basis(t, is_papers(method), basis);
}
