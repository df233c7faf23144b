/* Reconstructions as materials of all their channels, evaluated at any directions. */
#include <stdlib.h>

#include <gonio/reconstruct.h>

#include "../basis/basis.h"
#include "../core/core.h"
#include "field.h"

typedef struct spectra {
    const gonio_basis *basis;
    const gonio_reconstruction *r;
} spectra;

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const spectra *s = self;
    return gonio_i_predict_many(context, s->basis, s->r, pairs, count, values);
}

gonio_status gonio_reconstruction_spectral_material(gonio_context *context,
                                                    const gonio_basis *basis,
                                                    const gonio_reconstruction *reconstruction,
                                                    const char *name, gonio_material **material)
{
    const gonio_reconstruction *r = reconstruction;
    if (r->field == NULL || (r->wavelengths == 0 && r->columns != 1) ||
        gonio_basis_describe(basis)->channels == GONIO_JOINT) {
        return gonio_reconstruction_material(context, basis, r, name, material);
    }
    spectra *self = gonio_i_allocate(context, 1, sizeof *self);
    if (self == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *self = (spectra){basis, r};
    const gonio_material_source source = {.size = sizeof source,
                                          .evaluate = evaluate,
                                          .release = free,
                                          .self = self,
                                          .channels = r->columns,
                                          .wavelength = r->wavelengths > 0 ? r->wavelength : NULL};
    const gonio_status status =
        gonio_material_create(context, name, "reconstruction", &source, material);
    if (status != GONIO_OK) {
        free(self);
    }
    return status;
}
