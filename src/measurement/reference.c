/* References that readings are relative to: see gonio_reference_read. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../core/csv_reader.h"
#include "../core/number.h"
#include "../core/text_encoding.h"
#include "../core/text_file.h"
#include "angle_unit.h"
#include "formats/csv_names.h"
#include "readings.h"

/* ---- its table ---- */

/* The columns of a table of a reference. */
typedef struct reference_columns {
    size_t theta;
    size_t factor;
    int angles;       /* gonio_angle_unit of theta */
    double to_factor; /* pi where the column is a BRDF, 1/100 where it is per cent */
} reference_columns;

static double factor_of_unit(int unit)
{
    return unit == GONIO_VALUE_BRDF ? M_PI : unit == GONIO_VALUE_PERCENT ? 0.01 : 1.0;
}

/* Values without a cosine and not as logarithms. */
static bool is_factor(const gonio_i_column_name *name)
{
    return name->kind == GONIO_I_VALUE && name->scale == 0 && name->unit != GONIO_VALUE_COSINE &&
           name->unit != GONIO_VALUE_FACTOR_COSINE;
}

static gonio_status find_columns(const gonio_i_csv_reader *r, reference_columns *c)
{
    *c = (reference_columns){r->columns, r->columns, GONIO_DEGREES, 1.0};
    for (size_t k = 0; k < r->columns; k++) {
        const gonio_i_column_name name = gonio_i_column_name_of(r->name[k]);
        const bool theta =
            name.kind == GONIO_I_ANGLE ? name.index == 2 : strncasecmp(r->name[k], "theta", 5) == 0;
        if (theta && c->theta == r->columns) {
            c->theta = k;
            c->angles = name.kind == GONIO_I_ANGLE && name.unit != GONIO_I_DEGREES_OR_GRADIANS
                            ? name.unit
                            : c->angles;
        } else if (is_factor(&name) && c->factor == r->columns) {
            c->factor = k;
            c->to_factor = factor_of_unit(name.unit);
        }
    }
    return c->theta < r->columns && c->factor < r->columns
               ? GONIO_OK
               : gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                              "%s: a reference needs the columns theta_r_deg and brf (its "
                              "reflectance factor there)",
                              r->path);
}

static gonio_status take_row(const gonio_i_csv_reader *r, const reference_columns *c,
                             gonio_reference_row *row)
{
    double theta = NAN;
    double factor = NAN;
    const bool numbers = gonio_i_csv_is_number(r->cell[c->theta], r->delimiter, &theta) &&
                         gonio_i_csv_is_number(r->cell[c->factor], r->delimiter, &factor);
    const double degrees = gonio_i_degrees_of(c->angles, theta);
    *row = (gonio_reference_row){fabs(degrees * M_PI / 180.0), factor * c->to_factor};
    return numbers && row->theta <= M_PI / 2.0 && row->factor > 0.0 && row->factor < 1e6
               ? GONIO_OK
               : gonio_i_fail(r->context, GONIO_ERROR_DATA,
                              "%s:%zu: an angle of at most 90 degrees and a reflectance factor "
                              "above 0 are needed",
                              r->path, r->line);
}

static int compare_rows(const void *a, const void *b)
{
    const gonio_reference_row *x = a;
    const gonio_reference_row *y = b;
    return (x->theta > y->theta) - (x->theta < y->theta);
}

static gonio_status take_rows(gonio_i_csv_reader *r, gonio_reference_row **row, size_t *rows)
{
    reference_columns c;
    size_t room = 0;
    gonio_status status = find_columns(r, &c);
    if (status == GONIO_OK) {
        status = gonio_i_csv_next(r);
    }
    while (status == GONIO_OK && r->cells > 0) {
        if (*rows == room) {
            room = room > 0 ? 2 * room : 32;
            gonio_reference_row *more = reallocarray(*row, room, sizeof *more);
            if (more == NULL) {
                return gonio_i_fail(r->context, GONIO_ERROR_MEMORY, "%s: out of memory", r->path);
            }
            *row = more;
        }
        status = take_row(r, &c, &(*row)[*rows]);
        *rows += status == GONIO_OK;
        status = status == GONIO_OK ? gonio_i_csv_next(r) : status;
    }
    return status == GONIO_OK && *rows == 0
               ? gonio_i_fail(r->context, GONIO_ERROR_DATA, "%s: no rows", r->path)
               : status;
}

static gonio_status read_text(gonio_context *context, const char *path, const char *text,
                              size_t size, gonio_reference_row **row, size_t *rows)
{
    gonio_i_csv_reader reader;
    gonio_i_plain_numbers plain;
    if (!gonio_i_plain_numbers_begin(&plain)) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    }
    gonio_status status = gonio_i_csv_open(context, path, text, size, &reader);
    if (status == GONIO_OK) {
        status = take_rows(&reader, row, rows);
        gonio_i_csv_close(&reader);
    }
    gonio_i_plain_numbers_end(&plain);
    return status;
}

gonio_status gonio_reference_read(gonio_context *context, const char *path,
                                  gonio_reference_row **row, size_t *rows)
{
    char *text = NULL;
    size_t size = 0;
    gonio_reference_row *made = NULL;
    size_t count = 0;
    gonio_status status = gonio_i_text_read(context, path, &text, &size);
    if (status == GONIO_OK) {
        status = gonio_i_text_make_plain(context, path, &text, &size);
    }
    if (status == GONIO_OK) {
        status = read_text(context, path, text, size, &made, &count);
    }
    free(text);
    if (status != GONIO_OK) {
        free(made);
        return status;
    }
    if (made != NULL) {
        qsort(made, count, sizeof *made, compare_rows);
    }
    *row = made;
    *rows = count;
    return GONIO_OK;
}

/* ---- readings relative to it ---- */

gonio_status gonio_readings_times_reference(gonio_context *context, gonio_readings *readings,
                                            const gonio_reference_row *row, size_t rows)
{
    double least = INFINITY;
    double most = 0.0;
    if (rows == 0) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a reference has no rows");
    }
    for (size_t k = 0; k < readings->count; k++) {
        const double factor = gonio_i_reference_factor(row, rows, readings->pair[k].outgoing.theta);
        least = fmin(least, factor);
        most = fmax(most, factor);
        for (size_t c = 0; c < readings->channels; c++) {
            readings->value[k * readings->channels + c] *= factor;
            if (readings->deviation != NULL) {
                readings->deviation[k * readings->channels + c] *= factor;
            }
        }
    }
    return gonio_i_readings_note(context, readings,
                                 "relative to a reference of reflectance factor %.4g to %.4g",
                                 least, most);
}
