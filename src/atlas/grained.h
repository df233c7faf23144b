/* The parameters of an anisotropic atlas material. grained.c gives the model that they enter. */
#ifndef GONIO_ATLAS_GRAINED_H
#define GONIO_ATLAS_GRAINED_H

#include <gonio/direction.h>

enum { GONIO_I_GRAINED_LOBES = 3 };

/* A lobe of facets: two Student-t distributions of slopes, blended, stretched across one direction.
 * Weight 0 ends the list of lobes. */
typedef struct gonio_i_grained_lobe {
    double weight;             /* share of the area that mirrors this way, 0 .. 1 */
    double f0[GONIO_CHANNELS]; /* reflectance at normal incidence */
    double along;              /* slope at which the tails begin, along the lobe's direction */
    double across;             /* the same across it; the axis ratio is across/along */
    double light;              /* share of the light-tailed part, 0 (pure GGX) .. 1 */
    double turn;               /* of the lobe's direction from the grain, degrees */
} gonio_i_grained_lobe;

/* A row of the table. */
typedef struct gonio_i_grained_material {
    const char *name;
    const char *material_class;
    int symmetry; /* rotations of the sample that change nothing: 1, 2 or 4 in a full turn */
    double grain; /* azimuth of the grain, degrees */
    double edge;  /* share of Schlick's value lost at 82 degrees (metals), 0 .. 1 */

    /* A clear isotropic coat over all the rest. */
    double coat;       /* share of the area that has it, 0 .. 1 */
    double coat_f0;    /* reflectance at normal incidence */
    double coat_alpha; /* slope at which its tails begin */

    gonio_i_grained_lobe lobe[GONIO_I_GRAINED_LOBES];
    double diffuse[GONIO_CHANNELS]; /* albedo of the pigment */

    /* Fibres beneath the surface. */
    double fibre[GONIO_CHANNELS]; /* strength, 0: none */
    double fibre_width;           /* standard deviation around the cone, degrees */
    double fibre_tilt;            /* of the fibres out of the surface, degrees */
} gonio_i_grained_material;

extern const gonio_i_grained_material gonio_i_grained_materials[];
extern const int gonio_i_grained_material_count;

#endif
