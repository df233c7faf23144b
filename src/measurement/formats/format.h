/* File formats of readings: one file and one name in the list below each.
 *
 * A file is read whole, once. The first format that recognises it reads it. The reader states the
 * convention of the file's numbers and the channels, and adds one row after another (../import.h).
 * The import turns angles and values into gonio's, leaves out rows that are no readings, and notes
 * what the file was taken for. The reader puts comments into readings->comment, and what else is to
 * be written again into readings->attachment. Numbers have decimal points in any locale. */
#ifndef GONIO_READINGS_FORMAT_H
#define GONIO_READINGS_FORMAT_H

#include <stdio.h>

#include "../../core/file_head.h"
#include "../readings.h"

/* A file that is read. */
typedef struct gonio_i_readings_file {
    gonio_context *context;
    const char *path;
    char *text; /* [size] and a 0 behind it; a reader that keeps it sets it to NULL */
    size_t size;
} gonio_i_readings_file;

typedef struct gonio_i_readings_format {
    const char *word;          /* for --as format=WORD */
    const char *name;          /* for people */
    const char *extensions[2]; /* of files that are written in it; all others are CSV */

    /* Whether a text is of this format, judged by its content. text[size] is 0. */
    bool (*recognises)(const char *text, size_t size);

    /* Fills in readings whose path and options are set. */
    gonio_status (*read)(gonio_i_readings_file *file, gonio_readings *readings);

    /* Prints readings of any origin. NULL: the format is only read. The caller checks the stream
     * for errors. */
    gonio_status (*print)(gonio_context *context, const gonio_readings *readings,
                          const char *command, FILE *stream);
} gonio_i_readings_format;

/* The formats, in the order in which they are tried. CSV, the last, takes all other text. */
/* clang-format off */
#define GONIO_I_READINGS_FORMATS(FORMAT) \
    FORMAT(rgl) FORMAT(scattered) FORMAT(alta) FORMAT(pab) FORMAT(astm) FORMAT(tracepro) \
    FORMAT(zemax) FORMAT(fred) FORMAT(curet) FORMAT(openmaterial) FORMAT(brdf_json) \
    FORMAT(in_plane) FORMAT(crossed) FORMAT(csv)
/* clang-format on */

#define GONIO_I_DECLARE_FORMAT(name) extern const gonio_i_readings_format gonio_i_readings_##name;
GONIO_I_READINGS_FORMATS(GONIO_I_DECLARE_FORMAT)

/* The name of a file's format, judged by its beginning; NULL if it has none of them. */
const char *gonio_i_readings_format_of(const gonio_i_file *file);

/* The names of the formats; NULL past the last. */
const char *gonio_i_readings_format_name(int index);

#endif
