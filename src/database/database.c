/* The observation matrix: materials read once, in log space, kept in an unlinked scratch file.
 *
 * Scratch layout: [material][cell of the whole grid][channel], float64, NaN where there is no data.
 */
#include <gonio/database.h>

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../core/core.h"
#include "slab_mean.h"

struct gonio_database {
    gonio_database_options options;
    int scratch;
    size_t materials;
    char **names;
    uint64_t *fingerprints;
    size_t cells;
    int32_t *cell;
};

void gonio_database_options_default(gonio_database_options *options)
{
    *options = (gonio_database_options){0};
}

static size_t grid_cells(gonio_representation representation)
{
    return representation == GONIO_BIVARIATE ? GONIO_CELLS : GONIO_BINS;
}

static gonio_status open_scratch(gonio_context *context, const char *folder, int *descriptor)
{
    const char *wanted = folder != NULL ? folder : getenv("TMPDIR");
    const char *used = wanted != NULL && *wanted != '\0' ? wanted : "/tmp";
    char *name = gonio_i_format("%s/gonio-XXXXXX", used);
    if (name == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *descriptor = mkostemp(name, O_CLOEXEC);
    const int reason = errno;
    if (*descriptor >= 0) {
        unlink(name);
    }
    free(name);
    if (*descriptor < 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO,
                            "%s: cannot make a scratch file: %s; set TMPDIR to another folder",
                            used, strerror(reason));
    }
    return GONIO_OK;
}

static gonio_status scratch_write(gonio_context *context, int descriptor, const void *data,
                                  size_t size, off_t offset)
{
    const char *from = data;
    while (size > 0) {
        const ssize_t done = pwrite(descriptor, from, size, offset);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done < 0) {
            return gonio_i_fail(
                context, GONIO_ERROR_IO,
                "cannot write the scratch file: %s; set TMPDIR to a folder with room",
                strerror(errno));
        }
        from += done;
        offset += done;
        size -= (size_t)done;
    }
    return GONIO_OK;
}

static gonio_status scratch_read(gonio_context *context, int descriptor, void *data, size_t size,
                                 off_t offset)
{
    char *to = data;
    while (size > 0) {
        const ssize_t done = pread(descriptor, to, size, offset);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            return gonio_i_fail(context, GONIO_ERROR_IO, "cannot read the scratch file: %s",
                                done < 0 ? strerror(errno) : "it ends early");
        }
        to += done;
        offset += done;
        size -= (size_t)done;
    }
    return GONIO_OK;
}

/* What one thread needs to read materials. */
typedef struct reader {
    double *rho;  /* one slab */
    double *rows; /* its part of the scratch file */
    bool *data;
} reader;

static bool make_reader(gonio_context *context, reader *r)
{
    r->rho = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof *r->rho);
    r->rows = gonio_i_allocate(context, GONIO_SLAB_VALUES, sizeof *r->rows);
    r->data = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof *r->data);
    return r->rho != NULL && r->rows != NULL && r->data != NULL;
}

static void free_reader(reader *r)
{
    free(r->rho);
    free(r->rows);
    free(r->data);
}

/* [cell][channel] of one slab of the full grid, where every bin is a cell. */
static void full_rows(int theta_h, const reader *r)
{
    gonio_slab_mask(theta_h, r->rho, r->data);
    gonio_slab_to_log(r->rho, r->rho);
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            r->rows[k * GONIO_CHANNELS + channel] =
                r->data[k] ? r->rho[channel * GONIO_SLAB_BINS + k] : NAN;
        }
    }
}

/* Reads one slab of a material into the scratch file; counts the materials with data per cell, and
 * the material's cells with data. */
static gonio_status read_slab(gonio_context *context, const gonio_database *database, size_t column,
                              const gonio_material *material, int theta_h, const reader *r,
                              gonio_fingerprint *fingerprint, uint32_t *present, size_t *with_data)
{
    gonio_status status = gonio_material_read_slab(material, context, theta_h, r->rho);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_fingerprint_add(fingerprint, r->rho, GONIO_SLAB_VALUES * sizeof *r->rho);
    const bool bivariate = database->options.representation == GONIO_BIVARIATE;
    if (bivariate) {
        gonio_i_slab_mean(theta_h, r->rho, r->rows);
    } else {
        full_rows(theta_h, r);
    }
    const size_t cells = bivariate ? GONIO_THETA_D_BINS : GONIO_SLAB_BINS;
    const size_t first = (size_t)theta_h * cells;
    for (size_t k = 0; k < cells; k++) {
        if (!isnan(r->rows[k * GONIO_CHANNELS])) {
#pragma omp atomic
            present[first + k]++;
            (*with_data)++;
        }
    }
    const size_t size = GONIO_CHANNELS * sizeof *r->rows;
    const size_t start = column * grid_cells(database->options.representation) + first;
    return scratch_write(context, database->scratch, r->rows, cells * size, (off_t)(start * size));
}

