/* A reconstruction's field as a material and at single directions: see reconstruct.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../basis/basis.h"
#include "../core/vector_math.h"
#include "../material/colour.h"
#include "../measurement/readings.h"
#include "../posterior/observations.h"
#include "field.h"

/* A field at the rows around a direction. */
static double add_up(const double *field, const gonio_i_row_weight *around, int points)
{
    double value = 0.0;
    for (int k = 0; k < points; k++) {
        value += around[k].weight * field[around[k].row];
    }
    return value;
}

double gonio_i_field_at(const gonio_basis *basis, const double *field, int channel,
                        gonio_half_difference at)
{
    gonio_i_row_weight around[GONIO_I_MOST_POINTS];
    return add_up(field, around, gonio_i_rows_around(basis, at, channel, around));
}

/* ---- predicting ---- */

static bool is_joint(const gonio_basis *basis)
{
    return gonio_basis_describe(basis)->channels == GONIO_JOINT;
}

static size_t channels_of(const gonio_basis *basis, const gonio_reconstruction *r)
{
    return is_joint(basis) ? GONIO_CHANNELS : r->columns;
}

/* R, G, B, as gonio_readings_are_colours has it. */
static bool has_colours(const gonio_basis *basis, const gonio_reconstruction *r)
{
    return r->wavelengths == 0 && channels_of(basis, r) == GONIO_CHANNELS;
}

static double scale_of(const gonio_basis *basis, const gonio_reconstruction *r, size_t channel)
{
    return gonio_log_scale(has_colours(basis, r) ? (int)channel : GONIO_CHANNELS);
}

/* The first row of a channel in a field or a deviation. */
static const double *rows_of(const gonio_basis *basis, const double *field, size_t channel)
{
    return field + (is_joint(basis) ? 0 : channel * gonio_basis_describe(basis)->rows);
}

bool gonio_reconstruction_predict(const gonio_basis *basis, const gonio_reconstruction *r,
                                  gonio_half_difference at, double *value, double *deviation)
{
    if (r->field == NULL || (deviation != NULL && r->deviation == NULL)) {
        return false;
    }
    for (size_t k = 0; k < channels_of(basis, r); k++) {
        const double g = gonio_i_field_at(basis, rows_of(basis, r->field, k), (int)k, at);
        value[k] = scale_of(basis, r, k) * expm1(fmin(fmax(g, 0.0), GONIO_I_LARGEST_LOG));
        if (deviation != NULL) {
            deviation[k] = gonio_i_field_at(basis, rows_of(basis, r->deviation, k), (int)k, at);
        }
    }
    return true;
}

/* Directions that are predicted at a time, and their rows. */
typedef struct directions {
    size_t count;
    int points[GONIO_I_PREDICTED];
    gonio_i_row_weight around[GONIO_I_PREDICTED][GONIO_I_MOST_POINTS];
} directions;

/* Channels are outside: the rows of all directions of one stay in the cache. */
static void predict_channels(gonio_context *context, const gonio_basis *basis,
                             const gonio_reconstruction *r, const directions *d, double *value)
{
    const size_t channels = r->columns;
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(context))
    for (size_t c = 0; c < channels; c++) {
        const double *field = rows_of(basis, r->field, c);
        const double scale = scale_of(basis, r, c);
        for (size_t k = 0; k < d->count; k++) {
            const double g = add_up(field, d->around[k], d->points[k]);
            value[k * channels + c] = scale * expm1(fmin(fmax(g, 0.0), GONIO_I_LARGEST_LOG));
        }
    }
}

