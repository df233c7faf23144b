/* MPI, loaded when it is used: see mpi_library.h. */
#define MPI_ITSELF
#include "mpi_library.h"

GONIO_I_DEFINE_LIBRARY(mpi, mpi_load, MPI_SYMBOLS, true)
