/* The observation matrix: materials are read once, mapped to log space, and kept in unlinked
 * scratch files.
 *
 * Only cells that can hold data are stored: the valid bins of the full grid, all cells of the
 * bivariate one. They are divided into tiles of neighbouring cells of one slab. Scratch layout:
 * [tile][material][column of the material][row in the tile], where a tile's rows are those of all
 * its stored cells, in the order of the matrix; a cell without data holds NaN.
 *
 * Values are float32, because the matrix is read twice. The relative error of 6e-8 is far below the
 * noise of any measurement, and its effect on a basis is as random as that noise. */
#include <gonio/database.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../core/options.h"
#include "../core/vector_math.h"
#include "../direction/grid.h"
#include "layout.h"
#include "scratch.h"
#include "slab_mean.h"
#include "tiles.h"

/* A tile of all materials fits into a processor's cache. A tile of one material is large enough for
 * a system call. */
enum { TILE_VALUES = 1 << 19, LARGEST_TILE = 1024, SMALLEST_TILE = 64 };

/* Bits: whether some material has data in a cell, and whether some material lacks it. */
enum { HAS_DATA = 1, LACKS_DATA = 2 };

typedef struct cell_tile {
    size_t first; /* of its stored cells */
    size_t count;
    size_t kept; /* position of its first cell that is kept */
} cell_tile;

struct gonio_database {
    gonio_database_options options;
    gonio_i_scratch scratch;
    size_t materials;
    char **names;
    uint64_t *fingerprints;
    size_t stored_count;
    int32_t *stored; /* [stored_count] cells of the grid, ascending */
    size_t tiles;
    cell_tile *tile;                           /* [tiles + 1], the last one empty */
    size_t slab_tiles[GONIO_THETA_H_BINS + 1]; /* the first tile of each slab */
    uint8_t first_phi[GONIO_CELLS];            /* grid.h */
    double inverse_scale[GONIO_CHANNELS];      /* 1/s, of values already divided by a bin's own s */
    size_t cells;
    int32_t *cell; /* those of `stored` that are kept */
    gonio_database_view view;
};

void gonio_database_options_default_of(gonio_database_options *options, size_t size)
{
    const gonio_database_options usual = {.representation = GONIO_SECTORED,
                                          .channels = GONIO_SEPARATE};
    gonio_i_give(&usual, sizeof usual, options, size);
}

/* ---- tiles ---- */

static size_t per_cell(const gonio_database *database)
{
    return gonio_i_rows_per_cell(database->options.channels);
}

static size_t tile_cells(const gonio_database *database)
{
    const size_t cells = TILE_VALUES / (GONIO_CHANNELS * database->materials);
    return cells < SMALLEST_TILE ? SMALLEST_TILE : cells > LARGEST_TILE ? LARGEST_TILE : cells;
}

/* 1/s of the channels. Bins with a scale of their own are divided by that scale before. */
static void find_scales(gonio_database *database)
{
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        database->inverse_scale[channel] =
            database->options.mapping == GONIO_LOG ? 1.0 / gonio_log_scale(channel) : 1.0;
    }
}

static void find_valid_bins(gonio_database *database)
{
    for (int cell = 0; cell < GONIO_CELLS; cell++) {
        const gonio_bin bin = gonio_cell_bin(GONIO_BIVARIATE, cell);
        database->first_phi[cell] = (uint8_t)gonio_i_first_valid_phi(bin.theta_h, bin.theta_d);
    }
}

/* Lists the stored cells of one slab: those with valid bins, and all bivariate ones. Returns their
 * number. */
static size_t list_cells(const gonio_database *database, int theta_h, int32_t *stored)
{
    const gonio_representation representation = database->options.representation;
    const int32_t slab = gonio_grid_cells(representation) / GONIO_THETA_H_BINS;
    size_t count = 0;
    for (int32_t cell = theta_h * slab; cell < (theta_h + 1) * slab; cell++) {
        const gonio_i_bin_run all = gonio_i_cell_bins(representation, cell);
        const int first = database->first_phi[theta_h * GONIO_THETA_D_BINS + all.first.theta_d];
        stored[count] = cell;
        count += all.count == GONIO_PHI_D_BINS || gonio_i_valid_bins(all, first).count > 0;
    }
    return count;
}

