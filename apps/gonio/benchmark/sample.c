/* A subject that is open: see sample.h. */
#include "sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "core/core.h"

enum { SUBSET_STREAM = 1000, CANDIDATE_STREAM = 1001 };

/* A random point of the grid: uniform in sqrt theta_h, theta_d and phi_d, as the bins are. */
static gonio_pair draw_pair(gonio_i_random *random)
{
    const double h = gonio_i_random_uniform(random);
    gonio_half_difference at = {.theta_h = h * h * M_PI_2};
    at.theta_d = gonio_i_random_uniform(random) * M_PI_2;
    at.phi_d = gonio_i_random_uniform(random) * M_PI;
    return gonio_pair_from_half_difference(at);
}

gonio_status benchmark_candidates(gonio_context *context, const benchmark_setting *setting,
                                  benchmark_pairs *candidates)
{
    gonio_i_random random;
    *candidates = (benchmark_pairs){0};
    if (setting->candidates == 0) {
        return GONIO_OK;
    }
    candidates->pair = gonio_i_allocate(context, setting->candidates, sizeof *candidates->pair);
    if (candidates->pair == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_i_random_seed(&random, setting->seed, CANDIDATE_STREAM);
    while (candidates->count < setting->candidates) {
        const gonio_pair pair = draw_pair(&random);
        if (pair.incident.theta < setting->reach && pair.outgoing.theta < setting->reach) {
            candidates->pair[candidates->count++] = pair;
        }
    }
    return GONIO_OK;
}

/* ---- opening ---- */

/* A material is read in its own colours if it evaluates them itself, otherwise by way of its table.
 */
static bool evaluates_colours(const gonio_material *material)
{
    const gonio_material_view *view = gonio_material_describe(material);
    return view->evaluated && view->wavelength == NULL && view->channels == GONIO_CHANNELS;
}

/* Where materials have no data in a channel on either side of a pair: a conversion to R, G, B has
 * made it negative. Room for one slab. */
typedef struct pair_list {
    size_t count;
    gonio_pair *pair; /* [2][count]: of bins and the reciprocal ones in turn */
    int32_t *bin;     /* [count] */
    double *value;    /* [2][count][channels] */
} pair_list;

/* Every stride-th bin of a slab. */
static void list_pairs(int slab, int stride, pair_list *list)
{
    list->count = 0;
    for (int32_t k = 0; k < GONIO_SLAB_BINS; k += stride) {
        const int32_t index = slab * GONIO_SLAB_BINS + k;
        const gonio_bin bin = gonio_bin_from_index(index);
        if (gonio_bin_is_valid(bin)) {
            const gonio_pair p = gonio_pair_from_half_difference(gonio_bin_centre(bin));
            list->pair[2 * list->count] = p;
            list->pair[2 * list->count + 1] = (gonio_pair){p.outgoing, p.incident};
            list->bin[list->count++] = index;
        }
    }
}

/* Clears the bits of what is missing; how many values are. */
static size_t clear_missing(const pair_list *list, unsigned char *measured)
{
    size_t missing = 0;
    for (size_t k = 0; k < 2 * list->count * GONIO_CHANNELS; k++) {
        if (isnan(list->value[k])) {
            const unsigned bit = 1U << k % GONIO_CHANNELS;
            measured[list->bin[k / (size_t)(2 * GONIO_CHANNELS)]] &= (unsigned char)~bit;
            missing++;
        }
    }
    return missing;
}

static gonio_status look_for_missing(gonio_context *context, benchmark_sample *sample, int stride,
                                     pair_list *list, size_t *missing)
{
    gonio_status status = GONIO_OK;
    *missing = 0;
    for (int slab = 0; slab < GONIO_THETA_H_BINS && status == GONIO_OK; slab++) {
        list_pairs(slab, stride, list);
        status = gonio_material_evaluate(context, sample->material, list->pair, 2 * list->count,
                                         list->value);
        if (status == GONIO_OK) {
            *missing += clear_missing(list, sample->measured);
        }
    }
    return status;
}

/* All bins are looked at only if something is missing in a sixteenth of them. */
static gonio_status find_missing(gonio_context *context, benchmark_sample *sample, pair_list *list)
{
    enum { FIRST_LOOK = 16 };
    size_t missing = 0;
    gonio_status status = look_for_missing(context, sample, FIRST_LOOK, list, &missing);
    if (status == GONIO_OK && missing > 0) {
        status = look_for_missing(context, sample, 1, list, &missing);
    }
    return status;
}

static gonio_status find_measured(gonio_context *context, benchmark_sample *sample)
{
    enum { ALL = (1 << GONIO_CHANNELS) - 1, PAIRS = 2 * GONIO_SLAB_BINS };
    pair_list list = {
        .pair = gonio_i_allocate(context, PAIRS, sizeof *list.pair),
        .bin = gonio_i_allocate(context, GONIO_SLAB_BINS, sizeof *list.bin),
        .value = gonio_i_allocate(context, (size_t)PAIRS * GONIO_CHANNELS, sizeof *list.value)};
    sample->measured = gonio_i_allocate(context, GONIO_BINS, 1);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (sample->measured != NULL && list.pair != NULL && list.bin != NULL && list.value != NULL) {
        memset(sample->measured, ALL, GONIO_BINS);
        status =
            evaluates_colours(sample->material) ? find_missing(context, sample, &list) : GONIO_OK;
    }
    free(list.pair);
    free(list.bin);
    free(list.value);
    return status;
}

static gonio_status open_table(gonio_context *context, const benchmark_pairs *shared,
                               benchmark_sample *sample)
{
    gonio_status status = gonio_material_open(context, sample->subject->path, &sample->material);
    if (status == GONIO_OK) {
        status = gonio_table_load(context, sample->material, &sample->table);
    }
    if (status == GONIO_OK) {
        status = find_measured(context, sample);
    }
    sample->candidate = shared->pair;
    sample->candidates = shared->count;
    return status;
}

static bool has_value(const gonio_readings_view *view, size_t reading)
{
    bool any = false;
    for (size_t c = 0; c < view->channels; c++) {
        any = any || !isnan(view->value[reading * view->channels + c]);
    }
    return any;
}

/* A random part of the candidates of the sample, in their order. */
static gonio_status thin_out(gonio_context *context, const benchmark_setting *setting,
                             benchmark_sample *sample)
{
    const size_t wanted = setting->candidates;
    if (wanted == 0 || sample->candidates <= wanted) {
        return GONIO_OK;
    }
    unsigned char *used = gonio_i_allocate(context, sample->candidates, 1);
    size_t *chosen = gonio_i_allocate(context, wanted, sizeof *chosen);
    if (used != NULL && chosen != NULL) {
        gonio_i_random random;
        gonio_i_random_seed(&random, setting->seed, SUBSET_STREAM);
        gonio_i_random_subset(&random, sample->candidates, wanted, used, chosen);
        for (size_t k = 0; k < wanted; k++) {
            sample->own[k] = sample->own[chosen[k]];
        }
        sample->candidates = wanted;
    }
    const gonio_status status = used != NULL && chosen != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    free(used);
    free(chosen);
    return status;
}

/* Copies `kept` channels, evenly spread, of from[count][channels]. */
static void spread(const double *from, size_t count, size_t channels, size_t kept, double *to)
{
    for (size_t k = 0; k < count * kept; k++) {
        const size_t channel = kept > 1 ? k % kept * (channels - 1) / (kept - 1) : 0;
        to[k] = from[k / kept * channels + channel];
    }
}

/* Leaves as many channels as the setting has. */
static gonio_status keep_channels(gonio_context *context, size_t kept, gonio_readings *readings)
{
    const gonio_readings_view view = *gonio_readings_describe(readings);
    if (kept == 0 || view.channels <= kept) {
        return GONIO_OK;
    }
    const bool known = view.deviation != NULL;
    double *values = gonio_i_allocate(context, 2 * view.count * kept, sizeof *values);
    double *wavelengths = gonio_i_allocate(context, kept, sizeof *wavelengths);
    gonio_status status = values != NULL && wavelengths != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        double *deviations = values + view.count * kept;
        spread(view.value, view.count, view.channels, kept, values);
        if (view.wavelength != NULL) {
            spread(view.wavelength, 1, view.channels, kept, wavelengths);
        }
        if (known) {
            spread(view.deviation, view.count, view.channels, kept, deviations);
        }
        status = gonio_readings_set_values(
            context, readings, kept, view.wavelength != NULL ? wavelengths : NULL, values, NULL);
        if (status == GONIO_OK && known) {
            status = gonio_readings_set_deviations(context, readings, deviations);
        }
    }
    free(values);
    free(wavelengths);
    return status;
}

