/* Scratch files: see scratch.h. */
#include "scratch.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void gonio_i_scratch_init(gonio_i_scratch *scratch)
{
    for (int k = 0; k < GONIO_I_SCRATCH_FILES; k++) {
        scratch->descriptor[k] = -1;
    }
}

static gonio_status open_unlinked(gonio_context *context, const char *folder, int *descriptor)
{
    char *name = gonio_i_format("%s/gonio-XXXXXX", folder);
    if (name == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *descriptor = mkostemp(name, O_CLOEXEC);
    const int reason = errno;
    if (*descriptor >= 0) {
        unlink(name);
    }
    free(name);
    if (*descriptor < 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO,
                            "%s: cannot make a scratch file: %s; set TMPDIR to another folder",
                            folder, strerror(reason));
    }
    return GONIO_OK;
}

gonio_status gonio_i_scratch_open(gonio_context *context, const char *folder,
                                  gonio_i_scratch *scratch)
{
    const char *wanted = folder != NULL ? folder : getenv("TMPDIR");
    const char *used = wanted != NULL && *wanted != '\0' ? wanted : "/tmp";
    gonio_status status = GONIO_OK;
    for (int k = 0; k < GONIO_I_SCRATCH_FILES && status == GONIO_OK; k++) {
        status = open_unlinked(context, used, &scratch->descriptor[k]);
    }
    return status;
}

void gonio_i_scratch_close(gonio_i_scratch *scratch)
{
    for (int k = 0; k < GONIO_I_SCRATCH_FILES; k++) {
        if (scratch->descriptor[k] >= 0) {
            close(scratch->descriptor[k]);
        }
    }
    gonio_i_scratch_init(scratch);
}

gonio_status gonio_i_scratch_write(gonio_context *context, const gonio_i_scratch *scratch,
                                   size_t file, const void *data, size_t size, off_t offset)
{
    const int descriptor = scratch->descriptor[file % GONIO_I_SCRATCH_FILES];
    const char *from = data;
    while (size > 0) {
        const ssize_t done = pwrite(descriptor, from, size, offset);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done < 0) {
            return gonio_i_fail(
                context, GONIO_ERROR_IO,
                "cannot write the scratch file: %s; set TMPDIR to a folder with room",
                strerror(errno));
        }
        from += done;
        offset += done;
        size -= (size_t)done;
    }
    return GONIO_OK;
}

gonio_status gonio_i_scratch_read(gonio_context *context, const gonio_i_scratch *scratch,
                                  size_t file, void *data, size_t size, off_t offset)
{
    const int descriptor = scratch->descriptor[file % GONIO_I_SCRATCH_FILES];
    char *to = data;
    while (size > 0) {
        const ssize_t done = pread(descriptor, to, size, offset);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            return gonio_i_fail(context, GONIO_ERROR_IO, "cannot read the scratch file: %s",
                                done < 0 ? strerror(errno) : "it ends early");
        }
        to += done;
        offset += done;
        size -= (size_t)done;
    }
    return GONIO_OK;
}
