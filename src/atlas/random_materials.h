/* Random analytic materials: parameters of the model of atlas.c, drawn at random.
 *
 * Named materials are few, and lobes of one width are far from those of another. Random ones fill
 * the space between: metals, paints with flakes, coated and bare pigments, cloth, with lobes of any
 * width and tail. A basis that knows them, too, is less surprised by materials unlike its database
 * (docs/experiments.md). */
#ifndef GONIO_ATLAS_RANDOM_MATERIALS_H
#define GONIO_ATLAS_RANDOM_MATERIALS_H

#include "materials.h"

/* Material k, the same everywhere. It has no name, and its class is "random". */
gonio_i_atlas_material gonio_i_random_material(int k);

#endif
