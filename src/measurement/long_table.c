/* Tables with one wavelength a row: see long_table.h. */
#include "long_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_ROOM = 256, MOST_WAVELENGTHS = 4096 };
enum { LEAST_CELLS = 1000000, MOST_HOLES = 16 }; /* holes for each value */

gonio_status gonio_i_long_table_add(gonio_i_long_table *table, const gonio_i_long_row *row)
{
    if (table->count == table->room) {
        const size_t room = table->room > 0 ? 2 * table->room : FIRST_ROOM;
        gonio_i_long_row *more = reallocarray(table->row, room, sizeof *more);
        if (more == NULL) {
            return gonio_i_fail(table->context, GONIO_ERROR_MEMORY, "out of memory");
        }
        table->row = more;
        table->room = room;
    }
    table->row[table->count++] = *row;
    table->any_deviation = table->any_deviation || !isnan(row->deviation);
    return GONIO_OK;
}

void gonio_i_long_table_free(gonio_i_long_table *table)
{
    free(table->row);
    *table = (gonio_i_long_table){.context = table->context};
}

/* ---- wavelengths ---- */

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The numbers 0 .. channels - 1. */
static gonio_status count_channels(const gonio_i_long_table *table, double **number, size_t *count)
{
    double *all = gonio_i_allocate(table->context, table->numbered, sizeof *all);
    for (size_t k = 0; all != NULL && k < table->numbered; k++) {
        all[k] = (double)k;
    }
    *number = all;
    *count = table->numbered;
    return all != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* The different wavelengths, ascending. */
static gonio_status find_wavelengths(const gonio_i_long_table *table, double **wavelength,
                                     size_t *count)
{
    double *all = gonio_i_allocate(table->context, table->count, sizeof *all);
    if (all == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < table->count; k++) {
        all[k] = table->row[k].wavelength;
    }
    qsort(all, table->count, sizeof *all, compare_numbers);
    size_t kept = 0;
    for (size_t k = 0; k < table->count; k++) {
        if (kept == 0 || all[k] != all[kept - 1]) {
            all[kept++] = all[k];
        }
    }
    *wavelength = all;
    *count = kept;
    return GONIO_OK;
}

static size_t channel_of(const double *wavelength, size_t count, double wanted)
{
    const double *found = bsearch(&wanted, wavelength, count, sizeof wanted, compare_numbers);
    return found != NULL ? (size_t)(found - wavelength) : 0;
}

/* ---- directions ---- */

typedef struct place {
    const gonio_i_long_row *row;
    size_t repeat; /* number of earlier values with the same directions, wavelength and state */
    size_t first;  /* the place of the first row of its directions and repeat */
} place;

static int compare_rows(const gonio_i_long_row *a, const gonio_i_long_row *b)
{
    return (a > b) - (a < b);
}

static int compare_degrees(const gonio_i_long_row *a, const gonio_i_long_row *b)
{
    int order = 0;
    for (int k = 0; k < 4 && order == 0; k++) {
        order = compare_numbers(&a->degrees[k], &b->degrees[k]);
    }
    return order;
}

static int compare_keys(const gonio_i_long_row *a, const gonio_i_long_row *b)
{
    int order = compare_degrees(a, b);
    order = order != 0 ? order : compare_numbers(&a->wavelength, &b->wavelength);
    return order != 0 ? order : compare_numbers(&a->state, &b->state);
}

/* By directions, wavelengths and states, then in the order of the table. */
static int compare_repeats(const void *a, const void *b)
{
    const place *x = a;
    const place *y = b;
    const int order = compare_keys(x->row, y->row);
    return order != 0 ? order : compare_rows(x->row, y->row);
}

/* By directions and repeats, then in the order of the table. */
static int compare_directions(const void *a, const void *b)
{
    const place *x = a;
    const place *y = b;
    int order = compare_degrees(x->row, y->row);
    order = order != 0 ? order : (x->repeat > y->repeat) - (x->repeat < y->repeat);
    return order != 0 ? order : compare_rows(x->row, y->row);
}

/* By the first row of the directions, then in the order of the table. */
static int compare_first(const void *a, const void *b)
{
    const place *x = a;
    const place *y = b;
    const int order = (x->first > y->first) - (x->first < y->first);
    return order != 0 ? order : compare_rows(x->row, y->row);
}

static void count_repeats(const gonio_i_long_table *table, place *places)
{
    qsort(places, table->count, sizeof *places, compare_repeats);
    size_t before = 0;
    for (size_t k = 0; k < table->count; k++) {
        const bool same = k > 0 && compare_keys(places[k - 1].row, places[k].row) == 0;
        const bool has_value = !isnan(places[k].row->value);
        before = same ? before : 0;
        places[k].repeat = has_value ? before : 0;
        before += has_value;
    }
}

/* Sorts the rows so that those of one reading are adjacent. */
static void group(const gonio_i_long_table *table, place *places)
{
    for (size_t k = 0; k < table->count; k++) {
        places[k] = (place){.row = &table->row[k]};
    }
    count_repeats(table, places);
    qsort(places, table->count, sizeof *places, compare_directions);
    for (size_t k = 0; k < table->count; k++) {
        const bool same = k > 0 && places[k - 1].repeat == places[k].repeat &&
                          compare_degrees(places[k - 1].row, places[k].row) == 0;
        places[k].first = same ? places[k - 1].first : (size_t)(places[k].row - table->row);
    }
    qsort(places, table->count, sizeof *places, compare_first);
}

/* ---- rows with all wavelengths ---- */

/* Sums of the values of one direction, and their numbers. [channels] each. */
typedef struct sums {
    size_t channels;
    double *value;
    double *square; /* of deviations */
    double *count;
} sums;

static void clear(const sums *s)
{
    memset(s->value, 0, s->channels * sizeof *s->value);
    memset(s->square, 0, s->channels * sizeof *s->square);
    memset(s->count, 0, s->channels * sizeof *s->count);
}

static void add(const sums *s, const gonio_i_long_row *row, size_t channel)
{
    if (!isnan(row->value)) {
        s->value[channel] += row->value;
        s->square[channel] += row->deviation * row->deviation;
        s->count[channel] += 1.0;
    }
}

/* Turns sums into means, NaN where nothing was read, and adds them as a row. */
static gonio_status hand_on(const sums *s, const gonio_i_long_table *table,
                            const gonio_i_long_row *row, gonio_i_import *import)
{
    for (size_t k = 0; k < s->channels; k++) {
        s->value[k] = s->count[k] > 0.0 ? s->value[k] / s->count[k] : NAN;
        s->square[k] = s->count[k] > 0.0 ? sqrt(s->square[k]) / s->count[k] : NAN;
    }
    gonio_i_row made = {.planned = GONIO_ALL_CHANNELS,
                        .line = row->line,
                        .value = s->value,
                        .deviation = table->any_deviation ? s->square : NULL};
    memcpy(made.degrees, row->degrees, sizeof made.degrees);
    return gonio_i_import_add(import, &made);
}

static gonio_status import_groups(const gonio_i_long_table *table, const place *places,
                                  const double *wavelength, const sums *s, gonio_i_import *import)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < table->count && status == GONIO_OK;) {
        const size_t first = k;
        clear(s);
        for (; k < table->count && places[k].first == places[first].first; k++) {
            add(s, places[k].row, channel_of(wavelength, s->channels, places[k].row->wavelength));
        }
        status = hand_on(s, table, places[first].row, import);
    }
    return status;
}

