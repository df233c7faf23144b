/* Usual mistakes in readings: wrong units and wrong angles. */
#ifndef GONIO_MISTAKES_H
#define GONIO_MISTAKES_H

#include "observations.h"

/* *mistake: what would explain the readings far better than what they say they are (static), or
 * NULL. columns: of the readings as they are; dark: of the readings as they are (dark_level.h), or
 * NULL. With a joint basis none is looked for. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_mistake_find(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_readings *readings, const gonio_i_noise *noise,
                                  const gonio_i_columns *columns, const double *dark,
                                  const char **mistake);

#endif
