/* The source of a material, for other files of this stage. */
#ifndef GONIO_SOURCE_H
#define GONIO_SOURCE_H

#include <stdbool.h>

#include <gonio/material.h>

gonio_material_source gonio_i_material_source(const gonio_material *material);

/* Whether gonio_i_material_colour looks the material up: it can be evaluated, in channels that are
 * not too many. */
bool gonio_i_material_is_direct(const gonio_material *material);

/* The colour of one pair of directions as gonio_material_evaluate finds its channels, on the
 * calling thread. A channel without data where others have some is 0. False, and 0, without data.
 */
bool gonio_i_material_colour(const gonio_material *material, gonio_pair pair,
                             double rgb[GONIO_CHANNELS]);

#endif
