/* Any rows of an observation matrix, from its tiles. */
#include "matrix.h"

#include <stdlib.h>

#include "../core/core.h"

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
