/* Readings as BRDF JSON, the exchange format of national metrology institutes (BiRD, BxDiff;
 * Color Research and Application 47 (2022) 1177): columns of angles, wavelengths, polarisations and
 * values in the object `data`. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../angle_unit.h"
#include "../import.h"
#include "../long_table.h"
#include "brdf_json.h"
#include "json_text.h"

enum { ANGLES = 4, MOST_CHANNELS = 4096 };

/* A column: an array of numbers, or one number for all rows. */
typedef struct column {
    const json_t *values; /* NULL: there is none */
    double scale;         /* to degrees; 1 */
    int angles;           /* gonio_angle_unit of angles */
    bool relative;        /* deviations are fractions of their values */
} column;

typedef struct columns {
    column angle[ANGLES];
    column wavelength;
    column value;
    column deviation;
    const json_t *lit;      /* polarisation of the light */
    const json_t *analysed; /* polarisation of the detector */
    const json_t *channel;  /* names or numbers of channels without wavelengths; NULL: none */
    size_t channels;        /* of these */
    size_t rows;
    int wavelengths; /* gonio_wavelength_unit */
} columns;

/* ---- finding columns ---- */

static const json_t *values_of(const json_t *object)
{
    const json_t *values = gonio_i_json_member(object, "values");
    values = values != NULL ? values : gonio_i_json_member(object, "value");
    return json_is_array(object) || json_is_number(object) ? object : values;
}

static const char *unit_of(const json_t *object)
{
    const char *unit = json_string_value(gonio_i_json_member(object, "unit"));
    return unit != NULL ? unit : "";
}

/* The unit of an angle; 0 for an unknown one. */
static int angle_unit(const char *unit)
{
    return *unit == '\0' || strncasecmp(unit, "deg", 3) == 0 || strcmp(unit, "\u00B0") == 0
               ? GONIO_DEGREES
           : strncasecmp(unit, "rad", 3) == 0 ? GONIO_RADIANS
                                              : GONIO_AS_STATED;
}

/* Finds a column of angles. The user's unit (as) comes before that of the file. */
static gonio_status find_angle(const gonio_i_readings_file *file, const json_t *data,
                               const char *name, const gonio_convention *as, column *c)
{
    const json_t *object = gonio_i_json_member(data, name);
    const int unit = as->angles != GONIO_AS_STATED ? as->angles : angle_unit(unit_of(object));
    c->values = values_of(object);
    c->angles = unit;
    if (c->values == NULL) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: no data.%s with values; theta_i, phi_i, theta_r and phi_r are "
                            "needed",
                            file->path, name);
    }
    if (unit == GONIO_AS_STATED) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: data.%s: the unit '%.20s' is neither degrees nor radians",
                            file->path, name, unit_of(object));
    }
    c->scale = gonio_i_degrees_of(unit, 1.0);
    return GONIO_OK;
}

/* The unit of a wavelength; 0 for an unknown one. */
static int wavelength_unit(const char *unit)
{
    return strcasecmp(unit, "nm") == 0 || *unit == '\0' ? GONIO_NANOMETRES
           : strcasecmp(unit, "um") == 0 || strcmp(unit, "\u00B5m") == 0 ||
                   strcmp(unit, "\u03BCm") == 0
               ? GONIO_MICROMETRES
           : strcmp(unit, "m") == 0 ? GONIO_METRES
                                    : GONIO_AS_STATED;
}

static gonio_status find_wavelength(const gonio_i_readings_file *file, const json_t *data,
                                    columns *c)
{
    const json_t *object = gonio_i_json_member(data, "wavelength_i");
    object = object != NULL ? object : gonio_i_json_member(data, "wavelength_r");
    object = object != NULL ? object : gonio_i_json_member(data, "wavelength");
    c->wavelength = (column){.values = values_of(object), .scale = 1.0};
    c->wavelengths = wavelength_unit(unit_of(object));
    return c->wavelengths != GONIO_AS_STATED
               ? GONIO_OK
               : gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                              "%s: the unit '%.20s' of wavelengths is not known", file->path,
                              unit_of(object));
}

static bool is_per_steradian(const char *unit)
{
    return *unit == '\0' || strcmp(unit, "1/sr") == 0 || strcmp(unit, "sr^-1") == 0 ||
           strcmp(unit, "sr-1") == 0;
}

