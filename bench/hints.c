/* How often right readings are taken for mistaken ones, and how often mistakes are noticed:
 * docs/experiments.md.
 *
 *     gonio-hints BASIS SEED DRAWS FILE[#SAMPLE] ...
 *
 * FILE is a material (atlas:NAME, a table, a network) or readings. For each, DRAWS sets of 10 to 80
 * readings are drawn: of a material in turn at random directions below 80 degrees, and at those of
 * a plan, with noise of 1 %; of readings at random ones. Each set is interpreted as it is and with
 * every usual mistake. Prints a line of CSV for each: the alternatives that are offered, or none.
 * Then, for every mistake, how often something is said and how often it is what was done. A pure
 * change of scale counts as told too if the albedo of the result says so by itself. */
#include <gonio/gonio.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "library_settings.h"
#include "core/core.h"
#include "core/random.h"
#include "posterior/interpret.h"

enum { MOST_READINGS = 80, SIZES = 7 };

static const size_t SIZE[SIZES] = {10, 14, 20, 28, 40, 56, 80};
static const double LIMIT = 80.0 * M_PI / 180.0;

/* ---- mistakes ---- */

typedef struct mistake {
    const char *name;
    const char *told; /* a part of what an alternative says; NULL: nothing should be said */
    double factor;    /* of the values */
    bool by_cosine_i;
    bool by_cosine_o;
    bool merl;
    gonio_pair (*change)(gonio_pair pair);
} mistake;

static gonio_pair to_radians(gonio_pair p)
{
    const double radian = M_PI / 180.0;
    return (gonio_pair){{p.incident.theta * radian, p.incident.phi * radian},
                        {p.outgoing.theta * radian, p.outgoing.phi * radian}};
}

static gonio_pair to_elevation(gonio_pair p)
{
    return (gonio_pair){{M_PI / 2.0 - p.incident.theta, p.incident.phi},
                        {M_PI / 2.0 - p.outgoing.theta, p.outgoing.phi}};
}

static gonio_pair to_mirror(gonio_pair p)
{
    return (gonio_pair){p.incident, {p.outgoing.theta, fmod(p.outgoing.phi + M_PI, 2.0 * M_PI)}};
}

static const mistake MISTAKES[] = {
    {"none", NULL, 1.0, false, false, false, NULL},
    {"cosine of theta_i", "cosine of theta_i", 1.0, true, false, false, NULL},
    {"cosine of theta_o", "cosine of theta_o", 1.0, false, true, false, NULL},
    {"reflectance factor", "reflectance factors; divide", M_PI, false, false, false, NULL},
    {"per cent", "in per cent; divide them by 100", 100.0, false, false, false, NULL},
    {"factor in per cent", "divide them by 100 pi", 100.0 * M_PI, false, false, false, NULL},
    {"MERL's numbers", "MERL", 1.0, false, false, true, NULL},
    {"radians", "radians", 1.0, false, false, false, to_radians},
    {"elevation", "from the surface", 1.0, false, false, false, to_elevation},
    {"mirror azimuth", "mirror direction", 1.0, false, false, false, to_mirror},
};

enum { KINDS = sizeof MISTAKES / sizeof *MISTAKES };

typedef struct tally {
    size_t draws;
    size_t said;
    size_t told;
    size_t unmeasured;
    size_t anisotropic;
} tally;

/* ---- drawing ---- */

typedef struct bench {
    gonio_context *context;
    gonio_i_prior *prior;
    gonio_plan *plan;
    gonio_i_random random;
    uint64_t seed; /* of the instrument's noise */
    tally tally[KINDS];
} bench;

static void check(gonio_status status)
{
    if (status != GONIO_OK) {
        exit(1);
    }
}

static void on_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    if (level == GONIO_MESSAGE_ERROR) {
        fprintf(stderr, "%s\n", text);
    }
}

static double draw(bench *b)
{
    return gonio_i_random_uniform(&b->random);
}

/* Uniform over the solid angle below the limit. */
static gonio_angles draw_direction(bench *b)
{
    const double cosine = 1.0 - draw(b) * (1.0 - cos(LIMIT));
    return (gonio_angles){acos(cosine), draw(b) * 2.0 * M_PI};
}

