/* Reading and writing readings (and plans) as CSV: docs/plan-and-readings.md. */
#include "readings.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const angle_columns[] = {"theta_i_deg", "phi_i_deg", "theta_o_deg", "phi_o_deg"};
static const char *const value_columns[GONIO_CHANNELS] = {"R_per_sr", "G_per_sr", "B_per_sr"};
static const char *const channel_names[] = {"all", "R", "G", "B"};
static const char grid_name[] = "half/difference 90 x 90 x 180";

void gonio_readings_options_default(gonio_readings_options *options)
{
    *options = (gonio_readings_options){.values_needed = true};
}

void gonio_readings_free(gonio_readings **readings)
{
    if (readings == NULL || *readings == NULL) {
        return;
    }
    gonio_i_csv_free(&(*readings)->csv);
    free((*readings)->path);
    free((*readings)->reading);
    free((*readings)->first_same);
    free((*readings)->wavelength);
    free((*readings)->spectrum);
    free(*readings);
    *readings = NULL;
}

gonio_readings_view gonio_readings_describe(const gonio_readings *readings)
{
    const char *method = gonio_i_csv_note(readings->csv, "method");
    return (gonio_readings_view){.count = readings->count,
                                 .reading = readings->reading,
                                 .path = readings->path,
                                 .basis = readings->basis,
                                 .components = readings->components,
                                 .method = method != NULL ? method : "",
                                 .wavelengths = readings->wavelengths,
                                 .wavelength = readings->wavelength,
                                 .spectrum = readings->spectrum};
}

size_t gonio_readings_channels(const gonio_readings *readings)
{
    return readings->wavelengths > 0 ? readings->wavelengths : GONIO_CHANNELS;
}

double gonio_readings_value(const gonio_readings *readings, size_t reading, size_t channel)
{
    return readings->wavelengths > 0 ? readings->spectrum[reading * readings->wavelengths + channel]
                                     : readings->reading[reading].value[channel];
}

double gonio_readings_scale(const gonio_readings *readings, size_t channel)
{
    return gonio_log_scale(readings->wavelengths > 0 ? GONIO_CHANNELS : (int)channel);
}

gonio_status gonio_i_readings_set_wavelengths(gonio_context *context, gonio_readings *readings,
                                              const double *wavelength, size_t count)
{
    double *kept = gonio_i_allocate(context, count, sizeof *kept);
    double *spectrum = gonio_i_allocate(context, readings->count * count, sizeof *spectrum);
    if (kept == NULL || spectrum == NULL) {
        free(kept);
        free(spectrum);
        return GONIO_ERROR_MEMORY;
    }
    memcpy(kept, wavelength, count * sizeof *kept);
    free(readings->wavelength);
    free(readings->spectrum);
    readings->wavelength = kept;
    readings->spectrum = spectrum;
    readings->wavelengths = count;
    return GONIO_OK;
}

/* ---- same directions ---- */

typedef struct indexed_reading {
    const gonio_reading *reading;
    size_t index;
} indexed_reading;

static int compare_numbers(double a, double b)
{
    return (a > b) - (a < b);
}

static int compare_pairs(const gonio_pair *a, const gonio_pair *b)
{
    int order = compare_numbers(a->incident.theta, b->incident.theta);
    order = order != 0 ? order : compare_numbers(a->incident.phi, b->incident.phi);
    order = order != 0 ? order : compare_numbers(a->outgoing.theta, b->outgoing.theta);
    return order != 0 ? order : compare_numbers(a->outgoing.phi, b->outgoing.phi);
}

static int compare_indexed(const void *a, const void *b)
{
    const indexed_reading *x = a;
    const indexed_reading *y = b;
    const int order = compare_pairs(&x->reading->pair, &y->reading->pair);
    return order != 0 ? order : (x->index > y->index) - (x->index < y->index);
}

