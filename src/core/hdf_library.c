/* The HDF5 library, loaded when it is used: see hdf_library.h. */
#define GONIO_I_HDF_ITSELF
#include "hdf_library.h"

GONIO_I_DEFINE_LIBRARY(gonio_i_hdf, gonio_i_hdf_load, GONIO_I_HDF_SYMBOLS, false)