gonio_status gonio_i_predict_many(gonio_context *context, const gonio_basis *basis,
                                  const gonio_reconstruction *r, const gonio_pair *pairs,
                                  size_t count, double *value)
{
    directions *d = gonio_i_allocate(context, 1, sizeof *d);
    if (d == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t first = 0; first < count; first += d->count) {
        d->count = count - first < GONIO_I_PREDICTED ? count - first : GONIO_I_PREDICTED;
        for (size_t k = 0; k < d->count; k++) {
            const gonio_half_difference at = gonio_half_difference_from_pair(pairs[first + k]);
            d->points[k] = gonio_i_rows_around(basis, at, 0, d->around[k]);
        }
        predict_channels(context, basis, r, d, value + first * r->columns);
    }
    free(d);
    return GONIO_OK;
}

/* Predicts one reading. deviation[channels], 1/sr, or NULL. */
static void predict_reading(const gonio_basis *basis, const gonio_reconstruction *r,
                            gonio_readings *readings, size_t reading, double *deviation)
{
    const gonio_pair *pair = &readings->pair[reading];
    double *value = gonio_i_readings_values(readings, reading);
    gonio_reconstruction_predict(basis, r, gonio_half_difference_from_pair(*pair), value,
                                 deviation);
    for (size_t c = 0; c < readings->channels; c++) {
        if (deviation != NULL) {
            deviation[c] *= value[c] + scale_of(basis, r, c);
        }
        value[c] =
            fmax(value[c] - gonio_i_dark_level_missing(r->dark, c, pair->incident.theta), 0.0);
    }
}

gonio_status gonio_reconstruction_predict_readings(gonio_context *context, const gonio_basis *basis,
                                                   const gonio_reconstruction *r,
                                                   gonio_readings *readings)
{
    if (r->field == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "only a reconstruction by posterior predicts single readings");
    }
    const size_t channels = channels_of(basis, r);
    const size_t count = r->deviation != NULL ? readings->count * channels : 0;
    double *deviation = count > 0 ? gonio_i_allocate(context, count, sizeof *deviation) : NULL;
    gonio_status status = count == 0 || deviation != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = gonio_i_readings_set_channels(context, readings, channels, r->wavelength);
    }
    for (size_t k = 0; k < readings->count && status == GONIO_OK; k++) {
        predict_reading(basis, r, readings, k, deviation != NULL ? deviation + k * channels : NULL);
    }
    if (status == GONIO_OK && deviation != NULL) {
        status = gonio_readings_set_deviations(context, readings, deviation);
    }
    free(deviation);
    return status;
}

/* ---- as a material ---- */

/* A field over the grid, of three channels. */
typedef struct grid_field {
    const gonio_basis *basis;
    const gonio_basis_view *view;
    bool plain; /* g itself in place of e^g - 1 */
    double *g;  /* [channel][position] */
} grid_field;

static void release(void *self)
{
    grid_field *f = self;
    free(f->g);
    free(f);
}

/* One row of bins: interpolated between the middles of sectors, or one cell for all bins or for
 * each. */
static void fill_row(const grid_field *f, int theta_h, int theta_d, size_t channel, int first,
                     double *row)
{
    const double *g = f->g + channel * f->view->cells;
    const int depth = gonio_i_phi_bins(f->view->representation);
    const int runs = gonio_i_phi_cells(f->view->representation);
    const int32_t cell = gonio_i_cell_at(runs, (gonio_i_cell_indices){theta_h, theta_d, 0});
    for (int p = first; p < GONIO_PHI_D_BINS - first; p++) {
        const double at = (p + 0.5) / depth - 0.5 + runs;
        const int low = (int)at;
        const size_t a = gonio_basis_position(f->basis, cell + low % runs);
        const size_t b = gonio_basis_position(f->basis, cell + (low + 1) % runs);
        row[p] = g[a] + (at - low) * (g[b] - g[a]);
    }
}

static void finish_row(const grid_field *f, size_t channel, size_t count, double *row)
{
    for (size_t k = 0; k < count; k++) {
        row[k] = row[k] > 0.0 ? fmin(row[k], GONIO_I_LARGEST_LOG) : 0.0;
    }
    if (!f->plain) {
        gonio_i_expm1(count, row, row);
    }
    for (size_t k = 0; k < count; k++) {
        row[k] *= gonio_log_scale((int)channel);
    }
}