static gonio_status find_values(const gonio_i_readings_file *file, const json_t *brdf,
                                const gonio_convention *as, column *c)
{
    *c = (column){.values = values_of(brdf), .scale = 1.0};
    if (!json_is_array(c->values)) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT, "%s: no data.BRDF with values",
                            file->path);
    }
    return as->values != GONIO_AS_STATED || is_per_steradian(unit_of(brdf))
               ? GONIO_OK
               : gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                              "%s: data.BRDF: the unit '%.20s' is not 1/sr; say what the values "
                              "are with --as values=brdf, factor, percent, cosine or "
                              "factor-cosine",
                              file->path, unit_of(brdf));
}

/* The number after "k =" in a text; NaN if there is none. */
static double factor_in(const char *text)
{
    for (const char *k = text; k != NULL && (k = strchr(k, 'k')) != NULL; k++) {
        const char *sign = k + 1 + strspn(k + 1, " ");
        char *end = NULL;
        const double factor = *sign == '=' ? strtod(sign + 1, &end) : NAN;
        if (end != NULL && end != sign + 1 && (k == text || !isalnum((unsigned char)k[-1]))) {
            return factor;
        }
    }
    return NAN;
}

/* The coverage factor of expanded uncertainties if it is stated, otherwise 1. */
static double coverage_factor(const json_t *uncertainty)
{
    const json_t *stated = gonio_i_json_member(uncertainty, "coverage_factor");
    stated = stated != NULL ? stated : gonio_i_json_member(uncertainty, "k");
    const json_t *comments = gonio_i_json_member(uncertainty, "comments");
    const double factor =
        stated != NULL ? gonio_i_json_double(stated) : factor_in(json_string_value(comments));
    return factor > 0.0 && isfinite(factor) ? factor : 1.0;
}

/* Finds the deviations. Uncertainties of single values come before one for all. */
static gonio_status find_deviation(const gonio_i_readings_file *file, const json_t *data,
                                   const json_t *brdf, column *c)
{
    const json_t *object = gonio_i_json_member(data, "uBRDF");
    object = object != NULL ? object : gonio_i_json_member(brdf, "uncertainty");
    const char *unit = unit_of(object);
    const bool relative = strcmp(unit, "%") == 0;
    *c = (column){.values = values_of(object),
                  .scale = (relative ? 0.01 : 1.0) / coverage_factor(object),
                  .relative = relative};
    return relative || is_per_steradian(unit)
               ? GONIO_OK
               : gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                              "%s: the unit '%.20s' of uncertainties is neither 1/sr nor %%",
                              file->path, unit);
}

/* The colour that a channel names: 0, 1, 2 for R, G, B; GONIO_CHANNELS for none. */
static size_t colour_of(const json_t *entry)
{
    static const char *const names[GONIO_CHANNELS][2] = {
        {"R", "red"}, {"G", "green"}, {"B", "blue"}};
    const char *name = json_string_value(entry);
    size_t k = 0;
    while (k < GONIO_CHANNELS && (name == NULL || (strcasecmp(name, names[k][0]) != 0 &&
                                                   strcasecmp(name, names[k][1]) != 0))) {
        k++;
    }
    return k;
}

/* The channel of a row, from 0; numbers count from 1. MOST_CHANNELS for neither a colour nor a
 * number. */
static size_t channel_at(const columns *c, size_t row)
{
    const json_t *entry = json_array_get(c->channel, row);
    const size_t colour = colour_of(entry);
    if (colour < GONIO_CHANNELS) {
        return colour;
    }
    const char *text = json_string_value(entry);
    char *end = NULL;
    const double number = text != NULL ? strtod(text, &end) : json_number_value(entry);
    const bool whole = number >= 1.0 && number <= MOST_CHANNELS && number == floor(number);
    return whole && (text == NULL || *end == '\0') ? (size_t)number - 1 : MOST_CHANNELS;
}

/* The column of channels: an ad-hoc variable, or beside the others. */
static const json_t *find_channel_column(const json_t *data)
{
    const json_t *channel =
        gonio_i_json_member(gonio_i_json_member(data, "adhoc_variables"), "channel");
    return values_of(channel != NULL ? channel : gonio_i_json_member(data, "channel"));
}

