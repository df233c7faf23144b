/* Units of angles in files: see angle_unit.h. */
#include "angle_unit.h"

#include <math.h>

#include <gonio/measurement.h>

static const struct {
    const char *word;
    double degrees; /* that so many units are */
    double units;
} known[] = {
    [GONIO_AS_STATED] = {"degrees", 1.0, 1.0},
    [GONIO_DEGREES] = {"degrees", 1.0, 1.0},
    [GONIO_RADIANS] = {"radians", 180.0, M_PI},
    [GONIO_GRADIANS] = {"gon", 9.0, 10.0},
};

double gonio_i_degrees_of(int unit, double angle)
{
    return angle * known[unit].degrees / known[unit].units;
}

double gonio_i_angle_of(int unit, double degrees)
{
    return degrees * known[unit].units / known[unit].degrees;
}

const char *gonio_i_angle_unit_word(int unit)
{
    return known[unit].word;
}
