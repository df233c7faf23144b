/* How accurate anisotropic plans and reconstructions are: docs/accuracy.md.
 *
 *     gonio-anisotropy BASIS N[,N...] [FILE ...]
 *
 * FILE is a material (atlas:NAME, a table), other:NAME (other_grain.h) or readings; other: stands
 * for all of these. Without any, all anisotropic built-in materials. A material is read without
 * noise at the first N directions of one anisotropic plan, and predicted at 3,000 random pairs of
 * any azimuth. Of readings, a random part of at most 3,000 are candidates of the plan; the others
 * are predicted, repeats averaged before.
 *
 * Prints a line of CSV for each file and N: E6, per cent, by the isotropic and the anisotropic
 * model and by interpolation from the same readings; the E6 that the anisotropic model expects; the
 * share of values within its 95 % bands; the ln of the odds of anisotropy; the ratio of the axes.
 * Then the means over the files for each N. loss is the error of the anisotropic model over that of
 * the isotropic one, less 1: for isotropic materials what --anisotropic costs. */
#include <gonio/gonio.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "library_settings.h"
#include "core/core.h"
#include "core/random.h"
#include "other_grain.h"
#include "prior/stretch.h"

enum { MOST_SIZES = 16, PLACES = 3000, CANDIDATES = 3000 };

typedef struct result {
    double isotropic;
    double anisotropic;
    double interpolation;
    double expected;
    double inside;
    double odds;
    double ratio;
} result;

typedef struct setting {
    gonio_context *context;
    gonio_basis *basis;
    size_t sizes;
    size_t size[MOST_SIZES];
    result sum[MOST_SIZES];
    size_t files;
    gonio_pair *planned; /* for every material; NULL before the first */
    size_t planned_count;
} setting;

/* A file: readings in the order of its plan, and the values to predict. */
typedef struct subject {
    size_t channels;
    const double *wavelength; /* [channels] or NULL; of `source` */
    gonio_readings *source;   /* NULL for a material */
    size_t planned;
    gonio_pair *pair; /* [planned] */
    double *value;    /* [planned][channels] */
    double *scale;    /* [channels] */
    size_t places;
    gonio_pair *place; /* [places] */
    double *known;     /* [places][channels] */
} subject;

static void on_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    if (level == GONIO_MESSAGE_ERROR) {
        fprintf(stderr, "%s\n", text);
    }
}

static void check(gonio_status status)
{
    if (status != GONIO_OK) {
        fprintf(stderr, "%s\n", gonio_status_text(status));
        exit(1);
    }
}

static void *room(size_t count, size_t size)
{
    void *made = calloc(count > 0 ? count : 1, size);
    if (made == NULL) {
        check(GONIO_ERROR_MEMORY);
    }
    return made;
}

/* ---- what is read ---- */

static void plan(const setting *s, const gonio_pair *candidates, size_t count, subject *it)
{
    gonio_plan_options options;
    gonio_plan *made = NULL;
    gonio_plan_options_default(&options);
    options.anisotropic = true;
    options.candidates = candidates;
    options.candidate_count = count;
    options.count = s->size[s->sizes - 1];
    check(gonio_plan_create(s->context, s->basis, &options, &made));
    it->planned = made->count;
    it->pair = room(made->count, sizeof *it->pair);
    for (size_t k = 0; k < made->count; k++) {
        it->pair[k] = made->entries[k].pair;
    }
    gonio_plan_free(&made);
}

/* The plan of all materials. */
static void plan_materials(setting *s, subject *it)
{
    if (s->planned == NULL) {
        plan(s, NULL, 0, it);
        s->planned = it->pair;
        s->planned_count = it->planned;
    }
    it->planned = s->planned_count;
    it->pair = room(it->planned, sizeof *it->pair);
    memcpy(it->pair, s->planned, it->planned * sizeof *it->pair);
}

static void look_up(const setting *s, const char *path, subject *it)
{
    gonio_material *material = NULL;
    if (other_grain_is(path)) {
        other_grain_values(path, it->pair, it->planned, it->value);
        other_grain_values(path, it->place, it->places, it->known);
        return;
    }
    check(gonio_material_open(s->context, path, &material));
    check(gonio_material_evaluate(s->context, material, it->pair, it->planned, it->value));
    check(gonio_material_evaluate(s->context, material, it->place, it->places, it->known));
    gonio_material_free(&material);
}

