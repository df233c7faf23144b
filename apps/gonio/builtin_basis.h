/* The basis of the built-in materials, kept in the cache folder. */
#ifndef GONIO_BUILTIN_BASIS_H
#define GONIO_BUILTIN_BASIS_H

#include "command_line.h"

/* Opens a BASIS argument. NULL: the basis of the built-in materials, which is learned on first use
 * and kept in the cache folder. A cache that is damaged or cannot be written is warned of. */
gonio_status tool_basis(tool *t, const char *path, const char *method, gonio_basis **basis);

/* The path of the built-in basis in the cache, which the caller frees. The basis is learned if
 * necessary. Errors: those of learning; _IO if it cannot be kept there. */
gonio_status tool_builtin_basis(tool *t, bool paper, char **path);

#endif
