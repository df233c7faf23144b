/* Opening the built-in materials of the atlas. */
#ifndef GONIO_BUILT_IN_H
#define GONIO_BUILT_IN_H

#include <gonio/material.h>

/* Opens a material of the atlas, isotropic or not, by its name without "atlas:". Errors: _ARGUMENT
 * (no such material), _MEMORY. */
gonio_status gonio_i_built_in_open(gonio_context *context, const char *name,
                                   gonio_material **material);

#endif