/* Finds the channels of a file without wavelengths, as gonio writes colours and sensors. */
static gonio_status find_channels(const gonio_i_readings_file *file, const json_t *data, columns *c)
{
    c->channel = c->wavelength.values == NULL ? find_channel_column(data) : NULL;
    c->channels = c->wavelength.values == NULL ? 1 : 0;
    for (size_t k = 0; k < json_array_size(c->channel); k++) {
        const size_t channel = channel_at(c, k);
        if (channel == MOST_CHANNELS) {
            return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                                "%s: entry %zu: a channel is R, G, B or a number from 1",
                                file->path, k + 1);
        }
        const bool colour = colour_of(json_array_get(c->channel, k)) < GONIO_CHANNELS;
        const size_t least = colour ? GONIO_CHANNELS : channel + 1;
        c->channels = least > c->channels ? least : c->channels;
    }
    return GONIO_OK;
}

/* Checks that every column has as many rows as the values, or one number. */
static gonio_status check_lengths(const gonio_i_readings_file *file, columns *c)
{
    const column *const all[] = {&c->angle[0], &c->angle[1],   &c->angle[2],
                                 &c->angle[3], &c->wavelength, &c->deviation};
    static const char *const names[] = {"theta_i", "phi_i",      "theta_r",
                                        "phi_r",   "wavelength", "the uncertainty"};
    c->rows = json_array_size(c->value.values);
    if (c->channel != NULL && json_array_size(c->channel) != c->rows) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: %zu values of the BRDF, but %zu channels", file->path, c->rows,
                            json_array_size(c->channel));
    }
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        const json_t *values = all[k]->values;
        if (json_is_array(values) && json_array_size(values) != c->rows) {
            return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                                "%s: %zu values of the BRDF, but %zu of %s", file->path, c->rows,
                                json_array_size(values), names[k]);
        }
    }
    return GONIO_OK;
}

static gonio_status find_angles(const gonio_i_readings_file *file, const json_t *data,
                                const gonio_convention *as, column angle[ANGLES])
{
    static const char *const names[ANGLES] = {"theta_i", "phi_i", "theta_r", "phi_r"};
    gonio_status status = GONIO_OK;
    for (int k = 0; k < ANGLES && status == GONIO_OK; k++) {
        status = find_angle(file, data, names[k], as, &angle[k]);
    }
    return status;
}

static gonio_status find_columns(const gonio_i_readings_file *file, const json_t *root,
                                 const gonio_convention *as, columns *c)
{
    const json_t *data = gonio_i_json_member(root, "data");
    const json_t *brdf = gonio_i_json_member(data, "BRDF");
    c->lit = values_of(gonio_i_json_member(data, "polarization_i"));
    c->analysed = values_of(gonio_i_json_member(data, "polarization_r"));
    gonio_status status = find_angles(file, data, as, c->angle);
    if (status == GONIO_OK) {
        status = find_values(file, brdf, as, &c->value);
    }
    if (status == GONIO_OK) {
        status = find_deviation(file, data, brdf, &c->deviation);
    }
    if (status == GONIO_OK) {
        status = find_wavelength(file, data, c);
    }
    if (status == GONIO_OK) {
        status = find_channels(file, data, c);
    }
    return status == GONIO_OK ? check_lengths(file, c) : status;
}

/* ---- rows ---- */

static double number_at(const column *c, size_t row)
{
    const json_t *value = json_is_array(c->values) ? json_array_get(c->values, row) : c->values;
    return gonio_i_json_double(value) * c->scale;
}

/* A number for each state of polarisation: above 0 for s, below 0 for p, 0 for unpolarised. Stokes
 * vectors are (1, Q, U, V); Q is 1 for s. */
static double state_at(const json_t *states, size_t row)
{
    const json_t *entry = json_array_get(states, row);
    const char *word = json_string_value(entry);
    if (word != NULL) {
        return strcasecmp(word, "s") == 0 ? 1.0 : strcasecmp(word, "p") == 0 ? -1.0 : 0.0;
    }
    double state = 0.0;
    for (size_t k = 1; k < json_array_size(entry) && k < 4; k++) {
        const double part = gonio_i_json_double(json_array_get(entry, k));
        state += isnan(part) ? 0.0 : part * pow(0.01, (double)k - 1.0);
    }
    return state;
}

/* The states that occur. */
typedef struct states {
    bool s;
    bool p;
    bool other;
} states;

static states states_of(const json_t *array)
{
    states found = {.other = json_array_size(array) == 0};
    for (size_t k = 0; k < json_array_size(array); k++) {
        const double state = state_at(array, k);
        found.s = found.s || state > 0.5;
        found.p = found.p || state < -0.5;
        found.other = found.other || fabs(state) <= 0.5;
    }
    return found;
}

/* The factor of values that were detected as s and as p: these add up. Values lit by s and by p are
 * averaged. */
