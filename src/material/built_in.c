/* The built-in materials as materials: see built_in.h. */
#include "built_in.h"

#include <stdlib.h>

#include <gonio/atlas.h>

#include "../atlas/materials.h"
#include "../core/core.h"
#include "inside.h"

static gonio_status read_isotropic_slab(void *self, gonio_context *context, int theta_h,
                                        double *rho)
{
    (void)context;
    gonio_atlas_slab(*(const int *)self, theta_h, rho);
    return GONIO_OK;
}

static gonio_status read_isotropic_row(void *self, gonio_context *context, int theta_h, int theta_d,
                                       double *rho)
{
    (void)context;
    gonio_i_atlas_row(*(const int *)self, theta_h, theta_d, rho);
    return GONIO_OK;
}

static gonio_status evaluate_anisotropic(void *self, gonio_context *context,
                                         const gonio_pair *pairs, size_t count, double *values)
{
    (void)context;
    for (size_t k = 0; k < count; k++) {
        gonio_atlas_anisotropic_value(*(const int *)self, pairs[k], values + k * GONIO_CHANNELS);
    }
    return GONIO_OK;
}

/* Makes a material of a source whose `self` is an index. */
static gonio_status create(gonio_context *context, const char *name, const char *of, int index,
                           gonio_material_source source, gonio_material **material)
{
    int *self = gonio_i_allocate(context, 1, sizeof *self);
    char *format = gonio_i_format("built-in %s", of);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (self != NULL && format != NULL) {
        *self = index;
        source.size = sizeof source;
        source.self = self;
        source.release = free;
        status = gonio_material_create(context, name, format, &source, material);
    }
    free(format);
    if (status != GONIO_OK) {
        free(self);
    }
    return status;
}

gonio_status gonio_i_built_in_open(gonio_context *context, const char *name,
                                   gonio_material **material)
{
    const int isotropic = gonio_atlas_find(name);
    const int grained = gonio_atlas_anisotropic_find(name);
    if (isotropic >= 0) {
        const gonio_status status =
            create(context, name, gonio_atlas_class(isotropic), isotropic,
                   (gonio_material_source){.read_slab = read_isotropic_slab}, material);
        if (status == GONIO_OK) {
            (*material)->read_row = read_isotropic_row;
        }
        return status;
    }
    if (grained >= 0) {
        return create(
            context, name, gonio_atlas_anisotropic_class(grained), grained,
            (gonio_material_source){.evaluate = evaluate_anisotropic, .anisotropic = true},
            material);
    }
    return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                        "atlas:%s: no such built-in material; 'gonio info atlas:' lists them",
                        name);
}
