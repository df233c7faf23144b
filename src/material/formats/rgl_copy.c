/* Writing an RGL .bsdf that was read from one: the same numbers in the same parameterisation. */
#include <stdlib.h>
#include <string.h>

#include "../../core/core.h"
#include "../tensor_write.h"
#include "rgl.h"

static float *as_floats(gonio_context *context, const double *values, size_t count)
{
    float *floats = gonio_i_allocate(context, count, sizeof *floats);
    for (size_t k = 0; floats != NULL && k < count; k++) {
        floats[k] = (float)values[k];
    }
    return floats;
}

/* Arrays that are converted from the doubles in memory. */
typedef struct copies {
    float *phi;
    float *theta;
    float *vndf;
    float *wavelength; /* NULL for R, G, B */
} copies;

static bool make_copies(gonio_context *context, const gonio_i_rgl *r, copies *made)
{
    const bool spectral = r->wavelength != NULL;
    made->phi = as_floats(context, r->phi, r->phis);
    made->theta = as_floats(context, r->theta, r->thetas);
    made->vndf =
        as_floats(context, r->vndf.density, r->vndf.slices * r->vndf.width * r->vndf.height);
    made->wavelength = spectral ? as_floats(context, r->wavelength, r->channels) : NULL;
    return made->phi != NULL && made->theta != NULL && made->vndf != NULL &&
           (!spectral || made->wavelength != NULL);
}

static gonio_status write_fields(gonio_context *context, const gonio_i_rgl *r, const copies *made,
                                 const char *name, const char *path)
{
    const bool spectral = r->wavelength != NULL;
    const uint32_t version[2] = {1, 0};
    const unsigned char jacobian = r->jacobian ? 1 : 0;
    const bool described = r->description != NULL;
    const gonio_i_rgl_image *n = &r->ndf;
    const gonio_i_rgl_image *s = &r->sigma;
    const gonio_i_tensor_type f32 = GONIO_I_TENSOR_F32;
    gonio_i_tensor_field fields[12] = {
        {"version", GONIO_I_TENSOR_U32, 1, {2}, version},
        {"description",
         GONIO_I_TENSOR_U8,
         1,
         {described ? r->description_size : strlen(name)},
         described ? (const void *)r->description : name},
        {"phi_i", f32, 1, {r->phis}, made->phi},
        {"theta_i", f32, 1, {r->thetas}, made->theta},
        {"sigma", f32, 2, {s->height, s->width}, s->value},
        {"ndf", f32, 2, {n->height, n->width}, n->value},
        {"vndf", f32, 4, {r->phis, r->thetas, r->vndf.height, r->vndf.width}, made->vndf},
        {"luminance", f32, 4, {r->phis, r->thetas, r->side, r->side}, r->luminance},
        {spectral ? "spectra" : "rgb",
         f32,
         5,
         {r->phis, r->thetas, r->channels, r->side, r->side},
         r->value},
        {"jacobian", GONIO_I_TENSOR_U8, 1, {1}, &jacobian},
    };
    size_t count = 10;
    if (r->valid != NULL) {
        fields[count++] =
            (gonio_i_tensor_field){"valid", GONIO_I_TENSOR_U8, 1, {r->valid_size}, r->valid};
    }
    if (spectral) {
        fields[count++] =
            (gonio_i_tensor_field){"wavelengths", f32, 1, {r->channels}, made->wavelength};
    }
    return gonio_i_tensor_write(context, path, fields, count);
}

gonio_status gonio_i_rgl_copy(gonio_context *context, const gonio_i_rgl *rgl, const char *name,
                              const char *path)
{
    copies made = {0};
    const gonio_status status = make_copies(context, rgl, &made)
                                    ? write_fields(context, rgl, &made, name, path)
                                    : GONIO_ERROR_MEMORY;
    free(made.phi);
    free(made.theta);
    free(made.vndf);
    free(made.wavelength);
    return status;
}
