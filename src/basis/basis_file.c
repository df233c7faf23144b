/* Which files are bases, and the conversion of those of an older gonio. */
#include "basis.h"

#include <string.h>

#include "basis_layout.h"

bool gonio_i_basis_is_hdf5(const gonio_i_file *file)
{
    return gonio_i_file_begins(file, "\x89HDF\r\n\x1a\n", 8);
}

bool gonio_i_basis_is_marked(const gonio_i_file *file)
{
    return memmem(file->head, file->head_size, gonio_i_basis_format,
                  strlen(gonio_i_basis_format)) != NULL;
}

bool gonio_i_basis_may_be(const gonio_i_file *file)
{
    return gonio_i_basis_is_hdf5(file) || gonio_i_safetensors_begin(file->head, file->head_size);
}

const char *gonio_i_basis_format_of(const gonio_i_file *file)
{
    const bool basis = gonio_i_basis_may_be(file) && gonio_i_basis_is_marked(file);
    return !basis                        ? NULL
           : gonio_i_basis_is_hdf5(file) ? "gonio basis of an older gonio, HDF5"
                                         : gonio_i_basis_format;
}

const char *gonio_i_basis_format_name(int index)
{
    return index == 0 ? gonio_i_basis_format : NULL; /* older ones are converted, not read */
}

gonio_status gonio_basis_convert(gonio_context *context, const char *input, const char *output)
{
    gonio_basis *basis = NULL;
    gonio_i_file head;
    gonio_status status = gonio_i_file_look(context, input, &head);
    if (status == GONIO_OK && !gonio_i_basis_is_hdf5(&head)) {
        status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                              "%s: a basis (%s), not a material; only bases of older gonios (HDF5) "
                              "are converted",
                              input, gonio_i_basis_format);
    }
    if (status == GONIO_OK) {
        status = gonio_i_basis_read_hdf5(context, input, &basis);
    }
    if (status == GONIO_OK) {
        status = gonio_basis_write(context, basis, basis->command, output);
    }
    gonio_basis_free(&basis);
    return status;
}
