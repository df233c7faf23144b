/* The kernels of the linear algebra, chosen before anything else. */
#ifndef GONIO_BLAS_KERNELS_H
#define GONIO_BLAS_KERNELS_H

/* OpenBLAS chooses its kernels by the processor's model when it is loaded. A processor newer than
 * the library gets the oldest kernels, which are several times as slow. If the processor's features
 * allow better ones, this starts the program again with OPENBLAS_CORETYPE set to them, and does not
 * return. Where the address space is limited, OPENBLAS_NUM_THREADS becomes 1 the same way.
 * Variables that the user has set stay as they are. argv: main's. */
void blas_kernels_choose(char **argv);

#endif
