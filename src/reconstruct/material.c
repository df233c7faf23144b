/* Reconstructions as materials: values are computed slab by slab on demand. */
#include <gonio/reconstruct.h>

#include <stdlib.h>
#include <string.h>

#include "../basis/basis.h"
#include "../core/vector_math.h"
#include "../database/layout.h"
#include "field.h"

typedef struct reconstructed {
    const gonio_basis *basis;
    const gonio_basis_view *view;
    size_t components;
    size_t columns;
    double coefficients[]; /* [columns][components] */
} reconstructed;

/* g = m + V c at a cell of the basis. */
static double log_value(const reconstructed *r, int32_t cell, size_t channel)
{
    const bool joint = r->columns == 1;
    const size_t position = gonio_basis_position(r->basis, cell);
    const size_t row = gonio_i_row_of(r->view->channels, position, (int)channel);
    const double *c = r->coefficients + (joint ? 0 : channel * r->components);
    return r->view->mean[row] + gonio_i_basis_dot(r->basis, row, c, r->components);
}

/* g clamped between 0 and a number whose exponential is finite; 0 for NaN. */
GONIO_I_VECTORISED static void clamp(size_t n, double *g)
{
    const double largest = 600.0;
    for (size_t k = 0; k < n; k++) {
        const double positive = g[k] > 0.0 ? g[k] : 0.0;
        g[k] = positive < largest ? positive : largest;
    }
}

/* scale (e^g - 1), clamped at 0, in place. A g beyond the range of numbers stays finite. */
static void exponentiate(size_t n, double *g, double scale)
{
    clamp(n, g);
    gonio_i_expm1(n, g, g);
    for (size_t k = 0; k < n; k++) {
        g[k] *= scale;
    }
}

/* s of a channel; 1 if each bin has a scale of its own, which is applied later. */
static double scale_of(const reconstructed *r, int channel)
{
    return r->view->mapping == GONIO_LOG ? gonio_log_scale(channel) : 1.0;
}

/* Sets the bins first .. last - 1 of a row. */
static void fill(double *row, int first, int last, double value)
{
    for (int p = first; p < last; p++) {
        row[p] = value;
    }
}

static double *row_of(double *rho, int channel, int theta_d)
{
    return rho + (size_t)channel * GONIO_SLAB_BINS + (size_t)theta_d * GONIO_PHI_D_BINS;
}

/* Sets all valid bins of each cell to the cell's value. */
static void fill_cells(const reconstructed *r, int theta_h, const int *first, double *rho)
{
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        double value[GONIO_THETA_D_BINS];
        for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
            value[theta_d] =
                log_value(r, gonio_i_cell_at(1, (gonio_i_cell_indices){theta_h, theta_d, 0}),
                          (size_t)channel);
        }
        exponentiate(GONIO_THETA_D_BINS, value, scale_of(r, channel));
        for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
            fill(row_of(rho, channel, theta_d), first[theta_d], GONIO_PHI_D_BINS - first[theta_d],
                 value[theta_d]);
        }
    }
}

/* Sets each valid bin to its own value. */
static void fill_bins(const reconstructed *r, int theta_h, const int *first, double *rho)
{
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        const int last = GONIO_PHI_D_BINS - first[theta_d];
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            double *row = row_of(rho, channel, theta_d);
            for (int p = first[theta_d]; p < last; p++) {
                row[p] = log_value(r, gonio_bin_index((gonio_bin){theta_h, theta_d, p}),
                                   (size_t)channel);
            }
            exponentiate((size_t)(last - first[theta_d]), row + first[theta_d],
                         scale_of(r, channel));
        }
    }
}

/* Converts e^g - 1 to rho if each bin has a scale of its own. */
static void scale_bins(int theta_h, const int *first, double *rho)
{
    double scale[GONIO_SLAB_BINS];
    gonio_slab_scale(GONIO_LOG_RELATIVE, 0, theta_h, scale);
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
            double *row = row_of(rho, channel, theta_d);
            for (int p = first[theta_d]; p < GONIO_PHI_D_BINS - first[theta_d]; p++) {
                row[p] *= scale[theta_d * GONIO_PHI_D_BINS + p];
            }
        }
    }
}

static void clear_invalid(const int *first, double *rho)
{
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
            double *row = row_of(rho, channel, theta_d);
            fill(row, 0, first[theta_d], -1.0);
            fill(row, GONIO_PHI_D_BINS - first[theta_d], GONIO_PHI_D_BINS, -1.0);
        }
    }
}

static gonio_status read_reconstructed(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)context;
    const reconstructed *r = self;
    int first[GONIO_THETA_D_BINS];
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        first[theta_d] = gonio_i_first_valid_phi(theta_h, theta_d);
    }
    if (r->view->representation == GONIO_BIVARIATE) {
        fill_cells(r, theta_h, first, rho);
    } else {
        fill_bins(r, theta_h, first, rho);
    }
    if (r->view->mapping == GONIO_LOG_RELATIVE) {
        scale_bins(theta_h, first, rho);
    }
    clear_invalid(first, rho);
    return GONIO_OK;
}

/* Of a sectored basis: by the field m + V c, as of a posterior, which is linear between the middles
 * of sectors. */
static gonio_status sectored_material(gonio_context *context, const gonio_basis *basis,
                                      const gonio_reconstruction *reconstruction, const char *name,
                                      gonio_material **material)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    gonio_reconstruction with_field = *reconstruction;
    const size_t values = reconstruction->columns * view->rows;
    with_field.field = gonio_i_allocate(context, values, sizeof *with_field.field);
    if (with_field.field == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < values; k++) {
        const size_t row = k % view->rows;
        const double *c =
            reconstruction->coefficients + k / view->rows * reconstruction->components;
        with_field.field[k] =
            view->mean[row] + gonio_i_basis_dot(basis, row, c, reconstruction->components);
    }
    const gonio_status status = gonio_i_field_material(context, basis, &with_field, name, material);
    free(with_field.field);
    return status;
}

gonio_status gonio_reconstruction_material(gonio_context *context, const gonio_basis *basis,
                                           const gonio_reconstruction *reconstruction,
                                           const char *name, gonio_material **material)
{
    if (reconstruction->field != NULL) {
        return gonio_i_field_material(context, basis, reconstruction, name, material);
    }
    if (gonio_basis_describe(basis)->representation == GONIO_SECTORED) {
        return sectored_material(context, basis, reconstruction, name, material);
    }
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
    const gonio_material_source source = {
        .size = sizeof source, .read_slab = read_reconstructed, .release = free, .self = r};
    const gonio_status status =
        gonio_material_create(context, name, "reconstruction", &source, material);
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
    const gonio_status status = gonio_material_read_slab(context, *original, theta_h, rho);
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
            exponentiate(GONIO_SLAB_BINS, rho + (size_t)channel * GONIO_SLAB_BINS,
                         gonio_log_scale(channel));
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
    const gonio_material_source source = {
        .size = sizeof source, .read_slab = read_average, .release = free, .self = self};
    const gonio_status status = gonio_material_create(context, gonio_material_name(original),
                                                      "bivariate average", &source, material);
    if (status != GONIO_OK) {
        free(self);
    }
    return status;
}
