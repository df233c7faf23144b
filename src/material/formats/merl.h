/* Writing MERL tables, several at a time. */
#ifndef GONIO_MERL_H
#define GONIO_MERL_H

#include <gonio/material.h>

#include "../../core/output.h"

/* What a count of a table is worth in each channel, 1/sr; also s of gonio's log space. */
extern const double gonio_i_merl_scale[GONIO_CHANNELS];

/* How far the writing of one or more tables is. */
typedef struct gonio_i_tables_progress {
    const char *task;
    size_t slabs; /* written so far */
    size_t tables;
} gonio_i_tables_progress;

/* Opens a table's file, writes it on some threads and flushes it to disk. What it returns is to be
 * handed to gonio_i_output_close, which puts the file in place, unless the file could not be
 * opened: then `output` is closed. Stops with _CANCELLED soon after the progress callback asked for
 * it; never reports progress of 1. */
gonio_status gonio_i_merl_write(gonio_context *context, const gonio_material *material,
                                const char *path, int threads, gonio_i_tables_progress *progress,
                                gonio_i_output *output);

#endif