static void begin_material(setting *s, const char *path, subject *it)
{
    gonio_i_oriented *place = room(PLACES, sizeof *place);
    plan_materials(s, it);
    it->channels = GONIO_CHANNELS;
    it->value = room(it->planned * it->channels, sizeof *it->value);
    it->scale = room(it->channels, sizeof *it->scale);
    it->places = PLACES;
    it->place = room(PLACES, sizeof *it->place);
    it->known = room(PLACES * it->channels, sizeof *it->known);
    gonio_i_oriented_sample(1, PLACES, place);
    for (size_t k = 0; k < PLACES; k++) {
        it->place[k] = gonio_i_oriented_pair(place[k]);
    }
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        it->scale[c] = gonio_log_scale(c);
    }
    look_up(s, path, it);
    free(place);
}

/* A random order of 0 .. count - 1. */
static size_t *shuffled(size_t count)
{
    size_t *order = room(count, sizeof *order);
    gonio_i_random random;
    gonio_i_random_seed(&random, 0, 0);
    for (size_t k = 0; k < count; k++) {
        const size_t other = (size_t)gonio_i_random_below(&random, k + 1);
        order[k] = order[other];
        order[other] = k;
    }
    return order;
}

static bool is_same_pair(const gonio_pair *a, const gonio_pair *b)
{
    return a->incident.theta == b->incident.theta && a->incident.phi == b->incident.phi &&
           a->outgoing.theta == b->outgoing.theta && a->outgoing.phi == b->outgoing.phi;
}

static bool is_planned(const subject *it, const gonio_pair *pair)
{
    bool found = false;
    for (size_t k = 0; k < it->planned && !found; k++) {
        found = is_same_pair(&it->pair[k], pair);
    }
    return found;
}

/* Values of the planned pairs; all other readings are to be predicted. */
static void share_out(const gonio_readings_view *view, subject *it)
{
    for (size_t k = 0; k < view->count; k++) {
        const double *value = view->value + k * it->channels;
        for (size_t p = 0; p < it->planned; p++) {
            if (is_same_pair(&it->pair[p], &view->pair[k])) {
                memcpy(it->value + p * it->channels, value, it->channels * sizeof *value);
            }
        }
        if (!is_planned(it, &view->pair[k])) {
            memcpy(it->known + it->places * it->channels, value, it->channels * sizeof *value);
            it->place[it->places++] = view->pair[k];
        }
    }
}

static void begin_readings(const setting *s, const char *path, subject *it)
{
    check(gonio_readings_read(s->context, path, NULL, &it->source));
    check(gonio_readings_average_repeats(s->context, it->source));
    const gonio_readings_view *view = gonio_readings_describe(it->source);
    const size_t count = view->count < CANDIDATES ? view->count : CANDIDATES;
    gonio_pair *candidates = room(count, sizeof *candidates);
    size_t *order = shuffled(view->count);
    for (size_t k = 0; k < count; k++) {
        candidates[k] = view->pair[order[k]];
    }
    plan(s, candidates, count, it);
    it->channels = view->channels;
    it->wavelength = view->wavelength;
    it->value = room(it->planned * it->channels, sizeof *it->value);
    it->scale = room(it->channels, sizeof *it->scale);
    it->place = room(view->count, sizeof *it->place);
    it->known = room(view->count * it->channels, sizeof *it->known);
    for (size_t c = 0; c < it->channels; c++) {
        it->scale[c] = gonio_readings_scale(it->source, c);
    }
    share_out(view, it);
    free(candidates);
    free(order);
}

static void end_subject(subject *it)
{
    gonio_readings_free(&it->source);
    free(it->pair);
    free(it->value);
    free(it->scale);
    free(it->place);
    free(it->known);
}

/* ---- what is made of it ---- */

/* E6 of predictions [places][channels], per cent, over the values that are known. */
static double error_of(const subject *it, const double *predicted)
{
    double error = 0.0;
    double square = 0.0;
    for (size_t k = 0; k < it->places * it->channels; k++) {
        const double scale = it->scale[k % it->channels];
        const double g = log1p(it->known[k] / scale);
        const double apart = g - log1p(predicted[k] / scale);
        error += isnan(g) ? 0.0 : apart * apart;
        square += isnan(g) ? 0.0 : g * g;
    }
    return 100.0 * sqrt(error / square);
}

