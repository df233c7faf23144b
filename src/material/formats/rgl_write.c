/* Writing RGL .bsdf files, and isotropic materials as such (rgl.c has the format's equations).
 *
 * The file's values at a place s are rho cos theta_o 4 sigma / ndf in the direction that s is
 * warped to, so any ndf that is positive and any warp represent any material. The better ndf
 * resembles the material, the smoother the values are, which is what interpolation wants: ndf is
 * the material's mean luminance by theta_h, and sigma its area projected towards the incident
 * direction. vndf depends on u alone, which crowds places around the mirror direction already; it
 * is higher where values bend (rgl_places.c). Light is sampled by the field luminance together with
 * vndf, so luminance is what a place reflects, the solid angle of its half vectors included:
 *
 *     luminance(s) = L(s) ndf(u) <i, m> u sin theta_m / vndf(u), L of the values.
 *
 * Values are fitted to the material at directions between the places (rgl_fit.c).
 * Where the material has no data, the nearest places stand in. Beyond the angle up to which it was
 * measured, the values at that angle do. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../tensor_write.h"
#include "rgl_writing.h"

enum {
    COARSE = 32,      /* fewest places along s, in spectra of many wavelengths */
    NUMBERS = 6 << 20 /* of values and luminance, that a spectral file holds about */
};

/* Incidences are denser towards grazing: theta_i = pi/2 (1 - (1 - x)^GRAZING), x evenly spaced. */
static const double GRAZING = 1.3;

/* The largest polar angle at which tables have data all around. */
static const double STEEPEST = 88.0 * M_PI / 180.0;

static gonio_status write_fields(const gonio_i_rgl_writing *w, const char *path)
{
    const float phi = 0.0F;
    const uint32_t version[2] = {1, 0};
    const unsigned char jacobian = 1;
    float wavelength[GONIO_I_RGL_WAVELENGTHS];
    const bool spectral = w->view->wavelength != NULL;
    const uint64_t nodes = w->side * w->side;
    for (size_t k = 0; spectral && k < w->channels; k++) {
        wavelength[k] = (float)w->view->wavelength[w->order[k]];
    }
    const gonio_i_tensor_field fields[] = {
        {"version", GONIO_I_TENSOR_U32, 1, {2}, version},
        {"description", GONIO_I_TENSOR_U8, 1, {strlen(w->view->name)}, w->view->name},
        {"phi_i", GONIO_I_TENSOR_F32, 1, {1}, &phi},
        {"theta_i", GONIO_I_TENSOR_F32, 1, {GONIO_I_RGL_THETAS}, w->theta},
        {"sigma", GONIO_I_TENSOR_F32, 2, {2, GONIO_I_RGL_NORMALS}, w->sigma},
        {"ndf", GONIO_I_TENSOR_F32, 2, {2, GONIO_I_RGL_NORMALS}, w->ndf},
        {"vndf", GONIO_I_TENSOR_F32, 4, {1, GONIO_I_RGL_THETAS, 2, GONIO_I_RGL_NORMALS}, w->vndf},
        {"luminance",
         GONIO_I_TENSOR_F32,
         4,
         {1, GONIO_I_RGL_THETAS, w->side, w->side},
         w->luminance},
        {spectral ? "spectra" : "rgb",
         GONIO_I_TENSOR_F32,
         5,
         {1, GONIO_I_RGL_THETAS, w->channels, w->side, w->side},
         w->value},
        {"jacobian", GONIO_I_TENSOR_U8, 1, {1}, &jacobian},
        {"valid",
         GONIO_I_TENSOR_U8,
         1,
         {gonio_i_bytes_of_bits(GONIO_I_RGL_THETAS * nodes)},
         w->valid},
        {"wavelengths", GONIO_I_TENSOR_F32, 1, {w->channels}, wavelength},
    };
    const size_t count = sizeof fields / sizeof *fields - (spectral ? 0 : 1);
    return gonio_i_tensor_write(w->context, path, fields, count);
}

static size_t choose_side(size_t channels)
{
    const double side = sqrt((double)NUMBERS / (double)(GONIO_I_RGL_THETAS * (channels + 1)));
    return (size_t)fmin(fmax(side, COARSE), GONIO_I_RGL_SIDE);
}

