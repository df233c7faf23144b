/* Writing MERL tables, several at a time. */
#ifndef GONIO_MERL_H
#define GONIO_MERL_H

#include <gonio/material.h>

#include "../../core/output.h"

/* The factor from stored numbers to 1/sr in each channel; also s of gonio's log space. */
extern const double gonio_i_merl_scale[GONIO_CHANNELS];

/* Progress of the writing of one or more tables. */
typedef struct gonio_i_tables_progress {
    const char *task;
    size_t slabs; /* written so far */
    size_t tables;
} gonio_i_tables_progress;

/* Opens a table's file, writes it on some threads and flushes it to disk. The caller hands the
 * status to gonio_i_output_close, which puts the file in place. If the file cannot be opened,
 * `output` is closed already. Stops with _CANCELLED soon after the progress callback asks for it.
 * Never reports progress of 1. */
gonio_status gonio_i_merl_write(gonio_context *context, const gonio_material *material,
                                const char *path, int threads, gonio_i_tables_progress *progress,
                                gonio_i_output *output);

#endif
