/* How the columns of angles of a row give its two directions. */
#ifndef GONIO_CSV_GEOMETRY_H
#define GONIO_CSV_GEOMETRY_H

#include "csv_names.h"

typedef enum gonio_i_geometry {
    GONIO_I_FOUR_ANGLES,
    GONIO_I_DIFFERENCE_GIVES_PHI_O,
    GONIO_I_DIFFERENCE_GIVES_PHI_I,
    GONIO_I_IN_PLANE,        /* without azimuths */
    GONIO_I_FROM_THE_NORMAL, /* theta_o from the mirror direction, away from the normal */
    GONIO_I_TOWARDS_LIGHT,   /* the same, the other way */
    GONIO_I_PHASE_ANGLE,     /* the angle between both directions in place of azimuths */
    GONIO_I_HALF_DIFFERENCE, /* theta_h, theta_d, phi_d; phi_h or 0 */
    GONIO_I_SINES,           /* sin theta_o - sin theta_i */
    GONIO_I_SIZE_OF_SINES,   /* the same without its sign */
    GONIO_I_UNIT_VECTORS,    /* x, y and z of both; their lengths do not count */
    GONIO_I_NAMED_DIRECTIONS /* by names of geometries: theta_i, and theta_o on the mirror's side */
} gonio_i_geometry;

/* What notes say of a geometry, behind the names of its columns; mirror: gonio_mirror_azimuth. */
const char *gonio_i_geometry_words(gonio_i_geometry geometry, int mirror);

/* The directions of a row. cell[GONIO_I_ANGLE_COLUMNS]: its angles in degrees, and components of
 * vectors; 0 where there is no column. degrees: theta_i, phi_i, theta_o, phi_o. Returns what is
 * wrong with them, or NULL. */
const char *gonio_i_geometry_take(gonio_i_geometry geometry, int mirror, const double *cell,
                                  double degrees[4]);

#endif