static gonio_status open_readings(gonio_context *context, const benchmark_setting *setting,
                                  benchmark_sample *sample)
{
    const benchmark_subject *s = sample->subject;
    gonio_status status =
        benchmark_readings_open(context, s->path, s->sample, &setting->reading, &sample->known);
    if (status == GONIO_OK) {
        status = keep_channels(context, setting->channels, sample->known);
    }
    if (status != GONIO_OK) {
        return status;
    }
    const gonio_readings_view *view = gonio_readings_describe(sample->known);
    sample->own = gonio_i_allocate(context, view->count, sizeof *sample->own);
    if (sample->own == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < view->count; k++) {
        if (has_value(view, k)) {
            sample->own[sample->candidates++] = view->pair[k];
        }
    }
    sample->candidate = sample->own;
    return thin_out(context, setting, sample);
}

gonio_status benchmark_sample_open(gonio_context *context, const benchmark_setting *setting,
                                   const benchmark_subject *subject, const benchmark_pairs *shared,
                                   benchmark_sample *sample)
{
    *sample = (benchmark_sample){.subject = subject};
    return subject->scattered ? open_readings(context, setting, sample)
                              : open_table(context, shared, sample);
}

void benchmark_sample_free(benchmark_sample *sample)
{
    gonio_table_free(&sample->table);
    gonio_material_free(&sample->material);
    gonio_readings_free(&sample->known);
    free(sample->own);
    free(sample->measured);
    *sample = (benchmark_sample){0};
}