static gonio_status lay_out(gonio_context *context, gonio_database *database)
{
    const size_t most = tile_cells(database);
    const size_t slab =
        (size_t)gonio_grid_cells(database->options.representation) / GONIO_THETA_H_BINS;
    const size_t tiles = GONIO_THETA_H_BINS * ((slab + most - 1) / most);
    database->stored =
        gonio_i_allocate(context, GONIO_THETA_H_BINS * slab, sizeof *database->stored);
    database->tile = gonio_i_allocate(context, tiles + 1, sizeof *database->tile);
    if (database->stored == NULL || database->tile == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    find_scales(database);
    find_valid_bins(database);
    size_t first = 0;
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
        const size_t end = first + list_cells(database, theta_h, database->stored + first);
        database->slab_tiles[theta_h] = database->tiles;
        for (; first < end; first += database->tile[database->tiles++].count) {
            const size_t count = end - first < most ? end - first : most;
            database->tile[database->tiles] = (cell_tile){.first = first, .count = count};
        }
    }
    database->slab_tiles[GONIO_THETA_H_BINS] = database->tiles;
    database->stored_count = first;
    database->tile[database->tiles].first = first;
    return GONIO_OK;
}

/* The offset of a material's rows of a tile in the scratch file. */
static off_t tile_offset(const gonio_database *database, const cell_tile *t, size_t material)
{
    const size_t values = database->materials * t->first + material * t->count;
    return (off_t)(values * GONIO_CHANNELS * sizeof(float));
}

/* ---- reading materials ---- */

/* Buffers of one thread that reads materials. */
typedef struct reader {
    double *rho;   /* one slab */
    double *scale; /* of its bins, where each has its own */
    double *g;     /* its stored cells in log space: [cell][channel] or [channel][cell] */
    bool *data;    /* [cell] of the slab */
    float *rows;   /* a tile's part of the scratch file */
    uint8_t *seen; /* [stored cell] HAS_DATA, LACKS_DATA: of the materials of this thread */
} reader;

static bool make_reader(gonio_context *context, const gonio_database *database, reader *r)
{
    r->rho = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof *r->rho);
    const bool relative = database->options.mapping == GONIO_LOG_RELATIVE;
    r->scale = gonio_i_allocate(context, relative ? GONIO_SLAB_BINS : 1, sizeof *r->scale);
    r->g = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof *r->g);
    r->data = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof *r->data);
    r->rows = gonio_i_allocate(context, GONIO_CHANNELS * tile_cells(database), sizeof *r->rows);
    r->seen = gonio_i_allocate(context, database->stored_count, sizeof *r->seen);
    return r->rho != NULL && r->scale != NULL && r->g != NULL && r->data != NULL &&
           r->rows != NULL && r->seen != NULL;
}

static void free_reader(reader *r)
{
    free(r->rho);
    free(r->scale);
    free(r->g);
    free(r->data);
    free(r->rows);
    free(r->seen);
}

/* The storage order of a slab in reader.g. */
typedef struct strides {
    size_t cell;
    size_t channel;
} strides;

GONIO_I_VECTORISED static void scale_run(const double *rho, size_t count, double factor, double *x)
{
    for (size_t k = 0; k < count; k++) {
        x[k] = rho[k] > 0.0 ? rho[k] * factor : 0.0;
    }
}

/* Divides a slab by the scale of each bin. Bins without data stay below 0. */
GONIO_I_VECTORISED static void divide_slab(const double *scale, double *rho)
{
    for (size_t plane = 0; plane < GONIO_SLAB_VALUES; plane += GONIO_SLAB_BINS) {
        for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
            rho[plane + k] /= scale[k];
        }
    }
}

GONIO_I_VECTORISED static void find_data(const double *rho, size_t count, bool *data)
{
    for (size_t k = 0; k < count; k++) {
        data[k] = rho[k] >= 0.0;
    }
}

