/* The numbers that a reading may have. Each function returns what is wrong with a number, for a
 * message that begins with it, and the status to fail with; NULL if the number is right. */
#ifndef GONIO_RULES_H
#define GONIO_RULES_H

#include <gonio/measurement.h>

/* theta_i, phi_i, theta_o, phi_o as columns are named. */
extern const char *const gonio_i_angle_names[4];

/* One of the four angles, in degrees. */
const char *gonio_i_angle_problem(int which, double degrees, gonio_status *status);

/* A value that was read (not NaN), 1/sr. */
const char *gonio_i_value_problem(double value, const gonio_readings_options *options,
                                  gonio_status *status);

/* A standard deviation, 1/sr. */
const char *gonio_i_deviation_problem(double deviation, gonio_status *status);

/* nm: the range of wavelengths of goniometers. */
extern const double gonio_i_least_wavelength;
extern const double gonio_i_most_wavelength;

/* A wavelength that occurs twice; 0 if none does, -1 when out of memory. */
double gonio_i_wavelength_twice(const double *wavelength, size_t count);

/* Angles in radians from allowed theta and phi in degrees; phi in [0, 2 pi). */
gonio_angles gonio_i_angles_from_degrees(double theta, double phi);

/* degrees: theta_i, phi_i, theta_o, phi_o. */
void gonio_i_pair_to_degrees(const gonio_pair *pair, double degrees[4]);

#endif
