/* Reconstruction of a known material without files: its readings at rows of a basis, and the
 * reconstruction from them. */
#include <gonio/reconstruct.h>

#include <stdlib.h>
#include <string.h>

#include "../basis/basis.h"
#include "../core/options.h"
#include "method.h"

/* A cell to read. */
typedef struct place {
    int32_t cell;
    int channel;  /* the first of those wanted */
    size_t index; /* into b */
} place;

typedef struct reader {
    gonio_context *context;
    const gonio_material *material;
    const gonio_basis_view *basis;
    size_t count; /* of rows; the distance of b's columns */
    double *g;    /* a slab in log space */
    bool *data;
    gonio_slab_statistics statistics;
} reader;

static int compare_places(const void *a, const void *b)
{
    const place *x = a;
    const place *y = b;
    return (x->cell > y->cell) - (x->cell < y->cell);
}

static int slab_of(const reader *r, int32_t cell)
{
    return gonio_cell_bin(r->basis->representation, cell).theta_h;
}

static gonio_status read_slab(reader *r, int theta_h)
{
    const gonio_status status = gonio_material_read_slab(r->context, r->material, theta_h, r->g);
    if (status == GONIO_OK) {
        gonio_slab_mask(theta_h, r->g, r->data);
        gonio_slab_to_mapped(r->basis->mapping, theta_h, r->g, r->g);
        if (r->basis->representation == GONIO_BIVARIATE) {
            gonio_slab_reduce(r->g, r->data, &r->statistics);
        }
    }
    return status;
}

/* The value of a cell of the slab: the mean of its bins with data. False if there are none. */
static bool value_at(const reader *r, int32_t cell, int channel, double *value)
{
    const gonio_i_bin_run bins = gonio_i_cell_bins(r->basis->representation, cell);
    const int theta_d = bins.first.theta_d;
    if (r->basis->representation == GONIO_BIVARIATE) {
        *value = r->statistics.mean[theta_d][channel];
        return r->statistics.count[theta_d] > 0;
    }
    const size_t first = (size_t)theta_d * GONIO_PHI_D_BINS + (size_t)bins.first.phi_d;
    const double *g = r->g + (size_t)channel * GONIO_SLAB_BINS;
    int count = 0;
    double sum = 0.0;
    for (size_t k = first; k < first + (size_t)bins.count; k++) {
        sum += r->data[k] ? g[k] : 0.0;
        count += r->data[k];
    }
    *value = count > 0 ? sum / count : 0.0;
    return count > 0;
}

/* All columns of one row. */
static gonio_status read_place(const reader *r, const place *at, double *b)
{
    const int columns = (int)gonio_i_columns_per_material(r->basis->channels);
    for (int column = 0; column < columns; column++) {
        if (!value_at(r, at->cell, at->channel + column,
                      &b[(size_t)column * r->count + at->index])) {
            return gonio_i_fail(r->context, GONIO_ERROR_DATA,
                                "%s: no data in cell %d, which the plan reads",
                                gonio_material_name(r->material), (int)at->cell);
        }
    }
    return GONIO_OK;
}

static gonio_status read_places(reader *r, const place *places, double *b)
{
    gonio_status status = GONIO_OK;
    int slab = -1;
    for (size_t k = 0; k < r->count && status == GONIO_OK; k++) {
        if (slab_of(r, places[k].cell) != slab) {
            slab = slab_of(r, places[k].cell);
            status = read_slab(r, slab);
        }
        if (status == GONIO_OK) {
            status = read_place(r, &places[k], b);
        }
    }
    return status;
}

gonio_status gonio_material_rows(gonio_context *context, const gonio_basis *basis,
                                 const gonio_material *material, const size_t *rows, size_t count,
                                 double *b)
{
    gonio_status status = gonio_i_reconstruct_check_rows(context, basis, rows, count);
    if (status != GONIO_OK) {
        return status;
    }
    reader r = {.context = context,
                .material = material,
                .basis = gonio_basis_describe(basis),
                .count = count,
                .g = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof *r.g),
                .data = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof *r.data)};
    place *places = gonio_i_allocate(context, count, sizeof *places);
    status = GONIO_ERROR_MEMORY;
    if (r.g != NULL && r.data != NULL && places != NULL) {
        for (size_t k = 0; k < count; k++) {
            places[k] = (place){gonio_i_row_cell(r.basis, rows[k]),
                                gonio_i_channel_of(r.basis->channels, rows[k]), k};
        }
        qsort(places, count, sizeof *places, compare_places);
        status = read_places(&r, places, b);
    }
    free(places);
    free(r.g);
    free(r.data);
    return status;
}

static int compare_rows(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a;
    const size_t y = *(const size_t *)b;
    return (x > y) - (x < y);
}

/* Lists the rows of all channels of the cells of `rows` (joint), without repeats, in all[3 x
 * count]. Returns their number. */
static size_t all_channels(const size_t *rows, size_t count, size_t *all)
{
    size_t cells = 0;
    for (size_t k = 0; k < count; k++) {
        all[k] = gonio_i_position_of(GONIO_JOINT, rows[k]);
    }
    qsort(all, count, sizeof *all, compare_rows);
    for (size_t k = 0; k < count; k++) {
        if (cells == 0 || all[cells - 1] != all[k]) {
            all[cells++] = all[k];
        }
    }
    for (size_t k = GONIO_CHANNELS * cells; k-- > 0;) {
        all[k] = gonio_i_row_of(GONIO_JOINT, all[k / GONIO_CHANNELS], (int)(k % GONIO_CHANNELS));
    }
    return GONIO_CHANNELS * cells;
}

gonio_status gonio_reconstruct_material(gonio_context *context, const gonio_basis *basis,
                                        const gonio_material *original, const size_t *rows,
                                        size_t count, const gonio_reconstruct_options *options,
                                        gonio_material **material)
{
    gonio_reconstruct_options how;
    gonio_status status = GONIO_I_TAKE(context, gonio_reconstruct_options, options, &how);
    if (status == GONIO_OK) {
        status = gonio_i_reconstruct_check_rows(context, basis, rows, count);
    }
    if (status != GONIO_OK) {
        return status;
    }
    const bool joint = gonio_basis_describe(basis)->channels == GONIO_JOINT;
    const bool more = joint && how.all_channels;
    size_t *used = gonio_i_allocate(context, GONIO_CHANNELS * count, sizeof *used);
    double *b = gonio_i_allocate(context, GONIO_CHANNELS * GONIO_CHANNELS * count, sizeof *b);
    gonio_reconstruction *made = NULL;
    status = GONIO_ERROR_MEMORY;
    if (used != NULL && b != NULL) {
        memcpy(used, rows, count * sizeof *used);
        count = more ? all_channels(rows, count, used) : count;
        status = gonio_material_rows(context, basis, original, used, count, b);
    }
    if (status == GONIO_OK) {
        status = gonio_reconstruct_rows_with(context, basis, &how, used, count, b, &made);
    }
    if (status == GONIO_OK) {
        status = gonio_reconstruction_material(context, basis, made, gonio_material_name(original),
                                               material);
    }
    gonio_reconstruction_free(&made);
    free(used);
    free(b);
    return status;
}
