/* The time of a row, in a column of its own. */
#ifndef GONIO_CSV_TIME_H
#define GONIO_CSV_TIME_H

#include <stdbool.h>

#include "csv_words.h"

/* Whether a name means the time of a row: "time", "time_s", "elapsed (min)", "timestamp". *seconds:
 * how many a unit has. Times of something else ("exposure time") are not meant. */
bool gonio_i_take_time_name(const gonio_i_words *words, double *seconds);

/* The time that a cell states, in seconds: a number of units, a clock (hh:mm, hh:mm:ss.s), or date
 * and clock (2026-11-28T14:05:09Z). NaN for anything else. */
double gonio_i_time_of(const char *cell, char delimiter, double seconds);

#endif
