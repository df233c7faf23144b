/* The bytes of an HDF5 file: see hdf_bytes.h. */
#include "hdf_bytes.h"

#include <string.h>

static const gonio_i_hdf_cursor nothing = {.failed = true};

gonio_i_hdf_cursor gonio_i_hdf_block(const gonio_i_hdf_file *file, uint64_t address, uint64_t size)
{
    if (address > file->size || size > file->size - address) {
        return nothing;
    }
    return (gonio_i_hdf_cursor){.at = file->bytes + address, .left = (size_t)size};
}

gonio_i_hdf_cursor gonio_i_hdf_from(const gonio_i_hdf_file *file, uint64_t address)
{
    return address > file->size ? nothing : gonio_i_hdf_block(file, address, file->size - address);
}

const unsigned char *gonio_i_hdf_take(gonio_i_hdf_cursor *cursor, uint64_t size)
{
    if (cursor->failed || size > cursor->left) {
        *cursor = nothing;
        return NULL;
    }
    const unsigned char *taken = cursor->at;
    cursor->at += size;
    cursor->left -= (size_t)size;
    return taken;
}

uint64_t gonio_i_hdf_number(gonio_i_hdf_cursor *cursor, size_t size)
{
    const unsigned char *bytes = gonio_i_hdf_take(cursor, size);
    uint64_t number = 0;
    for (size_t k = size; bytes != NULL && k > 0; k--) {
        number = number << 8 | bytes[k - 1];
    }
    return number;
}

bool gonio_i_hdf_expect(gonio_i_hdf_cursor *cursor, const char *signature)
{
    const unsigned char *bytes = gonio_i_hdf_take(cursor, 4);
    if (bytes == NULL || memcmp(bytes, signature, 4) != 0) {
        *cursor = nothing;
    }
    return !cursor->failed;
}
