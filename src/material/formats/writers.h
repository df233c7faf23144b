/* Formats that materials are written in: to add one, write a function like those below and add a
 * line to the table in write.c. */
#ifndef GONIO_WRITERS_H
#define GONIO_WRITERS_H

#include <gonio/material.h>

/* Most wavelengths of a .bsdf. */
enum { GONIO_I_RGL_WAVELENGTHS = 512 };

typedef struct gonio_i_format_writer {
    const char *name;      /* for --format */
    const char *extension; /* of files, with its dot */
    const char *summary;
    gonio_status (*write)(gonio_context *context, const gonio_material *material, const char *path);
} gonio_i_format_writer;

#endif
