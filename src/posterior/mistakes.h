/* Usual mistakes in readings: wrong units and wrong angles. */
#ifndef GONIO_MISTAKES_H
#define GONIO_MISTAKES_H

#include "observations.h"

/* Sets the albedo and the alternatives of an interpretation. columns: of the readings as given.
 * dark: the dark level of the readings as given (dark_level.h), or NULL. With a joint basis no
 * mistake is looked for. Errors: _MEMORY, _NUMERICAL, _CANCELLED. */
gonio_status gonio_i_mistakes_find(gonio_context *context, const gonio_i_prior *prior,
                                   const gonio_readings *readings, const gonio_i_noise *noise,
                                   const gonio_i_columns *columns, const double *dark,
                                   gonio_interpretation *interpretation);

/* How a mistake, as an alternative names it, changes directions; NULL: it does not. */
typedef gonio_pair (*gonio_i_change)(gonio_pair pair);
gonio_i_change gonio_i_mistake_change(const char *mistake);

#endif