static gonio_readings *read_material(bench *b, const gonio_material *material, size_t n,
                                     bool planned)
{
    gonio_pair pair[MOST_READINGS];
    for (size_t k = 0; k < n; k++) {
        const gonio_angles incident = draw_direction(b);
        const gonio_angles outgoing = draw_direction(b);
        pair[k] = (gonio_pair){incident, outgoing};
        if (planned) {
            pair[k] = b->plan->entries[k].pair;
        }
    }
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = n, .channels = GONIO_CHANNELS, .pair = pair};
    const gonio_instrument_options instrument = {
        .size = sizeof instrument, .noise = 0.01, .floor = 1e-5, .seed = b->seed++};
    gonio_readings *readings = NULL;
    check(gonio_readings_create(b->context, &arrays, NULL, &readings));
    check(gonio_measure_material(b->context, readings, material, &instrument));
    return readings;
}

static bool is_below_limit(gonio_pair pair)
{
    return pair.incident.theta <= LIMIT && pair.outgoing.theta <= LIMIT;
}

/* n different readings below the limit, or all if there are fewer. */
static gonio_readings *choose_readings(bench *b, const gonio_readings *all, size_t n)
{
    const gonio_readings_view *view = gonio_readings_describe(all);
    gonio_pair pair[MOST_READINGS];
    double *value = calloc(n * view->channels, sizeof *value);
    size_t *left = calloc(view->count, sizeof *left);
    size_t count = 0;
    size_t taken = 0;
    for (size_t k = 0; k < view->count; k++) {
        if (is_below_limit(view->pair[k])) {
            left[count++] = k;
        }
    }
    for (; taken < n && count > 0; taken++) {
        const size_t j = (size_t)(draw(b) * (double)count);
        pair[taken] = view->pair[left[j]];
        memcpy(value + taken * view->channels, view->value + left[j] * view->channels,
               view->channels * sizeof *value);
        left[j] = left[--count];
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = taken,
                                          .channels = view->channels,
                                          .pair = pair,
                                          .value = value,
                                          .wavelength = view->wavelength};
    const gonio_readings_options options = {.size = sizeof options, .average_repeats = true};
    gonio_readings *readings = NULL;
    check(gonio_readings_create(b->context, &arrays, &options, &readings));
    free(value);
    free(left);
    return readings;
}

/* The same readings with a mistake; NULL where it cannot be made. */
static gonio_readings *spoil(bench *b, const gonio_readings *right, const mistake *m)
{
    const gonio_readings_view *view = gonio_readings_describe(right);
    gonio_pair pair[MOST_READINGS];
    double *value = calloc(view->count * view->channels, sizeof *value);
    bool possible = !m->merl || gonio_readings_are_colours(right);
    for (size_t k = 0; k < view->count; k++) {
        pair[k] = m->change != NULL ? m->change(view->pair[k]) : view->pair[k];
        possible = possible && fmax(pair[k].incident.theta, pair[k].outgoing.theta) < M_PI / 2.0;
        for (size_t c = 0; c < view->channels; c++) {
            value[k * view->channels + c] =
                view->value[k * view->channels + c] * m->factor *
                (m->by_cosine_i ? cos(view->pair[k].incident.theta) : 1.0) *
                (m->by_cosine_o ? cos(view->pair[k].outgoing.theta) : 1.0) /
                (m->merl ? gonio_readings_scale(right, c) : 1.0);
        }
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = view->count,
                                          .channels = view->channels,
                                          .pair = pair,
                                          .value = value,
                                          .wavelength = view->wavelength};
    const gonio_readings_options options = {.size = sizeof options, .average_repeats = true};
    gonio_readings *readings = NULL;
    if (possible) {
        check(gonio_readings_create(b->context, &arrays, &options, &readings));
    }
    free(value);
    return readings;
}

/* ---- what is said ---- */

static gonio_interpretation interpret(bench *b, const gonio_readings *readings)
{
    const gonio_i_noise noise = {.relative = 0.01, .floor = 1e-5};
    gonio_i_columns columns;
    gonio_interpretation found;
    double *dark = NULL;
    check(gonio_i_columns_create(b->context, b->prior->view, readings, &noise, &columns));
    check(gonio_i_interpret(b->context, b->prior, readings, &noise, &columns, &found, &dark));
    gonio_i_columns_free(&columns);
    free(dark);
    return found;
}

