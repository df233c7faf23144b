/* Representations and channel models: their names, cells, bins and directions (layout.h). */
#include "layout.h"

#include <math.h>
#include <string.h>

/* The representations, by gonio_representation. */
static const struct {
    const char *name;
    int phi_bins; /* of a cell */
    int middle;   /* the bin that represents the cell */
    /* Weights of interpolation between these bins; returns the number of bins. */
    int (*interpolate)(gonio_half_difference at, gonio_i_stencil *stencil);
} representations[] = {
    [GONIO_BIVARIATE] = {"bivariate", GONIO_PHI_D_BINS, 0, gonio_i_bilinear},
    [GONIO_FULL] = {"full", 1, 0, gonio_i_trilinear},
    [GONIO_SECTORED] = {"sectored", GONIO_SECTOR_BINS, GONIO_SECTOR_BINS / 2,
                        gonio_i_trilinear_sectors},
};

static const char *const channel_models[] = {
    [GONIO_JOINT] = "joint", [GONIO_SEPARATE] = "separate"};

enum {
    REPRESENTATIONS = sizeof representations / sizeof *representations,
    CHANNEL_MODELS = sizeof channel_models / sizeof *channel_models
};

/* ---- names ---- */

const char *gonio_representation_name(gonio_representation representation)
{
    const size_t k = (size_t)representation;
    return k < REPRESENTATIONS ? representations[k].name : NULL;
}

const char *gonio_channel_model_name(gonio_channel_model channels)
{
    const size_t k = (size_t)channels;
    return k < CHANNEL_MODELS ? channel_models[k] : NULL;
}

bool gonio_representation_parse(const char *name, gonio_representation *representation)
{
    for (int k = 0; k < REPRESENTATIONS; k++) {
        if (strcmp(name, representations[k].name) == 0) {
            *representation = (gonio_representation)k;
            return true;
        }
    }
    return false;
}

bool gonio_channel_model_parse(const char *name, gonio_channel_model *channels)
{
    for (int k = 0; k < CHANNEL_MODELS; k++) {
        if (strcmp(name, channel_models[k]) == 0) {
            *channels = (gonio_channel_model)k;
            return true;
        }
    }
    return false;
}

/* ---- cells and bins ---- */

int gonio_i_phi_bins(gonio_representation representation)
{
    return representations[representation].phi_bins;
}

int gonio_i_phi_cells(gonio_representation representation)
{
    return GONIO_PHI_D_BINS / gonio_i_phi_bins(representation);
}

int32_t gonio_grid_cells(gonio_representation representation)
{
    return gonio_representation_name(representation) != NULL
               ? GONIO_BINS / gonio_i_phi_bins(representation)
               : 0;
}

gonio_i_bin_run gonio_i_cell_bins(gonio_representation representation, int32_t cell)
{
    const int count = gonio_i_phi_bins(representation);
    return (gonio_i_bin_run){gonio_bin_from_index(cell * count), count};
}

gonio_bin gonio_cell_bin(gonio_representation representation, int32_t cell)
{
    if (cell < 0 || cell >= gonio_grid_cells(representation)) {
        return (gonio_bin){-1, -1, -1};
    }
    gonio_bin bin = gonio_i_cell_bins(representation, cell).first;
    bin.phi_d += representations[representation].middle;
    return bin;
}

int32_t gonio_cell_of_bin(gonio_representation representation, gonio_bin bin)
{
    const bool held = gonio_i_is_bin(bin) && gonio_representation_name(representation) != NULL;
    return held ? gonio_bin_index(bin) / gonio_i_phi_bins(representation) : -1;
}

gonio_i_bin_run gonio_i_valid_bins(gonio_i_bin_run run, int first_valid)
{
    const int last_valid = GONIO_PHI_D_BINS - first_valid;
    const int first = run.first.phi_d > first_valid ? run.first.phi_d : first_valid;
    const int end = run.first.phi_d + run.count;
    const int last = end < last_valid ? end : last_valid;
    run.first.phi_d = first;
    run.count = last > first ? last - first : 0;
    return run;
}

int gonio_i_valid_bin_count(gonio_representation representation, int32_t cell)
{
    const gonio_i_bin_run all = gonio_i_cell_bins(representation, cell);
    return gonio_i_valid_bins(all, gonio_i_first_valid_phi(all.first.theta_h, all.first.theta_d))
        .count;
}

/* ---- directions ---- */

gonio_half_difference gonio_i_cell_direction(gonio_representation representation, int32_t cell,
                                             double phi_d)
{
    const gonio_bin bin = gonio_cell_bin(representation, cell);
    const int first = gonio_i_first_valid_phi(bin.theta_h, bin.theta_d);
    const double low = (first + 0.5) * M_PI / GONIO_PHI_D_BINS;
    gonio_half_difference at = gonio_bin_centre(bin);
    at.phi_d = gonio_i_phi_cells(representation) == 1 ? phi_d : at.phi_d;
    if (first > 0) {
        at.phi_d = fmin(fmax(at.phi_d, low), fmax(M_PI - low, low));
    }
    return at;
}

int gonio_i_cells_around(gonio_representation representation, gonio_half_difference at,
                         gonio_i_cell_weight around[GONIO_I_MOST_POINTS])
{
    gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
    const int points = representations[representation].interpolate(at, stencil);
    for (int k = 0; k < points; k++) {
        around[k] = (gonio_i_cell_weight){gonio_cell_of_bin(representation, stencil[k].bin),
                                          stencil[k].weight};
    }
    return points;
}
