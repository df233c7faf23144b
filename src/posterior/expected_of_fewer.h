/* The error to expect of columns of many readings. */
#ifndef GONIO_EXPECTED_OF_FEWER_H
#define GONIO_EXPECTED_OF_FEWER_H

#include "solve_columns.h"

/* The error to expect of columns of so many readings that learning takes long: from fewer, which
 * neighbours are merged to. columns: as they were given, before merging. Errors: _MEMORY,
 * _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_expect_of_fewer(gonio_i_finding *all, const gonio_i_column *columns);

#endif