static void report(bench *b, const char *label, int kind, const gonio_interpretation *found)
{
    const mistake *m = &MISTAKES[kind];
    tally *t = &b->tally[kind];
    bool told = false;
    printf("%s,%s,%.3g,%zu,%d,", label, m->name, found->albedo, found->unmeasured,
           found->anisotropic);
    for (size_t k = 0; k < found->alternatives; k++) {
        const gonio_alternative *a = &found->alternative[k];
        told = told || (m->told != NULL && strstr(a->mistake, m->told) != NULL);
        printf("%s%.*s (%.2g)", k > 0 ? " | " : "", (int)strcspn(a->mistake, ";"), a->mistake,
               a->albedo);
    }
    puts(found->alternatives == 0 ? "nothing" : "");
    fflush(stdout);
    t->draws++;
    t->said += found->alternatives > 0;
    t->told += told;
    t->unmeasured += found->unmeasured > 0;
    t->anisotropic += found->anisotropic;
}

static void run_draw(bench *b, const char *label, const gonio_readings *right)
{
    for (int kind = 0; kind < KINDS; kind++) {
        gonio_readings *readings = spoil(b, right, &MISTAKES[kind]);
        if (readings != NULL) {
            const gonio_interpretation found = interpret(b, readings);
            report(b, label, kind, &found);
        }
        gonio_readings_free(&readings);
    }
}

/* ---- files ---- */

static void run_file(bench *b, const char *argument, int draws)
{
    gonio_material *material = NULL;
    gonio_readings *all = NULL;
    gonio_readings_options options = {.size = sizeof options,
                                      .values_needed = true,
                                      .average_repeats = true,
                                      .negative_to_zero = true};
    char *path = strdup(argument);
    char *sample = strchr(path, '#');
    if (sample != NULL) {
        *sample = '\0';
        options.as.sample = atoi(sample + 1);
    }
    if (gonio_material_open(b->context, path, &material) != GONIO_OK) {
        check(gonio_readings_read(b->context, path, &options, &all));
    }
    const char *slash = strrchr(argument, '/');
    for (int d = 0; d < draws; d++) {
        const size_t n = SIZE[(size_t)(draw(b) * SIZES)];
        const bool planned = material != NULL && d % 2 == 1;
        gonio_readings *right =
            material != NULL ? read_material(b, material, n, planned) : choose_readings(b, all, n);
        char label[256];
        snprintf(label, sizeof label, "%s,%d,%zu,%s", slash != NULL ? slash + 1 : argument, d,
                 gonio_readings_describe(right)->count, planned ? "planned" : "random");
        run_draw(b, label, right);
        gonio_readings_free(&right);
    }
    gonio_material_free(&material);
    gonio_readings_free(&all);
    free(path);
}

static void print_tallies(const bench *b)
{
    fprintf(stderr, "%-20s %6s %6s %6s %10s %11s\n", "mistake", "draws", "hints", "right",
            "unmeasured", "anisotropic");
    for (int k = 0; k < KINDS; k++) {
        const tally *t = &b->tally[k];
        fprintf(stderr, "%-20s %6zu %6zu %6zu %10zu %11zu\n", MISTAKES[k].name, t->draws, t->said,
                t->told, t->unmeasured, t->anisotropic);
    }
}

int main(int argc, char **argv)
{
    library_settings_choose(argv, true);
    if (argc < 5) {
        fprintf(stderr, "usage: %s BASIS SEED DRAWS FILE[#SAMPLE] ...\n", argv[0]);
        return 2;
    }
    const gonio_context_options options = {.size = sizeof options, .message = on_message};
    gonio_plan_options wanted;
    gonio_basis *basis = NULL;
    bench b = {.seed = strtoull(argv[2], NULL, 10)};
    gonio_i_random_seed(&b.random, b.seed, 0);
    check(gonio_context_create(&b.context, &options));
    check(gonio_basis_read(b.context, argv[1], &basis));
    check(gonio_i_prior_create(b.context, basis, &b.prior));
    gonio_plan_options_default(&wanted);
    wanted.count = MOST_READINGS;
    check(gonio_plan_create(b.context, basis, &wanted, &b.plan));
    puts("file,draw,n,directions,mistake,albedo,unmeasured,anisotropic,alternatives");
    for (int k = 4; k < argc; k++) {
        run_file(&b, argv[k], atoi(argv[3]));
    }
    print_tallies(&b);
    gonio_plan_free(&b.plan);
    gonio_i_prior_free(&b.prior);
    gonio_basis_free(&basis);
    gonio_context_free(&b.context);
    return 0;
}
