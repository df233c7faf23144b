/* Buffers of OpenBLAS. A thread that multiplies matrices maps one; where there is no room for it,
 * OpenBLAS tries for ever. */
#ifndef GONIO_BLAS_BUFFERS_H
#define GONIO_BLAS_BUFFERS_H

#include <stdbool.h>

/* Where the address space is limited (ulimit -v): maps buffers for so many threads, which OpenBLAS
 * keeps and uses again. False if there is no room for them. */
bool gonio_i_reserve_blas_buffers(int threads);

#endif
