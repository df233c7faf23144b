/* The layout of a basis file: the names, types and checksums of its arrays, and the words of its
 * metadata. docs/basis-file.md describes it. */
#ifndef GONIO_BASIS_LAYOUT_H
#define GONIO_BASIS_LAYOUT_H

#include <stdbool.h>
#include <stdint.h>

#include "../core/safetensors.h"

/* The metadata "format" and "format_version". */
extern const char gonio_i_basis_format[];
extern const char gonio_i_basis_format_version[];

/* Words for the values of an enumeration, from 0 on; NULL past the last. */
extern const char *const gonio_i_basis_representations[];
extern const char *const gonio_i_basis_channel_models[];
extern const char *const gonio_i_basis_mappings[];
extern const char *const gonio_i_basis_centrings[];

/* The arrays of a file. */
enum {
    GONIO_I_LOG_SCALE,
    GONIO_I_MEAN,
    GONIO_I_VARIANCES,
    GONIO_I_MATERIAL_FINGERPRINTS,
    GONIO_I_COMPONENTS,
    GONIO_I_CELL,
    GONIO_I_MATERIAL_NAMES,
    GONIO_I_LOADINGS,
    GONIO_I_MIXTURE_PARENTS,
    GONIO_I_BASIS_ARRAYS
};

typedef struct gonio_i_basis_array {
    const char *name;
    const char *checksum; /* the key of its hash */
    gonio_i_array_type type;
    int rank;
    bool needed;
} gonio_i_basis_array;

extern const gonio_i_basis_array gonio_i_basis_layout[GONIO_I_BASIS_ARRAYS];

/* The grid that this program works on. */
enum { GONIO_I_BASIS_GRID = 3 };

typedef struct gonio_i_basis_grid {
    const char *key;
    const char *bins;
} gonio_i_basis_grid;

extern const gonio_i_basis_grid gonio_i_basis_grids[GONIO_I_BASIS_GRID];

/* A hash as the metadata has it: 16 hexadecimal digits. */
enum { GONIO_I_HASH_ROOM = 17 };
void gonio_i_print_hash(uint64_t value, char text[GONIO_I_HASH_ROOM]);

#endif
