/* The HDF5 library, loaded when it is used: see hdf_library.h. */
#define GONIO_I_HDF_ITSELF
#include "hdf_library.h"

#ifdef GONIO_HDF5_LIBRARY
GONIO_I_HDF_SYMBOLS(GONIO_I_SYMBOL_WEAK)
#else
#define GONIO_HDF5_LIBRARY NULL
#endif

struct gonio_i_hdf gonio_i_hdf;

gonio_status gonio_i_hdf_load(gonio_context *context)
{
    static const gonio_i_symbol symbols[] = {GONIO_I_HDF_SYMBOLS(GONIO_I_SYMBOL_ROW)};
    static gonio_i_on_demand library = {.library = GONIO_HDF5_LIBRARY,
                                        .symbol = symbols,
                                        .symbols = sizeof symbols / sizeof *symbols,
                                        .pointers = &gonio_i_hdf,
                                        .lock = PTHREAD_MUTEX_INITIALIZER};
    return gonio_i_load(context, &library);
}