gonio_status gonio_i_readings_group(gonio_context *context, const gonio_reading *reading,
                                    size_t count, size_t *first_same)
{
    indexed_reading *sorted = gonio_i_allocate(context, count, sizeof *sorted);
    if (sorted == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < count; k++) {
        sorted[k] = (indexed_reading){&reading[k], k};
    }
    qsort(sorted, count, sizeof *sorted, compare_indexed);
    for (size_t k = 0; k < count; k++) {
        const bool same =
            k > 0 && compare_pairs(&sorted[k - 1].reading->pair, &sorted[k].reading->pair) == 0;
        first_same[sorted[k].index] = same ? first_same[sorted[k - 1].index] : sorted[k].index;
    }
    free(sorted);
    return GONIO_OK;
}

static bool channels_overlap(int a, int b)
{
    return a == b || a == GONIO_ALL_CHANNELS || b == GONIO_ALL_CHANNELS;
}

/* A direction may be listed once for each channel. `seen` holds, for each group, the last reading
 * of each channel plus one. */
static gonio_status refuse_repeats(gonio_context *context, const gonio_readings *readings,
                                   bool measured)
{
    size_t(*seen)[GONIO_CHANNELS + 1] = gonio_i_allocate(context, readings->count, sizeof *seen);
    if (seen == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < readings->count && status == GONIO_OK; k++) {
        size_t *group = seen[readings->first_same[k]];
        const int channel = readings->reading[k].channel;
        for (int other = GONIO_ALL_CHANNELS; other < GONIO_CHANNELS; other++) {
            const size_t earlier = group[other + 1];
            if (earlier > 0 && channels_overlap(channel, other) && status == GONIO_OK) {
                status = gonio_i_fail(
                    context, GONIO_ERROR_DATA,
                    "%s:%zu: the same directions and channel as line %zu; delete one%s",
                    readings->path, readings->reading[k].line, readings->reading[earlier - 1].line,
                    measured ? ", or accept repeats with --average-repeats" : "");
            }
        }
        group[channel + 1] = k + 1;
    }
    free(seen);
    return status;
}

/* ---- reading ---- */

typedef struct columns {
    int angle[4];
    int value[GONIO_CHANNELS];
    int channel;
    size_t wavelengths;
    int *spectral;      /* [wavelengths] */
    double *wavelength; /* [wavelengths], nm */
} columns;

/* The wavelength that a column is named by; 0 if it is another column. */
static double wavelength_of(const char *name)
{
    char *end = NULL;
    const double wavelength = strtod(name, &end);
    const bool named = isdigit((unsigned char)*name) && strcasecmp(end, "nm_per_sr") == 0;
    return named && wavelength > 0.0 && wavelength < 1e6 ? wavelength : 0.0;
}

static gonio_status find_wavelengths(gonio_context *context, const gonio_readings *readings,
                                     columns *c)
{
    c->spectral = gonio_i_allocate(context, readings->csv->columns, sizeof *c->spectral);
    c->wavelength = gonio_i_allocate(context, readings->csv->columns, sizeof *c->wavelength);
    if (c->spectral == NULL || c->wavelength == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < readings->csv->columns; k++) {
        const double wavelength = wavelength_of(readings->csv->name[k]);
        if (wavelength > 0.0) {
            c->spectral[c->wavelengths] = (int)k;
            c->wavelength[c->wavelengths++] = wavelength;
        }
    }
    return GONIO_OK;
}

static gonio_status find_columns(gonio_context *context, const gonio_readings *readings,
                                 bool values_needed, columns *c)
{
    const gonio_status status = find_wavelengths(context, readings, c);
    bool any = c->wavelengths > 0;
    if (status != GONIO_OK) {
        return status;
    }
    for (int k = 0; k < 4; k++) {
        c->angle[k] = gonio_i_csv_column(readings->csv, angle_columns[k]);
        if (c->angle[k] < 0) {
            return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                                "%s: no column '%s'; theta_i_deg, phi_i_deg, theta_o_deg and "
                                "phi_o_deg are needed",
                                readings->path, angle_columns[k]);
        }
    }
    for (int k = 0; k < GONIO_CHANNELS; k++) {
        c->value[k] = gonio_i_csv_column(readings->csv, value_columns[k]);
        any = any || c->value[k] >= 0;
        if (c->value[k] >= 0 && c->wavelengths > 0) {
            return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                                "%s: columns of colours (%s) and of wavelengths (%gnm_per_sr); "
                                "delete one kind",
                                readings->path, value_columns[k], c->wavelength[0]);
        }
    }
    if (values_needed && !any) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: no column of values (R_per_sr, G_per_sr, B_per_sr, or "
                            "400nm_per_sr ...): a plan that was "
                            "not measured yet?",
                            readings->path);
    }
    c->channel = gonio_i_csv_column(readings->csv, "channel");
    return GONIO_OK;
}

