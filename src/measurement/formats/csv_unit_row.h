/* The line of units that may follow the names of columns of CSV. */
#ifndef GONIO_CSV_UNIT_ROW_H
#define GONIO_CSV_UNIT_ROW_H

#include "../../core/csv_reader.h"

/* Reads the line of units that may follow the names, and appends units to names: "theta_i (deg)".
 * The next row is then the first row of numbers. */
gonio_status gonio_i_csv_take_units(gonio_i_csv_reader *reader);

#endif
