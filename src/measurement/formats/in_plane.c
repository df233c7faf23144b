/* Readings in the plane of incidence as columns of text. Either names are in the last `#` line and
 * numbers are separated by blanks (Scatterworks, NASA's CAR). Or columns are an incident angle, a
 * measured angle and reflectance factors by wavelength, separated by commas (OMS). */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../../core/text_numbers.h"
#include "../import.h"
#include "format.h"

enum { THETA_I, PHI_I, THETA_O, PHI_O, VALUE, MOST_COLUMNS = 4096 };

/* The value where a value was too low for the instrument. */
static const double FLOOR = 1e-4;

typedef struct column_name {
    const char *name;
    int role;
} column_name;

static const column_name column_names[] = {
    {"theta_i", THETA_I},
    {"phi_i", PHI_I},
    {"theta_o", THETA_O},
    {"phi_o", PHI_O},
    {"theta_r", THETA_O},
    {"phi_r", PHI_O},
    {"theta_s", THETA_O},
    {"phi_s", PHI_O},
    {"zenith_i", THETA_I},
    {"azimuth_i", PHI_I},
    {"zenith_o", THETA_O},
    {"azimuth_o", PHI_O},
    {"incident_angle", THETA_I},
    {"measure_angle", THETA_O},
    {"brdf", VALUE},
    {"bsdf", VALUE},
    {"value", VALUE},
};

enum { NAMES = sizeof column_names / sizeof *column_names };

typedef struct columns {
    size_t count;
    int role[MOST_COLUMNS];
    double *wavelength; /* [count]: of a value; 0: none */
    size_t values;
    bool found[VALUE]; /* of the angles */
    bool factors;      /* an incident and a measured angle: an OMS table */
} columns;

/* ---- the names ---- */

static bool is_between(char c)
{
    return c == ',' || c == ' ' || c == '\t' || c == '\r';
}

/* The next name of a line; its length is 0 at the end. A blank before a unit belongs to the name.
 */
static const char *next_name(const char *at, const char *end, size_t *length)
{
    while (at < end && is_between(*at)) {
        at++;
    }
    const char *stop = at;
    while (stop < end && !is_between(*stop)) {
        stop++;
    }
    *length = (size_t)(stop - at);
    return at;
}

static double wavelength_of(const char *name, size_t length)
{
    char *unit = NULL;
    const double value = strtod(name, &unit);
    return unit > name && unit + 2 == name + length && strncasecmp(unit, "nm", 2) == 0 ? value
                                                                                       : 0.0;
}

static int role_of(const char *name, size_t length)
{
    for (int k = 0; k < NAMES; k++) {
        if (strlen(column_names[k].name) == length &&
            strncasecmp(column_names[k].name, name, length) == 0) {
            return column_names[k].role;
        }
    }
    return wavelength_of(name, length) > 0.0 ? VALUE : -1;
}

/* Whether a table of reflectance factors may have a column: Incident_angle, Measure_angle, or
 * values by wavelength alone. */
static bool is_of_factors(int role, const char *name, size_t length)
{
    static const char angle[] = "angle";
    const size_t end = sizeof angle - 1;
    return role == VALUE ? wavelength_of(name, length) > 0.0
                         : length > end && strncasecmp(name + length - end, angle, end) == 0;
}

/* Finds the columns of a line of names. False unless all names are known and there are angles and
 * values. */
static bool find_columns(const char *line, const char *end, columns *c)
{
    size_t length = 0;
    bool factors = true;
    c->count = 0;
    c->values = 0;
    memset(c->found, 0, sizeof c->found);
    for (const char *at = next_name(line, end, &length); length > 0;
         at = next_name(at + length, end, &length)) {
        const int role = role_of(at, length);
        if (role < 0 || c->count == MOST_COLUMNS || (role < VALUE && c->found[role])) {
            return false;
        }
        c->role[c->count++] = role;
        c->values += role == VALUE;
        if (role < VALUE) {
            c->found[role] = true;
        }
        factors = factors && is_of_factors(role, at, length);
    }
    c->factors = factors && !c->found[PHI_I] && !c->found[PHI_O];
    return c->found[THETA_I] && c->found[THETA_O] && c->found[PHI_I] == c->found[PHI_O] &&
           c->values > 0;
}

