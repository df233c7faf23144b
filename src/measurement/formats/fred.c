/* Readings as FRED text, which RPC Photonics and VIAVI also write. A block is a line with the
 * incidence (theta, phi) and lines with theta, phi and a value. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../../core/text_numbers.h"
#include "../import.h"
#include "format.h"

/* The value where the detector was blocked. */
static const double BLOCKED = 1e-5;

typedef struct settings {
    bool sines;     /* the file has sin theta in place of theta */
    bool logarithm; /* values are decimal logarithms */
    double scale;
} settings;

/* ---- the header: "type bsdf_data", "format angles=deg bsdf=value scale=1" ---- */

static bool is_setting(const char *word, const char *name, const char *value)
{
    const size_t length = strlen(name);
    return strncasecmp(word, name, length) == 0 && word[length] == '=' &&
           strncasecmp(word + length + 1, value, strlen(value)) == 0;
}

static void read_setting(const char *word, settings *s)
{
    s->sines = s->sines || is_setting(word, "angles", "sin");
    s->logarithm = s->logarithm || is_setting(word, "bsdf", "log");
    if (strncasecmp(word, "scale=", 6) == 0) {
        s->scale = strtod(word + 6, NULL);
    }
}

static gonio_status read_header_line(gonio_i_numbers *n, settings *s)
{
    while (gonio_i_numbers_skip_blanks(n)) {
        char word[GONIO_I_WORD];
        gonio_i_numbers_word(n, word);
        read_setting(word, s);
    }
    return s->scale > 0.0 && isfinite(s->scale)
               ? GONIO_OK
               : gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                              "%s:%zu: the scale is not a number above 0", n->path, n->line);
}

/* ---- rows ---- */

static double polar(const settings *s, double theta)
{
    return s->sines && fabs(theta) <= 1.0 ? asin(theta) * 180.0 / M_PI : theta;
}

static gonio_status add_row(gonio_i_import *in, const settings *s, const double incidence[2],
                            const double number[3], size_t line)
{
    double value = (s->logarithm ? pow(10.0, number[2]) : number[2]) * s->scale;
    const bool blocked = number[2] == BLOCKED && in->how.zeros == GONIO_ZEROS_MISSING;
    value = blocked ? NAN : value;
    const gonio_i_row row = {.degrees = {gonio_i_import_degrees(in, incidence[0]),
                                         gonio_i_import_degrees(in, incidence[1]),
                                         gonio_i_import_degrees(in, polar(s, number[0])),
                                         gonio_i_import_degrees(in, number[1])},
                             .planned = GONIO_ALL_CHANNELS,
                             .line = line,
                             .value = &value};
    return gonio_i_import_add(in, &row);
}

static gonio_status bad_row(const gonio_i_numbers *n, size_t line, const char *problem)
{
    return gonio_i_fail(n->context, GONIO_ERROR_FORMAT, "%s:%zu: %s", n->path, line, problem);
}

/* Reads a line. Two numbers are an incidence, three a value there. */
static gonio_status read_row(gonio_i_numbers *n, gonio_i_import *in, const settings *s,
                             double incidence[2])
{
    double number[3];
    const size_t line = n->line;
    const int count = gonio_i_numbers_row(n, number, 3);
    if (count == 2) {
        incidence[0] = polar(s, number[0]);
        incidence[1] = number[1];
        return GONIO_OK;
    }
    if (count != 3) {
        return bad_row(n, line, "2 numbers (an incidence) or 3 (theta, phi, value) are expected");
    }
    return isnan(incidence[0]) ? bad_row(n, line, "a value before the first incidence")
                               : add_row(in, s, incidence, number, line);
}

static bool begins_number(char c)
{
    return c != '\0' && strchr("+-.0123456789", c) != NULL;
}

static gonio_status read_lines(gonio_i_numbers *n, gonio_i_import *in)
{
    settings s = {.scale = 1.0};
    double incidence[2] = {NAN, 0.0};
    gonio_status status = gonio_i_import_channels(in, 1, NULL);
    while (status == GONIO_OK && gonio_i_numbers_skip(n)) {
        status = begins_number(*n->at) ? read_row(n, in, &s, incidence) : read_header_line(n, &s);
    }
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    static const gonio_convention stated = {.angles = GONIO_DEGREES,
                                            .values = GONIO_VALUE_BRDF,
                                            .mirror = GONIO_MIRROR_0,
                                            .zeros = GONIO_ZEROS_MISSING};
    gonio_i_numbers n = gonio_i_numbers_of(file->context, file->path, file->text, file->size, '!');
    gonio_i_import in;
    gonio_i_import_begin(&in, file->context, readings, "FRED text", &stated);
    gonio_i_import_leniently(&in);
    return gonio_i_import_end(&in, read_lines(&n, &in));
}

static bool recognises(const char *text, size_t size)
{
    return memmem(text, size, "bsdf_data", 9) != NULL;
}

const gonio_i_readings_format gonio_i_readings_fred = {
    .word = "fred", .name = "FRED text", .recognises = recognises, .read = read};
