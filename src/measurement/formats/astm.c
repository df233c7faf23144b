/* Readings as ASTM E1392 tables of laboratories: `KEY value` lines, VARS with the names of the
 * columns, then rows of numbers separated by commas. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../../core/text_numbers.h"
#include "../../material/colour.h"
#include "../import.h"
#include "format.h"

enum { MOST_CHANNELS = 4096, ANGLES = 4 };

typedef struct columns {
    size_t channels;
    double *wavelength; /* [channels], nm; or NULL */
    bool tristimulus;   /* X, Y, Z */
} columns;

/* ---- the header ---- */

/* The line of a key; NULL if there is none. text[size] is 0. */
static const char *find_key(const char *text, size_t size, const char *key)
{
    const size_t length = strlen(key);
    const char *at = text;
    while (at != NULL && (size_t)(at - text) < size) {
        if (strncasecmp(at, key, length) == 0 && (at[length] == ' ' || at[length] == '\t')) {
            return at;
        }
        at = memchr(at, '\n', size - (size_t)(at - text));
        at = at != NULL ? at + 1 : NULL;
    }
    return NULL;
}

static size_t count_commas(const char *line)
{
    size_t count = 0;
    for (const char *at = line; *at != '\0' && *at != '\n'; at++) {
        count += *at == ',';
    }
    return count;
}

static bool is_name(const char *at, const char *name)
{
    const size_t length = strlen(name);
    return strncasecmp(at, name, length) == 0 && strchr(", \t\r\n", at[length]) != NULL;
}

static const char *next_name(const char *at)
{
    at += strcspn(at, ",\n");
    at += *at == ',';
    return at + strspn(at, " \t");
}

/* Reads the wavelengths if every name has one. */
static gonio_status read_wavelengths(gonio_context *context, const char *at, columns *c)
{
    c->wavelength = gonio_i_allocate(context, c->channels, sizeof *c->wavelength);
    if (c->wavelength == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < c->channels; k++, at = next_name(at)) {
        char *end = NULL;
        c->wavelength[k] = strtod(at, &end);
        if (end == at || strncasecmp(end, "nm", 2) != 0) {
            free(c->wavelength);
            c->wavelength = NULL;
            return GONIO_OK;
        }
    }
    return GONIO_OK;
}

static gonio_status read_columns(gonio_i_readings_file *file, const char *vars, columns *c)
{
    static const char *const angles[ANGLES] = {"theta_i", "phi_i", "theta_s", "phi_s"};
    const char *at = vars + 4 + strspn(vars + 4, " \t");
    for (int k = 0; k < ANGLES; k++, at = next_name(at)) {
        if (!is_name(at, angles[k])) {
            return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                                "%s: VARS: theta_i,phi_i,theta_s,phi_s and values are expected, in "
                                "this order",
                                file->path);
        }
    }
    const size_t commas = count_commas(vars);
    if (commas < ANGLES || commas - ANGLES + 1 > MOST_CHANNELS) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: VARS names no values, or more "
                            "than %d",
                            file->path, MOST_CHANNELS);
    }
    c->channels = commas - ANGLES + 1;
    c->tristimulus = c->channels == GONIO_CHANNELS && is_name(at, "X") &&
                     is_name(next_name(at), "Y") && is_name(next_name(next_name(at)), "Z");
    return read_wavelengths(file->context, at, c);
}

/* ---- rows ---- */

static gonio_status read_row(gonio_i_numbers *n, gonio_i_import *in, const columns *c,
                             double *number)
{
    const size_t line = n->line;
    const int count = gonio_i_numbers_row(n, number, (int)(ANGLES + c->channels));
    if (count != (int)(ANGLES + c->channels)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: a row of %zu numbers is expected (VARS)", n->path, line,
                            ANGLES + c->channels);
    }
    double rgb[GONIO_CHANNELS];
    gonio_i_row row = {.planned = GONIO_ALL_CHANNELS, .line = line, .value = number + ANGLES};
    for (int k = 0; k < ANGLES; k++) {
        row.degrees[k] = gonio_i_import_degrees(in, number[k]);
    }
    if (c->tristimulus) {
        gonio_i_xyz_to_rgb(row.value, rgb);
        row.value = rgb;
    }
    return gonio_i_import_add(in, &row);
}

static gonio_status read_rows(gonio_i_numbers *n, gonio_i_import *in, const columns *c)
{
    gonio_status status = gonio_i_import_channels(in, c->channels, c->wavelength);
    double *number = NULL;
    if (status == GONIO_OK) {
        number = gonio_i_allocate(n->context, ANGLES + c->channels, sizeof *number);
        status = number != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    while (status == GONIO_OK && gonio_i_numbers_skip(n)) {
        status = read_row(n, in, c, number);
    }
    free(number);
    return status;
}

/* Checks the number of rows against NUM_POINTS. */
static gonio_status check_points(gonio_i_readings_file *file, const char *points, size_t rows)
{
    const unsigned long stated = points != NULL ? strtoul(points + 10, NULL, 10) : rows;
    return stated == rows
               ? GONIO_OK
               : gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                              "%s: %zu rows where NUM_POINTS says %lu; is the file whole?",
                              file->path, rows, stated);
}

static size_t rows_seen(const gonio_i_import *in)
{
    size_t rows = in->readings->count;
    for (int k = 0; k < GONIO_I_REASONS; k++) {
        rows += in->left_out[k];
    }
    return rows;
}

static gonio_status read_table(gonio_i_readings_file *file, const char *vars, gonio_i_import *in)
{
    columns c = {0};
    const char *points = find_key(file->text, file->size, "NUM_POINTS");
    gonio_status status = read_columns(file, vars, &c);
    if (status == GONIO_OK) {
        gonio_i_numbers n =
            gonio_i_numbers_of(file->context, file->path, file->text, file->size, 0);
        n.commas = true;
        gonio_i_numbers_go_to(&n, vars + strcspn(vars, "\n"));
        status = read_rows(&n, in, &c);
    }
    if (status == GONIO_OK) {
        status = check_points(file, points, rows_seen(in));
    }
    free(c.wavelength);
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    static const gonio_convention stated = {.angles = GONIO_RADIANS, .values = GONIO_VALUE_BRDF};
    const char *vars = find_key(file->text, file->size, "VARS");
    if (vars == NULL) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: no line VARS theta_i,phi_i,theta_s,phi_s,...", file->path);
    }
    gonio_i_import in;
    gonio_i_import_begin(&in, file->context, readings, "an ASTM E1392 table", &stated);
    gonio_i_import_leniently(&in);
    return gonio_i_import_end(&in, read_table(file, vars, &in));
}

static bool recognises(const char *text, size_t size)
{
    const char *vars = find_key(text, size, "VARS");
    return vars != NULL && is_name(vars + 4 + strspn(vars + 4, " \t"), "theta_i");
}

const gonio_i_readings_format gonio_i_readings_astm = {
    .word = "astm", .name = "ASTM E1392 table", .recognises = recognises, .read = read};
