/* The simulated instrument: reads a known material at given directions, with noise. */
#include <math.h>
#include <stdlib.h>

#include "../core/options.h"
#include "../core/random.h"
#include "../material/source.h"
#include "readings.h"

void gonio_instrument_options_default_of(gonio_instrument_options *options, size_t size)
{
    const gonio_instrument_options usual = {0};
    gonio_i_give(&usual, sizeof usual, options, size);
}

/* The stream of random numbers of a pair of directions. Noise depends on the directions and on how
 * often they were read before, not on the line. */
static uint64_t stream_of(const gonio_pair *pair)
{
    const union {
        double angle[4];
        uint64_t bits[4];
    } u = {.angle = {pair->incident.theta, pair->incident.phi, pair->outgoing.theta,
                     pair->outgoing.phi}};
    uint64_t stream = 0;
    for (int k = 0; k < 4; k++) {
        stream = (stream ^ u.bits[k]) * UINT64_C(0x9e3779b97f4a7c15);
        stream ^= stream >> 29;
    }
    return stream;
}

/* repeat[count]: how often the directions of each reading were read before, which the caller frees;
 * NULL: out of memory. */
static size_t *count_repeats(gonio_context *context, const gonio_readings *readings)
{
    size_t *repeat = gonio_i_allocate(context, readings->count, sizeof *repeat);
    size_t *times = gonio_i_allocate(context, readings->count, sizeof *times);
    for (size_t k = 0; repeat != NULL && times != NULL && k < readings->count; k++) {
        repeat[k] = times[readings->first_same[k]]++;
    }
    if (times == NULL) {
        free(repeat);
        repeat = NULL;
    }
    free(times);
    return repeat;
}

/* Reports the number of directions at which the material has no data. */
static gonio_status report_holes(gonio_context *context, const gonio_readings *readings,
                                 size_t holes, size_t first)
{
    if (holes == readings->count) {
        return gonio_i_fail(context, GONIO_ERROR_DATA,
                            "%s:%zu: the material has no data around these directions, nor around "
                            "any other of the file (gonio info shows its share)",
                            readings->path, readings->line[first]);
    }
    if (holes > 0) {
        gonio_i_note(context,
                     "%s: the material has no data around %zu of %zu directions (the first is line "
                     "%zu): their values stay empty",
                     readings->path, holes, readings->count, readings->line[first]);
    }
    return GONIO_OK;
}

/* Turns the true values of a direction into readings: noise, other noise each time it is read, and
 * a factor if the direction is an outlier. NaN stays. */
static void disturb(const gonio_readings *readings, size_t reading, size_t repeat,
                    const gonio_instrument_options *options, double *value)
{
    const gonio_pair *pair = &readings->pair[reading];
    gonio_i_random random;
    gonio_i_random wrongness;
    gonio_i_random_seed(&random, options->seed,
                        stream_of(pair) + repeat * UINT64_C(0x9e3779b97f4a7c15));
    gonio_i_random_seed(&wrongness, ~options->seed, stream_of(pair));
    const bool wrong = gonio_i_random_uniform(&wrongness) < options->outliers;
    const double factor = !wrong ? 1.0 : gonio_i_random_uniform(&wrongness) < 0.5 ? 10.0 : 0.1;
    for (size_t k = 0; k < readings->channels; k++) {
        const double gain = 1.0 + options->noise * gonio_i_random_normal(&random);
        const double offset = options->floor * gonio_i_random_normal(&random);
        value[k] = isnan(value[k]) ? NAN : fmax(factor * value[k] * gain + offset, 0.0);
    }
}

/* Reads one direction from a table. Returns whether there are data. */
static bool read_one(gonio_readings *readings, size_t reading, size_t repeat,
                     const gonio_table *table, const gonio_instrument_options *options)
{
    const gonio_pair *pair = &readings->pair[reading];
    double *value = gonio_i_readings_values(readings, reading);
    if (!gonio_table_value(table, gonio_half_difference_from_pair(*pair), value)) {
        value[0] = value[1] = value[2] = NAN;
        return false;
    }
    disturb(readings, reading, repeat, options, value);
    return true;
}

