/* A basis in memory: creation, description, and the row that a reading observes. */
#include "basis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/number.h"
#include "analytic.h"
#include "../direction/grid.h"

size_t gonio_i_basis_row_count(size_t cells, gonio_channel_model channels)
{
    return gonio_i_rows_per_cell(channels) * cells;
}

size_t gonio_i_basis_columns(const gonio_basis *basis)
{
    return gonio_i_columns_per_material(basis->channels) * basis->materials + basis->mixtures +
           basis->analytic;
}

gonio_i_column_weights gonio_i_weights_of_columns(size_t measured, size_t mixtures, size_t analytic)
{
    const double all = (double)(measured + mixtures + analytic);
    const double share = analytic > 0 ? GONIO_I_ANALYTIC_SHARE : 0.0;
    const double each = (mixtures > 0 ? 0.5 : 1.0) * (1.0 - share) * all;
    return (gonio_i_column_weights){
        .measured = each / (double)measured,
        .mixture = mixtures > 0 ? each / (double)mixtures : 0.0,
        .analytic = analytic > 0 ? share * all / (double)analytic : 0.0,
    };
}

gonio_basis *gonio_i_basis_allocate(gonio_context *context, size_t materials, size_t mixtures,
                                    size_t analytic, size_t cells, gonio_channel_model channels,
                                    size_t components, size_t variance_count)
{
    gonio_basis *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return NULL;
    }
    const size_t rows = gonio_i_basis_row_count(cells, channels);
    made->channels = channels;
    made->materials = materials;
    made->mixtures = mixtures;
    made->analytic = analytic;
    made->cells = cells;
    made->rows = rows;
    made->components = components;
    made->variance_count = variance_count;
    made->names = gonio_i_allocate(context, materials, sizeof *made->names);
    made->fingerprints = gonio_i_allocate(context, materials, sizeof *made->fingerprints);
    made->cell = gonio_i_allocate(context, cells, sizeof *made->cell);
    made->mean = gonio_i_allocate(context, rows, sizeof *made->mean);
    made->variances = gonio_i_allocate(context, variance_count, sizeof *made->variances);
    made->loadings =
        gonio_i_allocate(context, gonio_i_basis_columns(made) * components, sizeof *made->loadings);
    if (mixtures > 0) {
        made->parents = gonio_i_allocate(context, 2 * mixtures, sizeof *made->parents);
    }
    if (made->names == NULL || made->fingerprints == NULL || made->cell == NULL ||
        made->mean == NULL || made->variances == NULL || made->loadings == NULL ||
        (mixtures > 0 && made->parents == NULL)) {
        gonio_basis_free(&made);
    }
    return made;
}

void gonio_basis_free(gonio_basis **basis)
{
    if (basis == NULL || *basis == NULL) {
        return;
    }
    gonio_basis *old = *basis;
    for (size_t k = 0; old->names != NULL && k < old->materials; k++) {
        free(old->names[k]);
    }
    free(old->names);
    free(old->fingerprints);
    free(old->cell);
    free(old->mean);
    free(old->kept);
    gonio_i_safetensors_close(&old->file);
    free(old->variances);
    free(old->loadings);
    free(old->parents);
    free(old->program);
    free(old->command);
    free(old->position);
    free(old);
    *basis = NULL;
}

/* The nearest cell of the basis that is known so far for a cell of the grid. */
typedef struct nearest {
    int32_t position; /* -1: none yet */
    int32_t distance; /* squared, in index space */
} nearest;

/* One direction of the grid. */
typedef struct axis {
    size_t length;
    size_t stride;
    bool periodic;
} axis;

static void consider(nearest candidate, size_t step, nearest *best)
{
    const int32_t distance = candidate.distance + (int32_t)(step * step);
    const bool nearer = best->position < 0 || distance < best->distance ||
                        (distance == best->distance && candidate.position < best->position);
    if (candidate.position >= 0 && nearer) {
        *best = (nearest){candidate.position, distance};
    }
}