static double analysers(const columns *c)
{
    const states detected = states_of(c->analysed);
    return detected.s && detected.p ? 2.0 : 1.0;
}

/* Notes that values of one polarisation stand for unpolarised light. */
static gonio_status note_polarisation(const gonio_i_readings_file *file, gonio_readings *readings,
                                      const char *what, const json_t *array)
{
    const states found = states_of(array);
    return found.other || found.s == found.p
               ? GONIO_OK
               : gonio_i_readings_note(file->context, readings,
                                       "the light %s is polarised, %s only; it is taken as "
                                       "unpolarised",
                                       what, found.s ? "s" : "p");
}

static gonio_status add_row(const gonio_i_readings_file *file, const columns *c, double factor,
                            size_t k, gonio_i_long_table *table)
{
    gonio_i_long_row row = {.value = factor * number_at(&c->value, k),
                            .deviation = factor * number_at(&c->deviation, k),
                            .state = state_at(c->lit, k) + 1e3 * state_at(c->analysed, k),
                            .line = k + 1};
    row.deviation *= c->deviation.relative ? fabs(number_at(&c->value, k)) : 1.0;
    for (int a = 0; a < ANGLES; a++) {
        const double degrees = number_at(&c->angle[a], k);
        row.degrees[a] = c->angle[a].scale == 1.0 ? degrees : gonio_i_import_rounded(degrees);
        if (!isfinite(row.degrees[a])) {
            return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                                "%s: entry %zu: an angle is not a number", file->path, k + 1);
        }
    }
    row.wavelength = c->channel != NULL ? (double)channel_at(c, k)
                     : c->channels > 0  ? 0.0
                                        : number_at(&c->wavelength, k);
    if (isnan(row.wavelength)) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: entry %zu: the wavelength is not a number", file->path, k + 1);
    }
    return gonio_i_long_table_add(table, &row);
}

static gonio_status read_rows(const gonio_i_readings_file *file, const columns *c,
                              gonio_i_import *in)
{
    gonio_i_long_table table = {.context = file->context, .numbered = c->channels};
    const double factor = analysers(c);
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < c->rows && status == GONIO_OK; k++) {
        status = add_row(file, c, factor, k, &table);
    }
    if (status == GONIO_OK) {
        status = gonio_i_long_table_import(&table, in);
    }
    gonio_i_long_table_free(&table);
    return status;
}

static int unit_of_angles(const columns *c)
{
    bool same = true;
    for (int k = 1; k < ANGLES; k++) {
        same = same && c->angle[k].angles == c->angle[0].angles;
    }
    return same ? c->angle[0].angles : GONIO_DEGREES;
}

static gonio_status read_notes(const gonio_i_readings_file *file, const columns *c,
                               const json_t *root, gonio_readings *readings)
{
    gonio_status status = note_polarisation(file, readings, "on the sample", c->lit);
    if (status == GONIO_OK) {
        status = note_polarisation(file, readings, "that is detected", c->analysed);
    }
    return status == GONIO_OK ? gonio_i_brdf_json_read_comments(file, root, readings) : status;
}

static gonio_status read_root(const gonio_i_readings_file *file, const json_t *root,
                              gonio_readings *readings)
{
    columns c = {0};
    gonio_i_import in;
    gonio_status status = find_columns(file, root, &readings->options.as, &c);
    const gonio_convention stated = {
        .angles = unit_of_angles(&c), .values = GONIO_VALUE_BRDF, .wavelengths = c.wavelengths};
    gonio_i_import_begin(&in, file->context, readings, "BRDF JSON", &stated);
    gonio_i_import_leniently(&in);
    if (status == GONIO_OK) {
        status = read_notes(file, &c, root, readings);
    }
    if (status == GONIO_OK) {
        status = read_rows(file, &c, &in);
    }
    return gonio_i_import_end(&in, status);
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    json_t *root = gonio_i_json_parse(file);
    if (root == NULL) {
        return GONIO_ERROR_FORMAT;
    }
    const gonio_status status = read_root(file, root, readings);
    json_decref(root);
    return status;
}

static bool recognises(const char *text, size_t size)
{
    return gonio_i_json_has(text, size, "\"BRDF\"");
}

const gonio_i_readings_format gonio_i_readings_brdf_json = {.word = "json",
                                                            .name = "BRDF JSON",
                                                            .extensions = {".json", ".brdf"},
                                                            .recognises = recognises,
                                                            .read = read,
                                                            .print = gonio_i_brdf_json_print};
