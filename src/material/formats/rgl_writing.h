/* An RGL .bsdf that is being written: what its distribution of normals (rgl_normals.c), its values
 * (rgl_values.c) and its file (rgl_write.c) share. */
#ifndef GONIO_RGL_WRITING_H
#define GONIO_RGL_WRITING_H

#include "../../core/core.h"
#include "../sampler.h"
#include "../warp.h"
#include "rgl.h"
#include "rgl_fit.h"
#include "rgl_places.h"
#include "writers.h"

enum {
    GONIO_I_RGL_THETAS = 26, /* incidences */
    GONIO_I_RGL_SIDE = 84    /* most places along s */
};

typedef struct gonio_i_rgl_writing {
    gonio_context *context;
    gonio_i_sampler sampler;
    const gonio_material_view *view;
    size_t channels; /* 3, or the wavelengths */
    size_t side;
    double limit;                        /* polar angle that directions are held to */
    float theta[GONIO_I_RGL_THETAS];     /* of incidence */
    float ndf[2][GONIO_I_RGL_NORMALS];   /* the rows are alike */
    float sigma[2][GONIO_I_RGL_NORMALS]; /* the same */
    float vndf[GONIO_I_RGL_THETAS][2][GONIO_I_RGL_NORMALS]; /* all rows are alike */
    gonio_i_warp warp;                                      /* of a slice */
    float *value;                                           /* [thetas][channels][side][side] */
    float *luminance;                                       /* [thetas][side][side] */
    unsigned char *valid;                  /* a bit for each [thetas][side][side] */
    double *weight;                        /* [channels]: of the luminance */
    size_t order[GONIO_I_RGL_WAVELENGTHS]; /* [channels]: which of the material */
} gonio_i_rgl_writing;

/* The bytes of a mask of bits. */
static inline size_t gonio_i_bytes_of_bits(size_t bits)
{
    return (bits + 7) / 8;
}

/* The material's channel of each channel of the file, whose wavelengths ascend: order[channels]. */
void gonio_i_rgl_find_order(const gonio_material_view *view, size_t channels, size_t *order);

/* Fills empty places with the mean of their neighbours, ring by ring, in all channels:
 * value[side side][channels]. side: at most GONIO_I_RGL_SIDE. */
void gonio_i_rgl_fill_empty(double *value, size_t side, size_t channels, bool *known);

/* Writes an anisotropic material. Errors: as gonio_material_write_rgl. */
gonio_status gonio_i_rgl_write_anisotropic(gonio_context *context, const gonio_material *material,
                                           const char *path);

/* Fill in w->ndf, w->sigma, and w->vndf with w->warp, in this order. Errors: _MEMORY, those of the
 * material. */
gonio_status gonio_i_rgl_find_ndf(gonio_i_rgl_writing *w);
void gonio_i_rgl_find_sigma(gonio_i_rgl_writing *w);
gonio_status gonio_i_rgl_find_vndf(gonio_i_rgl_writing *w);

/* Fills in w->value, w->luminance and w->valid. Errors: _MEMORY, _CANCELLED, those of the material.
 */
gonio_status gonio_i_rgl_find_values(gonio_i_rgl_writing *w);

#endif
