/* Readings in the format of the ALTA library: `#KEY` lines, then rows of coordinates and values. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/text_numbers.h"
#include "../import.h"
#include "format.h"

enum { MOST_NUMBERS = 64, MOST_COORDINATES = 6 };

/* ---- coordinates ---- */

/* theta_i, phi_i, theta_o, phi_o from the numbers of a row; all are radians, and dphi = 0 is the
 * light's side. */
typedef void to_angles(const double *x, double angle[4]);

static void from_light_view_difference(const double *x, double angle[4])
{
    memcpy(angle, (double[4]){x[0], 0.0, x[1], x[2]}, 4 * sizeof *angle);
}

static void from_view_light_difference(const double *x, double angle[4])
{
    memcpy(angle, (double[4]){x[1], 0.0, x[0], x[2]}, 4 * sizeof *angle);
}

/* From theta_l, and theta_v as a vector along the difference of azimuths. */
static void from_projected_difference(const double *x, double angle[4])
{
    const double difference = x[1] == 0.0 && x[2] == 0.0 ? 0.0 : atan2(x[2], x[1]);
    memcpy(angle, (double[4]){x[0], 0.0, hypot(x[1], x[2]), difference}, 4 * sizeof *angle);
}

static void from_light_view(const double *x, double angle[4])
{
    memcpy(angle, x, 4 * sizeof *angle);
}

static void from_half_difference(const double *x, double angle[4])
{
    const gonio_pair pair =
        gonio_pair_from_half_difference((gonio_half_difference){x[0], x[1], x[2]});
    memcpy(
        angle,
        (double[4]){pair.incident.theta, pair.incident.phi, pair.outgoing.theta, pair.outgoing.phi},
        4 * sizeof *angle);
}

/* From theta_h, phi_h, theta_d, phi_d of an isotropic material. */
static void from_four_half_difference(const double *x, double angle[4])
{
    from_half_difference((double[3]){x[0], x[2], x[3]}, angle);
}

static void spherical(const double *x, double *theta, double *phi)
{
    *theta = atan2(hypot(x[0], x[1]), x[2]);
    *phi = x[0] == 0.0 && x[1] == 0.0 ? 0.0 : atan2(x[1], x[0]);
}

/* From two vectors: view, light. */
static void from_vectors(const double *x, double angle[4])
{
    spherical(x + 3, &angle[0], &angle[1]);
    spherical(x, &angle[2], &angle[3]);
}

static const struct parametrisation {
    const char *name;
    size_t numbers;
    to_angles *to_angles;
} parametrisations[] = {
    {"ISOTROPIC_TL_TV_PROJ_DPHI", 3, from_projected_difference},
    {"ISOTROPIC_TV_TL_DPHI", 3, from_view_light_difference},
    {"ISOTROPIC_TL_TV_DPHI", 3, from_light_view_difference},
    {"SPHERICAL_TL_PL_TV_PV", 4, from_light_view},
    {"RUSIN_TH_TD_PD", 3, from_half_difference},
    {"RUSIN_TH_PH_TD_PD", 4, from_four_half_difference},
    {"CARTESIAN", 6, from_vectors},
};

enum { PARAMETRISATIONS = sizeof parametrisations / sizeof *parametrisations };

/* ---- the header ---- */

typedef struct header {
    size_t coordinates; /* of #DIM */
    size_t values;
    const struct parametrisation *in; /* NULL: not stated or unknown */
    char unknown[GONIO_I_WORD];       /* its name */
    bool cosine;                      /* values include the cosine of theta_v */
} header;

static const struct parametrisation *find_parametrisation(const char *name)
{
    for (size_t k = 0; k < PARAMETRISATIONS; k++) {
        if (strcmp(parametrisations[k].name, name) == 0) {
            return &parametrisations[k];
        }
    }
    return NULL;
}

