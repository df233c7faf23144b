/* Kinematics of a table of reachable directions, for anything else. */
#include <math.h>
#include <string.h>

#include "instrument.h"

/* Directions this near are a row of the table, rad. */
static const double SAME = 1e-3;

/* The row whose axes are nearest. */
static gonio_pair pair_of(const gonio_instrument *instrument, const double *axis)
{
    size_t best = 0;
    double least = INFINITY;
    for (size_t row = 0; row < instrument->view.directions; row++) {
        double away = 0.0;
        for (size_t k = 0; k < instrument->view.axes; k++) {
            away += fabs(instrument->row[row].axis[k] - axis[k]);
        }
        best = away < least ? row : best;
        least = fmin(least, away);
    }
    return instrument->row[best].pair;
}

/* The angle between two azimuths, on the sphere at theta. */
static double apart(double a, double b, double theta)
{
    const double turn = gonio_i_azimuth(a - b);
    return fmin(turn, 2.0 * M_PI - turn) * sin(theta);
}

static bool is_same(const gonio_pair *row, const gonio_pair *pair, bool isotropic)
{
    if (fabs(row->incident.theta - pair->incident.theta) > SAME ||
        fabs(row->outgoing.theta - pair->outgoing.theta) > SAME) {
        return false;
    }
    if (isotropic) {
        return apart(gonio_i_azimuth_difference(row), gonio_i_azimuth_difference(pair),
                     fmin(row->incident.theta, row->outgoing.theta)) < SAME;
    }
    return apart(row->incident.phi, pair->incident.phi, row->incident.theta) < SAME &&
           apart(row->outgoing.phi, pair->outgoing.phi, row->outgoing.theta) < SAME;
}

static size_t settings_of(const gonio_instrument *instrument, gonio_pair pair, bool isotropic,
                          double axis[][GONIO_MOST_AXES])
{
    size_t count = 0;
    for (size_t row = 0; row < instrument->view.directions && count < GONIO_I_MOST_SOLUTIONS;
         row++) {
        if (is_same(&instrument->row[row].pair, &pair, isotropic)) {
            memcpy(axis[count++], instrument->row[row].axis, sizeof *axis);
        }
    }
    return count;
}

const gonio_i_kinematics gonio_i_table_kinematics = {
    .name = "table",
    .summary = "a table of reachable directions",
    .incidence = -1,
    .pair = pair_of,
    .settings = settings_of,
};
