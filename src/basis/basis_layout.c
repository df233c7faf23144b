/* The layout of a basis file: see basis_layout.h. */
#include "basis_layout.h"

#include <inttypes.h>
#include <stdio.h>

const char gonio_i_basis_format[] = "gonio basis";
const char gonio_i_basis_format_version[] = "2";

const char *const gonio_i_basis_representations[] = {"bivariate", "full", "sectored", NULL};
const char *const gonio_i_basis_channel_models[] = {"joint", "separate", NULL};
const char *const gonio_i_basis_mappings[] = {"log", "relative", NULL};
const char *const gonio_i_basis_centrings[] = {"mean", "none", NULL};

const gonio_i_basis_grid gonio_i_basis_grids[GONIO_I_BASIS_GRID] = {
    {"theta_h_bins", "90"}, {"theta_d_bins", "90"}, {"phi_d_bins", "180"}};

const gonio_i_basis_array gonio_i_basis_layout[GONIO_I_BASIS_ARRAYS] = {
    [GONIO_I_LOG_SCALE] = {"log_scale", "xxh3.log_scale", GONIO_I_F64, 1, true},
    [GONIO_I_MEAN] = {"mean", "xxh3.mean", GONIO_I_F64, 1, true},
    [GONIO_I_VARIANCES] = {"variances", "xxh3.variances", GONIO_I_F64, 1, true},
    [GONIO_I_MATERIAL_FINGERPRINTS] = {"material_fingerprints", "xxh3.material_fingerprints",
                                       GONIO_I_U64, 1, true},
    [GONIO_I_COMPONENTS] = {"components", "xxh3.components", GONIO_I_F32, 2, true},
    [GONIO_I_CELL] = {"cell", "xxh3.cell", GONIO_I_I32, 1, true},
    [GONIO_I_MATERIAL_NAMES] = {"material_names", "xxh3.material_names", GONIO_I_U8, 1, true},
    [GONIO_I_LOADINGS] = {"loadings", "xxh3.loadings", GONIO_I_F64, 2, false},
    [GONIO_I_MIXTURE_PARENTS] = {"mixture_parents", "xxh3.mixture_parents", GONIO_I_I32, 2, false},
};

void gonio_i_print_hash(uint64_t value, char text[GONIO_I_HASH_ROOM])
{
    snprintf(text, GONIO_I_HASH_ROOM, "%016" PRIx64, value);
}
