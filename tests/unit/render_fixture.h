/* What the tests of rendering share: a context that keeps messages, files and images. */
#ifndef RENDER_FIXTURE_H
#define RENDER_FIXTURE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "core/core.h"

/* Keeps the last message (support_message). */
static gonio_context *telling;

static inline int begin(void **state)
{
    (void)state;
    telling = support_context();
    return telling == NULL;
}

static inline int end(void **state)
{
    (void)state;
    gonio_context_free(&telling);
    return 0;
}

static inline void assert_close(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance)) {
        fail_msg("%.12g is not %.12g", a, b);
    }
}

static inline char *path_in(const char *folder, const char *name)
{
    return gonio_i_format("%s/%s", folder, name);
}

static inline void write_file(const char *path, const void *data, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(data, 1, size, stream), size);
    fclose(stream);
}

static inline gonio_status read_mesh(const char *text, size_t size, gonio_mesh **mesh)
{
    char *folder = support_folder();
    char *path = path_in(folder, "mesh");
    write_file(path, text, size);
    const gonio_status status = gonio_mesh_read(telling, path, mesh);
    free(path);
    support_remove(folder);
    return status;
}

#endif