static double inside_bands(const subject *it, const double *predicted, const double *deviation)
{
    size_t inside = 0;
    size_t all = 0;
    for (size_t k = 0; k < it->places * it->channels; k++) {
        const double scale = it->scale[k % it->channels];
        const double apart = log1p(it->known[k] / scale) - log1p(predicted[k] / scale);
        inside += fabs(apart) <= 1.96 * deviation[k];
        all += !isnan(apart);
    }
    return (double)inside / (double)all;
}

static void try_isotropic(const setting *s, const subject *it, const gonio_readings *readings,
                          double *predicted, result *r)
{
    gonio_reconstruction *made = NULL;
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    how.no_checks = true;
    check(gonio_reconstruct(s->context, s->basis, readings, &how, &made));
    for (size_t k = 0; k < it->places; k++) {
        const gonio_half_difference at = gonio_half_difference_from_pair(it->place[k]);
        gonio_reconstruction_predict(s->basis, made, at, predicted + k * it->channels, NULL);
    }
    r->isotropic = error_of(it, predicted);
    gonio_reconstruction_free(&made);
}

static void try_anisotropic(const setting *s, const subject *it, const gonio_readings *readings,
                            double *predicted, result *r)
{
    double *deviation = predicted + it->places * it->channels;
    gonio_anisotropic_reconstruction *made = NULL;
    check(gonio_reconstruct_anisotropic(s->context, s->basis, readings, NULL, &made));
    check(gonio_anisotropic_reconstruction_predict(s->context, made, it->place, it->places,
                                                   predicted, deviation));
    const gonio_anisotropic_reconstruction_view *view =
        gonio_anisotropic_reconstruction_describe(made);
    r->anisotropic = error_of(it, predicted);
    r->inside = inside_bands(it, predicted, deviation);
    r->expected = view->predicted_e6;
    r->odds = view->anisotropy.evidence;
    r->ratio = view->anisotropy.axis_ratio;
    gonio_anisotropic_reconstruction_free(&made);
}

/* As the interpolation of docs/benchmark.md, with the azimuth of the half vector. */
enum { COORDINATES = 6 };

static void coordinates_of(gonio_pair pair, double *x)
{
    const gonio_i_oriented here = gonio_i_oriented_of(pair);
    const double h = sqrt(here.at.theta_h / M_PI_2);
    const double d = here.at.theta_d / M_PI_2;
    x[0] = h;
    x[1] = d;
    x[2] = 0.25 * h * d * cos(2.0 * here.at.phi_d);
    x[3] = 0.25 * h * d * sin(2.0 * here.at.phi_d);
    x[4] = 0.25 * h * cos(2.0 * here.phi_h);
    x[5] = 0.25 * h * sin(2.0 * here.phi_h);
}