/* The valid bins of a slab of the full grid, in log space, [channel][cell]. */
static strides full_rows(const gonio_database *database, int theta_h, const reader *r)
{
    size_t count = 0;
    for (size_t d = 0; d < GONIO_THETA_D_BINS; d++) {
        const size_t first = database->first_phi[(size_t)theta_h * GONIO_THETA_D_BINS + d];
        const size_t length = GONIO_PHI_D_BINS - 2 * first;
        const double *rho = r->rho + d * GONIO_PHI_D_BINS + first;
        find_data(rho, length, r->data + count);
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            scale_run(rho + channel * GONIO_SLAB_BINS, length, database->inverse_scale[channel],
                      r->g + channel * GONIO_SLAB_BINS + count);
        }
        count += length;
    }
    for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
        double *g = r->g + channel * GONIO_SLAB_BINS;
        gonio_i_log1p(count, g, g);
    }
    return (strides){1, GONIO_SLAB_BINS};
}

/* The mean over a sector's bins with data, in `first` .. `end` - 1 of [channel][bin]. */
static void reduce_sector(const reader *r, size_t first, size_t end, size_t cell)
{
    size_t count = 0;
    double sum[GONIO_CHANNELS] = {0.0};
    for (size_t k = first; k < end; k++) {
        for (size_t channel = 0; channel < GONIO_CHANNELS && r->data[k]; channel++) {
            sum[channel] += r->g[channel * GONIO_SLAB_BINS + k];
        }
        count += r->data[k];
    }
    for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
        r->g[channel * GONIO_SLAB_BINS + cell] = count > 0 ? sum[channel] / (double)count : 0.0;
    }
    r->data[cell] = count > 0;
}

/* The cells of a slab of the sectored grid, [channel][cell]: the bins of the full grid are reduced
 * in place. A sector's index is never larger than that of its bins. */
static strides sectored_rows(const gonio_database *database, int theta_h, const reader *r)
{
    const strides step = full_rows(database, theta_h, r);
    size_t bin = 0;
    size_t cell = 0;
    for (size_t d = 0; d < GONIO_THETA_D_BINS; d++) {
        const size_t first = database->first_phi[(size_t)theta_h * GONIO_THETA_D_BINS + d];
        const size_t last = GONIO_PHI_D_BINS - first;
        for (size_t p = first; p < last;) {
            const size_t edge = (p / GONIO_SECTOR_BINS + 1) * GONIO_SECTOR_BINS;
            const size_t end = edge < last ? edge : last;
            reduce_sector(r, bin, bin + end - p, cell++);
            bin += end - p;
            p = end;
        }
    }
    return step;
}

/* The cells of a slab of the bivariate grid, [cell][channel]. */
static strides bivariate_rows(const gonio_database *database, int theta_h, const reader *r)
{
    gonio_i_slab_mean(database->first_phi + (size_t)theta_h * GONIO_THETA_D_BINS, r->rho,
                      database->inverse_scale, r->g);
    for (size_t k = 0; k < GONIO_THETA_D_BINS; k++) {
        r->data[k] = !isnan(r->g[k * GONIO_CHANNELS]);
    }
    return (strides){GONIO_CHANNELS, 1};
}

GONIO_I_VECTORISED static void to_float(const double *g, size_t step, const bool *data,
                                        size_t count, float *row, size_t row_step)
{
    if (step == 1 && row_step == 1) { /* the case that counts */
        for (size_t k = 0; k < count; k++) {
            row[k] = data[k] ? (float)g[k] : NAN;
        }
        return;
    }
    for (size_t k = 0; k < count; k++) {
        row[k * row_step] = data[k] ? (float)g[k * step] : NAN;
    }
}

