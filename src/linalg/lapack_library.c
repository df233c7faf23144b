/* LAPACKE, loaded when it is used: see lapack_library.h. */
#define GONIO_I_LAPACK_ITSELF
#include "lapack_library.h"

GONIO_I_DEFINE_LIBRARY(gonio_i_lapack, gonio_i_lapack_load, GONIO_I_LAPACK_SYMBOLS, false)
