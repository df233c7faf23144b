/* Readings of databases, read from text. */
#ifndef DATABASE_READINGS_H
#define DATABASE_READINGS_H

#include <math.h>
#include <string.h>

#include "made_readings.h"

/* Columns of the angles of four rows; theta_r: its numbers, radians. */
#define ANGLES(theta_r)                                                                            \
    "\"theta_i\":{\"unit\":\"deg\",\"values\":[30,30,30,30]},"                                     \
    "\"phi_i\":{\"unit\":\"\u00B0\",\"values\":0},"                                                \
    "\"theta_r\":{\"unit\":\"rad\",\"value\":[" theta_r "]},"                                      \
    "\"phi_r\":{\"unit\":\"deg\",\"values\":[180,180,180,180]}"

static inline void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fmax(1.0, fabs(expected)))) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
}

static inline gonio_readings *read_good(const char *text, const char *taken_as)
{
    char *folder = support_folder();
    gonio_readings *readings = NULL;
    assert_int_equal(made_readings(NULL, folder, "r.brdf", text, NULL, &readings), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->notes, 1);
    assert_non_null(strstr(view->note[0], taken_as));
    support_remove(folder);
    return readings;
}

#endif
