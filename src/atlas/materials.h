/* The parameters of an atlas material. atlas.c gives the model that they enter. */
#ifndef GONIO_ATLAS_MATERIALS_H
#define GONIO_ATLAS_MATERIALS_H

#include <gonio/direction.h>

/* A distribution of facets by slope, isotropic: a blend of two Student-t distributions of one
 * width. Width 0 means that there is no lobe. */
typedef struct gonio_i_atlas_facets {
    double alpha; /* slope at which the tails begin (GGX's alpha) */
    double light; /* share of the light-tailed part, 0 (pure GGX) .. 1 */
} gonio_i_atlas_facets;

typedef struct gonio_i_atlas_material {
    const char *name;
    const char *material_class;

    /* The surface: a mirror-like lobe and the haze around it. */
    double surface;              /* share of the area that has it, 0 .. 1 */
    double f0[GONIO_CHANNELS];   /* reflectance at normal incidence */
    double edge;                 /* share of Schlick's value lost at 82 degrees (metals), 0 .. 1 */
    gonio_i_atlas_facets facets; /* of the main lobe */
    double haze;                 /* weight of the haze within the surface's lobe, 0 .. 1 */
    gonio_i_atlas_facets haze_facets;

    /* Beneath the surface: flakes or fibres that mirror ... */
    double flake[GONIO_CHANNELS]; /* reflectance */
    gonio_i_atlas_facets flake_facets;
    double film; /* optical thickness n d of a film on the flakes, nm; 0: none */

    /* ... and pigment that scatters. */
    double diffuse[GONIO_CHANNELS]; /* albedo */
    double roughness;               /* Oren-Nayar sigma in Fujii's parametrisation, 0 .. 1 */
    double opposition;              /* height of the surge towards the light, 0: none */
    double opposition_width;        /* tangent of half the phase angle at which it halves */

    /* Relief: facets with slopes close to one value (weave, emboss, crystal faces). */
    double relief[GONIO_CHANNELS]; /* reflectance, 0: none */
    double relief_slope;
    double relief_width; /* half width at 1/e, in slope */

    /* Fibres standing out of the surface. */
    double sheen[GONIO_CHANNELS]; /* weight */
    double sheen_exponent;        /* concentration at grazing incidence */
} gonio_i_atlas_material;

extern const gonio_i_atlas_material gonio_i_atlas_materials[];
extern const int gonio_i_atlas_material_count;

/* Fills the row of phi_d of gonio_atlas_slab at one theta_d index, in its place in the slab: the
 * same numbers, at a ninetieth of the time. Both indices are in 0 .. 89. */
void gonio_i_atlas_row(int index, int theta_h, int theta_d, double *slab);

#endif
