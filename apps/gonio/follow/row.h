/* One line of a run, read as a file of readings is. */
#ifndef GONIO_FOLLOW_ROW_H
#define GONIO_FOLLOW_ROW_H

#include "run.h"

/* Checks the names of columns at the end of `head`. If they cannot be understood, r->problem says
 * why. */
gonio_status row_check_names(run *r, const char *head);

/* Reads a line below r->head. False, with r->problem, if it is no row; *status: _MEMORY or
 * GONIO_OK. */
bool row_read(run *r, const char *text, run_row *row, gonio_status *status);

#endif