size_t benchmark_sample_most(const benchmark_sample *sample)
{
    return sample->known != NULL ? sample->candidates / 2 : SIZE_MAX;
}

/* ---- reading ---- */

/* Readings are gathered here. */
typedef struct gathered {
    size_t count;
    gonio_pair *pair;
    double *value;     /* [count][channels] */
    double *deviation; /* the same; NULL: none is known */
} gathered;

static gonio_status make_readings(gonio_context *context, const gathered *g, size_t channels,
                                  const double *wavelength, gonio_readings **readings)
{
    gonio_readings_options how;
    gonio_readings_options_default(&how);
    how.average_repeats = true;
    how.negative_to_zero = true;
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = g->count,
                                          .channels = channels,
                                          .pair = g->pair,
                                          .wavelength = wavelength,
                                          .value = g->value,
                                          .deviation = g->deviation};
    return gonio_readings_create(context, &arrays, &how, readings);
}

/* Copies the readings with a value to the front; how many those are. */
static size_t keep_read(const gonio_readings_view *view, gonio_pair *pair, double *value)
{
    size_t kept = 0;
    for (size_t k = 0; k < view->count; k++) {
        if (has_value(view, k)) {
            pair[kept] = view->pair[k];
            memcpy(value + kept * view->channels, view->value + k * view->channels,
                   view->channels * sizeof *value);
            kept++;
        }
    }
    return kept;
}

static gonio_status drop_empty(gonio_context *context, gonio_readings **readings)
{
    const gonio_readings_view *view = gonio_readings_describe(*readings);
    gonio_readings *made = NULL;
    gathered g = {0};
    g.pair = gonio_i_allocate(context, view->count, sizeof *g.pair);
    g.value = gonio_i_allocate(context, view->count * view->channels, sizeof *g.value);
    gonio_status status = g.pair != NULL && g.value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        g.count = keep_read(view, g.pair, g.value);
    }
    if (status == GONIO_OK && g.count < view->count) {
        status = make_readings(context, &g, view->channels, view->wavelength, &made);
    }
    if (made != NULL) {
        gonio_readings_free(readings);
        *readings = made;
    }
    free(g.pair);
    free(g.value);
    return status;
}

