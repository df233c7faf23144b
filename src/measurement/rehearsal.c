/* A rehearsed run: what an instrument would write when it reads a known material by a plan.
 *
 * A value is the mean of the BRDF over the apertures, times the gain at that time and 1 + noise,
 * and the stray light, the dark level and the additive noise; at most the saturation. Before the
 * first reading and whenever it is due, the run reads an ideal diffuser as the reference and, if
 * there is a dark level, covers the lamp. Their noise is that of as many readings as fit into the
 * time. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/csv.h"
#include "../core/number.h"
#include "../core/random.h"
#include "readings.h"

enum { RINGS = 2, FIRST_VALUE = 6 };

/* What a marked row reads. */
typedef enum target { SAMPLE, REFERENCE, DARK } target;

typedef struct rehearsal {
    gonio_context *context;
    const gonio_readings *plan;
    const gonio_instrument *instrument;
    const gonio_instrument_view *view;
    gonio_setting *setting;   /* [plan->count] */
    gonio_readings *averaged; /* pairs over the apertures, read without noise */
    size_t *first;            /* [plan->count + 1]: of each reading */
    size_t channels;
    gonio_i_random random;
    gonio_i_csv *csv;
    double *value; /* [channels]: scratch */
    bool plain;    /* values are written in 1/sr */
    size_t saturated;
} rehearsal;

/* ---- settings ---- */

/* The setting nearest to the one before that reads a pair as it is or, of a sample that cannot
 * turn, turned about the normal. */
static bool find_setting(const rehearsal *r, size_t reading, const gonio_setting *before)
{
    static const gonio_freedom freedoms[] = {{false, false, false}, {true, false, false}};
    gonio_setting found[GONIO_MOST_SETTINGS];
    size_t count = 0;
    for (int k = 0; k < 2 && count == 0; k++) {
        count = gonio_instrument_settings(r->instrument, r->plan->pair[reading], freedoms[k], found,
                                          GONIO_MOST_SETTINGS);
    }
    double least = INFINITY;
    for (size_t k = 0; k < count; k++) {
        const double time = gonio_instrument_travel(r->instrument, before, &found[k]);
        if (time < least) {
            least = time;
            r->setting[reading] = found[k];
        }
    }
    return count > 0;
}

static gonio_status find_settings(const rehearsal *r)
{
    gonio_setting at;
    size_t missing = 0;
    size_t first = 0;
    gonio_instrument_home(r->instrument, &at);
    for (size_t k = 0; k < r->plan->count; k++) {
        if (find_setting(r, k, &at)) {
            at = r->setting[k];
        } else {
            first = missing++ == 0 ? k : first;
        }
    }
    return missing == 0
               ? GONIO_OK
               : gonio_i_fail(
                     r->context, GONIO_ERROR_MISMATCH,
                     "%s:%zu: the instrument %s cannot read this direction, nor %zu others "
                     "of %zu; plan with --instrument",
                     r->plan->path, r->plan->line[first], r->view->path, missing - 1,
                     r->plan->count);
}

/* ---- the material over the apertures ---- */

