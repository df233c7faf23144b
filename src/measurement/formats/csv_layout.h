/* Tables of text that are not quite CSV, made CSV: names of columns behind another comment mark or
 * below lines of other things, columns between blanks or upright strokes. */
#ifndef GONIO_CSV_LAYOUT_H
#define GONIO_CSV_LAYOUT_H

#include "../../core/core.h"

/* Whether a text has names of angles in a line that the reader of CSV would not take them from. */
bool gonio_i_csv_layout_is_other(const char *text, size_t size);

/* Puts CSV in the place of such a text, with as many lines; other texts stay. Lines above the names
 * become comments. Errors: _MEMORY. */
gonio_status gonio_i_csv_layout_make_plain(gonio_context *context, const char *path, char **text,
                                           size_t *size);

/* Whether the first line of a table holds numbers, where names of columns are expected. */
bool gonio_i_csv_layout_lacks_names(const char *text, size_t size);

#endif