static gonio_status bad_cell(gonio_context *context, const gonio_readings *readings, size_t row,
                             int column, gonio_status status, const char *problem)
{
    return gonio_i_fail(context, status, "%s:%zu: %s '%.60s' %s", readings->path,
                        readings->csv->line[row], readings->csv->name[column],
                        gonio_i_csv_cell(readings->csv, row, (size_t)column), problem);
}

static gonio_status read_angles(gonio_context *context, const gonio_readings *readings, size_t row,
                                const columns *c, double degrees[4])
{
    for (int k = 0; k < 4; k++) {
        if (!gonio_i_csv_number(readings->csv, row, (size_t)c->angle[k], &degrees[k]) ||
            !isfinite(degrees[k])) {
            return bad_cell(context, readings, row, c->angle[k], GONIO_ERROR_FORMAT,
                            "is not a finite number");
        }
        const bool polar = k % 2 == 0;
        if (polar && !(degrees[k] >= 0.0 && degrees[k] < 90.0)) {
            return bad_cell(context, readings, row, c->angle[k], GONIO_ERROR_DATA,
                            degrees[k] < 0.0 ? "is negative: give 0 to 90, and turn phi by 180"
                                             : "is at or below the horizon: theta is less than 90");
        }
        if (!polar && !(fabs(degrees[k]) <= 360.0)) {
            return bad_cell(context, readings, row, c->angle[k], GONIO_ERROR_DATA,
                            "is outside -360 to 360 degrees");
        }
    }
    return GONIO_OK;
}

static gonio_angles to_angles(double theta, double phi)
{
    const double turned = fmod(phi < 0.0 ? phi + 360.0 : phi, 360.0);
    return (gonio_angles){theta * M_PI / 180.0, turned * M_PI / 180.0};
}

static bool is_missing(const char *cell)
{
    return *cell == '\0' || strcasecmp(cell, "na") == 0 || strcasecmp(cell, "nan") == 0;
}

/* 1/sr: far above any peak, in any unit, and far below where squares overflow. */
static const double MOST_VALUE = 1e30;

/* NaN for a column that there is not (-1) and for an empty cell. */
static gonio_status read_value(gonio_context *context, const gonio_readings *readings, size_t row,
                               int column, const gonio_readings_options *options, double *value)
{
    *value = NAN;
    if (column < 0 || is_missing(gonio_i_csv_cell(readings->csv, row, (size_t)column))) {
        return GONIO_OK;
    }
    if (!gonio_i_csv_number(readings->csv, row, (size_t)column, value) || !isfinite(*value)) {
        return bad_cell(context, readings, row, column, GONIO_ERROR_FORMAT,
                        "is not a finite number (leave the cell empty where nothing was read)");
    }
    if (*value > MOST_VALUE) {
        return bad_cell(context, readings, row, column, GONIO_ERROR_DATA,
                        "is larger than any BRDF (leave the cell empty where nothing was read)");
    }
    if (*value < 0.0 && !options->negative_to_zero) {
        return bad_cell(context, readings, row, column, GONIO_ERROR_DATA,
                        "is negative: a dark level too high? --negative-to-zero takes it as 0");
    }
    *value = fmax(*value, 0.0);
    return GONIO_OK;
}

