/* Units of angles in files. unit: gonio_angle_unit; 0: degrees. */
#ifndef GONIO_ANGLE_UNIT_H
#define GONIO_ANGLE_UNIT_H

/* An angle of a file in degrees, and back. */
double gonio_i_degrees_of(int unit, double angle);
double gonio_i_angle_of(int unit, double degrees);

/* As in "is impossible in radians". */
const char *gonio_i_angle_unit_word(int unit);

#endif
