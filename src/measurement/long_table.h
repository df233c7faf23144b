/* Tables with a row for each direction and wavelength (and polarisation) become rows with all
 * wavelengths. Equal directions are joined, in the order in which they first appear. Values of one
 * direction and wavelength in several states of polarisation become their mean; the mean of s and p
 * is unpolarised. Values in the same state are repeats: the second values of a direction are a row
 * of their own, and so on. */
#ifndef GONIO_LONG_TABLE_H
#define GONIO_LONG_TABLE_H

#include "import.h"

typedef struct gonio_i_long_row {
    double degrees[4]; /* as in gonio_i_row */
    double wavelength; /* in the convention's unit; or the number of a channel from 0 on */
    double value;
    double deviation; /* NaN: not known */
    double state;     /* a number for each state of polarisation; no NaN */
    size_t line;
} gonio_i_long_row;

typedef struct gonio_i_long_table {
    gonio_context *context;
    size_t count;
    size_t room;
    gonio_i_long_row *row; /* [count] */
    bool any_deviation;
    size_t numbered; /* channels that rows number; 0: rows have wavelengths */
} gonio_i_long_table;

/* Adds a row. A new table is zero except for its context. Errors: _MEMORY. */
gonio_status gonio_i_long_table_add(gonio_i_long_table *table, const gonio_i_long_row *row);

/* Sets the channels of the import (numbered ones, or wavelengths ascending) and adds its rows. The
 * deviation of a mean of m values is the root of the sum of their squared deviations, over m.
 * Errors: as of the import; _FORMAT for more than 4096 wavelengths, and where most of a large table
 * would be holes; _MEMORY. */
gonio_status gonio_i_long_table_import(gonio_i_long_table *table, gonio_i_import *import);

void gonio_i_long_table_free(gonio_i_long_table *table);

#endif
