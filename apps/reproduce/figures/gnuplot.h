/* gnuplot, called as a program. */
#ifndef GONIO_REPRODUCE_GNUPLOT_H
#define GONIO_REPRODUCE_GNUPLOT_H

#include "core/core.h"

/* Runs `gnuplot SCRIPT` in a folder, without a shell and without user settings. Its messages become
 * a warning or, if it fails, the error. *found: whether there is a gnuplot on PATH; it is no error
 * if there is none. Errors: _IO. */
gonio_status gonio_i_gnuplot(gonio_context *context, const char *folder, const char *script,
                             bool *found);

#endif