/* Writes a slab's tiles; `from` is the slab's first stored cell. */
static gonio_status write_tiles(gonio_context *context, const gonio_database *database,
                                size_t column, int theta_h, const reader *r, strides step)
{
    const size_t from = database->tile[database->slab_tiles[theta_h]].first;
    const bool joint = database->options.channels == GONIO_JOINT;
    gonio_status status = GONIO_OK;
    for (size_t j = database->slab_tiles[theta_h];
         j < database->slab_tiles[theta_h + 1] && status == GONIO_OK; j++) {
        const cell_tile *t = &database->tile[j];
        const size_t k = t->first - from;
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            to_float(r->g + k * step.cell + channel * step.channel, step.cell, r->data + k,
                     t->count, r->rows + channel * (joint ? 1 : t->count), per_cell(database));
        }
        status = gonio_i_scratch_write(context, &database->scratch, j, r->rows,
                                       GONIO_CHANNELS * t->count * sizeof *r->rows,
                                       tile_offset(database, t, column));
    }
    return status;
}

/* Marks the cells of a slab in which a material has or lacks data. Returns the number with data. */
GONIO_I_VECTORISED static size_t mark_seen(const bool *data, size_t count, uint8_t *seen)
{
    size_t with_data = 0;
    for (size_t k = 0; k < count; k++) {
        seen[k] |= data[k] ? HAS_DATA : LACKS_DATA;
        with_data += data[k];
    }
    return with_data;
}

/* Reads one slab of a material into the scratch file; counts the material's cells with data. */
static gonio_status read_slab(gonio_context *context, const gonio_database *database, size_t column,
                              const gonio_material *material, int theta_h, const reader *r,
                              gonio_fingerprint *fingerprint, size_t *with_data)
{
    gonio_status status = gonio_material_read_slab(context, material, theta_h, r->rho);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_fingerprint_add(fingerprint, r->rho, GONIO_SLAB_VALUES * sizeof *r->rho);
    if (database->options.mapping == GONIO_LOG_RELATIVE) {
        gonio_slab_scale(GONIO_LOG_RELATIVE, 0, theta_h, r->scale);
        divide_slab(r->scale, r->rho);
    }
    static strides (*const rows_of[])(const gonio_database *, int,
                                      const reader *) = {[GONIO_BIVARIATE] = bivariate_rows,
                                                         [GONIO_FULL] = full_rows,
                                                         [GONIO_SECTORED] = sectored_rows};
    const strides step = rows_of[database->options.representation](database, theta_h, r);
    const size_t first = database->tile[database->slab_tiles[theta_h]].first;
    const size_t end = database->tile[database->slab_tiles[theta_h + 1]].first;
    *with_data += mark_seen(r->data, end - first, r->seen + first);
    return write_tiles(context, database, column, theta_h, r, step);
}

static gonio_status read_slabs(gonio_context *context, gonio_database *database, size_t column,
                               const gonio_material *material, const reader *r, size_t *with_data)
{
    gonio_fingerprint *fingerprint = NULL;
    gonio_status status = gonio_fingerprint_create(&fingerprint);
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS && status == GONIO_OK; theta_h++) {
        status = read_slab(context, database, column, material, theta_h, r, fingerprint, with_data);
    }
    if (status == GONIO_OK) {
        database->fingerprints[column] = gonio_fingerprint_value(fingerprint);
    }
    gonio_fingerprint_free(&fingerprint);
    return status;
}

/* Materials to learn from: files, opened one at a time, or materials in memory. */
typedef struct sources {
    const char *const *path;               /* [materials] or NULL */
    const gonio_material *const *material; /* [materials] or NULL */
} sources;

/* name: for messages. */
static gonio_status take_material(gonio_context *context, gonio_database *database, size_t column,
                                  const gonio_material *material, const char *name, const reader *r)
{
    database->names[column] = strdup(gonio_material_name(material));
    size_t with_data = 0;
    const gonio_status status =
        database->names[column] == NULL
            ? GONIO_ERROR_MEMORY
            : read_slabs(context, database, column, material, r, &with_data);
    if (status == GONIO_OK && with_data == 0) {
        return gonio_i_fail(context, GONIO_ERROR_DATA,
                            "%s: the material holds no data at all; leave it out", name);
    }
    return status;
}

static gonio_status read_material(gonio_context *context, gonio_database *database, size_t column,
                                  const sources *from, const reader *r)
{
    if (from->material != NULL) {
        const gonio_material *given = from->material[column];
        return take_material(context, database, column, given, gonio_material_name(given), r);
    }
    gonio_material *opened = NULL;
    const char *path = from->path[column];
    gonio_status status = gonio_material_open(context, path, &opened);
    if (status == GONIO_OK) {
        status = take_material(context, database, column, opened, path, r);
    }
    gonio_material_free(&opened);
    return status;
}

