/* Which numbers a reading may have: see rules.h. */
#include "rules.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const gonio_i_angle_names[4] = {"theta_i_deg", "phi_i_deg", "theta_o_deg", "phi_o_deg"};

/* 1/sr: far above any peak in any unit, far below the overflow of squares. */
static const double MOST_VALUE = 1e30;

const char *gonio_i_angle_problem(int which, double degrees, gonio_status *status)
{
    const bool polar = which % 2 == 0;
    if (!isfinite(degrees)) {
        *status = GONIO_ERROR_FORMAT;
        return "is not a finite number";
    }
    *status = GONIO_ERROR_DATA;
    if (polar && degrees < 0.0) {
        return "is negative: give 0 to 90, and turn phi by 180";
    }
    if (polar && degrees >= 90.0) {
        return "is at or below the horizon: give a theta below 90";
    }
    if (!polar && fabs(degrees) > 360.0) {
        return "is outside -360 to 360 degrees";
    }
    *status = GONIO_OK;
    return NULL;
}

const char *gonio_i_value_problem(double value, const gonio_readings_options *options,
                                  gonio_status *status)
{
    if (!isfinite(value)) {
        *status = GONIO_ERROR_FORMAT;
        return "is not a finite number (leave the cell empty where nothing was read)";
    }
    *status = GONIO_ERROR_DATA;
    if (value > MOST_VALUE) {
        return "is larger than any BRDF (leave the cell empty where nothing was read)";
    }
    if (value < 0.0 && !options->negative_to_zero) {
        return "is negative (a dark level that is too high?): --negative-to-zero takes it as 0";
    }
    *status = GONIO_OK;
    return NULL;
}

const char *gonio_i_deviation_problem(double deviation, gonio_status *status)
{
    *status = GONIO_ERROR_DATA;
    if (!isfinite(deviation) || deviation < 0.0 || deviation > MOST_VALUE) {
        return "is not a standard deviation: give a finite number from 0 on, in 1/sr";
    }
    *status = GONIO_OK;
    return NULL;
}

const double gonio_i_least_wavelength = 100.0;
const double gonio_i_most_wavelength = 1e6;

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

double gonio_i_wavelength_twice(const double *wavelength, size_t count)
{
    double *sorted = malloc((count + 1) * sizeof *sorted);
    double twice = sorted != NULL ? 0.0 : -1.0;
    if (sorted != NULL) {
        memcpy(sorted, wavelength, count * sizeof *sorted);
        qsort(sorted, count, sizeof *sorted, compare_numbers);
    }
    for (size_t k = 1; sorted != NULL && k < count && twice == 0.0; k++) {
        twice = sorted[k - 1] == sorted[k] ? sorted[k] : 0.0;
    }
    free(sorted);
    return twice;
}

gonio_angles gonio_i_angles_from_degrees(double theta, double phi)
{
    const double azimuth = fmod(phi < 0.0 ? phi + 360.0 : phi, 360.0);
    return (gonio_angles){theta * M_PI / 180.0, azimuth * M_PI / 180.0};
}

static double to_degrees(double radians)
{
    return radians * 180.0 / M_PI;
}

void gonio_i_pair_to_degrees(const gonio_pair *pair, double degrees[4])
{
    degrees[0] = to_degrees(pair->incident.theta);
    degrees[1] = to_degrees(pair->incident.phi);
    degrees[2] = to_degrees(pair->outgoing.theta);
    degrees[3] = to_degrees(pair->outgoing.phi);
}
