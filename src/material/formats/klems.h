/* Klems bases: the hemisphere in rings of patches, as WINDOW and Radiance divide it.
 *
 * Patch j of a ring of n is centred at azimuth 2 pi j/n. An incident patch is named by the
 * direction in which light travels: the direction towards the light is at the patch's azimuth + pi.
 * So the patches of an incident direction and of its mirror direction have the same number. */
#ifndef GONIO_KLEMS_H
#define GONIO_KLEMS_H

#include <stdbool.h>
#include <stddef.h>

#include <gonio/direction.h>

enum { GONIO_I_KLEMS_RINGS = 64, GONIO_I_KLEMS_NAME = 64 };

typedef struct gonio_i_klems {
    char name[GONIO_I_KLEMS_NAME];
    size_t rings;
    double bound[GONIO_I_KLEMS_RINGS + 1]; /* polar angles between rings, degrees, ascending */
    size_t patches[GONIO_I_KLEMS_RINGS];   /* of each ring, at least 1 */
} gonio_i_klems;

/* "LBNL/Klems Full", "LBNL/Klems Half", "LBNL/Klems Quarter"; NULL for other names. */
const gonio_i_klems *gonio_i_klems_named(const char *name);

/* The number of patches. */
size_t gonio_i_klems_patches(const gonio_i_klems *basis);

/* The patch of an outgoing direction; of an incident one if `incident`. The number of patches if it
 * is in none. */
size_t gonio_i_klems_patch(const gonio_i_klems *basis, gonio_angles direction, bool incident);

/* A direction in a patch: across and around go from 0 to 1, evenly in projected solid angle. */
gonio_angles gonio_i_klems_direction(const gonio_i_klems *basis, size_t patch, double across,
                                     double around, bool incident);

#endif
