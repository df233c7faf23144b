/* The stored bytes of HDF5 datasets: see hdf_chunks.h. */
#include "hdf_chunks.h"

#include <stdlib.h>

static const char damaged[] = "cannot be read (file damaged or truncated)";
static const char no_memory[] = "is too large for the memory";

/* ---- the B-tree of chunks ---- */

/* A chunk as the tree tells of it. */
typedef struct stored_chunk {
    uint64_t size, mask, address;
    uint64_t start[GONIO_I_HDF_RANK];
} stored_chunk;

/* A walk over the chunks; `take` returns NULL, or what is wrong. */
typedef struct walk {
    const gonio_i_hdf_set *set;
    size_t steps; /* that are left: no file has more chunks and nodes than bytes */
    const char *(*take)(struct walk *walk, const stored_chunk *chunk);
    uint64_t bytes; /* of chunks, stored */
    size_t chunks;  /* that may still come: more lie on top of others */
    unsigned char *chunk, *other;
    gonio_i_hdf_stored_run *run;
    void *user;
} walk;

/* A key: size of the chunk, filters that were left out, first element and a zero. */
static stored_chunk read_key(gonio_i_hdf_cursor *c, int rank)
{
    stored_chunk chunk = {.size = gonio_i_hdf_number(c, 4)};
    chunk.mask = gonio_i_hdf_number(c, 4);
    for (int k = 0; k < rank; k++) {
        chunk.start[k] = gonio_i_hdf_number(c, 8);
    }
    gonio_i_hdf_take(c, 8);
    chunk.address = gonio_i_hdf_number(c, 8);
    return chunk;
}

/* A node: TREE, 1 for chunks, level, count, two siblings; keys between children. */
static const char *walk_node(walk *w, uint64_t address, uint64_t level)
{
    gonio_i_hdf_cursor c = gonio_i_hdf_from(w->set->file, address);
    gonio_i_hdf_expect(&c, "TREE");
    const bool good = gonio_i_hdf_number(&c, 1) == 1 && gonio_i_hdf_number(&c, 1) == level;
    uint64_t count = gonio_i_hdf_number(&c, 2);
    gonio_i_hdf_take(&c, 16);
    const char *problem = good && !c.failed ? NULL : damaged;
    for (; count > 0 && problem == NULL; count--) {
        const stored_chunk child = read_key(&c, w->set->space.rank);
        if (c.failed || w->steps == 0) {
            return damaged;
        }
        w->steps--;
        problem = level > 0 ? walk_node(w, child.address, level - 1) : w->take(w, &child);
    }
    return problem;
}

static const char *walk_tree(walk *w)
{
    enum { MOST_LEVELS = 16 };
    const uint64_t tree = w->set->layout.tree;
    if (tree == GONIO_I_HDF_NOWHERE) {
        return NULL;
    }
    gonio_i_hdf_cursor c = gonio_i_hdf_from(w->set->file, tree);
    gonio_i_hdf_take(&c, 5);
    const uint64_t level = gonio_i_hdf_number(&c, 1);
    w->steps = w->set->file->size;
    return c.failed || level > MOST_LEVELS ? damaged : walk_node(w, tree, level);
}

/* ---- whether they hold it all ---- */

static uint64_t least_size(const gonio_i_hdf_layout *layout)
{
    return layout->filters.count > 0 ? layout->chunk_bytes / GONIO_I_HDF_MOST_DEFLATION
                                     : layout->chunk_bytes;
}

static const char *add_size(walk *w, const stored_chunk *chunk)
{
    const bool inside = !gonio_i_hdf_block(w->set->file, chunk->address, chunk->size).failed;
    w->bytes += chunk->size;
    return inside && chunk->size >= least_size(&w->set->layout) ? NULL : damaged;
}

static size_t chunk_places(const gonio_i_hdf_set *set)
{
    size_t places = 1;
    for (int k = 0; k < set->space.rank; k++) {
        places *= (set->space.extent[k] + set->layout.chunk[k] - 1) / set->layout.chunk[k];
    }
    return places;
}

/* Tables compress to a half or so, and constant ones to a thousandth. A file that grows more than a
 * hundredfold, beyond what costs little, was made to fill the memory or to take for ever. */
static bool is_moderate(const gonio_i_hdf_set *set, size_t width)
{
    const double most_free = 512.0 * 1048576.0;
    const double most_compression = 100.0;
    const double most = most_free + most_compression * (double)set->file->size;
    const double chunk = (double)set->layout.chunk_bytes;
    return (double)set->space.count * (double)width <= most && chunk <= most / 4.0 &&
           chunk * (double)chunk_places(set) <= most;
}

