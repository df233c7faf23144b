/* Embree, loaded when it is used: see embree_library.h. */
#define GONIO_I_EMBREE_ITSELF
#include "embree_library.h"

#ifdef GONIO_EMBREE_LIBRARY
GONIO_I_EMBREE_SYMBOLS(GONIO_I_SYMBOL_WEAK)
#else
#define GONIO_EMBREE_LIBRARY NULL
#endif

struct gonio_i_embree gonio_i_embree;

gonio_status gonio_i_embree_load(gonio_context *context)
{
    static const gonio_i_symbol symbols[] = {GONIO_I_EMBREE_SYMBOLS(GONIO_I_SYMBOL_ROW)};
    static gonio_i_on_demand library = {.library = GONIO_EMBREE_LIBRARY,
                                        .symbol = symbols,
                                        .symbols = sizeof symbols / sizeof *symbols,
                                        .pointers = &gonio_i_embree,
                                        .lock = PTHREAD_MUTEX_INITIALIZER};
    return gonio_i_load(context, &library);
}
