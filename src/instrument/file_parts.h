/* The parts of an instrument file, each read by a file of its own into the instrument. */
#ifndef GONIO_FILE_PARTS_H
#define GONIO_FILE_PARTS_H

#include "fields.h"

/* Axes, and the table of reachable directions. instrument->kinematics is set before. */
gonio_status gonio_i_read_axes(const gonio_i_place *place, const json_t *root,
                               gonio_instrument *instrument);

/* Limits, forbidden zones and the footprint. Axes are read before. */
gonio_status gonio_i_read_limits(const gonio_i_place *place, const json_t *root,
                                 gonio_instrument *instrument);

/* Channels, what values are, noise and levels, apertures. */
gonio_status gonio_i_read_sensor(const gonio_i_place *place, const json_t *root,
                                 gonio_instrument *instrument);

/* Times. */
gonio_status gonio_i_read_times(const gonio_i_place *place, const json_t *root,
                                gonio_instrument *instrument);

#endif
