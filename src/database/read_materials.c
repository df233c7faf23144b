/* Materials read into the scratch files of an observation matrix, several at a time. */
#include "matrix.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "slab_cells.h"

/* Buffers of one thread that reads materials. */
typedef struct reader {
    gonio_i_slab_cells slab;
    float *rows;   /* a tile's part of the scratch file */
    uint8_t *seen; /* [stored cell] GONIO_I_HAS_DATA, GONIO_I_LACKS_DATA: of the materials of this
                      thread */
} reader;

static bool make_reader(gonio_context *context, const gonio_database *database, reader *r)
{
    r->slab.rho = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof *r->slab.rho);
    const bool relative = database->options.mapping == GONIO_LOG_RELATIVE;
    r->slab.scale =
        gonio_i_allocate(context, relative ? GONIO_SLAB_BINS : 1, sizeof *r->slab.scale);
    r->slab.g = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof *r->slab.g);
    r->slab.data = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof *r->slab.data);
    r->rows =
        gonio_i_allocate(context, GONIO_CHANNELS * gonio_i_tile_cells(database), sizeof *r->rows);
    r->seen = gonio_i_allocate(context, database->stored_count, sizeof *r->seen);
    return r->slab.rho != NULL && r->slab.scale != NULL && r->slab.g != NULL &&
           r->slab.data != NULL && r->rows != NULL && r->seen != NULL;
}

static void free_reader(reader *r)
{
    free(r->slab.rho);
    free(r->slab.scale);
    free(r->slab.g);
    free(r->slab.data);
    free(r->rows);
    free(r->seen);
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
                                size_t column, int theta_h, const reader *r)
{
    const gonio_i_strides step = gonio_i_slab_strides(database->options.representation);
    const size_t from = database->tile[database->slab_tiles[theta_h]].first;
    const bool joint = database->options.channels == GONIO_JOINT;
    gonio_status status = GONIO_OK;
    for (size_t j = database->slab_tiles[theta_h];
         j < database->slab_tiles[theta_h + 1] && status == GONIO_OK; j++) {
        const gonio_i_cell_tile *t = &database->tile[j];
        const size_t k = t->first - from;
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            to_float(r->slab.g + k * step.cell + channel * step.channel, step.cell,
                     r->slab.data + k, t->count, r->rows + channel * (joint ? 1 : t->count),
                     gonio_i_rows_per_cell(database->options.channels));
        }
        status = gonio_i_scratch_write(context, &database->scratch, j, r->rows,
                                       GONIO_CHANNELS * t->count * sizeof *r->rows,
                                       gonio_i_tile_offset(database, t, column));
    }
    return status;
}

/* Copies the kept cells of one channel of a slab, from one tile on, to a material's columns. */
static void keep_cells(const gonio_database *database, const gonio_i_cell_tile *t, size_t from,
                       size_t channel, const gonio_i_slab_cells *slab, float *columns)
{
    const gonio_i_strides step = gonio_i_slab_strides(database->options.representation);
    const gonio_channel_model channels = database->options.channels;
    const size_t rows = gonio_i_rows_per_cell(channels) * database->cells;
    float *column = columns + (channels == GONIO_JOINT ? 0 : channel * rows);
    size_t kept = t->kept;
    for (size_t k = t->first; k < t->first + t->count && kept < t[1].kept; k++) {
        if (database->stored[k] == database->cell[kept]) {
            const size_t row = gonio_i_row_of(channels, kept++, (int)channel);
            const double g = slab->g[(k - from) * step.cell + channel * step.channel];
            column[row] = slab->data[k - from] ? (float)g : NAN;
        }
    }
}

static gonio_status read_other_slab(gonio_context *context, const gonio_database *database,
                                    const gonio_material *material, int theta_h,
                                    const gonio_i_slab_cells *slab, float *columns)
{
    const size_t from = database->tile[database->slab_tiles[theta_h]].first;
    const gonio_status status = gonio_material_read_slab(context, material, theta_h, slab->rho);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_i_slab_to_cells(database, theta_h, slab);
    for (size_t j = database->slab_tiles[theta_h]; j < database->slab_tiles[theta_h + 1]; j++) {
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            keep_cells(database, &database->tile[j], from, channel, slab, columns);
        }
    }
    return GONIO_OK;
}

gonio_status gonio_i_database_read_other(gonio_context *context, const gonio_database *database,
                                         const gonio_material *material, float *columns)
{
    reader r = {0};
    gonio_status status = make_reader(context, database, &r) ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS && status == GONIO_OK; theta_h++) {
        status = read_other_slab(context, database, material, theta_h, &r.slab, columns);
    }
    free_reader(&r);
    return status;
}

/* Marks the cells of a slab in which a material has or lacks data. Returns the number with data. */
GONIO_I_VECTORISED static size_t mark_seen(const bool *data, size_t count, uint8_t *seen)
{
    size_t with_data = 0;
    for (size_t k = 0; k < count; k++) {
        seen[k] |= data[k] ? GONIO_I_HAS_DATA : GONIO_I_LACKS_DATA;
        with_data += data[k];
    }
    return with_data;
}

/* Reads one slab of a material into the scratch file; counts the material's cells with data. */
static gonio_status read_slab(gonio_context *context, const gonio_database *database, size_t column,
                              const gonio_material *material, int theta_h, const reader *r,
                              gonio_fingerprint *fingerprint, size_t *with_data)
{
    gonio_status status = gonio_material_read_slab(context, material, theta_h, r->slab.rho);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_fingerprint_add(fingerprint, r->slab.rho, GONIO_SLAB_VALUES * sizeof *r->slab.rho);
    gonio_i_slab_to_cells(database, theta_h, &r->slab);
    const size_t first = database->tile[database->slab_tiles[theta_h]].first;
    const size_t end = database->tile[database->slab_tiles[theta_h + 1]].first;
    *with_data += mark_seen(r->slab.data, end - first, r->seen + first);
    return write_tiles(context, database, column, theta_h, r);
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

/* name: for messages. */
static gonio_status take_material(gonio_context *context, gonio_database *database, size_t column,
                                  const gonio_material *material, const char *name, const reader *r)
{
    database->names[column] = strdup(gonio_material_name(material));
    database->anisotropic[column] = gonio_material_describe(material)->anisotropic;
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
                                  const gonio_i_sources *from, const reader *r)
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

gonio_status gonio_i_database_read_materials(gonio_context *context, gonio_database *database,
                                             const gonio_i_sources *from, uint8_t *seen)
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
