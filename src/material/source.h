/* The source of a material, for other files of this stage. */
#ifndef GONIO_SOURCE_H
#define GONIO_SOURCE_H

#include <stdbool.h>

#include <gonio/material.h>

gonio_material_source gonio_i_material_source(const gonio_material *material);

/* Whether gonio_i_material_colour works: the material can be evaluated, and has not too many
 * channels. */
bool gonio_i_material_is_direct(const gonio_material *material);

/* The colour of one pair of directions, with channels as by gonio_material_evaluate, on the calling
 * thread. A channel without data is 0 where others have data. False, and all 0, without any data.
 */
bool gonio_i_material_colour(const gonio_material *material, gonio_pair pair,
                             double rgb[GONIO_CHANNELS]);

/* gonio_table_load at a part of the directions: a material that has to be evaluated is evaluated at
 * one bin of each run of `run` bins of phi_d, whose value the others get. */
gonio_status gonio_i_table_load_runs(gonio_context *context, const gonio_material *material,
                                     int run, gonio_table **table);

#endif
