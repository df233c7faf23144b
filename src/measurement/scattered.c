/* Scattered readings as text, as Cornell's laboratory and pbrt have them: see measurement.h. */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "readings.h"

enum { MOST_WAVELENGTHS = 4096, ANGLES = 4 };

/* The numbers of a file, one after another. */
typedef struct numbers {
    gonio_context *context;
    const char *path;
    FILE *file;
    size_t line;
} numbers;

/* Passes over blanks and comments; returns the next character, which stays to be read. */
static int skip(numbers *n)
{
    int c = fgetc(n->file);
    for (; isspace(c) || c == '#'; c = fgetc(n->file)) {
        const bool comment = c == '#';
        while (comment && c != '\n' && c != EOF) {
            c = fgetc(n->file);
        }
        n->line += c == '\n';
    }
    if (c != EOF) {
        ungetc(c, n->file);
    }
    return c;
}

/* The next word. */
static void read_word(numbers *n, char word[64])
{
    size_t length = 0;
    for (int c = fgetc(n->file); c != EOF; c = fgetc(n->file)) {
        if (isspace(c) || c == '#') {
            ungetc(c, n->file);
            break;
        }
        if (length < 63) {
            word[length++] = (char)c;
        }
    }
    word[length] = '\0';
}

static gonio_status read_number(numbers *n, double *value)
{
    char word[64];
    char *end = NULL;
    if (skip(n) == EOF) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s: ends within a reading (line %zu); is the file whole?", n->path,
                            n->line);
    }
    read_word(n, word);
    *value = strtod(word, &end);
    if (*end != '\0' || end == word || !isfinite(*value)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT, "%s:%zu: '%.40s' is no number", n->path,
                            n->line, word);
    }
    return GONIO_OK;
}

/* A text whose first word is a whole number, alone on its line: in a CSV file there are names. */
bool gonio_i_scattered_probe(const char *path)
{
    numbers n = {.path = path, .file = fopen(path, "rbe"), .line = 1};
    char word[64] = "";
    if (n.file == NULL) {
        return false;
    }
    const size_t before = skip(&n) != EOF ? n.line : 0;
    read_word(&n, word);
    const bool number = word[0] != '\0' && word[strspn(word, "0123456789")] == '\0';
    const int next = number ? skip(&n) : EOF;
    fclose(n.file);
    return number && next != EOF && n.line > before;
}

static gonio_status read_wavelengths(numbers *n, gonio_i_csv *csv, size_t *count)
{
    static const char *const angles[ANGLES] = {"theta_i_deg", "phi_i_deg", "theta_o_deg",
                                               "phi_o_deg"};
    double number = 0.0;
    gonio_status status = read_number(n, &number);
    if (status == GONIO_OK && !(number >= 1.0 && number <= MOST_WAVELENGTHS)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: %g wavelengths; 1 to %d are expected", n->path, n->line,
                            number, MOST_WAVELENGTHS);
    }
    *count = (size_t)number;
    bool done = true;
    for (size_t k = 0; k < ANGLES && done; k++) {
        done = gonio_i_csv_add_column(csv, angles[k]);
    }
    for (size_t k = 0; k < *count && status == GONIO_OK && done; k++) {
        char name[48];
        status = read_number(n, &number);
        if (status == GONIO_OK && !(number > 0.0 && number < 1e6)) {
            return gonio_i_fail(n->context, GONIO_ERROR_FORMAT, "%s:%zu: %g is no wavelength in nm",
                                n->path, n->line, number);
        }
        snprintf(name, sizeof name, "%.10gnm_per_sr", number);
        if (status == GONIO_OK && gonio_i_csv_column(csv, name) >= 0) {
            return gonio_i_fail(n->context, GONIO_ERROR_FORMAT, "%s:%zu: %g nm occurs twice",
                                n->path, n->line, number);
        }
        done = gonio_i_csv_add_column(csv, name);
    }
    return status == GONIO_OK && !done ? GONIO_ERROR_MEMORY : status;
}

static gonio_status read_reading(numbers *n, gonio_i_csv *csv, size_t wavelengths)
{
    const size_t row = csv->rows;
    gonio_status status = gonio_i_csv_add_row(csv, n->line) ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < ANGLES + wavelengths && status == GONIO_OK; k++) {
        double value = 0.0;
        status = read_number(n, &value);
        if (status == GONIO_OK) {
            const double given = k < ANGLES ? value * 180.0 / M_PI : value;
            status = gonio_i_csv_set(csv, row, k, "%.9g", given) ? GONIO_OK : GONIO_ERROR_MEMORY;
        }
    }
    return status;
}

gonio_status gonio_i_scattered_read(gonio_context *context, const char *path, gonio_i_csv **csv)
{
    numbers n = {.context = context, .path = path, .file = fopen(path, "rbe"), .line = 1};
    if (n.file == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    }
    size_t wavelengths = 0;
    gonio_i_csv *made = gonio_i_csv_create(context);
    gonio_status status =
        made == NULL ? GONIO_ERROR_MEMORY : read_wavelengths(&n, made, &wavelengths);
    while (status == GONIO_OK && skip(&n) != EOF) {
        status = read_reading(&n, made, wavelengths);
    }
    if (status == GONIO_OK && ferror(n.file)) {
        status =
            gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    }
    fclose(n.file);
    if (status != GONIO_OK) {
        gonio_i_csv_free(&made);
        return status;
    }
    *csv = made;
    return GONIO_OK;
}
