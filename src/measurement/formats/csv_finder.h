/* The search for the columns of readings as CSV: what its parts share. */
#ifndef GONIO_CSV_FINDER_H
#define GONIO_CSV_FINDER_H

#include "csv_columns.h"

typedef struct gonio_i_csv_finder {
    const gonio_i_csv_reader *r;
    const gonio_readings_options *options;
    gonio_i_csv_columns *c;
    gonio_i_column_name *name; /* [columns] */
    gonio_i_strength strongest;
    gonio_i_family family; /* of the channels that are read */
    int quantity;
    int scale;   /* gonio_value_scale of logarithms; 0: linear */
    bool cosine; /* values contain cos theta_o */
    bool polarised;
} gonio_i_csv_finder;

/* Errors: _FORMAT, always, with a message that names both columns. */
gonio_status gonio_i_csv_refuse_two(const gonio_i_csv_finder *f, const char *what, size_t a,
                                    size_t b);

/* Checks that columns agree in their unit. unit: of one column; *stated: of those before, 0 for
 * none. Errors: _FORMAT. */
gonio_status gonio_i_csv_agree(const gonio_i_csv_finder *f, const char *what, const char *key,
                               size_t k, int unit, int *stated, size_t *by);

/* The text of the first comment "key: text" with one of the keys, which end with NULL; NULL for
 * none. */
const char *gonio_i_csv_comment_of(const gonio_i_csv_finder *f, const char *const *keys);

/* Finds the columns of angles, and what the comments say of them (csv_angles.c). Errors: _FORMAT.
 */
gonio_status gonio_i_csv_find_angles(const gonio_i_csv_finder *f);

/* Finds the columns of the planned channel, the time, the mark, the wavelength and the polarisation
 * of a row (csv_row_columns.c), behind those of values. Errors: _FORMAT for columns of wavenumbers
 * and of polarisations that the detector sees. */
gonio_status gonio_i_csv_find_row_columns(const gonio_i_csv_finder *f);

/* Finds a column that states the colour of the row's one value, if rows differ in it
 * (csv_row_colours.c). */
void gonio_i_csv_find_row_colours(const gonio_i_csv_finder *f);

#endif
