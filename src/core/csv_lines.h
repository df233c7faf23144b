/* The lines of a table as text: comments are taken aside, empty lines passed over. */
#ifndef GONIO_CSV_LINES_H
#define GONIO_CSV_LINES_H

#include "comments.h"

typedef struct gonio_i_csv_lines {
    const char *text; /* [size] */
    size_t size;
    size_t at;                 /* where the next line begins */
    size_t next_number;        /* of that line, from 1 */
    size_t number;             /* of the line found last */
    gonio_i_comments *comment; /* where comments go; NULL: nowhere */
} gonio_i_csv_lines;

/* Begins behind a byte-order mark. */
void gonio_i_csv_lines_begin(gonio_i_csv_lines *lines, const char *text, size_t size,
                             gonio_i_comments *comment);

/* The next line that is neither a comment nor empty, with its end; *length is 0 at the end of the
 * text. A line within quotes goes on behind its end. A line in which all cells are empty is empty.
 * A comment has # as its first character, or behind a quote; separators at its end, which
 * spreadsheets put there, are no part of it. False when out of memory. */
bool gonio_i_csv_lines_next(gonio_i_csv_lines *lines, const char **line, size_t *length);

/* Puts blanks in place of tabs, line ends and other control characters. */
void gonio_i_csv_blank_controls(char *text, size_t length);

/* The separator that a line like sep=; states; 0 if it is none. */
char gonio_i_csv_stated_separator(const char *line, size_t length);

#endif
