/* Formats that materials are written in: to add one, write a file that ends with its row, like
 * rgl_write.c, and add its name to the list below. */
#ifndef GONIO_WRITERS_H
#define GONIO_WRITERS_H

#include <stdbool.h>

#include <gonio/material.h>

/* Most wavelengths of a .bsdf. */
enum { GONIO_I_RGL_WAVELENGTHS = 512 };

/* Writes a material; the options are never NULL. Errors: _IO, _MEMORY, _CANCELLED, those of the
 * source; _ARGUMENT for what the format cannot hold. */
typedef gonio_status (*gonio_i_write)(gonio_context *context, const gonio_material *material,
                                      const char *path, const gonio_write_options *options);

typedef struct gonio_i_format_writer {
    const char *name;      /* for --format */
    const char *extension; /* of files, with its dot */
    const char *summary;
    bool isotropic; /* cannot hold anisotropic materials, but for their mean over azimuths */
    bool averages;  /* writes that mean where it is asked for */
    gonio_i_write write;
} gonio_i_format_writer;

/* The writers. The first of an extension is the one that it stands for; the first of all is what a
 * file of an unknown extension becomes. */
#define GONIO_I_MATERIAL_WRITERS(WRITER)                                                           \
    WRITER(merl)                                                                                   \
    WRITER(rgl) WRITER(table) WRITER(klems) WRITER(zemax) WRITER(grid)

#define GONIO_I_DECLARE_WRITER(name) extern const gonio_i_format_writer gonio_i_##name##_writer;
GONIO_I_MATERIAL_WRITERS(GONIO_I_DECLARE_WRITER)

#endif
