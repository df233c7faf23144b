/* The picture of what an instrument reaches. */
#ifndef GONIO_REACH_FIGURE_H
#define GONIO_REACH_FIGURE_H

#include <gonio/instrument.h>

/* Draws FOLDER/reach.svg, .pdf and .png: the directions of the detector that can be read, for four
 * directions of the light. Errors: those of figures. */
gonio_status reach_figure(gonio_context *context, const gonio_instrument *instrument,
                          const char *folder);

#endif
