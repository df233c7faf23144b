/* Columns of values in the order of their channels: what is of the same channel is found in a list,
 * as files may have very many columns. */
#ifndef GONIO_CSV_KEYS_H
#define GONIO_CSV_KEYS_H

#include "csv_finder.h"

typedef struct gonio_i_csv_keyed {
    double key; /* colour, wavelength or number */
    size_t column;
} gonio_i_csv_keyed;

typedef struct gonio_i_csv_keys {
    size_t count;
    gonio_i_csv_keyed *item; /* [count], ascending by key, then by column */
} gonio_i_csv_keys;

double gonio_i_csv_key_of(const gonio_i_column_name *name);

/* The columns that are wanted. keys->item is to be freed. Errors: _MEMORY. */
gonio_status gonio_i_csv_list_keys(const gonio_i_csv_finder *f,
                                   bool (*wanted)(const gonio_i_csv_finder *f, size_t column),
                                   gonio_i_csv_keys *keys);

/* other[columns]: of listed columns of values of one polarisation, the one before of the same
 * channel and the other polarisation; the number of columns where there is none
 * (csv_polarised.c). */
void gonio_i_csv_find_partners(const gonio_i_csv_finder *f, const gonio_i_csv_keys *keys,
                               size_t *other);

#endif
