/* Notes on a CSV file that is read: what its columns are taken for, and which columns of numbers
 * are not read. */
#ifndef GONIO_CSV_NOTES_H
#define GONIO_CSV_NOTES_H

#include "csv_columns.h"

/* "CSV (angles 'sza', 'vza', 'raa'; values 'brdf')", for the note of the import; mirror: a
 * gonio_mirror_azimuth, or 0 if nothing says it. */
enum { GONIO_I_TAKEN_ROOM = 512 };
void gonio_i_csv_describe(const gonio_i_csv_reader *reader, const gonio_i_csv_columns *columns,
                          int mirror, char text[GONIO_I_TAKEN_ROOM]);

/* Columns that are not read and have held only numbers so far. */
typedef struct gonio_i_csv_others {
    size_t count;
    size_t *column; /* [count] */
    bool *number;   /* [count]: whether there was one */
} gonio_i_csv_others;

/* Errors: _MEMORY. */
gonio_status gonio_i_csv_others_begin(gonio_i_csv_others *others, gonio_context *context,
                                      const gonio_i_csv_columns *columns);

/* Inspects the row that was read last. */
void gonio_i_csv_others_look(gonio_i_csv_others *others, const gonio_i_csv_reader *reader);

/* Writes a note that names the unknown columns of numbers. Errors: _MEMORY. */
gonio_status gonio_i_csv_others_note(gonio_i_csv_others *others, const gonio_i_csv_reader *reader,
                                     gonio_readings *readings);

void gonio_i_csv_others_free(gonio_i_csv_others *others);

#endif