static gonio_status read_field(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)context;
    const grid_field *f = self;
    for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
        rho[k] = -1.0;
    }
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        const int first = gonio_i_first_valid_phi(theta_h, theta_d);
        for (size_t channel = 0; channel < GONIO_CHANNELS && 2 * first < GONIO_PHI_D_BINS;
             channel++) {
            double *row = rho + channel * GONIO_SLAB_BINS + (size_t)theta_d * GONIO_PHI_D_BINS;
            fill_row(f, theta_h, theta_d, channel, first, row);
            finish_row(f, channel, (size_t)(GONIO_PHI_D_BINS - 2 * first), row + first);
        }
    }
    return GONIO_OK;
}

/* [channel][position] of R, G, B. */
static void copy_colours(const double *from, grid_field *f)
{
    const bool joint = is_joint(f->basis);
    for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
        for (size_t k = 0; k < f->view->cells; k++) {
            f->g[channel * f->view->cells + k] =
                from[gonio_i_row_of(f->view->channels, k, (int)channel) +
                     (joint ? 0 : channel * f->view->rows)];
        }
    }
}

/* A single channel without a wavelength as grey. */
static void copy_grey(const gonio_reconstruction *r, grid_field *f)
{
    for (size_t k = 0; k < f->view->cells; k++) {
        const double rho =
            scale_of(f->basis, r, 0) * expm1(fmin(fmax(r->field[k], 0.0), GONIO_I_LARGEST_LOG));
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            f->g[channel * f->view->cells + k] = gonio_log_from_brdf(rho, (int)channel);
        }
    }
}

/* Cells whose colours are mixed at a time, of all wavelengths. */
enum { MIXED_CELLS = 64 };

/* Light that no colour has, as infrared has none. */
static bool is_invisible(const gonio_reconstruction *r, const double *weight, size_t wavelength)
{
    bool invisible = true;
    for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
        invisible = invisible && weight[channel * r->wavelengths + wavelength] == 0.0;
    }
    return invisible;
}

static void mix_cells(const gonio_reconstruction *r, const double *weight, size_t first,
                      size_t count, const grid_field *f)
{
    double rgb[GONIO_CHANNELS][MIXED_CELLS] = {{0.0}};
    for (size_t j = 0; j < r->wavelengths; j++) {
        const double *g = r->field + j * f->view->rows + first;
        if (is_invisible(r, weight, j)) {
            continue;
        }
        for (size_t k = 0; k < count; k++) {
            const double rho =
                scale_of(f->basis, r, j) * expm1(fmin(fmax(g[k], 0.0), GONIO_I_LARGEST_LOG));
            for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
                rgb[channel][k] += weight[channel * r->wavelengths + j] * rho;
            }
        }
    }
    for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
        for (size_t k = 0; k < count; k++) {
            f->g[channel * f->view->cells + first + k] =
                gonio_log_from_brdf(fmax(rgb[channel][k], 0.0), (int)channel);
        }
    }
}

/* The colours of spectra. weight[channel][wavelengths]. */
static void mix_colours(gonio_context *context, const gonio_reconstruction *r, const double *weight,
                        const grid_field *f)
{
    const size_t cells = f->view->cells;
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(context))
    for (size_t first = 0; first < cells; first += MIXED_CELLS) {
        const size_t left = cells - first;
        mix_cells(r, weight, first, left < MIXED_CELLS ? left : MIXED_CELLS, f);
    }
}

/* Deviations of the colours' g from those of the channels: d rho = (rho + s) d g. The errors of all
 * wavelengths are taken as fully correlated. weight[channel][columns]; NULL for a single channel.
 */
