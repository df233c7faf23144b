/* Reconstructions as materials: values made slab by slab when asked for. */
#include <gonio/reconstruct.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../core/vector_math.h"
#include "../direction/grid.h"

typedef struct reconstructed {
    const gonio_basis *basis;
    gonio_basis_view view;
    size_t components;
    size_t columns;
    double coefficients[]; /* [columns][components] */
} reconstructed;

/* g = m + V c at a cell of the basis. */
static double log_value(const reconstructed *r, size_t position, size_t channel)
{
    const bool joint = r->columns == 1;
    const size_t row = joint ? GONIO_CHANNELS * position + channel : position;
    const double *v = r->view.vectors + row * r->view.components;
    const double *c = r->coefficients + (joint ? 0 : channel * r->components);
    double g = r->view.mean[row];
    for (size_t k = 0; k < r->components; k++) {
        g += v[k] * c[k];
    }
    return g;
}

/* Fills one cell's phi_d bins of a channel with g, or each bin of a full basis. */
static void fill_row(const reconstructed *r, int theta_h, int theta_d, size_t channel, double *row)
{
    const int32_t cell = theta_d + GONIO_THETA_D_BINS * theta_h;
    if (r->view.representation == GONIO_BIVARIATE) {
        const double g = log_value(r, gonio_basis_position(r->basis, cell), channel);
        for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
            row[p] = g;
        }
        return;
    }
    for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
        row[p] = log_value(r, gonio_basis_position(r->basis, cell * GONIO_PHI_D_BINS + p), channel);
    }
}

/* rho = s (e^g - 1), clamped at 0, in place. A g beyond the range of numbers stays finite. */
static void to_brdf(size_t n, double *g, int channel)
{
    const double largest = 600.0;
    const double scale = gonio_log_scale(channel);
    for (size_t k = 0; k < n; k++) {
        g[k] = fmin(fmax(g[k], 0.0), largest);
    }
    gonio_i_expm1(n, g, g);
    for (size_t k = 0; k < n; k++) {
        g[k] *= scale;
    }
}

static void clear_invalid(int theta_h, int theta_d, double *row)
{
    const int first = gonio_i_first_valid_phi(theta_h, theta_d);
    for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
        if (p < first || p >= GONIO_PHI_D_BINS - first) {
            row[p] = -1.0;
        }
    }
}

static gonio_status read_reconstructed(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)context;
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            double *row = rho + channel * GONIO_SLAB_BINS + (size_t)theta_d * GONIO_PHI_D_BINS;
            fill_row(self, theta_h, theta_d, channel, row);
            to_brdf(GONIO_PHI_D_BINS, row, (int)channel);
            clear_invalid(theta_h, theta_d, row);
        }
    }
    return GONIO_OK;
}

gonio_status gonio_reconstruction_material(gonio_context *context, const gonio_basis *basis,
                                           const gonio_reconstruction *reconstruction,
                                           const char *name, gonio_material **material)
{
    const size_t count = reconstruction->columns * reconstruction->components;
    reconstructed *r = gonio_i_allocate(context, 1, sizeof *r + count * sizeof(double));
    if (r == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    r->basis = basis;
    r->view = gonio_basis_describe(basis);
    r->components = reconstruction->components;
    r->columns = reconstruction->columns;
    memcpy(r->coefficients, reconstruction->coefficients, count * sizeof(double));
    const gonio_material_source source = {read_reconstructed, free, r};
    const gonio_status status =
        gonio_material_create(context, name, "reconstruction", source, material);
    if (status != GONIO_OK) {
        free(r);
    }
    return status;
}

/* ---- the bivariate average of a material ---- */

static gonio_status read_average(void *self, gonio_context *context, int theta_h, double *rho)
{
    bool *data = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof *data);
    if (data == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_material *const *original = self;
    const gonio_status status = gonio_material_read_slab(*original, context, theta_h, rho);
    if (status == GONIO_OK) {
        gonio_slab_statistics statistics;
        gonio_slab_mask(theta_h, rho, data);
        gonio_slab_to_log(rho, rho);
        gonio_slab_reduce(rho, data, &statistics);
        for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
            const size_t channel = k / GONIO_SLAB_BINS;
            const size_t theta_d = k % GONIO_SLAB_BINS / GONIO_PHI_D_BINS;
            rho[k] = data[k % GONIO_SLAB_BINS] ? statistics.mean[theta_d][channel] : 0.0;
        }
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            to_brdf(GONIO_SLAB_BINS, rho + (size_t)channel * GONIO_SLAB_BINS, channel);
        }
        for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
            rho[k] = data[k % GONIO_SLAB_BINS] ? rho[k] : -1.0;
        }
    }
    free(data);
    return status;
}

gonio_status gonio_bivariate_material(gonio_context *context, const gonio_material *original,
                                      gonio_material **material)
{
    const gonio_material **self = gonio_i_allocate(context, 1, sizeof *self);
    if (self == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *self = original;
    const gonio_material_source source = {read_average, free, self};
    const gonio_status status = gonio_material_create(context, gonio_material_name(original),
                                                      "bivariate average", source, material);
    if (status != GONIO_OK) {
        free(self);
    }
    return status;
}
