/* A file format of materials: to add one, write a file like merl.c and add a line to the table in
 * material.c. */
#ifndef GONIO_FORMAT_H
#define GONIO_FORMAT_H

#include <gonio/material.h>

#include "../../core/core.h"

enum { GONIO_I_HEAD = 1024 }; /* bytes of the file's start that a format may look at */

typedef struct gonio_i_file {
    const char *path;
    unsigned char head[GONIO_I_HEAD];
    size_t head_size; /* bytes of head that the file has */
    uint64_t size;    /* of the whole file */
} gonio_i_file;

typedef struct gonio_i_format_reader {
    const char *name; /* for "this file is not one of: ..." */
    /* Whether the content (never the name) looks like this format. */
    bool (*probe)(const gonio_i_file *file);
    /* Opens it: gives a source and a description in words, to be released with free(). */
    gonio_status (*open)(gonio_context *context, const gonio_i_file *file,
                         gonio_material_source *source, char **description);
} gonio_i_format_reader;

extern const gonio_i_format_reader gonio_i_merl_reader;
extern const gonio_i_format_reader gonio_i_neural_reader;
extern const gonio_i_format_reader gonio_i_rgl_reader;

#endif
