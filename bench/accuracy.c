/* How accurate plans and reconstructions are on materials that were left out: docs/accuracy.md.
 *
 *     gonio-accuracy FOLDER SPLITS.json FIRST LAST N[,N...] [noise|outliers|METHOD ...]
 *
 * For splits FIRST to LAST of a splits file (as `gonio reproduce --splits` takes it) learns a basis
 * of the materials to learn from, plans, reads the test materials at single directions,
 * reconstructs and compares. Prints a line of CSV for each material and number of readings. A split
 * that does not say what to learn from learns from the test materials of all others: classes.json
 * leaves out a class of materials at a time; unlike.json learns from one database and tests on
 * another (atlas:NAME is a built-in material), or learns from few materials. `adaptive` plans the
 * first N only; the directions that follow are those of gonio_plan_next for each material. Other
 * methods are given the basis that they were published with (condition, random: the paper's, 45
 * components; nielsen, frost: the full grid, relative to the median, separate channels), a plan for
 * every N, and no more components than N. */
#include <gonio/gonio.h>

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "library_settings.h"

enum { MOST_SIZES = 32, MOST_MATERIALS = 4096 };

typedef struct setting {
    const char *folder;
    size_t size[MOST_SIZES];
    size_t sizes;
    double noise;    /* relative */
    double floor;    /* 1/sr */
    double outliers; /* share of readings that are wrong */
    const char *method;
    gonio_metric metric;
    bool deviation;
    bool adaptive;
} setting;

static void on_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    (void)level;
    fprintf(stderr, "%s\n", text);
}

static char *path_of(const char *folder, const char *name)
{
    static const char *const endings[] = {".h5", ".binary"};
    char *path = NULL;
    if (strncmp(name, "atlas:", 6) == 0) {
        return strdup(name);
    }
    for (int k = 0; k < 2; k++) {
        if (asprintf(&path, "%s/%s%s", folder, name, endings[k]) > 0 && access(path, R_OK) == 0) {
            return path;
        }
        free(path);
    }
    fprintf(stderr, "%s: no such material in %s\n", name, folder);
    exit(1);
}

static void check(gonio_status status)
{
    if (status != GONIO_OK) {
        exit(1);
    }
}

/* What a split learns from. */
static json_t *names_to_learn(const json_t *splits, size_t number)
{
    const json_t *given = json_object_get(json_array_get(splits, number), "basis");
    json_t *names = given != NULL ? json_copy((json_t *)given) : json_array();
    for (size_t k = 0; k < json_array_size(splits) && given == NULL; k++) {
        if (k != number) {
            json_array_extend(names, json_object_get(json_array_get(splits, k), "test"));
        }
    }
    return names;
}

/* The kind of basis that a method is meant for. */
static gonio_plan_basis basis_of(const setting *s)
{
    const gonio_plan_basis *kind = gonio_plan_method_basis(s->method);
    return kind != NULL ? *kind : (gonio_plan_basis){.representation = GONIO_BIVARIATE};
}

static bool is_posterior(const setting *s)
{
    return basis_of(s).mixtures;
}

/* The recipe for the kind of basis that a method is meant for. */
static gonio_recipe recipe_of(const setting *s)
{
    const gonio_plan_basis kind = basis_of(s);
    gonio_recipe recipe;
    gonio_recipe_for_grid(&recipe, kind.representation);
    recipe.channels = kind.channels;
    recipe.mapping = kind.mapping;
    recipe.without_mean = kind.without_mean;
    if (!kind.mixtures) {
        recipe.mixtures = 0;
        recipe.components = kind.representation == GONIO_FULL ? s->size[s->sizes - 1] : 45;
    }
    return recipe;
}

static gonio_basis *learn(gonio_context *context, const setting *s, const json_t *names)
{
    const gonio_recipe recipe = recipe_of(s);
    gonio_basis *basis = NULL;
    char *path[MOST_MATERIALS];
    const size_t count = json_array_size(names);
    for (size_t k = 0; k < count; k++) {
        path[k] = path_of(s->folder, json_string_value(json_array_get(names, k)));
    }
    check(gonio_learn(context, (const char *const *)path, count, &recipe, &basis));
    for (size_t k = 0; k < count; k++) {
        free(path[k]);
    }
    return basis;
}

/* The first n directions of a plan as readings to be filled in. */
static gonio_readings *first_of(gonio_context *context, const gonio_plan *plan, size_t n)
{
    gonio_readings *readings = NULL;
    gonio_plan part = *plan;
    part.count = n;
    check(gonio_readings_create_from_plan(context, &part, &readings));
    return readings;
}