static gonio_status read_values(gonio_context *context, gonio_readings *readings, size_t row,
                                const columns *c, const gonio_readings_options *options)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < GONIO_CHANNELS && status == GONIO_OK; k++) {
        status = read_value(context, readings, row, c->value[k], options,
                            &readings->reading[row].value[k]);
    }
    for (size_t k = 0; k < c->wavelengths && status == GONIO_OK; k++) {
        status = read_value(context, readings, row, c->spectral[k], options,
                            &readings->spectrum[row * c->wavelengths + k]);
    }
    return status;
}

static gonio_status read_channel(gonio_context *context, const gonio_readings *readings, size_t row,
                                 const columns *c, int *channel)
{
    *channel = GONIO_ALL_CHANNELS;
    if (c->channel < 0) {
        return GONIO_OK;
    }
    const char *cell = gonio_i_csv_cell(readings->csv, row, (size_t)c->channel);
    if (*cell == '\0') {
        return GONIO_OK;
    }
    for (int k = GONIO_ALL_CHANNELS; k < GONIO_CHANNELS; k++) {
        if (strcasecmp(cell, channel_names[k + 1]) == 0) {
            *channel = k;
            return GONIO_OK;
        }
    }
    return bad_cell(context, readings, row, c->channel, GONIO_ERROR_FORMAT,
                    "is no channel: R, G, B or all");
}

static gonio_status read_row(gonio_context *context, gonio_readings *readings, size_t row,
                             const columns *c, const gonio_readings_options *options)
{
    gonio_reading *reading = &readings->reading[row];
    double degrees[4];
    gonio_status status = read_angles(context, readings, row, c, degrees);
    if (status == GONIO_OK) {
        reading->pair =
            (gonio_pair){to_angles(degrees[0], degrees[1]), to_angles(degrees[2], degrees[3])};
        reading->line = readings->csv->line[row];
        status = read_channel(context, readings, row, c, &reading->channel);
    }
    if (status == GONIO_OK) {
        status = read_values(context, readings, row, c, options);
    }
    return status;
}

/* The number of a "# key: number" line; 0 if there is no such line. */
static gonio_status read_note(gonio_context *context, const gonio_readings *readings,
                              const char *key, int base, uint64_t *number)
{
    const char *text = gonio_i_csv_note(readings->csv, key);
    if (text == NULL) {
        *number = 0;
        return GONIO_OK;
    }
    char *end = NULL;
    errno = 0;
    *number = strtoull(text, &end, base);
    if (!isxdigit((unsigned char)*text) || *end != '\0' || errno != 0 || *number == 0) {
        return gonio_i_fail(
            context, GONIO_ERROR_FORMAT,
            "%s: '# %s: %.60s' is not what gonio plan writes; restore it, or delete "
            "the line",
            readings->path, key, text);
    }
    return GONIO_OK;
}

static gonio_status read_notes(gonio_context *context, gonio_readings *readings)
{
    const char *grid = gonio_i_csv_note(readings->csv, "grid");
    if (grid != NULL && strcmp(grid, grid_name) != 0) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                            "%s: made for the grid '%s'; this gonio works on '%s'", readings->path,
                            grid, grid_name);
    }
    uint64_t components = 0;
    gonio_status status = read_note(context, readings, "basis", 16, &readings->basis);
    if (status == GONIO_OK) {
        status = read_note(context, readings, "components", 10, &components);
    }
    readings->components = (size_t)components;
    return status;
}

static gonio_status read_all(gonio_context *context, gonio_readings *readings,
                             const gonio_readings_options *options, columns *c)
{
    readings->count = readings->csv->rows;
    if (readings->count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "%s: no lines below the column names",
                            readings->path);
    }
    gonio_status status = find_columns(context, readings, options->values_needed, c);
    if (status != GONIO_OK) {
        return status;
    }
    readings->reading = gonio_i_allocate(context, readings->count, sizeof *readings->reading);
    readings->first_same = gonio_i_allocate(context, readings->count, sizeof *readings->first_same);
    if (readings->reading == NULL || readings->first_same == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    if (c->wavelengths > 0) {
        status = gonio_i_readings_set_wavelengths(context, readings, c->wavelength, c->wavelengths);
    }
    for (size_t row = 0; row < readings->count && status == GONIO_OK; row++) {
        status = read_row(context, readings, row, c, options);
    }
    if (status == GONIO_OK) {
        status = gonio_i_readings_group(context, readings->reading, readings->count,
                                        readings->first_same);
    }
    if (status == GONIO_OK && !options->average_repeats) {
        status = refuse_repeats(context, readings, options->values_needed);
    }
    return status;
}

