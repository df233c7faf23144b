/* The choice of OpenBLAS's kernels, before anything else. */
#ifndef GONIO_BLAS_KERNELS_H
#define GONIO_BLAS_KERNELS_H

/* OpenBLAS chooses its kernels by the processor's model when it is loaded. A processor newer than
 * the library gets the oldest kernels, which are several times as slow. If the processor's features
 * allow better kernels, this function starts the program again with OPENBLAS_CORETYPE set to them,
 * and does not return. If the address space is limited, it sets OPENBLAS_NUM_THREADS to 1 in the
 * same way. Variables that the user has set stay. argv: main's. */
void blas_kernels_choose(char **argv);

#endif
