/* Formats that materials are written in: to add one, write a function like those below and add a
 * line to the table in write.c. */
#ifndef GONIO_WRITERS_H
#define GONIO_WRITERS_H

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
    gonio_i_write write;
} gonio_i_format_writer;

gonio_status gonio_i_klems_write(gonio_context *context, const gonio_material *material,
                                 const char *path, const gonio_write_options *options);
gonio_status gonio_i_zemax_write(gonio_context *context, const gonio_material *material,
                                 const char *path, const gonio_write_options *options);
gonio_status gonio_i_grid_write(gonio_context *context, const gonio_material *material,
                                const char *path, const gonio_write_options *options);
gonio_status gonio_i_table_write(gonio_context *context, const gonio_material *material,
                                 const char *path, const gonio_write_options *options);

#endif
