/* Scans in blocks, made a table: a line that names the angle of incidence ("AOI 20 deg"), then rows
 * of the detector's angle and values. */
#ifndef GONIO_CSV_BLOCKS_H
#define GONIO_CSV_BLOCKS_H

#include "../../core/core.h"

/* Whether a text has rows below a line that names the angle of incidence, and no names of columns
 * of directions above them. */
bool gonio_i_csv_are_blocks(const char *text, size_t size);

/* Puts CSV in the place of such a text, with as many lines; other texts stay. The first column of
 * rows is theta_o, in the plane of incidence, unless its name says more. Errors: _MEMORY. */
gonio_status gonio_i_csv_blocks_make_plain(gonio_context *context, const char *path, char **text,
                                           size_t *size);

#endif
