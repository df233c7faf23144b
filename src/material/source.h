/* The source of a material, for other files of this stage. */
#ifndef GONIO_SOURCE_H
#define GONIO_SOURCE_H

#include <gonio/material.h>

gonio_material_source gonio_i_material_source(const gonio_material *material);

#endif
