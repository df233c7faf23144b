/* Elongation: see elongation.h. */
#include "elongation.h"

#include <math.h>

#include "../direction/grid.h"

static double cosine_of_twice(gonio_angles direction)
{
    return cos(2.0 * direction.phi);
}

void gonio_i_elongation_of_cells(const gonio_basis *basis, double *across)
{
    const bool has_azimuths = gonio_i_phi_cells(basis->representation) > 1;
    for (size_t k = 0; k < basis->cells; k++) {
        const gonio_bin bin = gonio_cell_bin(basis->representation, basis->cell[k]);
        const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
        across[k] = has_azimuths
                        ? -0.25 * (cosine_of_twice(pair.incident) + cosine_of_twice(pair.outgoing))
                        : 0.0;
    }
}

/* Where the value of a cell comes from: two positions, and the share of the second. */
typedef struct source {
    size_t low;
    size_t high;
    double share;
} source;

static source find_source(const gonio_basis *basis, size_t position, double log_width)
{
    const int32_t phi_cells = gonio_i_phi_cells(basis->representation);
    gonio_i_cell_indices at = gonio_i_indices_of_cell(phi_cells, basis->cell[position]);
    /* theta_h is spaced by a square root */
    const gonio_i_between between =
        gonio_i_between_bins((at.theta_h + 0.5) * exp(-0.5 * log_width) - 0.5, GONIO_THETA_H_BINS);
    at.theta_h = between.low;
    const int32_t low = gonio_i_cell_at(phi_cells, at);
    at.theta_h++;
    const int32_t high = gonio_i_cell_at(phi_cells, at);
    return (source){(size_t)basis->position[low], (size_t)basis->position[high], between.share};
}

void gonio_i_elongate(const gonio_basis *basis, const double *across, double log_ratio,
                      const float *columns, float *elongated)
{
    const size_t each = gonio_i_rows_per_cell(basis->channels);
    const size_t count = gonio_i_columns_per_material(basis->channels);
    for (size_t k = 0; k < basis->cells; k++) {
        const source from = find_source(basis, k, log_ratio * across[k]);
        for (size_t j = 0; j < count * each; j++) {
            const float *column = columns + j / each * basis->rows + j % each;
            const double low = column[from.low * each];
            const double high = column[from.high * each];
            elongated[j / each * basis->rows + k * each + j % each] =
                (float)(low + from.share * (high - low));
        }
    }
}
