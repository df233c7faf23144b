/* Readings as text of pab-opto and Mountain goniophotometers: `#key value` lines, then rows of
 * theta, phi and values at one incidence. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../../core/text_numbers.h"
#include "../../material/colour.h"
#include "../import.h"
#include "format.h"

enum { MOST_VALUES = 64 };

typedef struct header {
    double incidence[2]; /* theta, phi; degrees */
    bool known[2];
    double up; /* the phi from which azimuths are counted */
    size_t values;
    int kind;    /* gonio_value_kind */
    bool colour; /* values are X, Y, Z */
} header;

static double number_after(gonio_i_numbers *n, bool *known)
{
    char word[GONIO_I_WORD] = "";
    char *end = NULL;
    if (gonio_i_numbers_skip_blanks(n)) {
        gonio_i_numbers_word(n, word);
    }
    const double value = strtod(word, &end);
    *known = end != word && *end == '\0';
    return value;
}

/* Reads `#format: theta phi BSDF`, a column for each word. DSF includes the cosine. */
static void read_format(gonio_i_numbers *n, header *h)
{
    size_t columns = 0;
    char word[GONIO_I_WORD] = "";
    while (gonio_i_numbers_skip_blanks(n)) {
        gonio_i_numbers_word(n, word);
        columns++;
    }
    h->values = columns > 2 ? columns - 2 : 0;
    h->kind = strcasecmp(word, "DSF") == 0 ? GONIO_VALUE_COSINE : GONIO_VALUE_BRDF;
}

static void read_colorimetry(gonio_i_numbers *n, header *h)
{
    char word[GONIO_I_WORD] = "";
    if (gonio_i_numbers_skip_blanks(n)) {
        gonio_i_numbers_word(n, word);
    }
    h->colour = strcasecmp(word, "CIE-XYZ") == 0;
}

/* Reads the key of a line `#key` or `#key:`, without both signs. */
static void read_name(gonio_i_numbers *n, char name[GONIO_I_WORD])
{
    char word[GONIO_I_WORD];
    gonio_i_numbers_word(n, word);
    const char *begin = word + strspn(word, "#");
    const size_t length = strcspn(begin, ":");
    memcpy(name, begin, length);
    name[length] = '\0';
}

static void read_key(gonio_i_numbers *n, header *h)
{
    char name[GONIO_I_WORD];
    bool known = false;
    read_name(n, name);
    if (strcasecmp(name, "format") == 0) {
        read_format(n, h);
    } else if (strcasecmp(name, "colorimetry") == 0) {
        read_colorimetry(n, h);
    } else if (strcasecmp(name, "intheta") == 0) {
        h->incidence[0] = number_after(n, &h->known[0]);
    } else if (strcasecmp(name, "inphi") == 0) {
        h->incidence[1] = number_after(n, &h->known[1]);
    } else if (strcasecmp(name, "incident_angle") == 0) {
        h->incidence[0] = number_after(n, &h->known[0]);
        h->incidence[1] = number_after(n, &h->known[1]);
    } else if (strcasecmp(name, "upphi") == 0) {
        h->up = number_after(n, &known);
    }
    gonio_i_numbers_next_line(n);
}

static gonio_status check_header(const gonio_i_numbers *n, const header *h)
{
    if (!h->known[0]) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s: no '#intheta' or '#incident_angle' with a number before the rows",
                            n->path);
    }
    if (h->values < 1 || h->values > MOST_VALUES || (h->colour && h->values != GONIO_CHANNELS)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s: '#format' names %zu values; 1 to %d are read, 3 of CIE-XYZ",
                            n->path, h->values, MOST_VALUES);
    }
    return GONIO_OK;
}

static gonio_status read_row(gonio_i_numbers *n, gonio_i_import *in, const header *h)
{
    double x[2 + MOST_VALUES];
    double rgb[GONIO_CHANNELS];
    const size_t line = n->line;
    const int count = gonio_i_numbers_row(n, x, 2 + MOST_VALUES);
    if (count != (int)(2 + h->values)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: a row of %zu numbers is expected (#format)", n->path, line,
                            2 + h->values);
    }
    gonio_i_row row = {.degrees = {h->incidence[0], h->incidence[1] - h->up, x[0], x[1] - h->up},
                       .planned = GONIO_ALL_CHANNELS,
                       .line = line,
                       .value = x + 2};
    if (h->colour) {
        gonio_i_xyz_to_rgb(x + 2, rgb);
        row.value = rgb;
    }
    for (int k = 0; k < 4; k++) {
        row.degrees[k] = gonio_i_import_degrees(in, row.degrees[k]);
    }
    return gonio_i_import_add(in, &row);
}

/* Reads rows. Keys may be between them: a file of several incidences has the keys of each before
 * its rows. */
static gonio_status read_rows(gonio_i_numbers *n, gonio_i_import *in, header *h)
{
    gonio_status status = GONIO_OK;
    while (status == GONIO_OK && gonio_i_numbers_skip(n)) {
        if (*n->at == '#') {
            read_key(n, h);
            continue;
        }
        status = check_header(n, h);
        if (status == GONIO_OK && in->value == NULL) {
            in->how.values = in->how.values == GONIO_AS_STATED ? h->kind : in->how.values;
            status = gonio_i_import_channels(in, h->values, NULL);
        }
        if (status == GONIO_OK && h->values != in->readings->channels) {
            status = gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                                  "%s:%zu: '#format' changes within the file", n->path, n->line);
        }
        if (status == GONIO_OK) {
            status = read_row(n, in, h);
        }
    }
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    static const gonio_convention stated = {.angles = GONIO_DEGREES};
    gonio_i_numbers n = gonio_i_numbers_of(file->context, file->path, file->text, file->size, 0);
    gonio_i_import in;
    header h = {0};
    gonio_i_import_begin(&in, file->context, readings, "pab-opto text", &stated);
    gonio_i_import_leniently(&in);
    return gonio_i_import_end(&in, read_rows(&n, &in, &h));
}

static bool recognises(const char *text, size_t size)
{
    return text[0] == '#' && memmem(text, size, "#format", 7) != NULL &&
           (memmem(text, size, "#intheta", 8) != NULL ||
            memmem(text, size, "#incident_angle", 15) != NULL);
}

const gonio_i_readings_format gonio_i_readings_pab = {
    .word = "pab", .name = "pab-opto text", .recognises = recognises, .read = read};