/* Searches outwards from k, until no farther cell can be nearer. */
static nearest nearest_in_line(const nearest *line, const axis *a, size_t k)
{
    nearest best = {-1, 0};
    for (size_t step = 0;
         step < a->length && (best.position < 0 || step * step <= (size_t)best.distance); step++) {
        if (a->periodic || k >= step) {
            consider(line[(k + a->length - step) % a->length], step, &best);
        }
        if (a->periodic || k + step < a->length) {
            consider(line[(k + step) % a->length], step, &best);
        }
    }
    return best;
}

/* Searches along one axis for nearer cells than those known so far. */
static void search_axis(gonio_context *context, const axis *a, nearest *cells, size_t count)
{
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(context))
    for (size_t l = 0; l < count / a->length; l++) {
        nearest line[GONIO_PHI_D_BINS];
        nearest *first = cells + l / a->stride * a->stride * a->length + l % a->stride;
        for (size_t k = 0; k < a->length; k++) {
            line[k] = first[k * a->stride];
        }
        for (size_t k = 0; k < a->length; k++) {
            first[k * a->stride] = nearest_in_line(line, a, k);
        }
    }
}

/* Squared distances add up over the axes. So the nearest cell is found one axis after another.
 * Invalid bins of the full grid get a nearest cell too, because interpolation may use them. */
gonio_status gonio_i_basis_map_cells(gonio_context *context, gonio_basis *basis)
{
    const size_t all = (size_t)gonio_grid_cells(basis->representation);
    const size_t depth = (size_t)gonio_i_phi_cells(basis->representation);
    const axis axes[] = {{depth, 1, true},
                         {GONIO_THETA_D_BINS, depth, false},
                         {GONIO_THETA_H_BINS, GONIO_THETA_D_BINS * depth, false}};
    nearest *cells = gonio_i_allocate(context, all, sizeof *cells);
    free(basis->position);
    basis->position = gonio_i_allocate(context, all, sizeof *basis->position);
    if (cells == NULL || basis->position == NULL) {
        free(cells);
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < all; k++) {
        cells[k].position = -1;
    }
    for (size_t k = 0; k < basis->cells; k++) {
        cells[basis->cell[k]].position = (int32_t)k;
    }
    for (size_t k = 0; k < sizeof axes / sizeof *axes; k++) {
        search_axis(context, &axes[k], cells, all);
    }
    for (size_t k = 0; k < all; k++) {
        basis->position[k] = cells[k].position;
    }
    free(cells);
    return GONIO_OK;
}

/* A basis in log space with a mean has the fingerprint that it had before other mappings existed.
 */
static void add_kind(const gonio_basis *basis, gonio_fingerprint *fingerprint)
{
    const int32_t kind[2] = {basis->representation, basis->channels};
    const int32_t more[2] = {basis->mapping, basis->without_mean};
    gonio_fingerprint_add(fingerprint, kind, sizeof kind);
    if (more[0] != GONIO_LOG || more[1] != 0) {
        gonio_fingerprint_add(fingerprint, more, sizeof more);
    }
    if (basis->mixtures > 0) {
        const uint64_t mixtures = basis->mixtures;
        gonio_fingerprint_add(fingerprint, &mixtures, sizeof mixtures);
    }
    if (basis->analytic > 0) {
        const uint64_t analytic = basis->analytic;
        gonio_fingerprint_add(fingerprint, &analytic, sizeof analytic);
    }
    gonio_fingerprint_add(fingerprint, basis->cell, basis->cells * sizeof *basis->cell);
}

/* Processors round differently. So the materials' names and the leading variances to six digits
 * identify a basis. Variances of another database differ in the first digits. */
static void add_identity(const gonio_basis *basis, gonio_fingerprint *fingerprint)
{
    add_kind(basis, fingerprint);
    for (size_t k = 0; k < basis->materials; k++) {
        gonio_fingerprint_add(fingerprint, basis->names[k], strlen(basis->names[k]) + 1);
    }
    for (size_t k = 0; k < basis->components; k++) {
        char text[32] = "";
        if (basis->variances[k] > 1e-6 * basis->variances[0]) {
            gonio_i_print(text, sizeof text, "%.5e", basis->variances[k]);
        }
        gonio_fingerprint_add(fingerprint, text, sizeof text);
    }
}

