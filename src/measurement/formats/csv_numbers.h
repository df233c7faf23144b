/* Cells that are no plain numbers: angles with their signs, words, and what stands for a missing
 * value. */
#ifndef GONIO_CSV_NUMBERS_H
#define GONIO_CSV_NUMBERS_H

#include <stdbool.h>

/* An angle with the signs of degrees, minutes and seconds, or with the word deg: 30°, 10.5 deg,
 * 10°30'. */
bool gonio_i_csv_is_angle(const char *cell, char delimiter, double *degrees);

/* Behind blanks and tabs. */
const char *gonio_i_skip_blanks(const char *at);

/* Whether a cell or a name is one of the words, in capitals or not; they end with NULL. */
bool gonio_i_csv_is_one_of(const char *cell, const char *const *words);

/* Whether a cell is empty, or NA or NaN. */
bool gonio_i_csv_is_empty(const char *cell);

/* Whether a cell has another mark in place of a value that was not read or is out of the
 * instrument's range: ---, n/a, #N/A, -999, <LOD>, OVRFLW. */
bool gonio_i_csv_is_mark(const char *cell);

#endif
