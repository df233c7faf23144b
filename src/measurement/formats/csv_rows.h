/* The rows of readings as CSV. */
#ifndef GONIO_CSV_ROWS_H
#define GONIO_CSV_ROWS_H

#include "../import.h"
#include "../long_table.h"
#include "csv_forms.h"
#include "csv_notes.h"

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
    int polarisation;                    /* of a row: 1 s, -1 p, 0 unpolarised */
    size_t polarised[3];                 /* rows by polarisation: p, unpolarised, s */
    size_t sample_column;                /* that names samples */
    char sample[41];                     /* the name in the first row that has one */
    size_t marks;                        /* cells in place of values, such as "---" */
    char mark[16];                       /* the first of them */
    gonio_i_long_table table;            /* rows of one wavelength each */
} gonio_i_csv_source;

/* Takes all rows behind the names of the columns. Errors: _FORMAT, _DATA, _MEMORY; the message
 * names the line and the cell. */
gonio_status gonio_i_csv_take_rows(gonio_i_csv_source *source);

#endif
