/* Readings as CSV: what is kept of a file, and writing it again. */
#ifndef GONIO_CSV_KEPT_H
#define GONIO_CSV_KEPT_H

#include "csv_columns.h"

/* The text of a planned channel in a cell: all; R, G or B; 400nm; or its number from 1 on. */
void gonio_i_csv_name_channel(const gonio_readings *readings, int channel,
                              char name[GONIO_I_NAME_ROOM]);

/* What is kept of a CSV file. */
typedef struct gonio_i_csv_kept {
    char *text;
    size_t size;
    gonio_i_csv_columns columns;
    bool rewrite_angles; /* the file has them in another convention */
} gonio_i_csv_kept;

void gonio_i_csv_kept_free(void *kept);

/* What readings keep of their CSV file; NULL if they are from elsewhere. */
const gonio_i_csv_kept *gonio_i_csv_kept_of(const gonio_readings *readings);

/* Prints readings: with the columns of the file that they came from, otherwise as a new file.
 * Errors: _MEMORY. */
gonio_status gonio_i_csv_print(gonio_context *context, const gonio_readings *readings,
                               const char *command, FILE *stream);

#endif