static gonio_status make_pairs(rehearsal *r, gonio_pair **pairs)
{
    const size_t each = gonio_instrument_aperture_samples(r->instrument, RINGS);
    gonio_pair *made = gonio_i_allocate(r->context, r->plan->count * each, sizeof *made);
    size_t count = 0;
    for (size_t k = 0; k < r->plan->count && made != NULL; k++) {
        count += gonio_instrument_aperture(r->instrument, r->setting[k].pair, RINGS, made + count);
        r->first[k + 1] = count;
    }
    *pairs = made;
    return made != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status read_apertures(rehearsal *r, const gonio_material *material)
{
    const gonio_readings_options how = {.size = sizeof how, .average_repeats = true};
    gonio_pair *pairs = NULL;
    gonio_status status = make_pairs(r, &pairs);
    if (status == GONIO_OK) {
        const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                              .count = r->first[r->plan->count],
                                              .channels = GONIO_CHANNELS,
                                              .pair = pairs};
        status = gonio_readings_create(r->context, &arrays, &how, &r->averaged);
    }
    if (status == GONIO_OK) {
        status = gonio_measure_material(r->context, r->averaged, material, NULL);
    }
    if (status == GONIO_OK) {
        r->channels = r->averaged->channels;
        r->value = gonio_i_allocate(r->context, r->channels, sizeof *r->value);
        status = r->value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    free(pairs);
    return status;
}

/* The mean of a reading in a channel; NaN if nothing of it is known. */
static double mean_of(const rehearsal *r, size_t reading, size_t channel)
{
    double sum = 0.0;
    size_t known = 0;
    for (size_t k = r->first[reading]; k < r->first[reading + 1]; k++) {
        const double value = r->averaged->value[k * r->channels + channel];
        sum += isnan(value) ? 0.0 : value;
        known += !isnan(value);
    }
    return known > 0 ? sum / (double)known : NAN;
}

/* ---- what the sensor says ---- */

/* The number of a BRDF value at a time, in 1/sr. `share`: of the noise. */
static double sense(rehearsal *r, target what, double value, double time, double share)
{
    const gonio_instrument_view *v = r->view;
    const double gain = 1.0 + v->drift * time / 3600.0;
    const double relative = 1.0 + share * v->noise * gonio_i_random_normal(&r->random);
    const double added = share * v->floor * gonio_i_random_normal(&r->random);
    const double light = what == DARK ? 0.0 : gain * (value * relative + v->stray);
    const double read = fmax(light + v->dark + added, 0.0);
    r->saturated += read >= v->saturation;
    return fmin(read, v->saturation);
}

/* ---- the file ---- */

/* The comment that says what values are; NULL for those that are written in 1/sr. */
static const char *stated(gonio_value_kind kind)
{
    static const char *const texts[] = {[GONIO_VALUE_FACTOR] = "reflectance factor",
                                        [GONIO_VALUE_PERCENT] = "reflectance factor, per cent",
                                        [GONIO_VALUE_COSINE] = "BRDF times cosine",
                                        [GONIO_VALUE_FACTOR_COSINE] =
                                            "reflectance factor times cosine"};
    return kind <= GONIO_VALUE_FACTOR_COSINE ? texts[kind] : NULL;
}

static gonio_status out_of_memory(const rehearsal *r)
{
    return gonio_i_fail(r->context, GONIO_ERROR_MEMORY, "out of memory for a run");
}

static bool begin_file(rehearsal *r, const char *command)
{
    static const char *const columns[FIRST_VALUE] = {"theta_i_deg", "phi_i_deg", "theta_o_deg",
                                                     "phi_o_deg",   "time_s",    "mark"};
    const char *kind = stated(r->view->values);
    r->plain = kind == NULL;
    r->csv = gonio_i_csv_create(r->context);
    bool done = r->csv != NULL && gonio_i_comments_copy(&r->csv->comment, &r->plan->comment);
    if (done) {
        gonio_i_comments_drop(&r->csv->comment, "instrument");
        gonio_i_comments_drop(&r->csv->comment, "command");
        done = gonio_i_comments_add(&r->csv->comment, "instrument: %s", r->view->name) &&
               (kind == NULL || gonio_i_comments_add(&r->csv->comment, "values: %s", kind)) &&
               (command == NULL || gonio_i_comments_add(&r->csv->comment, "command: %s", command));
    }
    for (size_t k = 0; k < FIRST_VALUE && done; k++) {
        done = gonio_i_csv_add_column(r->csv, columns[k]);
    }
    for (size_t k = 0; k < r->channels && done; k++) {
        char name[GONIO_I_NAME_ROOM];
        gonio_i_value_name(r->averaged, k, false, name);
        name[strlen(name) - (r->plain ? 0 : strlen("_per_sr"))] = '\0';
        done = gonio_i_csv_add_column(r->csv, name);
    }
    return done;
}

/* A row with r->value, in 1/sr. */
static bool add_row(rehearsal *r, const double degrees[4], double time, target what, double factor)
{
    static const char *const marks[] = {[SAMPLE] = "", [REFERENCE] = "reference", [DARK] = "dark"};
    const size_t row = r->csv->rows;
    bool done = gonio_i_csv_add_row(r->csv, 0);
    for (size_t k = 0; k < 4 && done; k++) {
        done = gonio_i_csv_set(r->csv, row, k, "%.9g", degrees[k]);
    }
    done = done && gonio_i_csv_set(r->csv, row, 4, "%.1f", time) &&
           gonio_i_csv_set(r->csv, row, 5, "%s", marks[what]);
    for (size_t k = 0; k < r->channels && done; k++) {
        done = isnan(r->value[k]) ||
               gonio_i_csv_set(r->csv, row, FIRST_VALUE + k, "%.7g", factor * r->value[k]);
    }
    return done;
}

static double factor_at(const rehearsal *r, gonio_pair pair)
{
    return r->plain ? 1.0 : gonio_instrument_value_factor(r->instrument, pair);
}

/* The reference and, where there is one, the dark level. */
static bool add_reference(rehearsal *r, double time)
{
    static const double degrees[4] = {8.0, 0.0, 0.0, 0.0};
    const gonio_pair pair = {{8.0 * M_PI / 180.0, 0.0}, {0.0, 0.0}};
    const double readings = r->view->reference_time / fmax(r->view->exposure, 1e-3);
    const double share = 1.0 / sqrt(fmax(readings, 1.0));
    bool done = true;
    for (int what = REFERENCE; what <= (r->view->dark > 0.0 ? DARK : REFERENCE) && done; what++) {
        for (size_t k = 0; k < r->channels; k++) {
            r->value[k] = sense(r, (target)what, 1.0 / M_PI, time, share);
        }
        done = add_row(r, degrees, time, (target)what, factor_at(r, pair));
    }
    return done;
}

static bool add_reading(rehearsal *r, size_t reading, double time)
{
    const gonio_pair *pair = &r->setting[reading].pair;
    const double unit = 180.0 / M_PI;
    const double degrees[4] = {pair->incident.theta * unit, pair->incident.phi * unit,
                               pair->outgoing.theta * unit, pair->outgoing.phi * unit};
    for (size_t k = 0; k < r->channels; k++) {
        const double value = mean_of(r, reading, k);
        r->value[k] = isnan(value) ? NAN : sense(r, SAMPLE, value, time, 1.0);
    }
    return add_row(r, degrees, time, SAMPLE, factor_at(r, *pair));
}

/* The run, on the clock of gonio_instrument_schedule. */
static bool add_run(rehearsal *r, double *duration)
{
    const gonio_instrument_view *v = r->view;
    const bool references = v->reference_every > 0.0;
    gonio_setting at;
    gonio_instrument_home(r->instrument, &at);
    double now = references ? v->reference_time : 0.0;
    double last = now;
    bool done = !references || add_reference(r, now);
    for (size_t k = 0; k < r->plan->count && done; k++) {
        const double needed =
            gonio_instrument_travel(r->instrument, &at, &r->setting[k]) + v->exposure;
        if (references && now + needed - last > v->reference_every) {
            now += v->reference_time;
            last = now;
            done = add_reference(r, now);
        }
        now += needed;
        at = r->setting[k];
        done = done && add_reading(r, k, now);
    }
    *duration = now;
    return done;
}

static gonio_status rehearse(rehearsal *r, const gonio_material *material, const char *command,
                             const char *path, double *duration)
{
    gonio_status status = find_settings(r);
    if (status == GONIO_OK) {
        status = read_apertures(r, material);
    }
    if (status == GONIO_OK && !(begin_file(r, command) && add_run(r, duration))) {
        status = out_of_memory(r);
    }
    if (status == GONIO_OK && r->saturated > 0) {
        gonio_i_note(r->context, "%zu values reach the saturation of %g 1/sr", r->saturated,
                     r->view->saturation);
    }
    return status == GONIO_OK ? gonio_i_csv_write(r->context, r->csv, path) : status;
}

gonio_status gonio_rehearse(gonio_context *context, const gonio_readings *plan,
                            const gonio_material *material, const gonio_instrument *instrument,
                            uint64_t seed, const char *command, const char *path, double *duration,
                            size_t *channels)
{
    double time = 0.0;
    rehearsal r = {.context = context,
                   .plan = plan,
                   .instrument = instrument,
                   .view = gonio_instrument_describe(instrument),
                   .setting = gonio_i_allocate(context, plan->count, sizeof *r.setting),
                   .first = gonio_i_allocate(context, plan->count + 1, sizeof *r.first)};
    gonio_i_random_seed(&r.random, seed, 0);
    const gonio_status status = r.setting != NULL && r.first != NULL
                                    ? rehearse(&r, material, command, path, &time)
                                    : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK && duration != NULL) {
        *duration = time;
    }
    if (status == GONIO_OK && channels != NULL) {
        *channels = r.channels;
    }
    gonio_i_csv_free(&r.csv);
    gonio_readings_free(&r.averaged);
    free(r.setting);
    free(r.first);
    free(r.value);
    return status;
}
