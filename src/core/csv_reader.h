/* A table as text (CSV), on libcsv, row by row: `#` comment lines, a line of column names, then
 * rows. Commas, semicolons or tabs between cells or what a first line like sep=; states, quotes,
 * CRLF and a byte-order mark are understood; with semicolons or tabs a decimal comma is too. Empty
 * rows, and empty cells beyond the names, are passed over. No cell is kept: numbers go straight to
 * where they belong. */
#ifndef GONIO_CSV_READER_H
#define GONIO_CSV_READER_H

#include <stdio.h>

#include "comments.h"
#include "csv_lines.h"

typedef struct gonio_i_csv_reader {
    gonio_context *context;
    const char *path; /* for messages */
    const char *text; /* [size], the caller's */
    size_t size;
    size_t line; /* of the row read last, from 1 */
    size_t columns;
    char **name;              /* [columns]; "" where a column has none */
    size_t cells;             /* of the row read last: as many as columns; 0 behind the last row */
    char **cell;              /* until the next row is read */
    gonio_i_comments comment; /* so far */
    char delimiter;
    gonio_i_csv_lines lines;
    bool again;
    bool remarks_allowed; /* set by the caller: lines of words between rows, and names that are
                           * repeated, are no rows */
    size_t remarks;       /* such lines so far */
    size_t first_remark;  /* line of the first */
    struct csv_parser *parser;
    char *room; /* what cells point into */
    size_t room_size;
    size_t cell_room;
    char *name_room; /* what names point into */
} gonio_i_csv_reader;

/* Reads up to and with the line of column names. The text is the
 * caller's, must last as long as the reader, and ends in a 0 beyond `size`. Errors: _FORMAT for an
 * empty text, no column names, one that occurs twice, and those of _next; the reader is closed
 * then. */
gonio_status gonio_i_csv_open(gonio_context *context, const char *path, const char *text,
                              size_t size, gonio_i_csv_reader *reader);

/* Reads the next row; cells == 0 behind the last, when all comments are known. Errors: _FORMAT for
 * binary data, bad quotes, rows of other lengths than the header; the message names the line. */
gonio_status gonio_i_csv_next(gonio_i_csv_reader *reader);

/* The next call of _next finds the row read last once more, if there is one. */
void gonio_i_csv_again(gonio_i_csv_reader *reader);

/* Puts units behind the names, "theta_i (deg)"; unit[columns], "" or "-" for none. Errors: _MEMORY.
 */
gonio_status gonio_i_csv_units_behind_names(gonio_i_csv_reader *reader, char *const *unit);

void gonio_i_csv_close(gonio_i_csv_reader *reader);

/* Whether a cell is a number, all of it; with decimal points between
 * gonio_i_plain_numbers_begin and _end, in the program's locale otherwise. */
bool gonio_i_csv_is_number(const char *cell, char delimiter, double *value);

/* A cell as a line has it, in quotes where it needs them. */
void gonio_i_csv_print_cell(FILE *stream, const char *cell, char delimiter);

#endif