/* Wavelengths of the values, in the order of the columns. */
static gonio_status find_wavelengths(gonio_context *context, const char *line, const char *end,
                                     columns *c)
{
    size_t length = 0;
    size_t k = 0;
    c->wavelength = gonio_i_allocate(context, c->count, sizeof *c->wavelength);
    if (c->wavelength == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (const char *at = next_name(line, end, &length); length > 0;
         at = next_name(at + length, end, &length)) {
        if (role_of(at, length) == VALUE) {
            c->wavelength[k++] = wavelength_of(at, length);
        }
    }
    return GONIO_OK;
}

static const char *line_end(const char *at, const char *end)
{
    const char *stop = memchr(at, '\n', (size_t)(end - at));
    return stop != NULL ? stop : end;
}

/* The line of names: the last `#` line before the first row, otherwise the first line. NULL: none.
 */
static const char *find_names(const char *text, const char *end, const char **stop)
{
    const char *found = NULL;
    const char *at = text;
    while (at < end && *at == '#') {
        found = at + 1;
        *stop = line_end(at, end);
        at = *stop < end ? *stop + 1 : end;
    }
    if (found == NULL) {
        found = text;
        *stop = line_end(text, end);
    }
    return found;
}

/* Whether names are in a comment, as CSV never has them. Of names separated by commas, only the
 * table of two angles is of this format. */
static bool recognises(const char *text, size_t size)
{
    const char *stop = NULL;
    columns c = {0};
    const char *names = find_names(text, text + size, &stop);
    return find_columns(names, stop, &c) && (text[0] == '#' || c.factors);
}

/* ---- the comments ---- */

/* "... 532 nm": the number before the last "nm" of a word; 0 if there is none. */
static double wavelength_in(const char *text, const char *end)
{
    double found = 0.0;
    for (const char *at = text; at + 1 < end; at++) {
        const bool unit = at[0] == 'n' && at[1] == 'm' && !isalpha((unsigned char)at[2]);
        const char *digit = at;
        while (unit && digit > text && digit[-1] == ' ') {
            digit--;
        }
        while (unit && digit > text && (isdigit((unsigned char)digit[-1]) || digit[-1] == '.')) {
            digit--;
        }
        const double value = unit ? strtod(digit, NULL) : 0.0;
        found = value >= 100.0 && value <= 1e5 ? value : found;
    }
    return found;
}

/* ---- rows ---- */

/* Whether theta and phi are exchanged: some files call the polar angle phi. A theta beyond 90
 * degrees is then an azimuth. */
static bool are_exchanged(gonio_i_numbers n, const columns *c)
{
    double number[MOST_COLUMNS];
    double theta = 0.0;
    double phi = 0.0;
    while (gonio_i_numbers_skip(&n)) {
        if (gonio_i_numbers_row(&n, number, (int)c->count) != (int)c->count) {
            return false;
        }
        for (size_t k = 0; k < c->count; k++) {
            const bool polar = c->role[k] == THETA_I || c->role[k] == THETA_O;
            const double size = fabs(number[k]);
            theta = polar && size > theta ? size : theta;
            phi = !polar && c->role[k] != VALUE && size > phi ? size : phi;
        }
    }
    return theta > 90.0 && phi <= 90.0;
}

static void exchange(columns *c)
{
    static const int other[VALUE + 1] = {PHI_I, THETA_I, PHI_O, THETA_O, VALUE};
    for (size_t k = 0; k < c->count; k++) {
        c->role[k] = other[c->role[k]];
    }
}

static double value_of(const gonio_i_import *in, const columns *c, double number)
{
    const bool low = !c->factors && number == FLOOR && in->how.zeros == GONIO_ZEROS_MISSING;
    return low ? NAN : number;
}

static gonio_status read_row(gonio_i_numbers *n, gonio_i_import *in, const columns *c,
                             double *number, double *value)
{
    gonio_i_row row = {.degrees = {0.0, 0.0, 0.0, 180.0},
                       .planned = GONIO_ALL_CHANNELS,
                       .line = n->line,
                       .value = value};
    size_t values = 0;
    if (gonio_i_numbers_row(n, number, (int)c->count) != (int)c->count) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: a row of %zu numbers is expected, as many as names", n->path,
                            row.line, c->count);
    }
    for (size_t k = 0; k < c->count; k++) {
        if (c->role[k] == VALUE) {
            value[values++] = value_of(in, c, number[k]);
        } else {
            row.degrees[c->role[k]] = gonio_i_import_degrees(in, number[k]);
        }
    }
    return gonio_i_import_add(in, &row);
}