static gonio_status read_materials(gonio_context *context, gonio_database *database,
                                   const sources *from, uint8_t *seen)
{
    gonio_status result = GONIO_OK;
    size_t finished = 0;
    gonio_context *shared = gonio_i_shared_context_begin(context);
#pragma omp parallel num_threads(gonio_context_threads(context))
    {
        reader r = {0};
        gonio_status mine = make_reader(shared, database, &r) ? GONIO_OK : GONIO_ERROR_MEMORY;
#pragma omp for schedule(dynamic)
        for (size_t k = 0; k < database->materials; k++) {
            gonio_status so_far;
#pragma omp atomic read
            so_far = result;
            if (mine == GONIO_OK && so_far == GONIO_OK) {
                mine = read_material(shared, database, k, from, &r);
            }
            size_t done;
#pragma omp atomic capture
            done = ++finished;
            if (mine == GONIO_OK) {
                mine = gonio_i_progress(shared, "reading materials",
                                        (double)done / (double)database->materials);
            }
            if (mine != GONIO_OK) {
#pragma omp atomic write
                result = mine;
            }
        }
#pragma omp critical(gonio_database_seen)
        for (size_t k = 0; r.seen != NULL && k < database->stored_count; k++) {
            seen[k] |= r.seen[k];
        }
        free_reader(&r);
    }
    gonio_i_shared_context_end(shared, context);
    return result;
}

/* Keeps the cells in which all materials have data. Warns if many are lost, and names the material
 * that lacks most. */
static gonio_status keep_common_cells(gonio_context *context, gonio_database *database,
                                      const uint8_t *seen)
{
    size_t any = 0;
    size_t kept = 0;
    for (size_t k = 0; k < database->stored_count; k++) {
        any += (seen[k] & HAS_DATA) != 0;
        kept += seen[k] == HAS_DATA;
    }
    if (kept == 0) {
        return gonio_i_fail(context, GONIO_ERROR_DATA,
                            "no cell of the grid has data in every material; leave out the "
                            "material with the most holes (gonio info shows them)");
    }
    database->cell = gonio_i_allocate(context, kept, sizeof *database->cell);
    if (database->cell == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t j = 0; j < database->tiles; j++) {
        cell_tile *t = &database->tile[j];
        t->kept = database->cells;
        for (size_t k = t->first; k < t->first + t->count; k++) {
            if (seen[k] == HAS_DATA) {
                database->cell[database->cells++] = database->stored[k];
            }
        }
    }
    database->tile[database->tiles].kept = database->cells;
    if ((double)kept < 0.95 * (double)any) {
        gonio_i_warn(context,
                     "%zu of %zu cells are left out because some material has no data there; "
                     "gonio info shows each material's share",
                     any - kept, any);
    }
    return GONIO_OK;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static gonio_status check_names(gonio_context *context, const gonio_database *database)
{
    char **sorted = gonio_i_allocate(context, database->materials, sizeof *sorted);
    if (sorted == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(sorted, database->names, database->materials * sizeof *sorted);
    qsort(sorted, database->materials, sizeof *sorted, compare_names);
    gonio_status status = GONIO_OK;
    for (size_t k = 1; k < database->materials && status == GONIO_OK; k++) {
        if (strcmp(sorted[k - 1], sorted[k]) == 0) {
            status = gonio_i_fail(context, GONIO_ERROR_DATA,
                                  "two materials are called '%s': give each once, under one name",
                                  sorted[k]);
        }
    }
    free(sorted);
    return status;
}

static gonio_status fill(gonio_context *context, gonio_database *database, const sources *from)
{
    gonio_status status =
        gonio_i_scratch_open(context, database->options.scratch, &database->scratch);
    if (status == GONIO_OK) {
        status = lay_out(context, database);
    }
    if (status != GONIO_OK) {
        return status;
    }
    uint8_t *seen = gonio_i_allocate(context, database->stored_count, sizeof *seen);
    if (seen == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    status = read_materials(context, database, from, seen);
    if (status == GONIO_OK) {
        status = check_names(context, database);
    }
    if (status == GONIO_OK) {
        status = keep_common_cells(context, database, seen);
    }
    free(seen);
    return status;
}

static gonio_database_view view_of(const gonio_database *database)
{
    return (gonio_database_view){
        .representation = database->options.representation,
        .channels = database->options.channels,
        .mapping = database->options.mapping,
        .materials = database->materials,
        .names = (const char *const *)database->names,
        .fingerprints = database->fingerprints,
        .columns = gonio_i_columns_per_material(database->options.channels) * database->materials,
        .cells = database->cells,
        .cell = database->cell,
        .rows = per_cell(database) * database->cells,
    };
}

static gonio_status check_kind(gonio_context *context, const gonio_database_options *options)
{
    if (gonio_representation_name(options->representation) == NULL ||
        gonio_channel_model_name(options->channels) == NULL ||
        gonio_mapping_name(options->mapping) == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "no representation, channel model and mapping have the numbers %d, %d "
                            "and %d",
                            (int)options->representation, (int)options->channels,
                            (int)options->mapping);
    }
    if (options->representation == GONIO_SECTORED && options->mapping == GONIO_LOG_RELATIVE) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "the relative mapping needs the full or the bivariate grid, not "
                            "sectors (gonio learn --grid full)");
    }
    return GONIO_OK;
}

