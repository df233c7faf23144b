/* Cairo, loaded when it is used: see cairo_library.h. */
#define GONIO_I_CAIRO_ITSELF
#include "cairo_library.h"

#ifdef GONIO_CAIRO_LIBRARY
GONIO_I_CAIRO_SYMBOLS(GONIO_I_SYMBOL_WEAK)
#else
#define GONIO_CAIRO_LIBRARY NULL
#endif

struct gonio_i_cairo gonio_i_cairo;

gonio_status gonio_i_cairo_load(gonio_context *context)
{
    static const gonio_i_symbol symbols[] = {GONIO_I_CAIRO_SYMBOLS(GONIO_I_SYMBOL_ROW)};
    static gonio_i_on_demand library = {.library = GONIO_CAIRO_LIBRARY,
                                        .symbol = symbols,
                                        .symbols = sizeof symbols / sizeof *symbols,
                                        .pointers = &gonio_i_cairo,
                                        .lock = PTHREAD_MUTEX_INITIALIZER};
    return gonio_i_load(context, &library);
}
