/* Embree, loaded when it is used: see embree_library.h. */
#define GONIO_I_EMBREE_ITSELF
#include "embree_library.h"

GONIO_I_DEFINE_LIBRARY(gonio_i_embree, gonio_i_embree_load, GONIO_I_EMBREE_SYMBOLS, false)