static gonio_status create(gonio_context *context, const sources *from, size_t count,
                           const gonio_database_options *options, gonio_database **database)
{
    gonio_database_options how;
    const gonio_status given = GONIO_I_TAKE(context, gonio_database_options, options, &how);
    if (given != GONIO_OK) {
        return given;
    }
    if (count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "no materials given");
    }
    const gonio_status checked = check_kind(context, &how);
    if (checked != GONIO_OK) {
        return checked;
    }
    gonio_database *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->options = how;
    gonio_i_scratch_init(&made->scratch);
    made->materials = count;
    made->names = gonio_i_allocate(context, count, sizeof *made->names);
    made->fingerprints = gonio_i_allocate(context, count, sizeof *made->fingerprints);
    const gonio_status status = made->names == NULL || made->fingerprints == NULL
                                    ? GONIO_ERROR_MEMORY
                                    : fill(context, made, from);
    if (status != GONIO_OK) {
        gonio_database_free(&made);
        return status;
    }
    made->options.scratch = NULL;
    made->view = view_of(made);
    *database = made;
    return GONIO_OK;
}

gonio_status gonio_database_create(gonio_context *context, const char *const *paths, size_t count,
                                   const gonio_database_options *options, gonio_database **database)
{
    return create(context, &(sources){.path = paths}, count, options, database);
}

gonio_status gonio_database_create_from_materials(gonio_context *context,
                                                  const gonio_material *const *materials,
                                                  size_t count,
                                                  const gonio_database_options *options,
                                                  gonio_database **database)
{
    return create(context, &(sources){.material = materials}, count, options, database);
}

void gonio_database_free(gonio_database **database)
{
    if (database == NULL || *database == NULL) {
        return;
    }
    gonio_database *old = *database;
    gonio_i_scratch_close(&old->scratch);
    for (size_t k = 0; old->names != NULL && k < old->materials; k++) {
        free(old->names[k]);
    }
    free(old->names);
    free(old->fingerprints);
    free(old->stored);
    free(old->tile);
    free(old->cell);
    free(old);
    *database = NULL;
}

const gonio_database_view *gonio_database_describe(const gonio_database *database)
{
    return &database->view;
}

/* ---- reading the matrix ---- */

size_t gonio_i_database_tiles(const gonio_database *database)
{
    return database->tiles;
}

gonio_i_row_range gonio_i_database_tile_rows(const gonio_database *database, size_t tile)
{
    const size_t first = database->tile[tile].kept;
    const size_t end = database->tile[tile + 1].kept;
    return (gonio_i_row_range){per_cell(database) * first, per_cell(database) * (end - first)};
}

