/* The interpretation of readings: what they seem to be, where that is not what they say. */
#ifndef GONIO_INTERPRET_H
#define GONIO_INTERPRET_H

#include "observations.h"

/* Looks at turned readings, leaves out those of nothing (unmeasured.h), and searches for usual
 * mistakes (*interpretation) and a dark level (*dark, which the caller frees, or NULL). Corrects
 * the columns for the level, if there is one. Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_interpret(gonio_context *context, const gonio_i_prior *prior,
                               const gonio_readings *readings, const gonio_i_noise *noise,
                               gonio_i_columns *columns, gonio_interpretation *interpretation,
                               double **dark);

#endif
