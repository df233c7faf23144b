/* Readings as CSV: what each column holds, by its name; what is kept of a file; writing. */
#ifndef GONIO_CSV_COLUMNS_H
#define GONIO_CSV_COLUMNS_H

#include "../../core/csv_reader.h"
#include "../readings.h"

typedef enum gonio_i_column_kind {
    GONIO_I_OTHER = 0,
    GONIO_I_ANGLE,
    GONIO_I_PLANNED,
    GONIO_I_VALUE,
    GONIO_I_DEVIATION
} gonio_i_column_kind;

typedef struct gonio_i_csv_column {
    gonio_i_column_kind kind;
    size_t index;      /* of an angle; of a value's channel in the file */
    double wavelength; /* of a value or deviation, nm; 0: a colour or an unnamed channel */
} gonio_i_csv_column;

typedef struct gonio_i_csv_columns {
    size_t count;
    gonio_i_csv_column *column; /* [count] */
    size_t channels;
    double *wavelength; /* [channels]; NULL: colours or unnamed channels */
    bool any_value;
    bool any_deviation;
} gonio_i_csv_columns;

/* From the reader's column names. Errors: _FORMAT for angles that are not there, no
 * values where they are needed, columns of more than one kind of channels. */
gonio_status gonio_i_csv_columns_find(const gonio_i_csv_reader *reader, bool values_needed,
                                      gonio_i_csv_columns *columns);

void gonio_i_csv_columns_free(gonio_i_csv_columns *columns);

/* A planned channel as a cell has it: all; R, G or B; 400nm; or its number from 1. */
void gonio_i_csv_name_channel(const gonio_readings *readings, int channel,
                              char name[GONIO_I_NAME_ROOM]);

/* What is written again of a CSV file. */
typedef struct gonio_i_csv_kept {
    char *text;
    size_t size;
    gonio_i_csv_columns columns;
} gonio_i_csv_kept;

void gonio_i_csv_kept_free(void *kept);

/* NULL if the readings are not from a CSV file. */
const gonio_i_csv_kept *gonio_i_csv_kept_of(const gonio_readings *readings);

/* Prints readings over the file that they came from, or anew. Errors: _MEMORY. */
gonio_status gonio_i_csv_print(gonio_context *context, const gonio_readings *readings,
                               const char *command, FILE *stream);

#endif
