/* Where HDF5 datasets keep their elements: see hdf_layout.h. */
#include "hdf_layout.h"

#include "hdf_messages.h"

enum { COMPACT = 0, CONTIGUOUS = 1, CHUNKED = 2 };

static const char not_read[] = "is stored in a way that is not read";
static const char not_stored[] = "is not in the file, or not all of it";

/* ---- chunks ---- */

/* Takes the sizes of chunks, the last of which is that of an element. */
static bool read_chunk_sizes(gonio_i_hdf_cursor *c, size_t width, gonio_i_hdf_set *set)
{
    gonio_i_hdf_layout *layout = &set->layout;
    const uint64_t most = UINT32_MAX;
    uint64_t bytes = set->type.size;
    if (set->space.rank == 0) {
        return false;
    }
    for (int k = 0; k < set->space.rank; k++) {
        const uint64_t size = gonio_i_hdf_number(c, width);
        if (size == 0 || size > most / bytes) {
            return false;
        }
        bytes *= size;
        layout->chunk[k] = (size_t)size;
    }
    layout->chunk_bytes = (size_t)bytes;
    return gonio_i_hdf_number(c, width) == set->type.size && !c->failed;
}

/* Version 3: dimensions and one more, the B-tree, sizes of four bytes. */
static const char *read_tree(gonio_i_hdf_cursor c, gonio_i_hdf_set *set)
{
    const uint64_t dimensions = gonio_i_hdf_number(&c, 1);
    set->layout.tree = gonio_i_hdf_number(&c, 8);
    return dimensions == (uint64_t)set->space.rank + 1 && read_chunk_sizes(&c, 4, set) ? NULL
                                                                                       : not_read;
}

/* Version 4: flags, dimensions and one more, width of sizes, sizes, kind of index. Of these, a
 * single chunk: if it is filtered, its size and mask; its address. */
static const char *read_single(gonio_i_hdf_cursor c, gonio_i_hdf_set *set)
{
    enum { FILTERED = 0x02, SINGLE = 1, MOST_WIDTH = 8 };
    gonio_i_hdf_layout *layout = &set->layout;
    const uint64_t flags = gonio_i_hdf_number(&c, 1);
    const uint64_t dimensions = gonio_i_hdf_number(&c, 1);
    const uint64_t width = gonio_i_hdf_number(&c, 1);
    if (dimensions != (uint64_t)set->space.rank + 1 || width > MOST_WIDTH ||
        !read_chunk_sizes(&c, (size_t)width, set) || gonio_i_hdf_number(&c, 1) != SINGLE) {
        return not_read;
    }
    const bool filtered = (flags & FILTERED) != 0;
    const uint64_t size = filtered ? gonio_i_hdf_number(&c, 8) : layout->chunk_bytes;
    layout->single_mask = filtered ? gonio_i_hdf_number(&c, 4) : UINT64_MAX;
    const uint64_t address = gonio_i_hdf_number(&c, 8);
    layout->tree = GONIO_I_HDF_NOWHERE;
    layout->single = gonio_i_hdf_block(set->file, address, size);
    return c.failed || layout->single.failed ? not_stored : NULL;
}

/* ---- one piece ---- */

static const char *read_whole(gonio_i_hdf_cursor c, uint64_t class, gonio_i_hdf_set *set)
{
    gonio_i_hdf_cursor whole = {.failed = true};
    const uint64_t bytes = (uint64_t)set->space.count * set->type.size;
    if (class == COMPACT) {
        const uint64_t size = gonio_i_hdf_number(&c, 2);
        const unsigned char *at = gonio_i_hdf_take(&c, size);
        whole = (gonio_i_hdf_cursor){.at = at, .left = (size_t)size, .failed = at == NULL};
    } else {
        const uint64_t address = gonio_i_hdf_number(&c, 8);
        whole = gonio_i_hdf_block(set->file, address, gonio_i_hdf_number(&c, 8));
    }
    set->layout.whole = whole;
    return bytes == 0 || (!c.failed && !whole.failed && whole.left >= bytes) ? NULL : not_stored;
}

static const char *read_layout(gonio_i_hdf_object object, gonio_i_hdf_set *set)
{
    gonio_i_hdf_cursor c;
    if (!gonio_i_hdf_message(object, GONIO_I_HDF_LAYOUT, &c)) {
        return "is no dataset";
    }
    const uint64_t version = gonio_i_hdf_number(&c, 1);
    const uint64_t class = gonio_i_hdf_number(&c, 1);
    set->layout.chunked = class == CHUNKED;
    if (c.failed || (version != 3 && version != 4) || class > CHUNKED) {
        return not_read;
    }
    return class != CHUNKED ? read_whole(c, class, set)
           : version == 3   ? read_tree(c, set)
                            : read_single(c, set);
}

/* ---- the rest ---- */

/* Versions 1 and 2: when it is allocated, when it is written, whether it is defined, its size if so
 * (in version 1 always). Version 3: flags, of which one says that size and value follow. */
static void read_unwritten(gonio_i_hdf_object object, gonio_i_hdf_set *set)
{
    enum { GIVEN = 0x20 };
    gonio_i_hdf_cursor c;
    if (!gonio_i_hdf_message(object, GONIO_I_HDF_FILL, &c)) {
        return;
    }
    const uint64_t version = gonio_i_hdf_number(&c, 1);
    gonio_i_hdf_take(&c, version < 3 ? 2 : 0);
    const uint64_t flags = gonio_i_hdf_number(&c, 1);
    const bool given = version < 3 ? flags != 0 : (flags & GIVEN) != 0;
    const uint64_t size = given ? gonio_i_hdf_number(&c, 4) : 0;
    const unsigned char *value = gonio_i_hdf_take(&c, size);
    set->unwritten = size == set->type.size ? value : NULL;
}

static const char *read_set_filters(gonio_i_hdf_object object, gonio_i_hdf_set *set)
{
    gonio_i_hdf_cursor c;
    const bool known = !gonio_i_hdf_message(object, GONIO_I_HDF_FILTERS, &c) ||
                       gonio_i_hdf_read_filters(c, &set->layout.filters);
    return known ? NULL : not_read;
}

const char *gonio_i_hdf_read_set(gonio_i_hdf_object object, gonio_i_hdf_set *set)
{
    gonio_i_hdf_cursor body;
    *set = (gonio_i_hdf_set){.file = object.file};
    if (!gonio_i_hdf_message(object, GONIO_I_HDF_TYPE, &body) ||
        !gonio_i_hdf_read_type(body, &set->type)) {
        return "has a type that is not read";
    }
    if (!gonio_i_hdf_message(object, GONIO_I_HDF_SPACE, &body) ||
        !gonio_i_hdf_read_space(body, &set->space)) {
        return "has a wrong shape";
    }
    if (gonio_i_hdf_message(object, GONIO_I_HDF_EXTERNAL, &body)) {
        return not_stored;
    }
    const char *problem = read_set_filters(object, set);
    read_unwritten(object, set);
    return problem != NULL ? problem : read_layout(object, set);
}