static gonio_status check(gonio_context *context, const gonio_instrument_options *options)
{
    static const double most = 1e6; /* the products of larger numbers would not be finite */
    if (!(options->noise >= 0.0 && options->noise <= most) ||
        !(options->floor >= 0.0 && options->floor <= most)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "noise and floor must be finite and not negative, at most %g", most);
    }
    if (!(options->outliers >= 0.0 && options->outliers <= 1.0)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "the share of outliers must be 0 to 1");
    }
    return GONIO_OK;
}

static gonio_status take_options(gonio_context *context, const gonio_instrument_options *given,
                                 gonio_instrument_options *how)
{
    const gonio_status status = GONIO_I_TAKE(context, gonio_instrument_options, given, how);
    return status == GONIO_OK ? check(context, how) : status;
}

gonio_status gonio_measure(gonio_context *context, gonio_readings *readings,
                           const gonio_table *table, const gonio_instrument_options *options)
{
    gonio_instrument_options how;
    gonio_status status = take_options(context, options, &how);
    if (status == GONIO_OK) {
        status = gonio_i_readings_set_channels(context, readings, GONIO_CHANNELS, NULL);
    }
    size_t *repeat = count_repeats(context, readings);
    size_t holes = 0;
    size_t first = 0;
    if (status == GONIO_OK && repeat == NULL) {
        status = GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < readings->count && status == GONIO_OK; k++) {
        if (!read_one(readings, k, repeat[k], table, &how)) {
            first = holes == 0 ? k : first;
            holes++;
        }
    }
    free(repeat);
    return status == GONIO_OK ? report_holes(context, readings, holes, first) : status;
}

/* Evaluates the material itself at all directions, in its own channels. */
static gonio_status evaluate(gonio_context *context, gonio_readings *readings,
                             const gonio_material *material,
                             const gonio_instrument_options *options)
{
    const gonio_material_view *view = gonio_material_describe(material);
    gonio_status status =
        gonio_i_readings_set_channels(context, readings, view->channels, view->wavelength);
    if (status == GONIO_OK && readings->count > 0) {
        status = gonio_material_evaluate(context, material, readings->pair, readings->count,
                                         gonio_i_readings_values(readings, 0));
    }
    size_t *repeat = count_repeats(context, readings);
    size_t holes = 0;
    size_t first = 0;
    if (status == GONIO_OK && repeat == NULL) {
        status = GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < readings->count && status == GONIO_OK; k++) {
        double *value = gonio_i_readings_values(readings, k);
        bool any = false;
        for (size_t c = 0; c < view->channels; c++) {
            any = any || !isnan(value[c]);
        }
        disturb(readings, k, repeat[k], options, value);
        first = !any && holes == 0 ? k : first;
        holes += !any;
    }
    free(repeat);
    return status == GONIO_OK ? report_holes(context, readings, holes, first) : status;
}

/* Whether the planned channels exist in the material. A plan that names R, G or B needs colours. */
static bool is_for_all(const gonio_readings *readings, const gonio_material *material)
{
    const gonio_material_view *view = gonio_material_describe(material);
    const bool colours = view->wavelength == NULL && view->channels == GONIO_CHANNELS;
    bool all = true;
    for (size_t k = 0; k < readings->count; k++) {
        all = all && readings->planned[k] == GONIO_ALL_CHANNELS;
    }
    return all || colours;
}

gonio_status gonio_measure_material(gonio_context *context, gonio_readings *readings,
                                    const gonio_material *material,
                                    const gonio_instrument_options *options)
{
    gonio_instrument_options how;
    gonio_table *table = NULL;
    gonio_status status = take_options(context, options, &how);
    if (status != GONIO_OK) {
        return status;
    }
    if (gonio_i_material_source(material).evaluate != NULL && is_for_all(readings, material)) {
        return evaluate(context, readings, material, &how);
    }
    status = gonio_table_load(context, material, &table);
    if (status == GONIO_OK) {
        status = gonio_measure(context, readings, table, &how);
    }
    gonio_table_free(&table);
    return status;
}