static gonio_status read_rows(gonio_i_numbers *n, gonio_i_import *in, const columns *c)
{
    double *number = gonio_i_allocate(n->context, c->count + c->values, sizeof *number);
    gonio_status status = number != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    while (status == GONIO_OK && gonio_i_numbers_skip(n)) {
        status = read_row(n, in, c, number, number + c->count);
    }
    free(number);
    return status;
}

/* ---- all ---- */

static gonio_status begin_channels(gonio_i_import *in, const char *text, const char *names,
                                   const columns *c)
{
    if (c->values == 1 && c->wavelength[0] == 0.0) {
        const double stated = wavelength_in(text, names);
        return gonio_i_import_channels(in, 1, stated > 0.0 ? &stated : NULL);
    }
    bool named = true;
    for (size_t k = 0; k < c->values; k++) {
        named = named && c->wavelength[k] > 0.0;
    }
    return gonio_i_import_channels(in, c->values, named ? c->wavelength : NULL);
}

static gonio_status read_table(gonio_i_readings_file *file, columns *c, const char *names,
                               const char *stop, gonio_i_import *in)
{
    gonio_i_numbers n = gonio_i_numbers_of(file->context, file->path, file->text, file->size, '#');
    n.commas = true;
    gonio_i_numbers_go_to(&n, stop);
    if (!c->factors && are_exchanged(n, c)) {
        exchange(c);
        in->taken_as = "columns of text (phi is the polar angle, theta the azimuth)";
    }
    gonio_status status = find_wavelengths(file->context, names, stop, c);
    if (status == GONIO_OK) {
        status = begin_channels(in, file->text, names, c);
    }
    return status == GONIO_OK ? read_rows(&n, in, c) : status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    columns c = {0};
    const char *stop = NULL;
    const char *names = find_names(file->text, file->text + file->size, &stop);
    if (!find_columns(names, stop, &c)) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: no line of names: theta_i, phi_i, theta_o, phi_o and brdf, or "
                            "Incident_angle, Measure_angle and wavelengths",
                            file->path);
    }
    const gonio_convention stated = {.angles = GONIO_DEGREES,
                                     .values = c.factors ? GONIO_VALUE_FACTOR : GONIO_VALUE_BRDF,
                                     .zeros = GONIO_ZEROS_MISSING};
    gonio_i_import in;
    gonio_i_import_begin(&in, file->context, readings,
                         c.factors ? "in-plane readings (OMS; positive on the mirror's side)"
                                   : "columns of text",
                         &stated);
    gonio_i_import_leniently(&in);
    const gonio_status status = read_table(file, &c, names, stop, &in);
    free(c.wavelength);
    return gonio_i_import_end(&in, status);
}

const gonio_i_readings_format gonio_i_readings_in_plane = {
    .word = "in-plane", .name = "columns of text", .recognises = recognises, .read = read};
