/* The unlinked files that hold an observation matrix out of core. */
#ifndef GONIO_SCRATCH_H
#define GONIO_SCRATCH_H

#include <stddef.h>
#include <sys/types.h>

#include "../core/core.h"

enum { GONIO_I_SCRATCH_FILES = 8 };

/* There are several files, because the kernel lets only one thread at a time write to a file. */
typedef struct gonio_i_scratch {
    int descriptor[GONIO_I_SCRATCH_FILES]; /* -1 where not open */
} gonio_i_scratch;

/* Opens no file. _close may follow in any case. */
void gonio_i_scratch_init(gonio_i_scratch *scratch);

/* Opens the files in `folder`, or in $TMPDIR or /tmp if it is NULL. Errors: _IO, _MEMORY. */
gonio_status gonio_i_scratch_open(gonio_context *context, const char *folder,
                                  gonio_i_scratch *scratch);
void gonio_i_scratch_close(gonio_i_scratch *scratch);

/* Transfer bytes offset .. offset + size - 1 of the file file % GONIO_I_SCRATCH_FILES. Errors: _IO.
 */
gonio_status gonio_i_scratch_write(gonio_context *context, const gonio_i_scratch *scratch,
                                   size_t file, const void *data, size_t size, off_t offset);
gonio_status gonio_i_scratch_read(gonio_context *context, const gonio_i_scratch *scratch,
                                  size_t file, void *data, size_t size, off_t offset);

#endif