/* Refuses tables that would mostly consist of holes: a small file could otherwise fill the memory.
 */
static gonio_status check_holes(const gonio_i_long_table *table, const place *places,
                                size_t channels, const gonio_i_import *import)
{
    size_t readings = 1;
    for (size_t k = 1; k < table->count; k++) {
        readings += places[k].first != places[k - 1].first;
    }
    return readings * channels <= LEAST_CELLS + MOST_HOLES * table->count
               ? GONIO_OK
               : gonio_i_fail(import->context, GONIO_ERROR_FORMAT,
                              "%s: %zu directions and %zu wavelengths, but only %zu values",
                              import->readings->path, readings, channels, table->count);
}

static gonio_status import_rows(const gonio_i_long_table *table, const double *wavelength,
                                size_t channels, gonio_i_import *import)
{
    double *room = gonio_i_allocate(table->context, 3 * channels, sizeof *room);
    place *places = gonio_i_allocate(table->context, table->count, sizeof *places);
    gonio_status status = room != NULL && places != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        const sums s = {channels, room, room + channels, room + 2 * channels};
        group(table, places);
        status = check_holes(table, places, channels, import);
        if (status == GONIO_OK) {
            status = import_groups(table, places, wavelength, &s, import);
        }
    }
    free(places);
    free(room);
    return status;
}

gonio_status gonio_i_long_table_import(gonio_i_long_table *table, gonio_i_import *import)
{
    double *wavelength = NULL;
    size_t channels = 0;
    if (table->count == 0) {
        return gonio_i_import_channels(import, 1, NULL);
    }
    gonio_status status = table->numbered > 0 ? count_channels(table, &wavelength, &channels)
                                              : find_wavelengths(table, &wavelength, &channels);
    if (status == GONIO_OK && channels > MOST_WAVELENGTHS) {
        status = gonio_i_fail(import->context, GONIO_ERROR_FORMAT,
                              "%s: %zu wavelengths; 1 to %d are expected", import->readings->path,
                              channels, MOST_WAVELENGTHS);
    }
    if (status == GONIO_OK) {
        status = gonio_i_import_channels(import, channels, table->numbered > 0 ? NULL : wavelength);
    }
    if (status == GONIO_OK) {
        status = import_rows(table, wavelength, channels, import);
    }
    free(wavelength);
    return status;
}
