/* Lists of materials on the command line: see material_list.h. */
#include "material_list.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static bool add_path(material_list *list, char *path)
{
    char **more = path != NULL ? reallocarray(list->path, list->count + 1, sizeof *more) : NULL;
    if (more == NULL) {
        free(path);
        return false;
    }
    more[list->count++] = path;
    list->path = more;
    return true;
}

void material_list_free(material_list *list)
{
    for (size_t k = 0; k < list->count; k++) {
        free(list->path[k]);
    }
    free(list->path);
}

static char *joined(const char *a, const char *b)
{
    char *text = NULL;
    return asprintf(&text, "%s%s", a, b) < 0 ? NULL : text;
}

static bool is_material_name(const char *name)
{
    const char *dot = strrchr(name, '.');
    return name[0] != '.' && dot != NULL &&
           (strcmp(dot, ".binary") == 0 || strcmp(dot, ".h5") == 0 || strcmp(dot, ".hdf5") == 0);
}

static int only_materials(const struct dirent *entry)
{
    return is_material_name(entry->d_name);
}

/* Adds the materials of a folder, sorted by name. Returns an exit code. */
static int add_folder(const tool *t, material_list *list, const char *folder)
{
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, only_materials, alphasort);
    const int reason = errno;
    bool done = true;
    for (int k = 0; k < count; k++) {
        char *path = NULL;
        done = asprintf(&path, "%s/%s", folder, entries[k]->d_name) >= 0 && add_path(list, path) &&
               done;
        free(entries[k]);
    }
    free(entries);
    if (count < 0) {
        fprintf(stderr, "gonio %s: %s: cannot read: %s\n", t->name, folder, strerror(reason));
        return EXIT_DATA;
    }
    if (count == 0) {
        fprintf(stderr, "gonio %s: %s: no materials (*.binary, *.h5) in this folder\n", t->name,
                folder);
        return EXIT_DATA;
    }
    return done ? 0 : EXIT_DATA;
}

/* Adds the materials of an argument. Returns an exit code. */
static int add(const tool *t, material_list *list, const char *argument)
{
    struct stat status;
    if (strcmp(argument, "atlas:") == 0) {
        bool done = true;
        for (int k = 0; k < gonio_atlas_count(); k++) {
            done = add_path(list, joined("atlas:", gonio_atlas_name(k))) && done;
        }
        return done ? 0 : EXIT_DATA;
    }
    if (stat(argument, &status) == 0 && S_ISDIR(status.st_mode)) {
        return add_folder(t, list, argument);
    }
    return add_path(list, strdup(argument)) ? 0 : EXIT_DATA;
}

int material_list_add_all(const tool *t, material_list *list, const char *const *arguments,
                          size_t count)
{
    int code = 0;
    for (size_t k = 0; k < count && code == 0; k++) {
        code = add(t, list, arguments[k]);
    }
    return code;
}
