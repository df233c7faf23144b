/* Writing readings as BRDF JSON: an entry of `data` for each reading and channel. */
#include <math.h>
#include <stdlib.h>

#include "brdf_json.h"
#include "json_text.h"

typedef struct printer {
    FILE *stream;
    const gonio_readings *readings;
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

static void print_text(FILE *stream, const char *text)
{
    char *printed = gonio_i_json_quote(text);
    fputs(printed != NULL ? printed : "\"\"", stream);
    free(printed);
}

/* ---- the columns ---- */

static double degrees_of(const gonio_readings *r, size_t reading, size_t which)
{
    const gonio_pair *pair = &r->pair[reading];
    const double radians[4] = {pair->incident.theta, pair->incident.phi, pair->outgoing.theta,
                               pair->outgoing.phi};
    return r->given != NULL ? r->given[reading][which] : radians[which] * 180.0 / M_PI;
}

/* Twelve digits, as CSV has, so that 60 degrees are 60. */
static void print_degrees(const printer *p, size_t reading, size_t which)
{
    fprintf(p->stream, "%.12g", degrees_of(p->readings, reading, which));
}

static void print_theta_i(const printer *p, size_t reading, size_t channel)
{
    (void)channel;
    print_degrees(p, reading, 0);
}

static void print_phi_i(const printer *p, size_t reading, size_t channel)
{
    (void)channel;
    print_degrees(p, reading, 1);
}

static void print_theta_r(const printer *p, size_t reading, size_t channel)
{
    (void)channel;
    print_degrees(p, reading, 2);
}

static void print_phi_r(const printer *p, size_t reading, size_t channel)
{
    (void)channel;
    print_degrees(p, reading, 3);
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

/* An array with an element for each reading and channel, channels fastest. */
static void print_values(const printer *p, print_entry *print)
{
    const gonio_readings *r = p->readings;
    fputs("\"values\": [", p->stream);
    for (size_t k = 0; k < r->count * r->channels; k++) {
        fputs(k > 0 ? ", " : "", p->stream);
        print(p, k / r->channels, k % r->channels);
    }
    fputs("]", p->stream);
}

static void print_column(const printer *p, const char *name, const char *unit, print_entry *print)
{
    fprintf(p->stream, "    \"%s\": {", name);
    if (unit != NULL) {
        fprintf(p->stream, "\"unit\": \"%s\", ", unit);
    }
    print_values(p, print);
    fputs("},\n", p->stream);
}

/* Channels without wavelengths are a variable of their own. */
static void print_channels(const printer *p)
{
    if (p->readings->wavelength != NULL) {
        print_column(p, "wavelength_i", "nm", print_wavelength);
        return;
    }
    fprintf(p->stream, "    \"adhoc_variables\": {\"channel\": {\"description\": \"%s\", ",
            gonio_readings_are_colours(p->readings) ? "linear R, G, B of the sRGB primaries"
                                                    : "number of the channel");
    print_values(p, print_channel);
    fputs("}},\n", p->stream);
}

static void print_data(const printer *p)
{
    fputs("  \"data\": {\n", p->stream);
    print_column(p, "theta_i", "deg", print_theta_i);
    print_column(p, "phi_i", "deg", print_phi_i);
    print_column(p, "theta_r", "deg", print_theta_r);
    print_column(p, "phi_r", "deg", print_phi_r);
    print_channels(p);
    print_column(p, "polarization_i", NULL, print_polarisation);
    fputs("    \"BRDF\": {\"unit\": \"sr^-1\", ", p->stream);
    print_values(p, print_value);
    if (p->readings->deviation != NULL) {
        fputs(",\n      \"uncertainty\": {\"coverage_factor\": 1, \"unit\": \"sr^-1\", ",
              p->stream);
        print_values(p, print_deviation);
        fputs("}", p->stream);
    }
    fputs("}\n  }\n", p->stream);
}

/* ---- the metadata ---- */

static void print_metadata(const printer *p, const char *command)
{
    const gonio_i_comments *comments = &p->readings->comment;
    fputs("  \"metadata\": {\n    \"type\": \"BRDF\",\n    \"software\": {\"name\": \"gonio\", "
          "\"version\": ",
          p->stream);
    print_text(p->stream, gonio_version());
    if (command != NULL) {
        fputs(", \"command\": ", p->stream);
        print_text(p->stream, command);
    }
    fputs("},\n    \"description\": [", p->stream);
    for (size_t k = 0; k < comments->count; k++) {
        fputs(k > 0 ? ", " : "", p->stream);
        print_text(p->stream, comments->line[k]);
    }
    fputs("]\n  },\n", p->stream);
}

gonio_status gonio_i_brdf_json_print(gonio_context *context, const gonio_readings *readings,
                                     const char *command, FILE *stream)
{
    const printer p = {stream, readings};
    (void)context;
    fputs("{\n", stream);
    print_metadata(&p, command);
    print_data(&p);
    fputs("}\n", stream);
    return GONIO_OK;
}
