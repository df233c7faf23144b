/* The basis of the built-in materials, kept in the cache folder. */
#ifndef GONIO_BUILTIN_BASIS_H
#define GONIO_BUILTIN_BASIS_H

#include "command_line.h"

/* A BASIS argument, or with NULL the basis of the built-in materials, made on first use and kept in
 * the cache folder. */
gonio_status tool_basis(tool *t, const char *path, const char *method, gonio_basis **basis);

/* The path of the built-in basis, which is learned if necessary; to be released with free(). */
gonio_status tool_builtin_basis(tool *t, bool paper, char **path);

#endif
