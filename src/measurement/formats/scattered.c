/* Scattered readings as text, as Cornell's laboratory and pbrt have them: see measurement.h. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format.h"

enum { MOST_WAVELENGTHS = 4096, ANGLES = 4, DIGITS = 9 };

/* The numbers of a text, one after another. */
typedef struct numbers {
    gonio_context *context;
    const char *path;
    const char *at;
    const char *end;
    size_t line;
} numbers;

/* Passes over blanks and comments; whether there is more. */
static bool skip(numbers *n)
{
    while (n->at < n->end && (isspace((unsigned char)*n->at) || *n->at == '#')) {
        const char *end = *n->at == '#' ? memchr(n->at, '\n', (size_t)(n->end - n->at)) : n->at;
        n->at = end != NULL ? end : n->end;
        n->line += n->at < n->end && *n->at == '\n';
        n->at += n->at < n->end;
    }
    return n->at < n->end;
}

/* The next word. */
static void read_word(numbers *n, char word[64])
{
    size_t length = 0;
    for (; n->at < n->end && !isspace((unsigned char)*n->at) && *n->at != '#'; n->at++) {
        if (length < 63) {
            word[length++] = *n->at;
        }
    }
    word[length] = '\0';
}

static gonio_status read_number(numbers *n, double *value)
{
    char word[64];
    char *end = NULL;
    if (!skip(n)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s: ends within a reading (line %zu); is the file whole?", n->path,
                            n->line);
    }
    read_word(n, word);
    *value = strtod(word, &end);
    if (*end != '\0' || end == word || !isfinite(*value)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT, "%s:%zu: '%.40s' is not a number",
                            n->path, n->line, word);
    }
    return GONIO_OK;
}

/* A text whose first word is a whole number, alone on its line: in a CSV file there are names. */
static bool probe(const char *text, size_t size)
{
    numbers n = {.at = text, .end = text + size, .line = 1};
    char word[64] = "";
    const size_t before = skip(&n) ? n.line : 0;
    read_word(&n, word);
    const bool number = word[0] != '\0' && word[strspn(word, "0123456789")] == '\0';
    return number && skip(&n) && n.line > before;
}

static gonio_status read_wavelength(numbers *n, double *wavelength, size_t k)
{
    const gonio_status status = read_number(n, &wavelength[k]);
    if (status != GONIO_OK) {
        return status;
    }
    if (!(wavelength[k] > 0.0 && wavelength[k] < 1e6)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT, "%s:%zu: %g is not a wavelength in nm",
                            n->path, n->line, wavelength[k]);
    }
    for (size_t j = 0; j < k; j++) {
        if (wavelength[j] == wavelength[k]) {
            return gonio_i_fail(n->context, GONIO_ERROR_FORMAT, "%s:%zu: %g nm occurs twice",
                                n->path, n->line, wavelength[k]);
        }
    }
    return GONIO_OK;
}

static gonio_status read_wavelengths(numbers *n, gonio_readings *readings)
{
    double number = 0.0;
    gonio_status status = read_number(n, &number);
    if (status == GONIO_OK && !(number >= 1.0 && number <= MOST_WAVELENGTHS)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: %g wavelengths; 1 to %d are expected", n->path, n->line,
                            number, MOST_WAVELENGTHS);
    }
    if (status != GONIO_OK) {
        return status;
    }
    const size_t count = (size_t)number;
    double *wavelength = gonio_i_allocate(n->context, count, sizeof *wavelength);
    status = wavelength != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = read_wavelength(n, wavelength, k);
    }
    if (status == GONIO_OK) {
        status = gonio_i_readings_begin(n->context, readings, count, wavelength);
    }
    free(wavelength);
    return status;
}

/* Nine digits, as many as CSV has of these angles: a direction is the same number in both files. */
static double rounded(double degrees)
{
    if (degrees == 0.0) {
        return 0.0;
    }
    const int places = DIGITS - 1 - (int)floor(log10(fabs(degrees)));
    const double scale = pow(10.0, places);
    const double whole = nearbyint(degrees * scale);
    return places >= 0 && places <= 22 ? whole / scale : degrees;
}

static gonio_status read_reading(numbers *n, gonio_readings *readings, double *value)
{
    gonio_i_reading reading = {.planned = GONIO_ALL_CHANNELS, .line = n->line, .value = value};
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < ANGLES && status == GONIO_OK; k++) {
        double radians = 0.0;
        status = read_number(n, &radians);
        reading.degrees[k] = rounded(radians * 180.0 / M_PI);
    }
    for (size_t k = 0; k < readings->channels && status == GONIO_OK; k++) {
        status = read_number(n, &value[k]);
    }
    return status == GONIO_OK ? gonio_i_readings_add(n->context, readings, &reading) : status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    numbers n = {.context = file->context,
                 .path = file->path,
                 .at = file->text,
                 .end = file->text + file->size,
                 .line = 1};
    readings->keep_angles = true;
    gonio_status status = read_wavelengths(&n, readings);
    if (status != GONIO_OK) {
        return status;
    }
    double *value = gonio_i_allocate(file->context, readings->channels, sizeof *value);
    status = value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    while (status == GONIO_OK && skip(&n)) {
        status = read_reading(&n, readings, value);
    }
    free(value);
    return status;
}

const gonio_i_readings_format gonio_i_readings_scattered = {
    .name = "scattered readings as text", .probe = probe, .read = read};
