/* The interpretation of readings: the search for a dark level and for usual mistakes. */
#ifndef GONIO_INTERPRET_H
#define GONIO_INTERPRET_H

#include "observations.h"

/* Searches for a dark level (*dark, which the caller frees, or NULL) and a usual mistake (*mistake,
 * static, or NULL). Corrects the columns for the level, if there is one.
 * Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_interpret(gonio_context *context, const gonio_i_prior *prior,
                               const gonio_readings *readings, const gonio_i_noise *noise,
                               gonio_i_columns *columns, double **dark, const char **mistake);

#endif
