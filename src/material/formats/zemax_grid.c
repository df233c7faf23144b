/* Zemax BSDF files as they are: see zemax_grid.h. */
#include "zemax_grid.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../../core/text_numbers.h"

enum { MOST_ANGLES = 100000 };

typedef gonio_i_zemax_grid grid;
typedef gonio_i_zemax_axis axis;

const char *const gonio_i_zemax_axis_names[GONIO_I_ZEMAX_AXES] = {
    "SampleRotation", "AngleOfIncidence", "ScatterAzimuth", "ScatterRadial"};

void gonio_i_zemax_free(gonio_i_zemax_grid *g)
{
    for (int k = 0; k < GONIO_I_ZEMAX_AXES; k++) {
        free(g->axis[k].degrees);
    }
    for (int k = 0; k < GONIO_I_ZEMAX_PLANES; k++) {
        free(g->value[k]);
    }
    free(g->line);
}

size_t gonio_i_zemax_total(const gonio_i_zemax_grid *g)
{
    size_t count = 1;
    for (int k = 0; k < GONIO_I_ZEMAX_AXES; k++) {
        count *= g->axis[k].count;
    }
    return count;
}

/* ---- the header ---- */

/* Reads the number of angles. The rest of the text must have room for them. */
static gonio_status read_count(gonio_i_numbers *n, const char *name, size_t *count)
{
    double number = 0.0;
    const size_t room = (size_t)(n->end - n->at);
    const gonio_status status = gonio_i_numbers_read(n, &number);
    *count = number >= 1.0 && number <= MOST_ANGLES ? (size_t)number : 0;
    if (status == GONIO_OK && (*count == 0 || (double)*count != number || *count > room)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: %s %g: a number of angles from 1 to %d is expected, "
                            "followed by the angles",
                            n->path, n->line, name, number, MOST_ANGLES);
    }
    return status;
}

static gonio_status read_axis(gonio_i_numbers *n, int which, axis *a)
{
    gonio_status status = read_count(n, gonio_i_zemax_axis_names[which], &a->count);
    free(a->degrees);
    a->degrees = status == GONIO_OK ? gonio_i_allocate(n->context, a->count, sizeof(double)) : NULL;
    if (status == GONIO_OK && a->degrees == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < a->count && status == GONIO_OK; k++) {
        status = gonio_i_numbers_read(n, &a->degrees[k]);
    }
    return status;
}

static gonio_status check_type(const gonio_i_numbers *n, const char *type)
{
    return strcasecmp(type, "BRDF") == 0
               ? GONIO_OK
               : gonio_i_fail(n->context, GONIO_ERROR_DATA,
                              "%s:%zu: ScatterType %s: transmitted light; gonio reads BRDF",
                              n->path, n->line, type);
}

/* ---- the values ---- */

/* Allocates a plane if the rest of the text can hold as many values. */
static gonio_status make_plane(gonio_i_numbers *n, grid *g)
{
    const size_t room = (size_t)(n->end - n->at);
    size_t count = 1;
    for (int k = 0; k < GONIO_I_ZEMAX_AXES; k++) {
        count = g->axis[k].count == 0 || count > room ? 0 : count * g->axis[k].count;
    }
    if (count == 0 || count > room) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: DataBegin before the angles, or of more values than the file "
                            "has room for; is it whole?",
                            n->path, n->line);
    }
    if (g->planes == GONIO_I_ZEMAX_PLANES) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT, "%s:%zu: more than %d tables", n->path,
                            n->line, GONIO_I_ZEMAX_PLANES);
    }
    g->value[g->planes] = gonio_i_allocate(n->context, count, sizeof(double));
    if (g->line == NULL) {
        g->line = gonio_i_allocate(n->context, count, sizeof *g->line);
    }
    return g->value[g->planes] != NULL && g->line != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* Skips "TIS value", which is before each incidence. */
static gonio_status skip_total(gonio_i_numbers *n)
{
    char word[GONIO_I_WORD] = "";
    double number = 0.0;
    if (gonio_i_numbers_skip(n)) {
        gonio_i_numbers_word(n, word);
    }
    return strcasecmp(word, "TIS") == 0
               ? gonio_i_numbers_read(n, &number)
               : gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                              "%s:%zu: '%.40s' where TIS is expected; is the file whole?", n->path,
                              n->line, word);
}

static gonio_status read_plane(gonio_i_numbers *n, grid *g)
{
    gonio_status status = make_plane(n, g);
    const size_t block = g->axis[GONIO_I_ZEMAX_AZIMUTH].count * g->axis[GONIO_I_ZEMAX_RADIAL].count;
    const size_t count = status == GONIO_OK ? gonio_i_zemax_total(g) : 0;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        if (k % block == 0) {
            status = skip_total(n);
        }
        if (status == GONIO_OK) {
            status = gonio_i_numbers_read(n, &g->value[g->planes][k]);
        }
        g->line[k] = g->planes == 0 ? n->line : g->line[k];
    }
    g->planes++;
    return status;
}

static gonio_status read_word(gonio_i_numbers *n, const char *word, grid *g)
{
    for (int k = 0; k < GONIO_I_ZEMAX_AXES; k++) {
        if (strcasecmp(word, gonio_i_zemax_axis_names[k]) == 0) {
            return g->planes == 0
                       ? read_axis(n, k, &g->axis[k])
                       : gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                                      "%s:%zu: %s is after the values", n->path, n->line, word);
        }
    }
    if (strcasecmp(word, "ScatterType") == 0) {
        char type[GONIO_I_WORD] = "";
        if (gonio_i_numbers_skip_blanks(n)) {
            gonio_i_numbers_word(n, type);
        }
        return check_type(n, type);
    }
    return strcasecmp(word, "DataBegin") == 0 ? read_plane(n, g) : GONIO_OK;
}

/* Reads the grid. Words without meaning for the values are skipped. */
static gonio_status read_all(gonio_i_numbers *n, grid *g)
{
    gonio_status status = GONIO_OK;
    while (status == GONIO_OK && gonio_i_numbers_skip(n)) {
        char word[GONIO_I_WORD];
        gonio_i_numbers_word(n, word);
        status = read_word(n, word, g);
    }
    if (status == GONIO_OK && g->planes != 1 && g->planes != GONIO_I_ZEMAX_PLANES) {
        status = gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                              "%s: %zu tables of values (DataBegin); 1 or 3 are expected", n->path,
                              g->planes);
    }
    return status;
}

gonio_status gonio_i_zemax_read(gonio_context *context, const char *path, const char *text,
                                size_t size, gonio_i_zemax_grid *g)
{
    gonio_i_numbers n = gonio_i_numbers_of(context, path, text, size, '#');
    *g = (grid){0};
    const gonio_status status = read_all(&n, g);
    if (status != GONIO_OK) {
        gonio_i_zemax_free(g);
        *g = (grid){0};
    }
    return status;
}

/* Whether a text has a word, in any letter case. */
static bool has_word(const char *text, size_t size, const char *word)
{
    const size_t length = strlen(word);
    bool found = false;
    for (size_t k = 0; k + length <= size && !found; k++) {
        found = strncasecmp(text + k, word, length) == 0;
    }
    return found;
}

bool gonio_i_zemax_recognises(const char *text, size_t size)
{
    return has_word(text, size, "AngleOfIncidence") && has_word(text, size, "ScatterAzimuth");
}
