/* Materials: the object, and fingerprints. */
#include <gonio/material.h>

#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

#include "../core/core.h"
#include "../core/options.h"
#include "colour.h"
#include "inside.h"
#include "source.h"

struct gonio_fingerprint {
    XXH3_state_t *state;
};

static gonio_status check_source(gonio_context *context, const gonio_material_source *source)
{
    const bool colours = source->channels == 1 || source->channels == GONIO_CHANNELS;
    if (source->read_slab == NULL && source->evaluate == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a material needs read_slab or evaluate");
    }
    if (source->evaluate != NULL && source->wavelength == NULL && !colours) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a material of %zu channels needs their wavelengths", source->channels);
    }
    return GONIO_OK;
}

/* Copies the wavelengths, and finds their weights in the material's colours. */
static gonio_status keep_wavelengths(gonio_context *context, gonio_material *material)
{
    const size_t channels = material->source.channels;
    if (material->source.wavelength == NULL) {
        return GONIO_OK;
    }
    material->wavelength = gonio_i_allocate(context, channels, sizeof *material->wavelength);
    material->weight =
        gonio_i_allocate(context, GONIO_CHANNELS * channels, sizeof *material->weight);
    if (material->wavelength == NULL || material->weight == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(material->wavelength, material->source.wavelength, channels * sizeof(double));
    material->source.wavelength = material->wavelength;
    return gonio_i_colour_weights(context, material->wavelength, channels, GONIO_ILLUMINANT_E,
                                  material->weight);
}

static gonio_status keep_names(gonio_context *context, const char *name, const char *format,
                               gonio_material *material)
{
    material->name = strdup(name);
    material->format = strdup(format);
    return material->name != NULL && material->format != NULL
               ? GONIO_OK
               : gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
}

static gonio_material_view view_of(const gonio_material *material)
{
    const gonio_material_source *source = &material->source;
    const bool grid = source->evaluate == NULL;
    return (gonio_material_view){.name = material->name,
                                 .format = material->format,
                                 .channels = grid ? GONIO_CHANNELS : source->channels,
                                 .wavelength = grid ? NULL : source->wavelength,
                                 .anisotropic = source->anisotropic,
                                 .theta_limit = source->theta_limit,
                                 .evaluated = !grid,
                                 .both_halves = source->both_halves,
                                 .halves_difference = source->halves_difference};
}

gonio_status gonio_material_create(gonio_context *context, const char *name, const char *format,
                                   const gonio_material_source *source, gonio_material **material)
{
    gonio_material_source taken;
    gonio_material *made = NULL;
    gonio_status status = GONIO_I_TAKE_PLAIN(context, gonio_material_source, source, &taken);
    taken.channels = taken.channels == 0 ? GONIO_CHANNELS : taken.channels;
    if (status == GONIO_OK) {
        status = check_source(context, &taken);
    }
    if (status == GONIO_OK) {
        made = gonio_i_allocate(context, 1, sizeof *made);
        status = made != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    if (status == GONIO_OK) {
        made->source = taken;
        status = keep_names(context, name, format, made);
    }
    if (status == GONIO_OK) {
        status = keep_wavelengths(context, made);
    }
    if (status != GONIO_OK) {
        if (made != NULL) {
            made->source.release = NULL; /* the source stays the caller's */
        }
        gonio_material_free(&made);
        return status;
    }
    made->view = view_of(made);
    *material = made;
    return GONIO_OK;
}

void gonio_material_free(gonio_material **material)
{
    if (material == NULL || *material == NULL) {
        return;
    }
    if ((*material)->source.release != NULL) {
        (*material)->source.release((*material)->source.self);
    }
    free((*material)->name);
    free((*material)->format);
    free((*material)->wavelength);
    free((*material)->weight);
    free(*material);
    *material = NULL;
}

gonio_status gonio_material_set_illuminant(gonio_context *context, gonio_material *material,
                                           gonio_illuminant illuminant)
{
    return material->wavelength == NULL
               ? GONIO_OK
               : gonio_i_colour_weights(context, material->wavelength, material->source.channels,
                                        illuminant, material->weight);
}

const char *gonio_material_name(const gonio_material *material)
{
    return material->name;
}

const char *gonio_material_format(const gonio_material *material)
{
    return material->format;
}

const gonio_material_view *gonio_material_describe(const gonio_material *material)
{
    return &material->view;
}

gonio_material_source gonio_i_material_source(const gonio_material *material)
{
    return material->source;
}

gonio_status gonio_fingerprint_create(gonio_fingerprint **fingerprint)
{
    gonio_fingerprint *made = calloc(1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->state = XXH3_createState();
    if (made->state == NULL) {
        free(made);
        return GONIO_ERROR_MEMORY;
    }
    XXH3_64bits_reset(made->state);
    *fingerprint = made;
    return GONIO_OK;
}

/* The same for the processor's widest vectors, four times as fast. Only the shared xxhash library
 * of some systems has it. Only x86 needs it. */
#if defined(__x86_64__) && defined(__ELF__)
extern XXH_errorcode XXH3_64bits_update_dispatch(XXH3_state_t *state, const void *data, size_t size)
    __attribute__((weak));
#else
static XXH_errorcode (*const XXH3_64bits_update_dispatch)(XXH3_state_t *, const void *,
                                                          size_t) = NULL;
#endif

void gonio_fingerprint_add(gonio_fingerprint *fingerprint, const void *data, size_t size)
{
    if (XXH3_64bits_update_dispatch != NULL) {
        XXH3_64bits_update_dispatch(fingerprint->state, data, size);
    } else {
        XXH3_64bits_update(fingerprint->state, data, size);
    }
}

uint64_t gonio_fingerprint_value(const gonio_fingerprint *fingerprint)
{
    return XXH3_64bits_digest(fingerprint->state);
}

void gonio_fingerprint_free(gonio_fingerprint **fingerprint)
{
    if (fingerprint == NULL || *fingerprint == NULL) {
        return;
    }
    XXH3_freeState((*fingerprint)->state);
    free(*fingerprint);
    *fingerprint = NULL;
}
