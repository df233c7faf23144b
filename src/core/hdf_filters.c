/* The filters of HDF5, undone: see hdf_filters.h. */
#include "hdf_filters.h"

#include <string.h>
#include <zlib.h>

enum { DEFLATE = 1, SHUFFLE = 2, CHECKSUM = 3, OWN_FILTERS = 256, CHECKSUM_SIZE = 4 };

/* A filter: id, perhaps the length of its name, flags, count of parameters; name, parameters. In
 * version 1 every filter has a name, padded to eight bytes, and parameters are even in number. */
static bool read_filter(gonio_i_hdf_cursor *c, uint64_t version, gonio_i_hdf_filters *f)
{
    const uint64_t id = gonio_i_hdf_number(c, 2);
    const uint64_t name = version == 1 || id >= OWN_FILTERS ? gonio_i_hdf_number(c, 2) : 0;
    gonio_i_hdf_take(c, 2);
    const uint64_t parameters = gonio_i_hdf_number(c, 2);
    gonio_i_hdf_take(c, version == 1 ? (name + 7) / 8 * 8 : name);
    const uint64_t first = parameters > 0 ? gonio_i_hdf_number(c, 4) : 0;
    gonio_i_hdf_take(c, parameters > 0 ? 4 * (parameters - 1) : 0);
    gonio_i_hdf_take(c, version == 1 && parameters % 2 == 1 ? 4 : 0);
    f->id[f->count] = (uint16_t)id;
    f->element[f->count++] = (size_t)first;
    return !c->failed && (id == DEFLATE || id == CHECKSUM || (id == SHUFFLE && first > 0));
}

bool gonio_i_hdf_read_filters(gonio_i_hdf_cursor body, gonio_i_hdf_filters *filters)
{
    const uint64_t version = gonio_i_hdf_number(&body, 1);
    const uint64_t count = gonio_i_hdf_number(&body, 1);
    *filters = (gonio_i_hdf_filters){.count = 0};
    bool known = (version == 1 || version == 2) && count <= GONIO_I_HDF_MOST_FILTERS;
    gonio_i_hdf_take(&body, version == 1 ? 6 : 0);
    for (uint64_t k = 0; k < count && known; k++) {
        known = read_filter(&body, version, filters);
    }
    return known;
}

/* ---- undoing ---- */

static bool inflate_bytes(gonio_i_hdf_cursor *bytes, unsigned char *to, size_t room)
{
    uLongf length = room;
    if (uncompress(to, &length, bytes->at, bytes->left) != Z_OK) {
        return false;
    }
    *bytes = (gonio_i_hdf_cursor){.at = to, .left = length};
    return true;
}

/* All first bytes of elements were put first, then all second bytes, and so on. */
static bool unshuffle(gonio_i_hdf_cursor *bytes, size_t element, unsigned char *to, size_t room)
{
    const size_t count = bytes->left / element;
    const size_t whole = count * element;
    if (bytes->left > room) {
        return false;
    }
    for (size_t b = 0; b < element && count > 0; b++) {
        const unsigned char *from = bytes->at + b * count;
        for (size_t k = 0; k < count; k++) {
            to[k * element + b] = from[k];
        }
    }
    memcpy(to + whole, bytes->at + whole, bytes->left - whole);
    bytes->at = to;
    return true;
}

static bool undo(const gonio_i_hdf_filters *f, int k, gonio_i_hdf_cursor *bytes, unsigned char *to,
                 size_t room)
{
    if (f->id[k] == CHECKSUM) {
        const bool there = bytes->left >= CHECKSUM_SIZE;
        bytes->left -= there ? CHECKSUM_SIZE : 0;
        return there;
    }
    return f->id[k] == DEFLATE ? inflate_bytes(bytes, to, room)
                               : unshuffle(bytes, f->element[k], to, room);
}

bool gonio_i_hdf_undo_filters(const gonio_i_hdf_filters *filters, uint64_t mask,
                              gonio_i_hdf_cursor stored, size_t size, unsigned char *chunk,
                              unsigned char *other)
{
    bool done = !stored.failed;
    for (int k = filters->count - 1; k >= 0 && done; k--) {
        if ((mask >> k & 1U) == 0) {
            unsigned char *to = stored.at == chunk ? other : chunk;
            done = undo(filters, k, &stored, to, size + GONIO_I_HDF_SPARE);
        }
    }
    if (!done || stored.left != size) {
        return false;
    }
    if (stored.at != chunk) {
        memcpy(chunk, stored.at, size);
    }
    return true;
}