static gonio_status read_slabs(gonio_context *context, gonio_database *database, size_t column,
                               const gonio_material *material, const reader *r, uint32_t *present,
                               size_t *with_data)
{
    gonio_fingerprint *fingerprint = NULL;
    gonio_status status = gonio_fingerprint_create(&fingerprint);
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS && status == GONIO_OK; theta_h++) {
        status = read_slab(context, database, column, material, theta_h, r, fingerprint, present,
                           with_data);
    }
    if (status == GONIO_OK) {
        database->fingerprints[column] = gonio_fingerprint_value(fingerprint);
    }
    gonio_fingerprint_free(&fingerprint);
    return status;
}

static gonio_status read_material(gonio_context *context, gonio_database *database, size_t column,
                                  const char *path, const reader *r, uint32_t *present)
{
    gonio_material *material = NULL;
    gonio_status status = gonio_material_open(context, path, &material);
    if (status != GONIO_OK) {
        return status;
    }
    database->names[column] = strdup(gonio_material_name(material));
    size_t with_data = 0;
    status = database->names[column] == NULL
                 ? GONIO_ERROR_MEMORY
                 : read_slabs(context, database, column, material, r, present, &with_data);
    gonio_material_free(&material);
    if (status == GONIO_OK && with_data == 0) {
        status = gonio_i_fail(context, GONIO_ERROR_DATA,
                              "%s: the material holds no data at all; leave it out", path);
    }
    return status;
}

static gonio_status read_materials(gonio_context *context, gonio_database *database,
                                   const char *const *paths, uint32_t *present)
{
    gonio_status result = GONIO_OK;
    size_t finished = 0;
    gonio_context *team = gonio_i_team_begin(context);
#pragma omp parallel num_threads(gonio_context_threads(context))
    {
        reader r = {0};
        gonio_status mine = make_reader(team, &r) ? GONIO_OK : GONIO_ERROR_MEMORY;
#pragma omp for schedule(dynamic)
        for (size_t k = 0; k < database->materials; k++) {
            gonio_status seen;
#pragma omp atomic read
            seen = result;
            if (mine == GONIO_OK && seen == GONIO_OK) {
                mine = read_material(team, database, k, paths[k], &r, present);
            }
            size_t done;
#pragma omp atomic capture
            done = ++finished;
            if (mine == GONIO_OK) {
                mine = gonio_i_progress(team, "reading materials",
                                        (double)done / (double)database->materials);
            }
            if (mine != GONIO_OK) {
#pragma omp atomic write
                result = mine;
            }
        }
        free_reader(&r);
    }
    gonio_i_team_end(team, context);
    return result;
}

/* A cell stays if all materials have data there. Warns where that costs much, naming who lacks
 * most. */
