/* The picture of what an instrument reaches, and what keeps it from the rest. */
#ifndef GONIO_REACH_FIGURE_H
#define GONIO_REACH_FIGURE_H

#include <gonio/instrument.h>
#include <gonio/measurement.h>

/* Draws FOLDER/reach.svg, .pdf and .png: the directions of the detector that can be read and what
 * keeps the others out, for up to four directions of the light; with the readings of a plan near
 * them, unless it is NULL. Errors: those of figures. */
gonio_status reach_figure(gonio_context *context, const gonio_instrument *instrument,
                          const gonio_readings *plan, const char *folder);

#endif