/* Share of the bins' values that lie within 1.96 deviations. */
static double coverage(gonio_context *context, const gonio_material *original,
                       const gonio_material *made, const gonio_material *deviation)
{
    double *rho = calloc(3 * GONIO_SLAB_VALUES, sizeof *rho);
    size_t inside = 0;
    size_t all = 0;
    for (int slab = 0; slab < GONIO_THETA_H_BINS; slab++) {
        double *other = rho + GONIO_SLAB_VALUES;
        double *sigma = other + GONIO_SLAB_VALUES;
        check(gonio_material_read_slab(context, original, slab, rho));
        check(gonio_material_read_slab(context, made, slab, other));
        check(gonio_material_read_slab(context, deviation, slab, sigma));
        for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
            const int channel = (int)(k / GONIO_SLAB_BINS);
            if (rho[k] >= 0.0 && other[k] >= 0.0) {
                const double off =
                    gonio_log_from_brdf(rho[k], channel) - gonio_log_from_brdf(other[k], channel);
                inside += fabs(off) <= 1.96 * sigma[k] / gonio_log_scale(channel);
                all++;
            }
        }
    }
    free(rho);
    return (double)inside / (double)all;
}

/* A material that is read. */
typedef struct subject {
    const setting *s;
    const gonio_basis *basis;
    const gonio_material *original;
    const gonio_table *table;
    int split;
} subject;

static gonio_reconstruct_options how_to_reconstruct(const setting *s)
{
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    how.deviation = s->deviation;
    how.all_channels = true;
    how.noise = fmax(s->noise, how.noise);
    how.floor = fmax(s->floor, how.floor);
    return how;
}

static gonio_readings *read_first(gonio_context *context, const subject *it, const gonio_plan *plan,
                                  size_t n)
{
    gonio_readings *readings = first_of(context, plan, n);
    const gonio_instrument_options instrument = {.size = sizeof instrument,
                                                 .noise = it->s->noise,
                                                 .floor = it->s->floor,
                                                 .seed = (uint64_t)it->split,
                                                 .outliers = it->s->outliers};
    check(gonio_measure(context, readings, it->table, &instrument));
    return readings;
}

static void run(gonio_context *context, const subject *it, const gonio_plan *plan, size_t n)
{
    const setting *s = it->s;
    gonio_readings *readings = read_first(context, it, plan, n);
    gonio_reconstruction *made = NULL;
    gonio_material *material = NULL;
    gonio_material *deviation = NULL;
    gonio_comparison comparison;
    gonio_reconstruct_options how = how_to_reconstruct(s);
    how.components = is_posterior(s) ? 0 : plan->components;
    check(gonio_reconstruct(context, it->basis, readings, &how, &made));
    check(gonio_reconstruction_material(context, it->basis, made, "r", &material));
    check(gonio_compare(context, it->original, material, &comparison));
    double inside = NAN;
    if (made->deviation != NULL) {
        check(gonio_reconstruction_deviation_material(context, it->basis, made, &deviation));
        inside = coverage(context, it->original, material, deviation);
    }
    printf("%s%s,%d,%s,%zu,%g,%g,%g,%.4f,%.4f,%.5f,%.4f,%.4f,%g,%zu,%.3f,%.3f\n", s->method,
           s->adaptive ? " adaptive" : "", it->split, gonio_material_name(it->original), n,
           s->noise, s->floor, s->outliers, comparison.all.value[GONIO_E6],
           comparison.all.value[GONIO_CUBE_ROOT], comparison.all.value[GONIO_LOG_RELATIVE_ERROR],
           made->predicted_e6, inside, made->smoothness, made->outlying,
           plan->expected != NULL ? plan->expected[n - 1] : NAN, made->surprise);
    fflush(stdout);
    gonio_material_free(&deviation);
    gonio_material_free(&material);
    gonio_reconstruction_free(&made);
    gonio_readings_free(&readings);
}

/* Entries from `done` to n of a plan become those that are proposed after the first `done` are
 * read. */
static void go_on(gonio_context *context, const subject *it, gonio_plan *plan, size_t done,
                  size_t n)
{
    gonio_readings *readings = read_first(context, it, plan, done);
    const gonio_reconstruct_options how = how_to_reconstruct(it->s);
    gonio_plan_options options;
    gonio_plan *more = NULL;
    double now = 0.0;
    gonio_plan_options_default(&options);
    options.metric = it->s->metric;
    options.count = n - done;
    check(gonio_plan_next(context, it->basis, readings, &how, &options, &now, NULL, &more));
    memcpy(plan->entries + done, more->entries, (n - done) * sizeof *plan->entries);
    gonio_plan_free(&more);
    gonio_readings_free(&readings);
}