static gonio_status measure(gonio_context *context, const benchmark_setting *setting,
                            const benchmark_sample *sample, gonio_readings *readings)
{
    const gonio_instrument_options instrument = {.size = sizeof instrument,
                                                 .noise = setting->noise,
                                                 .floor = setting->floor,
                                                 .seed = setting->seed,
                                                 .outliers = setting->outliers};
    return evaluates_colours(sample->material)
               ? gonio_measure_material(context, readings, sample->material, &instrument)
               : gonio_measure(context, readings, sample->table, &instrument);
}

static gonio_status read_table(gonio_context *context, const benchmark_setting *setting,
                               const benchmark_sample *sample, const benchmark_pairs *at,
                               gonio_readings **readings)
{
    const gathered plan = {.count = at->count, .pair = at->pair};
    gonio_readings *made = NULL;
    gonio_status status = make_readings(context, &plan, GONIO_CHANNELS, NULL, &made);
    if (status == GONIO_OK) {
        status = measure(context, setting, sample, made);
    }
    if (status == GONIO_OK) {
        status = drop_empty(context, &made);
    }
    if (status == GONIO_OK) {
        *readings = made;
        return GONIO_OK;
    }
    gonio_readings_free(&made);
    return status;
}

static double squared_distance(const gonio_pair *a, const gonio_pair *b)
{
    const double d[4] = {a->incident.theta - b->incident.theta, a->incident.phi - b->incident.phi,
                         a->outgoing.theta - b->outgoing.theta, a->outgoing.phi - b->outgoing.phi};
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + d[3] * d[3];
}

/* The reading at a pair, which is one of the file's to rounding. */
static size_t find_reading(const gonio_readings_view *view, const gonio_pair *pair)
{
    size_t best = 0;
    double least = HUGE_VAL;
    for (size_t k = 0; k < view->count && least > 0.0; k++) {
        const double d = squared_distance(pair, &view->pair[k]);
        if (d < least && has_value(view, k)) {
            least = d;
            best = k;
        }
    }
    return best;
}

static void gather(const gonio_readings_view *view, const benchmark_pairs *at, gathered *g)
{
    const size_t channels = view->channels;
    for (size_t k = 0; k < at->count; k++) {
        const size_t from = find_reading(view, &at->pair[k]);
        g->pair[k] = view->pair[from];
        memcpy(g->value + k * channels, view->value + from * channels, channels * sizeof(double));
        if (g->deviation != NULL) {
            memcpy(g->deviation + k * channels, view->deviation + from * channels,
                   channels * sizeof(double));
        }
    }
}

static gonio_status read_scattered(gonio_context *context, const benchmark_sample *sample,
                                   const benchmark_pairs *at, gonio_readings **readings)
{
    const gonio_readings_view *view = gonio_readings_describe(sample->known);
    const size_t values = at->count * view->channels;
    gathered g = {.count = at->count};
    g.pair = gonio_i_allocate(context, at->count, sizeof *g.pair);
    g.value = gonio_i_allocate(context, values, sizeof *g.value);
    g.deviation =
        view->deviation != NULL ? gonio_i_allocate(context, values, sizeof *g.deviation) : NULL;
    gonio_status status = GONIO_ERROR_MEMORY;
    if (g.pair != NULL && g.value != NULL && (g.deviation != NULL || view->deviation == NULL)) {
        gather(view, at, &g);
        status = make_readings(context, &g, view->channels, view->wavelength, readings);
    }
    free(g.pair);
    free(g.value);
    free(g.deviation);
    return status;
}

gonio_status benchmark_sample_read(gonio_context *context, const benchmark_setting *setting,
                                   const benchmark_sample *sample, const benchmark_pairs *at,
                                   gonio_readings **readings)
{
    return sample->known != NULL ? read_scattered(context, sample, at, readings)
                                 : read_table(context, setting, sample, at, readings);
}