static void mix_deviations(const gonio_reconstruction *r, const double *weight, grid_field *f)
{
    const size_t count = r->columns;
    for (size_t k = 0; k < f->view->cells; k++) {
        double rgb[GONIO_CHANNELS] = {0.0};
        double deviation[GONIO_CHANNELS] = {0.0};
        for (size_t j = 0; j < count; j++) {
            const double s = scale_of(f->basis, r, j);
            const double g = r->field[j * f->view->rows + k];
            const double rho = s * expm1(fmin(fmax(g, 0.0), GONIO_I_LARGEST_LOG));
            for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
                const double w = weight != NULL ? weight[channel * count + j] : 1.0;
                rgb[channel] += w * rho;
                deviation[channel] += fabs(w) * (rho + s) * r->deviation[j * f->view->rows + k];
            }
        }
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            f->g[channel * f->view->cells + k] =
                deviation[channel] / (fmax(rgb[channel], 0.0) + gonio_log_scale((int)channel));
        }
    }
}

/* Under equal energy, as colours of spectral materials are. */
static gonio_status fill_spectra(gonio_context *context, const gonio_reconstruction *r,
                                 grid_field *f)
{
    double *weight = gonio_i_allocate(context, GONIO_CHANNELS * r->wavelengths, sizeof *weight);
    const gonio_status status = weight != NULL
                                    ? gonio_i_colour_weights(context, r->wavelength, r->wavelengths,
                                                             GONIO_ILLUMINANT_E, weight)
                                    : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK && f->plain) {
        mix_deviations(r, weight, f);
    } else if (status == GONIO_OK) {
        gonio_i_note_colours(context, "reconstruction", r->wavelength, r->wavelengths);
        mix_colours(context, r, weight, f);
    }
    free(weight);
    return status;
}

static gonio_status fill_field(gonio_context *context, const gonio_reconstruction *r,
                               const double *from, grid_field *f)
{
    if (has_colours(f->basis, r)) {
        copy_colours(from, f);
        return GONIO_OK;
    }
    if (r->wavelengths == 0 && r->columns == 1) {
        if (f->plain) {
            mix_deviations(r, NULL, f);
        } else {
            copy_grey(r, f);
        }
        return GONIO_OK;
    }
    if (r->wavelengths == 0) {
        return gonio_i_fail(
            context, GONIO_ERROR_ARGUMENT,
            "a table needs R, G, B, a spectrum or a single channel, not %zu channels", r->columns);
    }
    return fill_spectra(context, r, f);
}

static gonio_status create(gonio_context *context, const gonio_basis *basis,
                           const gonio_reconstruction *r, const double *from, bool plain,
                           const char *name, gonio_material **material)
{
    grid_field *f = gonio_i_allocate(context, 1, sizeof *f);
    if (f == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    f->basis = basis;
    f->view = gonio_basis_describe(basis);
    f->plain = plain;
    f->g = gonio_i_allocate(context, GONIO_CHANNELS * f->view->cells, sizeof *f->g);
    gonio_status status = f->g == NULL ? GONIO_ERROR_MEMORY : fill_field(context, r, from, f);
    const gonio_material_source source = {
        .size = sizeof source, .read_slab = read_field, .release = release, .self = f};
    if (status == GONIO_OK) {
        status = gonio_material_create(context, name, "reconstruction", &source, material);
    }
    if (status != GONIO_OK) {
        release(f);
    }
    return status;
}

gonio_status gonio_i_field_material(gonio_context *context, const gonio_basis *basis,
                                    const gonio_reconstruction *r, const char *name,
                                    gonio_material **material)
{
    return create(context, basis, r, r->field, false, name, material);
}

gonio_status gonio_reconstruction_deviation_material(gonio_context *context,
                                                     const gonio_basis *basis,
                                                     const gonio_reconstruction *r,
                                                     gonio_material **material)
{
    if (r->deviation == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "the reconstruction has no deviations; reconstruct with them");
    }
    return create(context, basis, r, r->deviation, true, "deviation", material);
}
