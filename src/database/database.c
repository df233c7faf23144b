/* The observation matrix: materials are read once, mapped to log space, and kept in unlinked
 * scratch files. matrix.h describes the storage. */
#include "matrix.h"

#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../core/options.h"

void gonio_database_options_default_of(gonio_database_options *options, size_t size)
{
    const gonio_database_options usual = {.representation = GONIO_SECTORED,
                                          .channels = GONIO_SEPARATE};
    gonio_i_give(&usual, sizeof usual, options, size);
}

/* Keeps the cells in which all materials have data. Warns if many are lost, and names the material
 * that lacks most. */
static gonio_status keep_common_cells(gonio_context *context, gonio_database *database,
                                      const uint8_t *seen)
{
    size_t any = 0;
    size_t kept = 0;
    for (size_t k = 0; k < database->stored_count; k++) {
        any += (seen[k] & GONIO_I_HAS_DATA) != 0;
        kept += seen[k] == GONIO_I_HAS_DATA;
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
        gonio_i_cell_tile *t = &database->tile[j];
        t->kept = database->cells;
        for (size_t k = t->first; k < t->first + t->count; k++) {
            if (seen[k] == GONIO_I_HAS_DATA) {
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
            status = gonio_i_fail(
                context, GONIO_ERROR_DATA,
                "two materials are called '%s'; give each material once, under a name of its own",
                sorted[k]);
        }
    }
    free(sorted);
    return status;
}

/* What is learned of materials that depend on the azimuth of the sample. */
static void tell_means(gonio_context *context, const gonio_database *database)
{
    const char *first = NULL;
    size_t others = 0;
    for (size_t k = 0; k < database->materials; k++) {
        others += first != NULL && database->anisotropic[k];
        first = first == NULL && database->anisotropic[k] ? database->names[k] : first;
    }
    if (first != NULL && others == 0) {
        gonio_i_note(context, "%s: anisotropic; its mean over azimuths of the sample is learned",
                     first);
    } else if (first != NULL) {
        gonio_i_note(context,
                     "%s and %zu other materials: anisotropic; their means over azimuths of the "
                     "sample are learned",
                     first, others);
    }
}

static gonio_status fill(gonio_context *context, gonio_database *database,
                         const gonio_i_sources *from)
{
    gonio_status status =
        gonio_i_scratch_open(context, database->options.scratch, &database->scratch);
    if (status == GONIO_OK) {
        status = gonio_i_database_lay_out(context, database);
    }
    if (status != GONIO_OK) {
        return status;
    }
    uint8_t *seen = gonio_i_allocate(context, database->stored_count, sizeof *seen);
    if (seen == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    status = gonio_i_database_read_materials(context, database, from, seen);
    if (status == GONIO_OK) {
        status = check_names(context, database);
    }
    if (status == GONIO_OK) {
        tell_means(context, database);
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
        .rows = gonio_i_rows_per_cell(database->options.channels) * database->cells,
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

static gonio_status create(gonio_context *context, const gonio_i_sources *from, size_t count,
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
    made->anisotropic = gonio_i_allocate(context, count, sizeof *made->anisotropic);
    const bool room =
        made->names != NULL && made->fingerprints != NULL && made->anisotropic != NULL;
    const gonio_status status = room ? fill(context, made, from) : GONIO_ERROR_MEMORY;
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
    return create(context, &(gonio_i_sources){.path = paths}, count, options, database);
}

gonio_status gonio_database_create_from_materials(gonio_context *context,
                                                  const gonio_material *const *materials,
                                                  size_t count,
                                                  const gonio_database_options *options,
                                                  gonio_database **database)
{
    return create(context, &(gonio_i_sources){.material = materials}, count, options, database);
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
    free(old->anisotropic);
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