static void add_everything(const gonio_basis *basis, gonio_fingerprint *fingerprint)
{
    add_kind(basis, fingerprint);
    gonio_fingerprint_add(fingerprint, basis->mean, basis->rows * sizeof *basis->mean);
    gonio_fingerprint_add(fingerprint, &basis->vectors_checksum, sizeof basis->vectors_checksum);
    gonio_fingerprint_add(fingerprint, basis->variances,
                          basis->variance_count * sizeof *basis->variances);
}

gonio_status gonio_i_basis_hash(gonio_context *context, const void *data, size_t size,
                                uint64_t *value)
{
    gonio_fingerprint *fingerprint = NULL;
    if (gonio_fingerprint_create(&fingerprint) != GONIO_OK) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    gonio_fingerprint_add(fingerprint, data, size);
    *value = gonio_fingerprint_value(fingerprint);
    gonio_fingerprint_free(&fingerprint);
    return GONIO_OK;
}

static gonio_basis_view view_of(const gonio_basis *basis)
{
    return (gonio_basis_view){
        .representation = basis->representation,
        .channels = basis->channels,
        .mapping = basis->mapping,
        .without_mean = basis->without_mean,
        .materials = basis->materials,
        .mixtures = basis->mixtures,
        .analytic = basis->analytic,
        .columns = gonio_i_basis_columns(basis),
        .names = (const char *const *)basis->names,
        .fingerprints = basis->fingerprints,
        .cells = basis->cells,
        .cell = basis->cell,
        .rows = basis->rows,
        .components = basis->components,
        .mean = basis->mean,
        .variance_count = basis->variance_count,
        .variances = basis->variances,
        .loadings = basis->loadings,
        .parents = basis->parents,
        .fingerprint = basis->fingerprint,
        .checksum = basis->checksum,
        .program = basis->program != NULL ? basis->program : "",
        .command = basis->command != NULL ? basis->command : "",
    };
}

gonio_status gonio_i_basis_finish(gonio_context *context, gonio_basis *basis)
{
    gonio_fingerprint *identity = NULL;
    gonio_fingerprint *everything = NULL;
    gonio_status status = gonio_fingerprint_create(&identity);
    if (status == GONIO_OK) {
        status = gonio_fingerprint_create(&everything);
    }
    if (status == GONIO_OK) {
        add_identity(basis, identity);
        add_everything(basis, everything);
        basis->fingerprint = gonio_fingerprint_value(identity);
        basis->checksum = gonio_fingerprint_value(everything);
        basis->view = view_of(basis);
        status = gonio_i_basis_map_cells(context, basis);
    } else {
        gonio_i_fail(context, status, "out of memory");
    }
    gonio_fingerprint_free(&identity);
    gonio_fingerprint_free(&everything);
    return status;
}

const gonio_basis_view *gonio_basis_describe(const gonio_basis *basis)
{
    return &basis->view;
}

/* ---- rows of V ---- */

/* Converts doubles to floats in the same memory. Forward order is safe: a float is written before
 * the doubles that are still to be read. */
static void round_in_place(double *values, size_t count)
{
    enum { CHUNK = 1024 };
    float rounded[CHUNK];
    for (size_t first = 0; first < count; first += CHUNK) {
        const size_t length = count - first < CHUNK ? count - first : CHUNK;
        for (size_t k = 0; k < length; k++) {
            rounded[k] = (float)values[first + k];
        }
        memcpy((char *)values + first * sizeof *rounded, rounded, length * sizeof *rounded);
    }
}

gonio_status gonio_i_basis_keep_vectors(gonio_context *context, gonio_basis *basis, double *vectors)
{
    const size_t count = basis->rows * basis->components;
    round_in_place(vectors, count);
    float *smaller = realloc(vectors, count * sizeof *smaller);
    basis->kept = smaller != NULL ? smaller : (float *)(void *)vectors;
    basis->vectors = basis->kept;
    return gonio_i_basis_hash(context, basis->vectors, count * sizeof *basis->vectors,
                              &basis->vectors_checksum);
}

GONIO_I_VECTORISED static void widen(const float *from, size_t count, double *to)
{
    for (size_t k = 0; k < count; k++) {
        to[k] = (double)from[k];
    }
}

