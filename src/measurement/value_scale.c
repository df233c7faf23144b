/* Values that a file has as logarithms: see value_scale.h. */
#include "value_scale.h"

#include <math.h>

#include <gonio/measurement.h>

bool gonio_i_scale_is_logarithm(int scale)
{
    return scale > GONIO_SCALE_LINEAR;
}

double gonio_i_scale_slope(int scale)
{
    return scale == GONIO_SCALE_LN        ? 1.0
           : scale == GONIO_SCALE_DECIBEL ? log(10.0) / 10.0
                                          : log(10.0);
}

double gonio_i_scale_value(int scale, double number)
{
    switch (scale) {
    case GONIO_SCALE_LOG10:
        return pow(10.0, number);
    case GONIO_SCALE_LN:
        return exp(number);
    case GONIO_SCALE_DECIBEL:
        return pow(10.0, number / 10.0);
    default:
        return number;
    }
}

double gonio_i_scale_number(int scale, double value)
{
    return gonio_i_scale_is_logarithm(scale) ? log(value) / gonio_i_scale_slope(scale) : value;
}

double gonio_i_scale_deviation(int scale, double value, double deviation)
{
    return gonio_i_scale_is_logarithm(scale) ? value * gonio_i_scale_slope(scale) * deviation
                                             : deviation;
}
