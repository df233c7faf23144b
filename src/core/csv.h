/* Small tables as text (CSV), read whole: every cell is a string. Large tables are read row by row
 * by csv_reader.h, which also describes the format. */
#ifndef GONIO_CSV_H
#define GONIO_CSV_H

#include "comments.h"

typedef struct gonio_i_csv {
    gonio_i_comments comment;
    size_t columns;
    char **name;
    size_t rows;
    char **cell;  /* [rows][columns] */
    size_t *line; /* [rows]: where in the file, from 1 */
    char delimiter;
} gonio_i_csv;

/* Errors: _IO; _FORMAT for binary data, bad quotes, rows longer or shorter than the header,
 * repeated column names, no header, or more than 1 GiB. The message names the line. */
gonio_status gonio_i_csv_read(gonio_context *context, const char *path, gonio_i_csv **csv);
gonio_status gonio_i_csv_write(gonio_context *context, const gonio_i_csv *csv, const char *path);
void gonio_i_csv_free(gonio_i_csv **csv);

/* Functions to build a table. Text is copied. False when out of memory. */
gonio_i_csv *gonio_i_csv_create(gonio_context *context);
bool gonio_i_csv_add_column(gonio_i_csv *csv, const char *name); /* empty cells in every row */
bool gonio_i_csv_add_row(gonio_i_csv *csv, size_t line);         /* of empty cells */
bool gonio_i_csv_set(gonio_i_csv *csv, size_t row, size_t column, const char *format, ...)
    GONIO_I_PRINTF(4, 5);

/* The index of the column with a name, in any letter case; -1 if there is none. */
int gonio_i_csv_column(const gonio_i_csv *csv, const char *name);
const char *gonio_i_csv_cell(const gonio_i_csv *csv, size_t row, size_t column);

/* Whether the whole cell is a number. */
bool gonio_i_csv_number(const gonio_i_csv *csv, size_t row, size_t column, double *value);

#endif
