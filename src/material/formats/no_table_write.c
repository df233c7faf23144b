/* The row of .h5 tables in a library that is built without HDF5 (GONIO_HDF5=OFF), and so cannot
 * write them. */
#include "../../core/core.h"
#include "writers.h"

static gonio_status write_table(gonio_context *context, const gonio_material *material,
                                const char *path, const gonio_write_options *options)
{
    (void)material;
    (void)options;
    return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                        "%s: this gonio was built without HDF5 (GONIO_HDF5=OFF), which it only "
                        "reads; choose another format",
                        path);
}

const gonio_i_format_writer gonio_i_table_writer = {
    .name = "table",
    .extension = ".h5",
    .summary = "table of any channels, HDF5, which this build cannot write",
    .write = write_table,
};
