/* Readings as CSV: which column holds what. */
#ifndef GONIO_CSV_COLUMNS_H
#define GONIO_CSV_COLUMNS_H

#include "../../core/csv_reader.h"
#include "../readings.h"
#include "csv_geometry.h"

typedef struct gonio_i_csv_column {
    gonio_i_column_kind kind; /* GONIO_I_OTHER: not read */
    size_t index;      /* of an angle (gonio_i_column_name); of a value's channel in the file */
    double wavelength; /* of a value or deviation, as in the name; 0: none */
    bool complement;   /* an angle from the surface */
    double factor;     /* of the unit of a value or an absolute deviation; 0: none */
    double scale;      /* of a relative deviation: factor to a fraction of the value; 0: absolute.
                        * Of a time: seconds */
    bool second;       /* a value that is averaged with that of the channel's first column */
    bool linear;       /* a deviation of the value itself, where the file has its logarithm */
} gonio_i_csv_column;

typedef struct gonio_i_csv_columns {
    size_t count;
    gonio_i_csv_column *column; /* [count] */
    size_t reads;
    size_t *read; /* [reads]: the columns that are read; angles, channel, wavelength, colour,
                     polarisation, time, mark, values, deviations */
    size_t channels;
    double *wavelength; /* [channels], as the names have them; NULL: colours or unnamed channels */
    gonio_convention stated; /* by names, units and comments; 0 where nothing states it */
    const char *unclear; /* a comment on values that is not understood or not heeded; belongs to the
                          * reader */
    gonio_i_geometry geometry; /* how the columns of angles give the directions */
    size_t polarised;          /* columns of values of one polarisation; */
    size_t averaged;           /* of them, those averaged with another */
    bool by_wavelength;        /* a row has one value of one wavelength */
    bool by_colour;            /* a row has one value of one colour */
    bool by_polarisation;      /* a row has values of one polarisation */
    bool own_angles;           /* named as gonio does */
    bool own;                  /* all are */
    bool any_value;
    bool any_deviation;
    bool any_time;
} gonio_i_csv_columns;

/* Finds the columns from their names, the comments, and the units in the options. Errors: _FORMAT
 * for missing angles, for missing values where they are needed (the message names a column that has
 * a number in the reader's row), for columns of more than one kind of channels, for two columns of
 * the same name, and for columns that differ in their units. */
gonio_status gonio_i_csv_columns_find(const gonio_i_csv_reader *reader,
                                      const gonio_readings_options *options,
                                      gonio_i_csv_columns *columns);

/* Whether several rows are one reading. */
bool gonio_i_csv_has_parts(const gonio_i_csv_columns *columns);

void gonio_i_csv_columns_free(gonio_i_csv_columns *columns);

#endif