size_t gonio_i_database_tile_room(const gonio_database *database)
{
    return per_cell(database) * tile_cells(database);
}

/* Removes the cells that are left out from the columns of a tile. */
static void drop_rows(const gonio_database *database, size_t tile, size_t columns, float *block)
{
    const size_t rows = per_cell(database);
    const size_t stored = database->tile[tile].count;
    const int32_t *cell = database->stored + database->tile[tile].first;
    const int32_t *kept = database->cell + database->tile[tile].kept;
    const int32_t *end = database->cell + database->tile[tile + 1].kept;
    float *to = block;
    for (size_t column = 0; column < columns; column++) {
        const int32_t *next = kept;
        for (size_t k = 0; k < stored && next < end; k++) {
            if (cell[k] == *next) {
                memmove(to, block + (column * stored + k) * rows, rows * sizeof *to);
                to += rows;
                next++;
            }
        }
    }
}

gonio_status gonio_i_database_read_tile(gonio_context *context, const gonio_database *database,
                                        size_t tile, const size_t *subset, size_t subset_count,
                                        float *block)
{
    const cell_tile *t = &database->tile[tile];
    const size_t materials = subset != NULL ? subset_count : database->materials;
    const size_t together = subset != NULL ? 1 : materials; /* all lie in one piece */
    const size_t values = GONIO_CHANNELS * t->count;
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < materials && status == GONIO_OK; k += together) {
        status = gonio_i_scratch_read(context, &database->scratch, tile, block + k * values,
                                      together * values * sizeof *block,
                                      tile_offset(database, t, subset != NULL ? subset[k] : 0));
    }
    if (status == GONIO_OK && t[1].kept - t->kept < t->count) {
        drop_rows(database, tile,
                  materials * gonio_i_columns_per_material(database->options.channels), block);
    }
    return status;
}

static gonio_status check_request(gonio_context *context, const gonio_database_view *view,
                                  size_t first, size_t count, const size_t *subset,
                                  size_t subset_count)
{
    if (count == 0 || first >= view->rows || count > view->rows - first) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "rows %zu to %zu are outside a matrix of %zu rows", first,
                            first + count, view->rows);
    }
    for (size_t k = 0; subset != NULL && k < subset_count; k++) {
        if (subset[k] >= view->materials) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                "material %zu is outside a database of %zu", subset[k],
                                view->materials);
        }
    }
    return GONIO_OK;
}

/* Copies the rows of a tile that are in first .. first + count - 1 to block[column][count]. */
static void copy_rows(gonio_i_row_range rows, const float *values, size_t columns, size_t first,
                      size_t count, double *block)
{
    const size_t from = first > rows.first ? first : rows.first;
    const size_t last = rows.first + rows.count;
    const size_t end = first + count < last ? first + count : last;
    for (size_t column = 0; column < columns; column++) {
        for (size_t row = from; row < end; row++) {
            block[column * count + row - first] = values[column * rows.count + row - rows.first];
        }
    }
}

gonio_status gonio_database_read_rows(gonio_context *context, const gonio_database *database,
                                      size_t first, size_t count, const size_t *subset,
                                      size_t subset_count, double *block)
{
    const gonio_database_view *view = gonio_database_describe(database);
    gonio_status status = check_request(context, view, first, count, subset, subset_count);
    if (status != GONIO_OK) {
        return status;
    }
    const size_t materials = subset != NULL ? subset_count : view->materials;
    const size_t columns = gonio_i_columns_per_material(database->options.channels) * materials;
    float *values =
        gonio_i_allocate(context, columns * gonio_i_database_tile_room(database), sizeof *values);
    status = values == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t tile = 0; tile < database->tiles && status == GONIO_OK; tile++) {
        const gonio_i_row_range rows = gonio_i_database_tile_rows(database, tile);
        if (rows.first < first + count && rows.first + rows.count > first) {
            status =
                gonio_i_database_read_tile(context, database, tile, subset, subset_count, values);
            if (status == GONIO_OK) {
                copy_rows(rows, values, columns, first, count, block);
            }
        }
    }
    free(values);
    return status;
}
