/* MPI, loaded when it is used: see mpi_library.h. */
#define MPI_ITSELF
#include "mpi_library.h"

#ifdef GONIO_MPI_LIBRARY
MPI_SYMBOLS(GONIO_I_SYMBOL_WEAK)
MPI_DATA(GONIO_I_SYMBOL_WEAK)
#else
#define GONIO_MPI_LIBRARY NULL
#endif

struct mpi mpi;

gonio_status mpi_load(gonio_context *context)
{
    static const gonio_i_symbol symbols[] = {MPI_SYMBOLS(GONIO_I_SYMBOL_ROW)
                                                 MPI_DATA(GONIO_I_SYMBOL_ROW)};
    static gonio_i_on_demand library = {.library = GONIO_MPI_LIBRARY,
                                        .global = true,
                                        .symbol = symbols,
                                        .symbols = sizeof symbols / sizeof *symbols,
                                        .pointers = &mpi,
                                        .lock = PTHREAD_MUTEX_INITIALIZER};
    return gonio_i_load(context, &library);
}
