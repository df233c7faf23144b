/* The kernels of the linear algebra, chosen before anything else. */
#ifndef GONIO_BLAS_KERNELS_H
#define GONIO_BLAS_KERNELS_H

/* OpenBLAS chooses its kernels when it is loaded, by the processor's model: one that is newer than
 * the library gets those of the oldest, several times as slow. If the processor's features allow
 * better ones, starts the program again with OPENBLAS_CORETYPE set to them; does not return then.
 * Does nothing where the user has set it. argv: main's. */
void blas_kernels_choose(char **argv);

#endif
