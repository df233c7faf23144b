/* Cells of the grid in each representation: see database.h. */
#include <gonio/database.h>

/* phi_d bins that share a cell. */
static int depth(gonio_representation representation)
{
    static const int bins[] = {[GONIO_BIVARIATE] = GONIO_PHI_D_BINS,
                               [GONIO_FULL] = 1,
                               [GONIO_SECTORED] = GONIO_SECTOR_BINS};
    return bins[representation];
}

int32_t gonio_grid_cells(gonio_representation representation)
{
    return GONIO_BINS / depth(representation);
}

gonio_bin gonio_cell_bin(gonio_representation representation, int32_t cell)
{
    const int middle = representation == GONIO_BIVARIATE ? 0 : depth(representation) / 2;
    return gonio_bin_from_index(cell * depth(representation) + middle);
}

int32_t gonio_cell_of_bin(gonio_representation representation, gonio_bin bin)
{
    return gonio_bin_index(bin) / depth(representation);
}