static gonio_status begin(gonio_i_rgl_writing *w, const gonio_material *material)
{
    w->view = gonio_material_describe(material);
    const bool spectral = w->view->wavelength != NULL;
    if (w->view->channels > GONIO_I_RGL_WAVELENGTHS) {
        return gonio_i_fail(w->context, GONIO_ERROR_ARGUMENT,
                            "%s: %zu wavelengths; a .bsdf is written with at most %d",
                            w->view->name, w->view->channels, GONIO_I_RGL_WAVELENGTHS);
    }
    w->channels = spectral ? w->view->channels : GONIO_CHANNELS;
    w->side = choose_side(w->channels);
    w->limit = w->view->theta_limit > 0.0 ? fmin(w->view->theta_limit, STEEPEST) : STEEPEST;
    for (size_t t = 0; t < GONIO_I_RGL_THETAS; t++) {
        const double left = 1.0 - (double)t / (GONIO_I_RGL_THETAS - 1);
        w->theta[t] = (float)(M_PI / 2.0 * (1.0 - pow(left, GRAZING)));
    }
    const size_t nodes = w->side * w->side;
    w->value =
        gonio_i_allocate(w->context, GONIO_I_RGL_THETAS * w->channels * nodes, sizeof *w->value);
    w->luminance = gonio_i_allocate(w->context, GONIO_I_RGL_THETAS * nodes, sizeof *w->luminance);
    w->valid = gonio_i_allocate(w->context, gonio_i_bytes_of_bits(GONIO_I_RGL_THETAS * nodes),
                                sizeof *w->valid);
    w->weight = gonio_i_allocate(w->context, w->channels, sizeof *w->weight);
    if (w->value == NULL || w->luminance == NULL || w->valid == NULL || w->weight == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    static const double rgb[GONIO_CHANNELS] = {0.2126, 0.7152, 0.0722};
    for (size_t c = 0; c < w->channels; c++) {
        w->weight[c] = spectral ? 1.0 / (double)w->channels : rgb[c];
    }
    gonio_i_rgl_find_order(w->view, w->channels, w->order);
    return gonio_i_sampler_begin(w->context, material, true, &w->sampler);
}

static void end(gonio_i_rgl_writing *w)
{
    gonio_i_sampler_end(&w->sampler);
    gonio_i_warp_free(&w->warp);
    free(w->value);
    free(w->luminance);
    free(w->valid);
    free(w->weight);
}

static gonio_status write_isotropic(gonio_context *context, const gonio_material *material,
                                    const char *path)
{
    gonio_i_rgl_writing *w = gonio_i_allocate(context, 1, sizeof *w);
    if (w == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *w = (gonio_i_rgl_writing){.context = context};
    gonio_status status = begin(w, material);
    if (status == GONIO_OK) {
        status = gonio_i_rgl_find_ndf(w);
    }
    if (status == GONIO_OK) {
        gonio_i_rgl_find_sigma(w);
        status = gonio_i_rgl_find_vndf(w);
    }
    if (status == GONIO_OK) {
        status = gonio_i_rgl_find_values(w);
    }
    if (status == GONIO_OK) {
        status = write_fields(w, path);
    }
    if (status == GONIO_OK) {
        status = gonio_i_progress(context, "writing", 1.0);
    }
    end(w);
    free(w);
    return status;
}

gonio_status gonio_material_write_rgl(gonio_context *context, const gonio_material *material,
                                      const char *path)
{
    const gonio_i_rgl *same = gonio_i_rgl_of(material);
    if (same != NULL && same->luminance != NULL) {
        return gonio_i_rgl_copy(context, same, gonio_material_name(material), path);
    }
    return gonio_material_describe(material)->anisotropic
               ? gonio_i_rgl_write_anisotropic(context, material, path)
               : write_isotropic(context, material, path);
}

static gonio_status write_rgl(gonio_context *context, const gonio_material *material,
                              const char *path, const gonio_write_options *options)
{
    return options->average_azimuths && gonio_material_describe(material)->anisotropic
               ? write_isotropic(context, material, path)
               : gonio_material_write_rgl(context, material, path);
}

const gonio_i_format_writer gonio_i_rgl_writer = {
    .name = "rgl",
    .extension = ".bsdf",
    .summary = "RGL BSDF of RGB or spectra, for Mitsuba 3 and pbrt-v4 (measured); isotropic or not",
    .averages = true,
    .write = write_rgl,
};
