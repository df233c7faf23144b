/* The rows of readings as CSV. */
#ifndef GONIO_CSV_ROWS_H
#define GONIO_CSV_ROWS_H

#include "../import.h"
#include "../long_table.h"
#include "csv_forms.h"
#include "csv_notes.h"

/* A column of words. */
typedef struct gonio_i_csv_word_column {
    size_t column;             /* the number of columns for none */
    char first[41], other[41]; /* words of it that differ; "" for none */
} gonio_i_csv_word_column;

/* A file that is read. */
typedef struct gonio_i_csv_source {
    gonio_context *context;
    gonio_i_csv_reader reader;
    gonio_i_csv_columns *columns;
    gonio_i_csv_forms forms;
    gonio_readings *readings;
    gonio_i_import in;
    double *value;                       /* [channels] of a row */
    double *deviation;                   /* [channels] */
    gonio_i_csv_others others;           /* columns that are not read */
    double angle[GONIO_I_ANGLE_COLUMNS]; /* degrees, and components of vectors, of a row */
    double wavelength;                   /* of a row */
    int colour;                          /* of a row: 0 R, 1 G, 2 B */
    int polarisation;                    /* of a row: 1 s, -1 p, 0 unpolarised */
    size_t polarised[3];                 /* rows by polarisation: p, unpolarised, s */
    gonio_i_csv_word_column subject;     /* what rows are of */
    size_t kind_column;                  /* whether they are of transmission */
    gonio_i_csv_word_column quality;     /* whether they are good */
    size_t marks;                        /* cells in place of values, such as "---" */
    char mark[16];                       /* the first of them */
    gonio_i_long_table table;            /* rows of one wavelength, colour or polarisation */
} gonio_i_csv_source;

/* Takes all rows behind the names of the columns. Errors: _FORMAT, _DATA, _MEMORY; the message
 * names the line and the cell. */
gonio_status gonio_i_csv_take_rows(gonio_i_csv_source *source);

/* Columns of words in which rows must not differ, or that say which rows are bad
 * (csv_word_columns.c). Errors: _DATA for a row of another sample, colour or side, or of
 * transmission. */
void gonio_i_csv_words_begin(gonio_i_csv_source *source);
gonio_status gonio_i_csv_words_look(gonio_i_csv_source *source);

/* Says that the quality of rows was not heeded. Errors: _MEMORY. */
gonio_status gonio_i_csv_words_note(const gonio_i_csv_source *source);

#endif
