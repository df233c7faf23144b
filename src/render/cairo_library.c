/* Cairo, loaded when it is used: see cairo_library.h. */
#define GONIO_I_CAIRO_ITSELF
#include "cairo_library.h"

GONIO_I_DEFINE_LIBRARY(gonio_i_cairo, gonio_i_cairo_load, GONIO_I_CAIRO_SYMBOLS, false)
