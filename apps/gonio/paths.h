/* Lists of materials on the command line. */
#ifndef GONIO_TOOL_PATHS_H
#define GONIO_TOOL_PATHS_H

#include "tool.h"

/* A growing list of paths. */
typedef struct tool_paths {
    size_t count;
    char **path;
} tool_paths;

/* Adds what an argument stands for: the materials of a folder by name, 'atlas:' for all built-in
 * ones, or itself. Returns an exit code, 0 if fine. */
int tool_add_materials(const tool *t, tool_paths *list, const char *argument);

void tool_free_paths(tool_paths *list);

#endif
