/* Lists of materials on the command line. */
#ifndef GONIO_MATERIAL_LIST_H
#define GONIO_MATERIAL_LIST_H

#include "command_line.h"

/* A growing list of paths. */
typedef struct material_list {
    size_t count;
    char **path;
} material_list;

/* Adds the materials of each argument: those of a folder sorted by name, all built-in ones for
 * 'atlas:', or the file itself. Returns an exit code. */
int material_list_add_all(const tool *t, material_list *list, const char *const *arguments,
                          size_t count);

void material_list_free(material_list *list);

#endif