static gonio_status read_rows(gonio_context *context, gonio_readings *readings,
                              const gonio_readings_options *options)
{
    columns c = {0};
    const gonio_status status = read_all(context, readings, options, &c);
    free(c.spectral);
    free(c.wavelength);
    return status;
}

gonio_status gonio_readings_read(gonio_context *context, const char *path,
                                 const gonio_readings_options *options, gonio_readings **readings)
{
    gonio_readings_options defaults;
    gonio_readings_options_default(&defaults);
    gonio_readings *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->path = strdup(path);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (made->path != NULL) {
        status = gonio_i_scattered_probe(path) ? gonio_i_scattered_read(context, path, &made->csv)
                                               : gonio_i_csv_read(context, path, &made->csv);
    }
    if (status == GONIO_OK) {
        status = read_notes(context, made);
    }
    if (status == GONIO_OK) {
        status = read_rows(context, made, options != NULL ? options : &defaults);
    }
    if (status != GONIO_OK) {
        gonio_readings_free(&made);
        return status;
    }
    *readings = made;
    return GONIO_OK;
}

/* ---- writing ---- */

static int column_or_new(gonio_i_csv *csv, const char *name)
{
    const int column = gonio_i_csv_column(csv, name);
    if (column >= 0) {
        return column;
    }
    return gonio_i_csv_add_column(csv, name) ? (int)csv->columns - 1 : -1;
}

static bool set_channel(gonio_i_csv *csv, const gonio_readings *readings, size_t channel,
                        const char *name)
{
    const int column = column_or_new(csv, name);
    bool set = column >= 0;
    for (size_t row = 0; row < readings->count && set; row++) {
        const double value = gonio_readings_value(readings, row, channel);
        set = isnan(value) ? gonio_i_csv_set(csv, row, (size_t)column, "%s", "")
                           : gonio_i_csv_set(csv, row, (size_t)column, "%.10g", value);
    }
    return set;
}

static bool set_values(gonio_i_csv *csv, const gonio_readings *readings)
{
    bool set = true;
    for (size_t k = 0; k < gonio_readings_channels(readings) && set; k++) {
        char name[48];
        if (readings->wavelengths > 0) {
            snprintf(name, sizeof name, "%.10gnm_per_sr", readings->wavelength[k]);
        }
        set = set_channel(csv, readings, k, readings->wavelengths > 0 ? name : value_columns[k]);
    }
    return set;
}

/* The header lines of a readings file: what it is and who wrote it, then what the plan said. */
static bool set_comments(gonio_i_csv *csv, const char *command)
{
    static const char plan_title[] = "gonio plan";
    if (csv->comments > 0 && strcmp(csv->comment[0], plan_title) == 0) {
        char *title = strdup("gonio readings");
        if (title == NULL) {
            return false;
        }
        free(csv->comment[0]);
        csv->comment[0] = title;
    }
    gonio_i_csv_drop_note(csv, "program");
    gonio_i_csv_drop_note(csv, "command");
    return gonio_i_csv_add_comment(csv, "program: gonio %s", gonio_version()) &&
           (command == NULL || gonio_i_csv_add_comment(csv, "command: %s", command));
}

gonio_status gonio_readings_write(gonio_context *context, const gonio_readings *readings,
                                  const char *command, const char *path)
{
    if (!set_values(readings->csv, readings) || !set_comments(readings->csv, command)) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    }
    return gonio_i_csv_write(context, readings->csv, path);
}