/* plan[i]: that of the i-th size; one for all of a method whose plans are nested. */
static void run_material(gonio_context *context, const subject *it, gonio_plan **plan)
{
    const setting *s = it->s;
    for (size_t i = 0; i < s->sizes; i++) {
        if (s->adaptive && i > 0) {
            go_on(context, it, plan[i], s->size[i - 1], s->size[i]);
        }
        run(context, it, plan[i], s->size[i]);
    }
}

static gonio_plan *make_plan(gonio_context *context, const setting *s, const gonio_basis *basis,
                             size_t n, int split)
{
    const size_t components = gonio_basis_describe(basis)->components;
    gonio_plan_options options;
    gonio_plan *plan = NULL;
    gonio_plan_options_default(&options);
    options.method = s->method;
    options.metric = s->metric;
    options.count = n;
    options.seed = (uint64_t)split;
    options.components = is_posterior(s) ? 0 : components < n ? components : n;
    check(gonio_plan_create(context, basis, &options, &plan));
    return plan;
}

static void run_split(gonio_context *context, const setting *s, const json_t *splits, int number)
{
    const json_t *test = json_object_get(json_array_get(splits, (size_t)number), "test");
    json_t *names = names_to_learn(splits, (size_t)number);
    gonio_basis *basis = learn(context, s, names);
    gonio_plan *plan[MOST_SIZES];
    for (size_t i = s->sizes; i-- > 0;) {
        const bool nested = is_posterior(s) && i + 1 < s->sizes;
        plan[i] = nested ? plan[i + 1] : make_plan(context, s, basis, s->size[i], number);
    }
    for (size_t k = 0; k < json_array_size(test); k++) {
        char *path = path_of(s->folder, json_string_value(json_array_get(test, k)));
        gonio_material *original = NULL;
        gonio_table *table = NULL;
        check(gonio_material_open(context, path, &original));
        check(gonio_table_load(context, original, &table));
        run_material(context, &(subject){s, basis, original, table, number}, plan);
        gonio_table_free(&table);
        gonio_material_free(&original);
        free(path);
    }
    for (size_t i = s->sizes; i-- > 0;) {
        if (i == 0 || plan[i] != plan[i - 1]) {
            gonio_plan_free(&plan[i]);
        }
    }
    gonio_basis_free(&basis);
    json_decref(names);
}

static void read_sizes(char *list, setting *s)
{
    for (char *word = strtok(list, ","); word != NULL && s->sizes < MOST_SIZES;
         word = strtok(NULL, ",")) {
        s->size[s->sizes++] = strtoul(word, NULL, 10);
    }
}

static void read_words(int count, char **words, setting *s)
{
    for (int k = 0; k < count; k++) {
        if (strcmp(words[k], "noise") == 0) {
            s->noise = 0.02;
            s->floor = 1e-4;
        } else if (strcmp(words[k], "outliers") == 0) {
            s->outliers = 0.05;
        } else if (strcmp(words[k], "deviation") == 0) {
            s->deviation = true;
        } else if (strcmp(words[k], "adaptive") == 0) {
            s->adaptive = true;
        } else if (strcmp(words[k], "cube-root") == 0) {
            s->metric = GONIO_CUBE_ROOT;
        } else if (strcmp(words[k], "log-relative") == 0) {
            s->metric = GONIO_LOG_RELATIVE_ERROR;
        } else {
            s->method = words[k];
        }
    }
}

int main(int argc, char **argv)
{
    library_settings_choose(argv, true);
    if (argc < 6) {
        fprintf(stderr, "usage: %s FOLDER SPLITS.json FIRST LAST N[,N...] [WORD...]\n", argv[0]);
        return 2;
    }
    gonio_context *context = NULL;
    const gonio_context_options options = {.size = sizeof options, .message = on_message};
    setting s = {.folder = argv[1], .method = "expected-error"};
    json_t *file = json_load_file(argv[2], 0, NULL);
    const json_t *splits = json_is_array(file) ? file : json_object_get(file, "splits");
    read_sizes(argv[5], &s);
    read_words(argc - 6, argv + 6, &s);
    check(gonio_context_create(&context, &options));
    puts("method,split,material,n,noise,floor,outliers,e6,cube_root,log_relative,predicted,inside,"
         "smoothness,outlying,expected,surprise");
    for (int k = atoi(argv[3]); k <= atoi(argv[4]); k++) {
        run_split(context, &s, splits, k);
    }
    gonio_context_free(&context);
    json_decref(file);
    return 0;
}
