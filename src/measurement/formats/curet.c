/* Readings of the CUReT database (Dana et al. 1999): a line for each sample, its number and values
 * at 205 pairs of directions, which stand in table.txt beside it: number, theta_v, phi_v, theta_l,
 * phi_l in radians. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/text_file.h"
#include "../../core/text_numbers.h"
#include "../import.h"
#include "format.h"

enum { PAIRS = 205, ROW = 1 + PAIRS, TABLE_ROW = 5, MOST_SAMPLES = 1000 };

static bool is_whole(double number)
{
    return number >= 1.0 && number <= 1e6 && floor(number) == number;
}

/* ---- the directions ---- */

static char *beside(gonio_context *context, const char *path)
{
    char *made = NULL;
    const char *slash = strrchr(path, '/');
    const int folder = slash != NULL ? (int)(slash - path) + 1 : 0;
    if (asprintf(&made, "%.*stable.txt", folder, path) < 0) {
        gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
        return NULL;
    }
    return made;
}

static gonio_status parse_directions(gonio_i_numbers *n, double (*angle)[4])
{
    for (size_t k = 0; k < PAIRS; k++) {
        double x[TABLE_ROW];
        (void)gonio_i_numbers_skip(n);
        const size_t line = n->line;
        if (gonio_i_numbers_row(n, x, TABLE_ROW) != TABLE_ROW || x[0] != (double)(k + 1)) {
            return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                                "%s:%zu: the number %zu and theta_v, phi_v, theta_l, phi_l are "
                                "expected: CUReT's table of directions",
                                n->path, line, k + 1);
        }
        memcpy(angle[k], (double[4]){x[3], x[4], x[1], x[2]}, sizeof angle[k]);
    }
    return GONIO_OK;
}

/* Reads the table. If it is missing, the message says what it is for. */
static gonio_status read_table(const gonio_i_readings_file *file, const char *path, char **text,
                               size_t *size)
{
    const gonio_status status = gonio_i_text_read(NULL, path, text, size);
    return status == GONIO_OK
               ? status
               : gonio_i_fail(file->context, status,
                              "%s: the directions of CUReT's values are expected in table.txt "
                              "beside it; %s cannot be read (%s)",
                              file->path, path, gonio_status_text(status));
}

static gonio_status read_directions(const gonio_i_readings_file *file, double (*angle)[4])
{
    char *text = NULL;
    size_t size = 0;
    char *path = beside(file->context, file->path);
    gonio_status status = path != NULL ? read_table(file, path, &text, &size) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        gonio_i_numbers n = gonio_i_numbers_of(file->context, path, text, size, '#');
        status = parse_directions(&n, angle);
    }
    free(text);
    free(path);
    return status;
}

/* ---- the samples ---- */

typedef struct samples {
    size_t count;
    int number[MOST_SAMPLES];
    double value[PAIRS]; /* of the one that is read */
    size_t line;         /* that it stands in; 0: not found */
} samples;

static gonio_status read_samples(gonio_i_numbers *n, int wanted, samples *s)
{
    double row[ROW];
    while (gonio_i_numbers_skip(n)) {
        const size_t line = n->line;
        if (gonio_i_numbers_row(n, row, ROW) != ROW || !is_whole(row[0]) ||
            s->count == MOST_SAMPLES) {
            return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                                "%s:%zu: a sample's number and %d values are expected", n->path,
                                line, PAIRS);
        }
        s->number[s->count++] = (int)row[0];
        if (s->line == 0 && (wanted == 0 || wanted == (int)row[0])) {
            memcpy(s->value, row + 1, sizeof s->value);
            s->line = line;
        }
    }
    return GONIO_OK;
}

static void print_numbers(const samples *s, char *text, size_t size)
{
    size_t used = 0;
    for (size_t k = 0; k < s->count && used < size; k++) {
        used += (size_t)snprintf(text + used, size - used, "%s%d", k > 0 ? ", " : "", s->number[k]);
    }
}

static gonio_status choose_sample(const gonio_i_readings_file *file, gonio_readings *readings,
                                  const samples *s, int wanted)
{
    char numbers[512] = "";
    print_numbers(s, numbers, sizeof numbers);
    if (s->line == 0) {
        return gonio_i_fail(file->context, GONIO_ERROR_DATA, "%s: no sample %d; there are %s",
                            file->path, wanted, numbers);
    }
    return wanted > 0 || s->count == 1
               ? GONIO_OK
               : gonio_i_readings_note(file->context, readings,
                                       "%zu samples, of which the first is read; --as sample=N "
                                       "reads another: %s",
                                       s->count, numbers);
}

/* ---- readings ---- */

static gonio_status import_sample(const samples *s, const double (*angle)[4], gonio_i_import *in)
{
    gonio_status status = gonio_i_import_channels(in, 1, NULL);
    for (size_t k = 0; k < PAIRS && status == GONIO_OK; k++) {
        gonio_i_row row = {.planned = GONIO_ALL_CHANNELS, .line = s->line, .value = &s->value[k]};
        for (int a = 0; a < 4; a++) {
            row.degrees[a] = gonio_i_import_degrees(in, angle[k][a]);
        }
        status = gonio_i_import_add(in, &row);
    }
    return status;
}

static gonio_status read_sample(gonio_i_readings_file *file, gonio_readings *readings, samples *s)
{
    const int wanted = readings->options.as.sample;
    gonio_i_numbers n = gonio_i_numbers_of(file->context, file->path, file->text, file->size, '#');
    const gonio_status status = read_samples(&n, wanted, s);
    return status == GONIO_OK ? choose_sample(file, readings, s, wanted) : status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    static const gonio_convention stated = {.angles = GONIO_RADIANS, .values = GONIO_VALUE_BRDF};
    double angle[PAIRS][4] = {{0.0}};
    samples s = {0};
    gonio_i_import in;
    gonio_i_import_begin(&in, file->context, readings, "a sample of CUReT", &stated);
    gonio_i_import_leniently(&in);
    gonio_status status = read_sample(file, readings, &s);
    if (status == GONIO_OK) {
        status = read_directions(file, angle);
    }
    if (status == GONIO_OK) {
        status = import_sample(&s, (const double(*)[4])angle, &in);
    }
    return gonio_i_import_end(&in, status);
}

/* Whether the first line has a whole number and 205 numbers. */
static bool recognises(const char *text, size_t size)
{
    gonio_i_numbers n = gonio_i_numbers_of(NULL, "", text, size, '#');
    double row[ROW];
    return gonio_i_numbers_skip(&n) && gonio_i_numbers_row(&n, row, ROW) == ROW && is_whole(row[0]);
}

const gonio_i_readings_format gonio_i_readings_curet = {
    .word = "curet", .name = "CUReT", .recognises = recognises, .read = read};