/* Reads a line `#KEY word ...` with its end. */
static void read_key(gonio_i_numbers *n, header *h)
{
    char key[GONIO_I_WORD];
    char word[GONIO_I_WORD] = "";
    gonio_i_numbers_word(n, key);
    if (gonio_i_numbers_skip_blanks(n)) {
        gonio_i_numbers_word(n, word);
    }
    if (strcmp(key, "#DIM") == 0) {
        char second[GONIO_I_WORD] = "";
        if (gonio_i_numbers_skip_blanks(n)) {
            gonio_i_numbers_word(n, second);
        }
        h->coordinates = strtoul(word, NULL, 10);
        h->values = strtoul(second, NULL, 10);
    } else if (strcmp(key, "#PARAM_IN") == 0) {
        h->in = find_parametrisation(word);
        memcpy(h->unknown, word, sizeof word);
    } else if (strcmp(key, "#PARAM_OUT") == 0) {
        h->cosine = strcmp(word, "INV_STERADIAN_COSINE_FACTOR") == 0;
    }
    gonio_i_numbers_next_line(n);
}

static void read_header(gonio_i_numbers *n, header *h)
{
    *h = (header){0};
    while (gonio_i_numbers_skip(n) && *n->at == '#') {
        read_key(n, h);
    }
}

static gonio_status check_header(const gonio_i_numbers *n, const header *h)
{
    if (h->in == NULL) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s: #PARAM_IN %s: gonio knows ISOTROPIC_TL_TV_PROJ_DPHI, "
                            "ISOTROPIC_TV_TL_DPHI, ISOTROPIC_TL_TV_DPHI, SPHERICAL_TL_PL_TV_PV, "
                            "RUSIN_TH_TD_PD, RUSIN_TH_PH_TD_PD and CARTESIAN",
                            n->path, h->unknown);
    }
    if (h->coordinates != h->in->numbers || h->values < 1 || h->values > MOST_NUMBERS / 2) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s: #DIM %zu %zu does not fit %s, which has %zu coordinates", n->path,
                            h->coordinates, h->values, h->in->name, h->in->numbers);
    }
    return GONIO_OK;
}

/* ---- rows ---- */

static gonio_status read_row(gonio_i_numbers *n, gonio_i_import *in, const header *h)
{
    double x[MOST_NUMBERS];
    double angle[4];
    const size_t line = n->line;
    const int count = gonio_i_numbers_row(n, x, MOST_NUMBERS);
    if (count < (int)(h->coordinates + h->values)) {
        return gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                            "%s:%zu: a row of %zu numbers is expected (#DIM)", n->path, line,
                            h->coordinates + h->values);
    }
    gonio_i_row row = {.planned = GONIO_ALL_CHANNELS, .line = line, .value = x + h->coordinates};
    h->in->to_angles(x, angle);
    for (int k = 0; k < 4; k++) {
        row.degrees[k] = gonio_i_import_degrees(in, angle[k]);
    }
    return gonio_i_import_add(in, &row);
}

static gonio_status read_rows(gonio_i_numbers *n, gonio_i_import *in, const header *h)
{
    gonio_status status = check_header(n, h);
    if (status == GONIO_OK) {
        status = gonio_i_import_channels(in, h->values, NULL);
    }
    n->comment = '#';
    while (status == GONIO_OK && gonio_i_numbers_skip(n)) {
        status = read_row(n, in, h);
    }
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    gonio_i_numbers n = gonio_i_numbers_of(file->context, file->path, file->text, file->size, 0);
    gonio_i_import in;
    header h;
    read_header(&n, &h);
    const gonio_convention stated = {.angles = GONIO_RADIANS,
                                     .values = h.cosine ? GONIO_VALUE_COSINE : GONIO_VALUE_BRDF};
    gonio_i_import_begin(&in, file->context, readings, "ALTA data", &stated);
    gonio_i_import_leniently(&in);
    return gonio_i_import_end(&in, read_rows(&n, &in, &h));
}

static bool recognises(const char *text, size_t size)
{
    return text[0] == '#' && memmem(text, size, "#DIM ", 5) != NULL &&
           memmem(text, size, "#PARAM_IN", 9) != NULL;
}

const gonio_i_readings_format gonio_i_readings_alta = {
    .word = "alta", .name = "ALTA data", .recognises = recognises, .read = read};