static gonio_status keep_common_cells(gonio_context *context, gonio_database *database,
                                      const uint32_t *present)
{
    const size_t all = grid_cells(database->options.representation);
    size_t any = 0;
    size_t kept = 0;
    for (size_t k = 0; k < all; k++) {
        any += present[k] > 0;
        kept += present[k] == database->materials;
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
    for (size_t k = 0; k < all; k++) {
        if (present[k] == database->materials) {
            database->cell[database->cells++] = (int32_t)k;
        }
    }
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

static gonio_status fill(gonio_context *context, gonio_database *database, const char *const *paths)
{
    gonio_status status = open_scratch(context, database->options.scratch, &database->scratch);
    if (status != GONIO_OK) {
        return status;
    }
    uint32_t *present =
        gonio_i_allocate(context, grid_cells(database->options.representation), sizeof *present);
    if (present == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    status = read_materials(context, database, paths, present);
    if (status == GONIO_OK) {
        status = check_names(context, database);
    }
    if (status == GONIO_OK) {
        status = keep_common_cells(context, database, present);
    }
    free(present);
    return status;
}

gonio_status gonio_database_create(gonio_context *context, const char *const *paths, size_t count,
                                   const gonio_database_options *options, gonio_database **database)
{
    if (count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "no materials given");
    }
    gonio_database *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    if (options != NULL) {
        made->options = *options;
    }
    made->scratch = -1;
    made->materials = count;
    made->names = gonio_i_allocate(context, count, sizeof *made->names);
    made->fingerprints = gonio_i_allocate(context, count, sizeof *made->fingerprints);
    const gonio_status status = made->names == NULL || made->fingerprints == NULL
                                    ? GONIO_ERROR_MEMORY
                                    : fill(context, made, paths);
    if (status != GONIO_OK) {
        gonio_database_free(&made);
        return status;
    }
    made->options.scratch = NULL;
    *database = made;
    return GONIO_OK;
}

void gonio_database_free(gonio_database **database)
{
    if (database == NULL || *database == NULL) {
        return;
    }
    gonio_database *old = *database;
    if (old->scratch >= 0) {
        close(old->scratch);
    }
    for (size_t k = 0; old->names != NULL && k < old->materials; k++) {
        free(old->names[k]);
    }
    free(old->names);
    free(old->fingerprints);
    free(old->cell);
    free(old);
    *database = NULL;
}

gonio_database_view gonio_database_describe(const gonio_database *database)
{
    const bool joint = database->options.channels == GONIO_JOINT;
    return (gonio_database_view){
        .representation = database->options.representation,
        .channels = database->options.channels,
        .materials = database->materials,
        .names = (const char *const *)database->names,
        .fingerprints = database->fingerprints,
        .columns = joint ? database->materials : GONIO_CHANNELS * database->materials,
        .cells = database->cells,
        .cell = database->cell,
        .rows = joint ? GONIO_CHANNELS * database->cells : database->cells,
    };
}

/* Picks rows first .. first + count - 1 out of one material's cells (the first of them being
 * cell[position] of the grid) into the material's column or columns. */
static void pick_rows(const gonio_database *database, const double *cells, size_t position,
                      size_t first, size_t count, double *columns)
{
    const bool joint = database->options.channels == GONIO_JOINT;
    const size_t origin = (size_t)database->cell[position];
    for (size_t k = 0; k < count; k++) {
        const size_t row = first + k;
        const size_t cell = (size_t)database->cell[joint ? row / GONIO_CHANNELS : row] - origin;
        if (joint) {
            columns[k] = cells[cell * GONIO_CHANNELS + row % GONIO_CHANNELS];
            continue;
        }
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            columns[channel * count + k] = cells[cell * GONIO_CHANNELS + channel];
        }
    }
}

static gonio_status check_request(gonio_context *context, const gonio_database_view *view,
                                  size_t first, size_t count, const size_t *subset,
                                  size_t subset_count)
{
    if (count == 0 || first >= view->rows || count > view->rows - first) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "rows %zu to %zu of a matrix of %zu rows", first, first + count,
                            view->rows);
    }
    for (size_t k = 0; subset != NULL && k < subset_count; k++) {
        if (subset[k] >= view->materials) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "material %zu of a database of %zu",
                                subset[k], view->materials);
        }
    }
    return GONIO_OK;
}

gonio_status gonio_database_read_rows(const gonio_database *database, gonio_context *context,
                                      size_t first, size_t count, const size_t *subset,
                                      size_t subset_count, double *block)
{
    const gonio_database_view view = gonio_database_describe(database);
    gonio_status status = check_request(context, &view, first, count, subset, subset_count);
    if (status != GONIO_OK) {
        return status;
    }
    const size_t materials = subset != NULL ? subset_count : view.materials;
    const size_t per_cell = view.rows / view.cells;
    const size_t per_material = view.columns / view.materials;
    const size_t low = first / per_cell;
    const size_t high = (first + count - 1) / per_cell;
    const size_t span = (size_t)(view.cell[high] - view.cell[low]) + 1;
    const size_t size = GONIO_CHANNELS * sizeof(double);
    double *cells = gonio_i_allocate(context, span, size);
    status = cells == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t k = 0; k < materials && status == GONIO_OK; k++) {
        const size_t material = subset != NULL ? subset[k] : k;
        const size_t start = material * grid_cells(view.representation) + (size_t)view.cell[low];
        status =
            scratch_read(context, database->scratch, cells, span * size, (off_t)(start * size));
        if (status == GONIO_OK) {
            pick_rows(database, cells, low, first, count, block + k * per_material * count);
        }
    }
    free(cells);
    return status;
}