/* Whether no chunk is larger than filters allow, and there are enough of them. */
static bool is_stored(const gonio_i_hdf_set *set)
{
    walk w = {.set = set, .take = add_size};
    const double bytes = (double)set->space.count * (double)set->type.size;
    w.bytes = set->layout.single.left;
    const bool good = set->layout.tree != GONIO_I_HDF_NOWHERE ? walk_tree(&w) == NULL
                                                              : w.bytes >= least_size(&set->layout);
    const double stored = (double)(w.bytes < set->file->size ? w.bytes : set->file->size);
    return good && w.bytes > 0 && bytes <= stored * GONIO_I_HDF_MOST_DEFLATION;
}

const char *gonio_i_hdf_lacks(const gonio_i_hdf_set *set, size_t width)
{
    if (!set->layout.chunked || set->space.count == 0) {
        return NULL; /* as was checked with the layout */
    }
    return !is_stored(set)            ? "is not in the file, or not all of it"
           : !is_moderate(set, width) ? "is far larger than its file (made to fill the memory?)"
                                      : NULL;
}

/* ---- elements of a chunk ---- */

/* Rows of a chunk that are in the dataset, along the last dimension. */
static void run_over_chunk(const walk *w, const uint64_t *start)
{
    const gonio_i_hdf_space *space = &w->set->space;
    const size_t *sizes = w->set->layout.chunk;
    const int last = space->rank - 1;
    const size_t left = space->extent[last] - (size_t)start[last];
    const size_t count = sizes[last] < left ? sizes[last] : left;
    const size_t rows = w->set->layout.chunk_bytes / w->set->type.size / sizes[last];
    size_t at[GONIO_I_HDF_RANK] = {0};
    for (size_t row = 0; row < rows; row++) {
        bool inside = true;
        size_t first = 0;
        for (int k = 0; k <= last; k++) {
            inside = inside && start[k] + at[k] < space->extent[k];
            first = first * space->extent[k] + (size_t)start[k] + at[k];
        }
        if (inside) {
            w->run(w->user, first, count, w->chunk + row * sizes[last] * w->set->type.size);
        }
        for (int k = last - 1; k >= 0 && ++at[k] == sizes[k]; k--) {
            at[k] = 0;
        }
    }
}

static bool is_in_place(const gonio_i_hdf_set *set, const uint64_t *start)
{
    bool good = true;
    for (int k = 0; k < set->space.rank; k++) {
        good = good && start[k] < set->space.extent[k] && start[k] % set->layout.chunk[k] == 0;
    }
    return good;
}

static const char *run_over_stored(walk *w, gonio_i_hdf_cursor stored, uint64_t mask,
                                   const uint64_t *start)
{
    const gonio_i_hdf_layout *layout = &w->set->layout;
    if (w->chunks == 0 || !is_in_place(w->set, start) ||
        !gonio_i_hdf_undo_filters(&layout->filters, mask, stored, layout->chunk_bytes, w->chunk,
                                  w->other)) {
        return damaged;
    }
    w->chunks--;
    run_over_chunk(w, start);
    return NULL;
}

static const char *take_chunk(walk *w, const stored_chunk *chunk)
{
    const gonio_i_hdf_cursor stored = gonio_i_hdf_block(w->set->file, chunk->address, chunk->size);
    return run_over_stored(w, stored, chunk->mask, chunk->start);
}

static const char *visit_chunks(const gonio_i_hdf_set *set, gonio_i_hdf_stored_run *run, void *user)
{
    const size_t room = set->layout.chunk_bytes + GONIO_I_HDF_SPARE;
    const uint64_t start[GONIO_I_HDF_RANK] = {0};
    walk w = {.set = set, .take = take_chunk, .run = run, .user = user};
    w.chunks = chunk_places(set);
    w.chunk = malloc(room);
    w.other = malloc(room);
    const char *problem = w.chunk == NULL || w.other == NULL ? no_memory : NULL;
    if (problem == NULL) {
        problem = set->layout.tree != GONIO_I_HDF_NOWHERE
                      ? walk_tree(&w)
                      : run_over_stored(&w, set->layout.single, set->layout.single_mask, start);
    }
    free(w.chunk);
    free(w.other);
    return problem;
}

const char *gonio_i_hdf_visit_stored(const gonio_i_hdf_set *set, gonio_i_hdf_stored_run *run,
                                     void *user)
{
    if (set->space.count == 0) {
        return NULL;
    }
    const char *problem = gonio_i_hdf_lacks(set, set->type.size);
    if (problem != NULL) {
        return problem;
    }
    if (set->layout.chunked) {
        return visit_chunks(set, run, user);
    }
    run(user, 0, set->space.count, set->layout.whole.at);
    return NULL;
}
