/* Usual mistakes in readings: wrong units and wrong angles. */
#ifndef GONIO_MISTAKES_H
#define GONIO_MISTAKES_H

#include "observations.h"

/* *mistake: the usual mistake that explains the readings far better than none (static), or NULL.
 * columns: of the readings as given. dark: the dark level of the readings as given (dark_level.h),
 * or NULL. With a joint basis no mistake is looked for. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_mistake_find(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_readings *readings, const gonio_i_noise *noise,
                                  const gonio_i_columns *columns, const double *dark,
                                  const char **mistake);

#endif
