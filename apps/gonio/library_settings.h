/* Settings of the libraries underneath that they read from the environment when they are loaded. */
#ifndef GONIO_LIBRARY_SETTINGS_H
#define GONIO_LIBRARY_SETTINGS_H

#include <stdbool.h>

/* Sets variables of the environment and starts the program again, in which case this function does
 * not return. In the second start it removes them, so that programs that gonio starts do not get
 * them. Variables that the user has set stay as they are. argv: main's.
 *
 * - OPENBLAS_CORETYPE: OpenBLAS chooses its kernels by the processor's model. A processor newer
 * than the library gets the oldest kernels, which are several times as slow. It is set if the
 *   processor's features allow better kernels.
 * - OPENBLAS_NUM_THREADS: 1 if the address space is limited.
 * - GOMP_SPINCOUNT, if `parallel` (the command computes on several threads): at the end of a
 *   parallel loop, a thread waits for the others in a loop of 300,000 looks, some 5 ms, before it
 *   sleeps. On a busy machine the others may not run for that long, and the time is wasted. It is
 *   set to a tenth. A user's OMP_WAIT_POLICY goes before it. */
void library_settings_choose(char **argv, bool parallel);

#endif
