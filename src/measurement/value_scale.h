/* Values that a file has as logarithms. scale: gonio_value_scale; 0: linear. */
#ifndef GONIO_VALUE_SCALE_H
#define GONIO_VALUE_SCALE_H

#include <stdbool.h>

bool gonio_i_scale_is_logarithm(int scale);

/* The value of a number of the file. */
double gonio_i_scale_value(int scale, double number);

/* The number of the file for a value. */
double gonio_i_scale_number(int scale, double value);

/* The change of the value, relative to it, per change of the number. Only of logarithms. */
double gonio_i_scale_slope(int scale);

/* The standard deviation of a value, of that of its number. */
double gonio_i_scale_deviation(int scale, double value, double deviation);

#endif
