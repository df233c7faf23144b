/* gnuplot, called as a program. */
#ifndef GONIO_REPRODUCE_GNUPLOT_H
#define GONIO_REPRODUCE_GNUPLOT_H

#include "core/core.h"

/* Runs `gnuplot SCRIPT` in a folder, by no shell and with nobody's settings. What it says becomes a
 * warning or, if it fails, the error. `*found` tells whether there is a gnuplot on PATH; it is no
 * error if not. Errors: _IO. */
gonio_status gonio_i_gnuplot(gonio_context *context, const char *folder, const char *script,
                             bool *found);

#endif
