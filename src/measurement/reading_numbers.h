/* The numbers of a reading, checked by rules.h. Messages name the file, the line and the column. */
#ifndef GONIO_READING_NUMBERS_H
#define GONIO_READING_NUMBERS_H

#include "readings.h"

/* degrees: theta_i, phi_i, theta_o, phi_o. Errors: _FORMAT, _DATA. */
gonio_status gonio_i_check_angles(gonio_context *context, const gonio_readings *readings,
                                  size_t line, const double degrees[4]);

/* Checks a value of a channel, 1/sr; NaN is none. *to is 0 for a value below zero, where the
 * options allow one. Errors: _FORMAT, _DATA. */
gonio_status gonio_i_take_value(gonio_context *context, const gonio_readings *readings, size_t line,
                                size_t channel, const gonio_readings_options *options, double value,
                                double *to);

/* Checks a standard deviation of a channel, 1/sr; NaN is none. Errors: _FORMAT, _DATA. */
gonio_status gonio_i_take_deviation(gonio_context *context, const gonio_readings *readings,
                                    size_t line, size_t channel, double deviation, double *to);

#endif
