/* Scattered readings as text, in the format of Cornell's laboratory and pbrt: see measurement.h. */
#include <stdlib.h>
#include <string.h>

#include "../../core/text_numbers.h"
#include "../import.h"
#include "format.h"

enum { MOST_WAVELENGTHS = 4096, ANGLES = 4, LEAST_WAVELENGTH = 100 };

static bool is_whole_number(const char *word)
{
    return word[0] != '\0' && word[strspn(word, "0123456789")] == '\0';
}

/* Whether the rest of a line could be wavelengths or the first of them: at most `most` numbers,
 * which are larger than values and angles in radians. */
static bool begins_with_wavelengths(gonio_i_numbers *n, size_t most)
{
    double wavelength = 0.0;
    size_t count = 0;
    bool good = true;
    while (good && gonio_i_numbers_skip_blanks(n)) {
        char word[GONIO_I_WORD];
        char *end = NULL;
        gonio_i_numbers_word(n, word);
        wavelength = strtod(word, &end);
        good = *end == '\0' && wavelength >= LEAST_WAVELENGTH && ++count <= most;
    }
    return good;
}

/* Whether a text begins with a whole number and as many wavelengths. A CSV file has names there.
 * The reader checks the numbers. */
static bool recognises(const char *text, size_t size)
{
    gonio_i_numbers n = gonio_i_numbers_of(NULL, "", text, size, '#');
    char word[GONIO_I_WORD] = "";
    const size_t before = gonio_i_numbers_skip(&n) ? n.line : 0;
    gonio_i_numbers_word(&n, word);
    return is_whole_number(word) && begins_with_wavelengths(&n, strtoul(word, NULL, 10)) &&
           gonio_i_numbers_skip(&n) && n.line > before;
}

static gonio_status read_wavelengths(gonio_i_numbers *n, gonio_i_import *in)
{
    double number = 0.0;
    gonio_status status = gonio_i_numbers_read(n, &number);
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
        status = gonio_i_numbers_read(n, &wavelength[k]);
    }
    if (status == GONIO_OK) {
        status = gonio_i_import_channels(in, count, wavelength);
    }
    free(wavelength);
    return status;
}

static gonio_status read_row(gonio_i_numbers *n, gonio_i_import *in, double *value)
{
    gonio_i_row row = {.planned = GONIO_ALL_CHANNELS, .line = n->line, .value = value};
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < ANGLES && status == GONIO_OK; k++) {
        double angle = 0.0;
        status = gonio_i_numbers_read(n, &angle);
        row.degrees[k] = gonio_i_import_degrees(in, angle);
    }
    for (size_t k = 0; k < in->readings->channels && status == GONIO_OK; k++) {
        status = gonio_i_numbers_read(n, &value[k]);
    }
    return status == GONIO_OK ? gonio_i_import_add(in, &row) : status;
}

static gonio_status read_rows(gonio_i_numbers *n, gonio_i_import *in)
{
    gonio_status status = read_wavelengths(n, in);
    double *value = NULL;
    if (status == GONIO_OK) {
        value = gonio_i_allocate(n->context, in->readings->channels, sizeof *value);
        status = value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    while (status == GONIO_OK && gonio_i_numbers_skip(n)) {
        status = read_row(n, in, value);
    }
    free(value);
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    static const gonio_convention stated = {
        .angles = GONIO_RADIANS, .values = GONIO_VALUE_BRDF, .wavelengths = GONIO_NANOMETRES};
    gonio_i_numbers n = gonio_i_numbers_of(file->context, file->path, file->text, file->size, '#');
    gonio_i_import in;
    gonio_i_import_begin(&in, file->context, readings, "scattered readings (Cornell, pbrt)",
                         &stated);
    return gonio_i_import_end(&in, read_rows(&n, &in));
}

const gonio_i_readings_format gonio_i_readings_scattered = {.word = "scattered",
                                                            .name = "scattered readings as text",
                                                            .recognises = recognises,
                                                            .read = read};
