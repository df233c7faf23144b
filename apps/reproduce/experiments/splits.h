/* Splits of the materials: some to learn a basis from, others to test on. */
#ifndef GONIO_REPRODUCE_SPLITS_H
#define GONIO_REPRODUCE_SPLITS_H

#include <jansson.h>

#include "collection.h"

typedef struct gonio_i_split {
    size_t basis_count, test_count;
    size_t *basis; /* [basis_count]: materials of the collection */
    size_t *test;
} gonio_i_split;

typedef struct gonio_i_splits {
    size_t count;
    gonio_i_split *split;
} gonio_i_splits;

enum { GONIO_I_LEAST_BASIS = 3 };

/* Makes random splits, 80 per cent to learn from. Errors: _ARGUMENT for fewer than 4 materials;
 * _MEMORY. The splits are to be freed in any case; so below. */
gonio_status gonio_i_splits_make(gonio_context *context, const gonio_i_collection *collection,
                                 size_t count, uint64_t seed, gonio_i_splits *splits);

/* Reads the splits of a file (reproduce.h). Errors: _IO, _FORMAT; _DATA for materials that are
 * unknown or named twice, and for fewer than 3 to learn from or none to test on; _MEMORY. */
gonio_status gonio_i_splits_read(gonio_context *context, const gonio_i_collection *collection,
                                 const char *path, gonio_i_splits *splits);

void gonio_i_splits_free(gonio_i_splits *splits);

/* The splits in the form of that file. */
json_t *gonio_i_splits_json(const gonio_i_collection *collection, const gonio_i_splits *splits);

#endif