void gonio_i_basis_rows(const gonio_basis *basis, size_t first, size_t count, size_t components,
                        double *values)
{
    for (size_t i = 0; i < count; i++) {
        widen(basis->vectors + (first + i) * basis->components, components,
              values + i * components);
    }
}

gonio_status gonio_basis_rows(gonio_context *context, const gonio_basis *basis, size_t first,
                              size_t count, size_t components, double *values)
{
    if (first > basis->rows || count > basis->rows - first || components > basis->components) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%zu components of rows %zu to %zu requested, but the basis has "
                            "%zu components and %zu rows",
                            components, first, first + count, basis->components, basis->rows);
    }
    gonio_i_basis_rows(basis, first, count, components, values);
    return GONIO_OK;
}

GONIO_I_VECTORISED static double dot(const float *v, const double *c, size_t count)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = 0; k < count; k++) {
        sum += (double)v[k] * c[k];
    }
    return sum;
}

double gonio_i_basis_dot(const gonio_basis *basis, size_t row, const double *c, size_t components)
{
    return dot(basis->vectors + row * basis->components, c, components);
}

double gonio_i_singular_value(const gonio_basis_view *view, size_t k)
{
    return sqrt(view->variances[k] * (double)(view->columns - 1));
}

double gonio_basis_singular_value(const gonio_basis *basis, size_t k)
{
    return k < basis->variance_count ? gonio_i_singular_value(&basis->view, k) : 0.0;
}

double gonio_basis_cumulative_variance(const gonio_basis *basis, size_t k)
{
    double first = 0.0;
    double all = 0.0;
    for (size_t j = 0; j < basis->variance_count; j++) {
        first += j < k ? basis->variances[j] : 0.0;
        all += basis->variances[j];
    }
    return all > 0.0 ? first / all : 0.0;
}

size_t gonio_basis_position(const gonio_basis *basis, int32_t cell)
{
    const bool held = cell >= 0 && cell < gonio_grid_cells(basis->representation);
    return held ? (size_t)basis->position[cell] : basis->cells;
}

int gonio_i_row_bins(const gonio_basis_view *view, size_t row)
{
    return gonio_i_valid_bin_count(view->representation, gonio_i_row_cell(view, row));
}

gonio_half_difference gonio_i_row_coordinates(const gonio_basis_view *view, size_t row,
                                              int *channel)
{
    *channel = gonio_i_channel_of(view->channels, row);
    return gonio_i_cell_direction(view->representation, gonio_i_row_cell(view, row), M_PI / 2.0);
}

int gonio_i_rows_around(const gonio_basis *basis, gonio_half_difference at, int channel,
                        gonio_i_row_weight around[GONIO_I_MOST_POINTS])
{
    gonio_i_cell_weight cells[GONIO_I_MOST_POINTS];
    const int points = gonio_i_cells_around(basis->representation, at, cells);
    for (int k = 0; k < points; k++) {
        const size_t position = gonio_basis_position(basis, cells[k].cell);
        around[k] = (gonio_i_row_weight){gonio_i_row_of(basis->channels, position, channel),
                                         cells[k].weight};
    }
    return points;
}

bool gonio_basis_row_at(const gonio_basis *basis, gonio_half_difference coordinates, int channel,
                        size_t components, double *mean, double *row)
{
    const bool held = basis->channels != GONIO_JOINT || (channel >= 0 && channel < GONIO_CHANNELS);
    if (!held || components > basis->components) {
        return false;
    }
    gonio_i_basis_row_at(basis, coordinates, channel, components, mean, row);
    return true;
}

void gonio_i_basis_row_at(const gonio_basis *basis, gonio_half_difference coordinates, int channel,
                          size_t components, double *mean, double *row)
{
    gonio_i_row_weight around[GONIO_I_MOST_POINTS];
    const int points = gonio_i_rows_around(basis, coordinates, channel, around);
    *mean = 0.0;
    memset(row, 0, components * sizeof *row);
    for (int k = 0; k < points; k++) {
        const float *source = basis->vectors + around[k].row * basis->components;
        *mean += around[k].weight * basis->mean[around[k].row];
        for (size_t j = 0; j < components; j++) {
            row[j] += around[k].weight * (double)source[j];
        }
    }
}
