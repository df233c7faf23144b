/* What readings are taken to mean: a dark level and usual mistakes are looked for. */
#ifndef GONIO_INTERPRET_H
#define GONIO_INTERPRET_H

#include "observations.h"

/* Looks for a dark level (*dark, which the caller frees, or NULL) and a usual mistake (*mistake,
 * static, or NULL), and sets the columns to what the material
 * reflects if there is a level.
 * Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_interpret(gonio_context *context, const gonio_i_prior *prior,
                               const gonio_readings *readings, const gonio_i_noise *noise,
                               gonio_i_columns *columns, double **dark, const char **mistake);

#endif
