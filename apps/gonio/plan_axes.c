/* The positions of axes that a plan has: see plan_axes.h. */
#include "plan_axes.h"

#include <math.h>
#include <stdlib.h>
#include <strings.h>

#include "core/csv_reader.h"
#include "core/number.h"
#include "core/text_file.h"

static const double DEGREE = M_PI / 180.0;
static const double AGREE = 0.1 * M_PI / 180.0;

enum { NO_COLUMN = -1 };

/* ---- columns ---- */

/* The column of each axis. False if an axis that the instrument has lacks one. */
static bool find_columns(const gonio_i_csv_reader *reader, const gonio_instrument_view *view,
                         int *column)
{
    bool all = view->axes > 0;
    for (size_t k = 0; k < view->axes; k++) {
        char name[128];
        snprintf(name, sizeof name, "axis_%s_deg", view->axis[k].name);
        column[k] = NO_COLUMN;
        for (size_t j = 0; j < reader->columns; j++) {
            column[k] = strcasecmp(reader->name[j], name) == 0 ? (int)j : column[k];
        }
        all = all && (column[k] != NO_COLUMN || !view->axis[k].present);
    }
    return all;
}

/* The reading of a line of the file; the number of readings if it has none. */
static size_t reading_of(const gonio_readings_view *plan, size_t line)
{
    size_t k = 0;
    while (k < plan->count && plan->line[k] != line) {
        k++;
    }
    return k;
}

static bool take_row(const gonio_i_csv_reader *reader, const gonio_instrument *instrument,
                     const int *column, gonio_setting *setting)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    bool numbers = true;
    for (size_t k = 0; k < view->axes; k++) {
        double degrees = 0.0;
        numbers = numbers &&
                  (column[k] == NO_COLUMN ||
                   gonio_i_csv_is_number(reader->cell[column[k]], reader->delimiter, &degrees));
        setting->axis[k] = degrees * DEGREE;
    }
    setting->pair = gonio_instrument_pair(instrument, setting->axis);
    return numbers;
}

static gonio_status take_rows(gonio_i_csv_reader *reader, const gonio_instrument *instrument,
                              const gonio_readings_view *plan, gonio_setting *setting, bool *found)
{
    int column[GONIO_MOST_AXES] = {NO_COLUMN};
    size_t rows = 0;
    gonio_status status = GONIO_OK;
    *found = find_columns(reader, gonio_instrument_describe(instrument), column);
    while (*found && (status = gonio_i_csv_next(reader)) == GONIO_OK && reader->cells > 0) {
        const size_t k = reading_of(plan, reader->line);
        if (k < plan->count) {
            rows++;
            *found = take_row(reader, instrument, column, &setting[k]);
        }
    }
    *found = *found && rows == plan->count;
    return status;
}

gonio_status plan_axes_read(gonio_context *context, const gonio_instrument *instrument,
                            const gonio_readings *plan, const char *path, gonio_setting *setting,
                            bool *found)
{
    gonio_i_csv_reader reader;
    gonio_i_plain_numbers numbers;
    char *text = NULL;
    size_t size = 0;
    *found = false;
    gonio_status status = gonio_i_text_read(context, path, &text, &size);
    if (status == GONIO_OK && !gonio_i_plain_numbers_begin(&numbers)) {
        status = GONIO_ERROR_MEMORY;
    } else if (status == GONIO_OK) {
        status = gonio_i_csv_open(context, path, text, size, &reader);
        if (status == GONIO_OK) {
            status = take_rows(&reader, instrument, gonio_readings_describe(plan), setting, found);
            gonio_i_csv_close(&reader);
        }
        gonio_i_plain_numbers_end(&numbers);
    }
    free(text);
    return status;
}

/* ---- angles ---- */

static double azimuth_between(gonio_pair pair)
{
    return fabs(remainder(pair.outgoing.phi - pair.incident.phi, 2.0 * M_PI));
}

bool plan_axes_agree(const gonio_setting *setting, gonio_pair pair)
{
    const gonio_pair read = setting->pair;
    const double sine = fmin(sin(pair.incident.theta), sin(pair.outgoing.theta));
    return fabs(read.incident.theta - pair.incident.theta) <= AGREE &&
           fabs(read.outgoing.theta - pair.outgoing.theta) <= AGREE &&
           sine * fabs(azimuth_between(read) - azimuth_between(pair)) <= AGREE;
}
