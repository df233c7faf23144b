/* Lines and cells of a text whose layout is not known yet. */
#ifndef GONIO_CSV_CELLS_H
#define GONIO_CSV_CELLS_H

#include <stdio.h>

#include "../../core/core.h"

typedef struct gonio_i_line {
    const char *at;
    size_t length; /* without its end */
} gonio_i_line;

/* The next line of a text; false at its end. */
bool gonio_i_next_line(const char **at, const char *end, gonio_i_line *l);

/* Without blanks at both ends. */
gonio_i_line gonio_i_trimmed(gonio_i_line l);

/* The line without the comment mark that begins it. *mark: which, NULL for none. */
gonio_i_line gonio_i_without_mark(gonio_i_line l, const char **mark);

/* A cell of a line whose cells are between separators; ' ' stands for any blanks. *rest: what is
 * left of the line. False at its end. */
bool gonio_i_next_cell(gonio_i_line *rest, char separator, gonio_i_line *cell);
size_t gonio_i_count_cells(gonio_i_line l, char separator);

/* Puts what `print` writes of a text in its place; found: what it is to know. Errors: _MEMORY. */
gonio_status
gonio_i_print_again(gonio_context *context, const char *path, char **text, size_t *size,
                    void (*print)(FILE *stream, const char *text, size_t size, const void *found),
                    const void *found);

#endif
