/* A stream whose text is in memory, like open_memstream. But where memory is missing it fails as a
 * full disk does, and does not lose text in silence. */
#ifndef GONIO_MEMORY_STREAM_H
#define GONIO_MEMORY_STREAM_H

#include <stddef.h>
#include <stdio.h>

/* Opens a stream. After fflush and fclose, *text is what was printed, followed by a zero, and *size
 * its bytes. The caller frees *text in any case. fclose returns EOF if any of the text is missing.
 * NULL: out of memory. */
FILE *gonio_i_memory_stream(char **text, size_t *size);

#endif