static double inverse_fourth_power(const double *a, const double *b)
{
    double square = 1e-12;
    for (int i = 0; i < COORDINATES; i++) {
        square += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return 1.0 / (square * square);
}

static void interpolate(const subject *it, size_t n, double *predicted, result *r)
{
    double *seen = room(n * COORDINATES, sizeof *seen);
    for (size_t k = 0; k < n; k++) {
        coordinates_of(it->pair[k], seen + k * COORDINATES);
    }
    for (size_t p = 0; p < it->places * it->channels; p++) {
        const size_t c = p % it->channels;
        double here[COORDINATES];
        double sum = 0.0;
        double weights = 0.0;
        coordinates_of(it->place[p / it->channels], here);
        for (size_t k = 0; k < n; k++) {
            const double value = it->value[k * it->channels + c];
            const double weight =
                isnan(value) ? 0.0 : inverse_fourth_power(here, seen + k * COORDINATES);
            sum += weight > 0.0 ? weight * log1p(value / it->scale[c]) : 0.0;
            weights += weight;
        }
        predicted[p] = it->scale[c] * expm1(sum / weights);
    }
    r->interpolation = error_of(it, predicted);
    free(seen);
}

/* ---- the output ---- */

static void print_line(const char *name, size_t n, const result *r)
{
    printf("%s,%zu,%.3f,%.3f,%.3f,%.4f,%.3f,%.4f,%.2f,%.2f\n", name, n, r->isotropic,
           r->anisotropic, r->interpolation, r->anisotropic / r->isotropic - 1.0, r->expected,
           r->inside, r->odds, r->ratio);
    fflush(stdout);
}

static void add(const result *r, result *sum)
{
    sum->isotropic += r->isotropic;
    sum->anisotropic += r->anisotropic;
    sum->interpolation += r->interpolation;
    sum->expected += r->expected;
    sum->inside += r->inside;
    sum->odds += r->odds;
    sum->ratio += r->ratio;
}

static void print_means(const setting *s)
{
    const double n = (double)s->files;
    for (size_t i = 0; i < s->sizes; i++) {
        const result *t = &s->sum[i];
        const result mean = {t->isotropic / n, t->anisotropic / n, t->interpolation / n,
                             t->expected / n,  t->inside / n,      t->odds / n,
                             t->ratio / n};
        print_line("mean", s->size[i], &mean);
    }
}

static void try_size(setting *s, const subject *it, const char *name, size_t i)
{
    const size_t n = s->size[i] < it->planned ? s->size[i] : it->planned;
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = n,
                                          .channels = it->channels,
                                          .pair = it->pair,
                                          .wavelength = it->wavelength,
                                          .value = it->value};
    gonio_readings *readings = NULL;
    result r = {0};
    double *predicted = room(2 * it->places * it->channels, sizeof *predicted);
    check(gonio_readings_create(s->context, &arrays, NULL, &readings));
    try_isotropic(s, it, readings, predicted, &r);
    try_anisotropic(s, it, readings, predicted, &r);
    interpolate(it, n, predicted, &r);
    print_line(name, n, &r);
    add(&r, &s->sum[i]);
    gonio_readings_free(&readings);
    free(predicted);
}

static void try_file(setting *s, const char *path)
{
    subject it = {0};
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    if (!other_grain_is(path)) {
        check(gonio_file_kind(s->context, path, &kind, NULL));
    }
    if (kind == GONIO_KIND_READINGS) {
        begin_readings(s, path, &it);
    } else {
        begin_material(s, path, &it);
    }
    for (size_t i = 0; i < s->sizes; i++) {
        try_size(s, &it, path, i);
    }
    s->files++;
    end_subject(&it);
}

static void try_others(setting *s)
{
    for (int k = 0; k < other_grain_count(); k++) {
        char path[128];
        snprintf(path, sizeof path, "other:%s", other_grain_name(k));
        try_file(s, path);
    }
}

static void try_built_in(setting *s)
{
    for (int k = 0; k < gonio_atlas_anisotropic_count(); k++) {
        char path[128];
        snprintf(path, sizeof path, "atlas:%s", gonio_atlas_anisotropic_name(k));
        try_file(s, path);
    }
}

/* Sizes in ascending order, as plans are nested. */
static void read_sizes(char *list, setting *s)
{
    for (char *word = strtok(list, ","); word != NULL && s->sizes < MOST_SIZES;
         word = strtok(NULL, ",")) {
        const size_t size = strtoul(word, NULL, 10);
        size_t k = s->sizes++;
        for (; k > 0 && s->size[k - 1] > size; k--) {
            s->size[k] = s->size[k - 1];
        }
        s->size[k] = size;
    }
}

int main(int argc, char **argv)
{
    library_settings_choose(argv, true);
    setting s = {0};
    if (argc > 2) {
        read_sizes(argv[2], &s);
    }
    if (s.sizes == 0 || s.size[0] == 0) {
        fprintf(stderr, "usage: %s BASIS N[,N...] [FILE ...]\n", argv[0]);
        return 2;
    }
    const gonio_context_options options = {.size = sizeof options, .message = on_message};
    check(gonio_context_create(&s.context, &options));
    check(gonio_basis_read(s.context, argv[1], &s.basis));
    puts("file,n,isotropic,anisotropic,interpolation,loss,expected,inside,odds,axis_ratio");
    for (int k = 3; k < argc; k++) {
        if (strcmp(argv[k], "other:") == 0) {
            try_others(&s);
        } else {
            try_file(&s, argv[k]);
        }
    }
    if (argc == 3) {
        try_built_in(&s);
    }
    print_means(&s);
    free(s.planned);
    gonio_basis_free(&s.basis);
    gonio_context_free(&s.context);
    return 0;
}
