/* A file format that materials are read from: to add one, write a file like merl.c and add its name
 * to the list below. */
#ifndef GONIO_FORMAT_H
#define GONIO_FORMAT_H

#include <gonio/material.h>

#include "../../core/file_head.h"

typedef struct gonio_i_format_reader {
    const char *name; /* for "this file is not one of: ..." */
    /* Whether the content (never the name) looks like this format. */
    bool (*recognises)(const gonio_i_file *file);
    /* Opens the file. Gives a source and a text that describes it, to be released with free().
     * The text is NULL if out of memory; the caller reports this. */
    gonio_status (*open)(gonio_context *context, const gonio_i_file *file,
                         gonio_material_source *source, char **description);
    /* Files are readings in the first place, and materials where only these are wanted. */
    bool readings;
} gonio_i_format_reader;

/* The readers, in the order in which they are tried. */
#define GONIO_I_MATERIAL_READERS(READER)                                                           \
    READER(merl)                                                                                   \
    READER(table)                                                                                  \
    READER(anisotropic)                                                                            \
    READER(neural) READER(rgl) READER(kaist) READER(utia) READER(bsdf_xml) READER(zemax)

#define GONIO_I_DECLARE_READER(name) extern const gonio_i_format_reader gonio_i_##name##_reader;
GONIO_I_MATERIAL_READERS(GONIO_I_DECLARE_READER)

/* The name of a file's format; NULL if it is none of these, or is readings in the first place. */
const char *gonio_i_material_format_of(const gonio_i_file *file);

/* The same of readings that are materials too. */
const char *gonio_i_material_format_of_readings(const gonio_i_file *file);

/* The names of the formats; NULL past the last. */
const char *gonio_i_material_format_name(int index);

#endif
