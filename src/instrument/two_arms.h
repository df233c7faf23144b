/* A light arm in the plane phi = 0 and a detector arm in a plane that may turn about the normal:
 * what the kinematics `arms` and `in-plane` share. */
#ifndef GONIO_TWO_ARMS_H
#define GONIO_TWO_ARMS_H

#include "instrument.h"

/* Angles of the arms, rad. The detector is on the mirror's side where receive is positive. */
typedef struct gonio_i_arms {
    double incidence;
    double azimuth; /* of the detector's plane */
    double receive;
    double stage; /* turn of the sample about its normal */
} gonio_i_arms;

gonio_pair gonio_i_arms_pair(const gonio_i_arms *arms);

/* The angles of a pair: arms[4]; a stage that need not turn stands at `rest`. Returns how many. */
size_t gonio_i_arms_of_pair(const gonio_pair *pair, bool isotropic, double rest,
                            gonio_i_arms arms[]);

#endif
