/* Writing readings as BRDF JSON: an entry of `data` for each value. Names and forms follow the
 * published schema. Its azimuths are from 0 to below 360 degrees. It has no word for a value that
 * was not read. Such an entry is left out if nothing else is lost with it, otherwise it is null. */
#include <math.h>
#include <stdlib.h>

#include "brdf_json.h"
#include "json_text.h"

typedef struct printer {
    FILE *stream;
    const gonio_readings *readings;
    const bool *held; /* [channels]: whether any reading has a value */
    size_t angle;     /* that print_angle prints */
} printer;

/* Prints what belongs to one value. */
typedef void print_entry(const printer *p, size_t reading, size_t channel);

/* The shortest text that is read back as the same number; null for NaN. */
static void print_number(FILE *stream, double number)
{
    char text[32] = "null";
    for (int digits = 12; !isnan(number) && digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtod(text, NULL) == number) {
            break;
        }
    }
    fputs(text, stream);
}

/* ---- the columns ---- */

/* An azimuth from 0 to below 360 degrees, also after it is printed. */
static double from_zero(double degrees)
{
    const double rest = fmod(degrees, 360.0);
    const double turn = rest < 0.0 ? rest + 360.0 : rest;
    return turn < 360.0 - 1e-9 ? turn : 0.0;
}

/* Prints twelve digits, as in CSV, so that 60 degrees are 60. */
static void print_angle(const printer *p, size_t reading, size_t channel)
{
    const double degrees = gonio_i_readings_degrees(p->readings, reading, p->angle);
    (void)channel;
    fprintf(p->stream, "%.12g", p->angle % 2 == 1 ? from_zero(degrees) : degrees);
}

static void print_wavelength(const printer *p, size_t reading, size_t channel)
{
    (void)reading;
    print_number(p->stream, p->readings->wavelength[channel]);
}

static void print_channel(const printer *p, size_t reading, size_t channel)
{
    (void)reading;
    if (gonio_readings_are_colours(p->readings)) {
        fprintf(p->stream, "\"%c\"", "RGB"[channel]);
    } else {
        fprintf(p->stream, "%zu", channel + 1);
    }
}

static void print_polarisation(const printer *p, size_t reading, size_t channel)
{
    (void)reading;
    (void)channel;
    fputs("\"u\"", p->stream);
}

static void print_value(const printer *p, size_t reading, size_t channel)
{
    print_number(p->stream, gonio_readings_value(p->readings, reading, channel));
}

static void print_deviation(const printer *p, size_t reading, size_t channel)
{
    print_number(p->stream, p->readings->deviation[reading * p->readings->channels + channel]);
}

static bool has_values(const gonio_readings *r, size_t reading)
{
    bool any = false;
    for (size_t k = 0; k < r->channels && !any; k++) {
        any = !isnan(r->value[reading * r->channels + k]);
    }
    return any;
}

/* Whether a channel of a reading has an entry: it has a value, or the channel or the direction
 * would be lost. */
static bool is_entry(const printer *p, size_t reading, size_t channel)
{
    return !isnan(p->readings->value[reading * p->readings->channels + channel]) ||
           !p->held[channel] || !has_values(p->readings, reading);
}

/* Prints an array with an element for each entry, channels fastest. */
static void print_values(const printer *p, print_entry *print)
{
    const gonio_readings *r = p->readings;
    const char *between = "";
    fputs("\"values\": [", p->stream);
    for (size_t k = 0; k < r->count * r->channels; k++) {
        if (is_entry(p, k / r->channels, k % r->channels)) {
            fputs(between, p->stream);
            print(p, k / r->channels, k % r->channels);
            between = ", ";
        }
    }
    fputs("]", p->stream);
}

/* Prints a column. key: "unit" or another; word: its value. */
static void print_column(const printer *p, const char *name, const char *key, const char *word,
                         print_entry *print)
{
    fprintf(p->stream, "    \"%s\": {\"%s\": \"%s\", ", name, key, word);
    print_values(p, print);
    fputs("},\n", p->stream);
}

/* Prints channels without wavelengths, which are a variable of their own. */
static void print_channels(const printer *p)
{
    if (p->readings->wavelength != NULL) {
        print_column(p, "wavelength_i", "unit", "nm", print_wavelength);
        return;
    }
    const bool colours = gonio_readings_are_colours(p->readings);
    fprintf(p->stream,
            "    \"adhoc_variables\": {\"channel\": {\"description\": \"%s\", \"unit\": "
            "\"\", \"type\": \"%s\", ",
            colours ? "linear R, G, B of the sRGB primaries" : "number of the channel",
            colours ? "string" : "integer");
    print_values(p, print_channel);
    fputs("}},\n", p->stream);
}

static void print_angles(const printer *p)
{
    static const char *const names[4] = {"theta_i", "phi_i", "theta_r", "phi_r"};
    printer one = *p;
    for (one.angle = 0; one.angle < 4; one.angle++) {
        print_column(&one, names[one.angle], "unit", "deg", print_angle);
    }
}

static void print_data(const printer *p)
{
    fputs("  \"data\": {\n", p->stream);
    print_angles(p);
    print_channels(p);
    print_column(p, "polarization_i", "notation", "sp", print_polarisation);
    if (p->readings->deviation != NULL) {
        fputs("    \"uBRDF\": {\"comments\": \"standard uncertainty, k = 1\", \"unit\": "
              "\"sr^-1\", ",
              p->stream);
        print_values(p, print_deviation);
        fputs("},\n", p->stream);
    }
    fputs("    \"BRDF\": {\"unit\": \"sr^-1\", ", p->stream);
    print_values(p, print_value);
    fputs("}\n  }\n", p->stream);
}

/* Whether each channel has a value anywhere, which the caller frees. NULL: out of memory. */
static bool *find_held(gonio_context *context, const gonio_readings *r)
{
    bool *held = gonio_i_allocate(context, r->channels, sizeof *held);
    for (size_t k = 0; held != NULL && k < r->count * r->channels; k++) {
        held[k % r->channels] = held[k % r->channels] || !isnan(r->value[k]);
    }
    return held;
}

gonio_status gonio_i_brdf_json_print(gonio_context *context, const gonio_readings *readings,
                                     const char *command, FILE *stream)
{
    bool *held = find_held(context, readings);
    if (held == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const printer p = {.stream = stream, .readings = readings, .held = held};
    fputs("{\n", stream);
    const bool done = gonio_i_brdf_json_print_metadata(readings, command, stream);
    print_data(&p);
    fputs("}\n", stream);
    free(held);
    return done ? GONIO_OK
                : gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", readings->path);
}
