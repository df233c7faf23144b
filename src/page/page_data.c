/* Materials, errors and readings as JSON for the page: see page.h. */
#include "page.h"

#include <math.h>
#include <stdlib.h>

#include "../material/colour.h"
#include "../material/source.h"

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *numbers(const double *values, int count)
{
    json_t *array = json_array();
    for (int k = 0; k < count; k++) {
        json_array_append_new(array, number(values[k]));
    }
    return array;
}

/* ---- materials ---- */

enum { CHECKS = 48 };

/* The k-th of directions that fill the grid evenly: multiples of the powers of a cubic root
 * (Roberts's sequence), folded into the grid's coordinates. */
static gonio_half_difference check_direction(int k)
{
    const double root = 1.2207440846057596;
    const double u = fmod(0.5 + k / root, 1.0);
    const double v = fmod(0.5 + k / (root * root), 1.0);
    const double w = fmod(0.5 + k / (root * root * root), 1.0);
    return (gonio_half_difference){u * u * M_PI / 2.0, v * M_PI / 2.0, w * M_PI};
}

/* Values at directions; those below the horizon and those without data are left out. */
static json_t *checks(const gonio_table *table)
{
    json_t *array = json_array();
    for (int k = 0; k < CHECKS; k++) {
        const gonio_half_difference c = check_direction(k);
        double row[3 + GONIO_CHANNELS] = {c.theta_h, c.theta_d, c.phi_d};
        if (gonio_table_value(table, c, row + 3)) {
            json_array_append_new(array, numbers(row, 3 + GONIO_CHANNELS));
        }
    }
    return array;
}

/* A name that is not UTF-8 is shown without the bytes that are not ASCII. */
static json_t *text(const char *name)
{
    json_t *string = json_string(name);
    char *plain = string == NULL ? gonio_i_format("%s", name) : NULL;
    for (char *c = plain; c != NULL && *c != '\0'; c++) {
        *c = (char)((unsigned char)*c < 128 ? *c : '?');
    }
    if (plain != NULL) {
        string = json_string(plain);
    }
    free(plain);
    return string;
}

json_t *gonio_i_web_material(const gonio_material *material, const gonio_table *table, double step)
{
    return json_pack("{s:o, s:o, s:f, s:o}", "name", text(gonio_material_name(material)), "format",
                     text(gonio_material_format(material)), "step", step, "checks", checks(table));
}

/* ---- errors ---- */

json_t *gonio_i_web_metric(const gonio_metric_view *metric)
{
    return json_pack("{s:s, s:s, s:s, s:i, s:s}", "key", metric->key, "title", metric->title,
                     "unit", metric->unit, "digits", metric->digits, "summary", metric->summary);
}

/* The descriptions of the errors, in their order. */
static json_t *metrics(void)
{
    json_t *list = json_array();
    const gonio_metric_view *metric = NULL;
    for (int m = 0; (metric = gonio_metric_describe(m)) != NULL; m++) {
        json_array_append_new(list, gonio_i_web_metric(metric));
    }
    return list;
}

static json_t *error_numbers(const gonio_error *error)
{
    json_t *list = json_array();
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        json_array_append_new(list, number(error->value[m]));
    }
    return list;
}

json_t *gonio_i_web_comparison(const gonio_comparison *c)
{
    return json_pack("{s:I, s:I, s:o, s:o, s:[o,o,o]}", "bins", (json_int_t)c->bins, "missing",
                     (json_int_t)c->missing, "metrics", metrics(), "all", error_numbers(&c->all),
                     "channels", error_numbers(&c->channel[0]), error_numbers(&c->channel[1]),
                     error_numbers(&c->channel[2]));
}

/* ---- readings ---- */

enum { MOST_READINGS = 4000 }; /* so that the page's size is bounded */

static json_t *direction(gonio_angles angles)
{
    return json_pack("[f,f]", angles.theta, angles.phi);
}

static bool look_up(gonio_i_web_known known, gonio_pair pair, double rho[GONIO_CHANNELS])
{
    return gonio_i_web_turns(known.material)
               ? gonio_i_material_colour(known.material, pair, rho)
               : gonio_table_value(known.table, gonio_half_difference_from_pair(pair), rho);
}

static json_t *values_at(gonio_i_web_known known, gonio_pair pair)
{
    double rho[GONIO_CHANNELS];
    return known.material != NULL && look_up(known, pair, rho) ? numbers(rho, GONIO_CHANNELS)
                                                               : json_null();
}

/* The colour of the wavelengths that were read, NaN of none; false when out of memory. */
static bool mix_colour(const gonio_readings_view *view, size_t reading,
                       double value[GONIO_CHANNELS])
{
    const double *read = view->value + reading * view->channels;
    double *kept = malloc((2 + GONIO_CHANNELS) * view->channels * sizeof *kept);
    size_t count = 0;
    if (kept == NULL) {
        return false;
    }
    double *values = kept + view->channels;
    double *weight = values + view->channels;
    for (size_t k = 0; k < view->channels; k++) {
        if (!isnan(read[k])) {
            kept[count] = view->wavelength[k];
            values[count++] = read[k];
        }
    }
    const bool done = count > 0 && gonio_i_colour_weights(NULL, kept, count, GONIO_ILLUMINANT_E,
                                                          weight) == GONIO_OK;
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        double sum = done ? 0.0 : NAN;
        for (size_t k = 0; k < count && done; k++) {
            sum += weight[c * count + k] * values[k];
        }
        value[c] = sum < 0.0 ? 0.0 : sum;
    }
    free(kept);
    return true;
}

/* The values of R, G, B; of spectra their colours, of a single channel grey, of others NaN. */
static void colours_of(const gonio_readings *readings, size_t reading, double value[GONIO_CHANNELS])
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    if (view->wavelength != NULL && mix_colour(view, reading, value)) {
        return;
    }
    const bool colours = gonio_readings_are_colours(readings);
    const bool grey = view->channels == 1;
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        value[c] = colours || grey ? gonio_readings_value(readings, reading, grey ? 0 : c) : NAN;
    }
}

static json_t *reading_json(const gonio_readings *readings, size_t reading,
                            gonio_i_web_known reference, gonio_i_web_known reconstruction)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    const gonio_pair pair = view->pair[reading];
    double value[GONIO_CHANNELS];
    colours_of(readings, reading, value);
    return json_pack("{s:o, s:o, s:i, s:o, s:o, s:o}", "incident", direction(pair.incident),
                     "outgoing", direction(pair.outgoing), "channel", view->planned[reading],
                     "value", numbers(value, GONIO_CHANNELS), "reference",
                     values_at(reference, pair), "reconstruction", values_at(reconstruction, pair));
}

json_t *gonio_i_web_readings(const gonio_readings *readings, gonio_i_web_known reference,
                             gonio_i_web_known reconstruction)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    json_t *list = json_array();
    for (size_t k = 0; k < view->count && k < MOST_READINGS; k++) {
        json_array_append_new(list, reading_json(readings, k, reference, reconstruction));
    }
    char *name = gonio_i_base_name(view->path, true);
    json_t *json =
        json_pack("{s:o, s:I, s:I, s:o, s:o}", "file", text(name != NULL ? name : ""), "count",
                  (json_int_t)view->count, "components", (json_int_t)view->components, "method",
                  text(view->method), "list", list);
    free(name);
    return json;
}
