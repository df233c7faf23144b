/* LAPACKE, loaded when it is used: see lapack_library.h. */
#define GONIO_I_LAPACK_ITSELF
#include "lapack_library.h"

#ifdef GONIO_LAPACKE_LIBRARY
GONIO_I_LAPACK_SYMBOLS(GONIO_I_SYMBOL_WEAK)
#else
#define GONIO_LAPACKE_LIBRARY NULL
#endif

struct gonio_i_lapack gonio_i_lapack;

gonio_status gonio_i_lapack_load(gonio_context *context)
{
    static const gonio_i_symbol symbols[] = {GONIO_I_LAPACK_SYMBOLS(GONIO_I_SYMBOL_ROW)};
    static gonio_i_on_demand library = {.library = GONIO_LAPACKE_LIBRARY,
                                        .symbol = symbols,
                                        .symbols = sizeof symbols / sizeof *symbols,
                                        .pointers = &gonio_i_lapack,
                                        .lock = PTHREAD_MUTEX_INITIALIZER};
    return gonio_i_load(context, &library);
}
