/* Figures: data and scripts that are complete, safe against hostile names, the same every time, and
 * drawn where there is gnuplot. KEPT=FOLDER leaves the samples there for people to judge. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/core.h"
#include "core/random.h"
#include "figures/figure.h"
#include "run/run_folder.h"

static const char *kept_folder = NULL; /* for the samples */

/* ---- a context that listens ---- */

typedef struct fixture {
    char *folder;
    char figures_path[256];
    gonio_i_figures figures;
    gonio_context *context;
    int warnings, notes;
    char note[1024], error[4096];
} fixture;

static void on_message(void *user, gonio_message_level level, const char *text)
{
    fixture *f = user;
    print_message("%s\n", text);
    if (level == GONIO_MESSAGE_ERROR) {
        snprintf(f->error, sizeof f->error, "%s", text);
        return;
    }
    f->warnings += level == GONIO_MESSAGE_WARNING;
    f->notes += level == GONIO_MESSAGE_NOTE;
    snprintf(f->note, sizeof f->note, "%s", text);
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->folder = support_folder();
    snprintf(f->figures_path, sizeof f->figures_path, "%s/figures", f->folder);
    f->figures.folder = f->figures_path;
    const gonio_context_options options = {
        .size = sizeof options, .message = on_message, .user = f};
    assert_int_equal(gonio_context_create(&f->context, &options), GONIO_OK);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_context_free(&f->context);
    support_remove(f->folder);
    free(f);
    return 0;
}

static bool has_gnuplot(void)
{
    return access("/usr/bin/gnuplot", X_OK) == 0 || access("/usr/local/bin/gnuplot", X_OK) == 0;
}

static void need_gnuplot(void)
{
    if (!has_gnuplot()) {
        print_message("skipped: there is no gnuplot\n");
        skip();
    }
}

static char *read_file(const char *folder, const char *name, const char *ending, size_t *size)
{
    char path[512];
    struct stat status;
    snprintf(path, sizeof path, "%s/%s.%s", folder, name, ending);
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return NULL;
    }
    assert_int_equal(fstat(fileno(file), &status), 0);
    char *text = calloc((size_t)status.st_size + 1, 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)status.st_size, file), status.st_size);
    fclose(file);
    if (size != NULL) {
        *size = (size_t)status.st_size;
    }
    return text;
}

/* ---- samples: what the paper's figures are like, with made-up numbers ---- */

enum { SPECTRUM = 99, SWAPS = 150, RESTARTS = 8, COUNTS = 20, COLUMNS = 13 };

static double error_at(double k, double l)
{
    return l < k ? NAN : 2.4 + 12.0 * exp(-k / 9.0) + 0.02 * k / pow((l - k) / k + 0.12, 0.8);
}

static gonio_status sample_spectrum(fixture *f, gonio_i_figures *figures)
{
    double x[SPECTRUM], y[SPECTRUM], low[SPECTRUM], high[SPECTRUM];
    for (int k = 0; k < SPECTRUM; k++) {
        x[k] = k + 1;
        y[k] = 100.0 * (1.0 - 0.42 * exp(-k / 1.7) * 0.6 - 0.1 * exp(-k / 14.0));
        low[k] = y[k] - 2.0 * exp(-k / 10.0);
        high[k] = y[k] + 2.0 * exp(-k / 10.0);
    }
    const gonio_i_curve curve = {"mean of 10 splits and their range", SPECTRUM, x, y, low, high, 0};
    const gonio_i_curves figure = {.name = "fig-2a",
                                   .x = {"components K", NULL, false, 0, 100},
                                   .y = {"cumulative variance", "%", false, 0, 0},
                                   .intervals = GONIO_I_BAND,
                                   .count = 1,
                                   .curves = &curve};
    return gonio_i_figure_curves(f->context, figures, &figure);
}

static gonio_status sample_convergence(fixture *f, gonio_i_figures *figures)
{
    static double x[SWAPS], y[RESTARTS][SWAPS];
    gonio_i_curve curves[RESTARTS];
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 0);
    for (int r = 0; r < RESTARTS; r++) {
        const double end = 4.2 + 0.8 * gonio_i_random_uniform(&random);
        const double start = 200.0 * gonio_i_random_uniform(&random);
        for (int k = 0; k < SWAPS; k++) {
            x[k] = k;
            y[r][k] = end + start * exp(-k / 8.0) + 9.0 * exp(-k / 40.0);
        }
        curves[r] = (gonio_i_curve){r == 0 ? "best of 8 starts" : r == 1 ? "the others" : NULL,
                                    SWAPS,
                                    x,
                                    y[r],
                                    NULL,
                                    NULL,
                                    r > 0};
    }
    const gonio_i_curves figure = {.name = "fig-2b",
                                   .title = "K = 35, L = 80",
                                   .x = {"swaps", NULL, false, 0, 0},
                                   .y = {"condition number κ", NULL, true, 0, 0},
                                   .count = RESTARTS,
                                   .curves = curves};
    return gonio_i_figure_curves(f->context, figures, &figure);
}

static gonio_status sample_counts(fixture *f, gonio_i_figures *figures)
{
    static const int k_of[] = {10, 20, 30, 35, 40, 45, 60};
    enum { CURVES = sizeof k_of / sizeof *k_of };
    double x[COUNTS], y[CURVES][COUNTS];
    char names[CURVES][16];
    gonio_i_curve curves[CURVES];
    for (int c = 0; c < CURVES; c++) {
        snprintf(names[c], sizeof names[c], "K = %d", k_of[c]);
        for (int l = 0; l < COUNTS; l++) {
            x[l] = 10 * (l + 1);
            y[c][l] = error_at(k_of[c], x[l]);
        }
        curves[c] = (gonio_i_curve){names[c], COUNTS, x, y[c], NULL, NULL, false};
    }
    const gonio_i_curves figure = {.name = "fig-3a-curves",
                                   .x = {"readings L", NULL, false, 0, 210},
                                   .y = {"error E6", "%", true, 2.5, 10},
                                   .count = CURVES,
                                   .curves = curves};
    return gonio_i_figure_curves(f->context, figures, &figure);
}

static gonio_status sample_methods(fixture *f, gonio_i_figures *figures)
{
    static const char *const names[] = {"condition number", "random rows", "Matusik et al. 2003",
                                        "Nielsen et al. 2015"};
    enum { CURVES = 4, POINTS = 7 };
    static const double x[POINTS] = {10, 20, 40, 80, 170, 400, 800};
    double y[CURVES][POINTS], low[CURVES][POINTS], high[CURVES][POINTS];
    gonio_i_curve curves[CURVES];
    for (int c = 0; c < CURVES; c++) {
        for (int l = 0; l < POINTS; l++) {
            y[c][l] = 2.8 + 0.2 * c + (9.0 + 8.0 * c) * pow(x[l], -0.75);
            low[c][l] = y[c][l] * 0.93;
            high[c][l] = y[c][l] * 1.07;
        }
        curves[c] = (gonio_i_curve){names[c], POINTS, x, y[c], low[c], high[c], false};
    }
    gonio_i_curves figure = {.name = "fig-3b",
                             .title = "Mean error of the 20 test materials, 10 splits, ± 1 s.d.",
                             .x = {"readings L", NULL, true, 9, 900},
                             .y = {"error E6", "%", false, 0, 0},
                             .intervals = GONIO_I_ERROR_BARS,
                             .count = CURVES,
                             .curves = curves};
    const gonio_status status = gonio_i_figure_curves(f->context, figures, &figure);
    figure.name = "fig-3b-bands";
    figure.intervals = GONIO_I_BAND;
    return status == GONIO_OK ? gonio_i_figure_curves(f->context, figures, &figure) : status;
}

static gonio_status sample_map(fixture *f, gonio_i_figures *figures)
{
    double k[COLUMNS], l[COUNTS], values[COLUMNS * COUNTS];
    static const double levels[] = {2.8, 3.0, 3.2, 3.5, 4.0, 5.0, 6.0, 8.0};
    static const gonio_i_mark marks[] = {
        {35, 80, "35, 80"}, {40, 120, "40, 120"}, {45, 170, "45, 170"}};
    for (int c = 0; c < COLUMNS; c++) {
        for (int r = 0; r < COUNTS; r++) {
            k[c] = 5 * (c + 1);
            l[r] = 10 * (r + 1);
            values[c * COUNTS + r] = error_at(k[c], l[r]);
        }
    }
    const gonio_i_map figure = {.name = "fig-3a",
                                .title = "Mean error of the 20 test materials, 10 splits",
                                .x = {"components K", NULL, false, 0, 0},
                                .y = {"readings L", NULL, false, 0, 0},
                                .value = {"error E6", "%", true, 2.5, 10},
                                .columns = COLUMNS,
                                .rows = COUNTS,
                                .at_x = k,
                                .at_y = l,
                                .values = values,
                                .levels = sizeof levels / sizeof *levels,
                                .level = levels,
                                .marks = 3,
                                .mark = marks};
    return gonio_i_figure_map(f->context, figures, &figure);
}

static gonio_status sample_directions(fixture *f, gonio_i_figures *figures)
{
    static const size_t counts[] = {80, 120, 170};
    static const char *const names[] = {"K = 35, L = 80", "K = 40, L = 120", "K = 45, L = 170"};
    static gonio_pair pairs[3][170];
    gonio_i_panel panels[3];
    gonio_i_random random;
    gonio_i_random_seed(&random, 2, 0);
    for (int p = 0; p < 3; p++) {
        for (size_t k = 0; k < counts[p];) {
            const double u = gonio_i_random_uniform(&random);
            const gonio_half_difference h = {
                u * u * M_PI / 2.0, gonio_i_random_uniform(&random) * M_PI / 2.0, M_PI / 2.0};
            const gonio_pair pair = gonio_pair_from_half_difference(h);
            if (pair.incident.theta < M_PI / 2.0 && pair.outgoing.theta < M_PI / 2.0) {
                pairs[p][k++] = pair;
            }
        }
        panels[p] = (gonio_i_panel){names[p], counts[p], pairs[p]};
    }
    gonio_i_directions figure = {"fig-4", "Chosen directions", GONIO_I_EQUAL_ANGLE, 3, panels};
    gonio_status status = gonio_i_figure_directions(f->context, figures, &figure);
    figure = (gonio_i_directions){"fig-4-one", NULL, GONIO_I_ORTHOGRAPHIC, 1, panels};
    return status == GONIO_OK ? gonio_i_figure_directions(f->context, figures, &figure) : status;
}

/* Half of the hemisphere is one region, a spot another; the third is nowhere. */
static gonio_status sample_regions(fixture *f, gonio_i_figures *figures)
{
    enum { RINGS = 9, SPOKES = 24 };
    static const char *const names[] = {"can be read", "the detector's arm", "nowhere"};
    static int region[RINGS][SPOKES];
    static const gonio_angles point[] = {{0.3, 3.0}, {1.0, 2.0}};
    for (int ring = 0; ring < RINGS; ring++) {
        for (int spoke = 0; spoke < SPOKES; spoke++) {
            region[ring][spoke] = ring > 6 || (ring == 3 && (spoke < 2 || spoke == SPOKES - 1));
        }
    }
    const gonio_i_region_panel panels[] = {
        {"theta_i = 35 degrees", {0.61, 0.0}, region[0], 2, point},
        {"theta_i = 40 degrees", {0.70, 0.0}, region[0], 0, NULL}};
    const gonio_i_regions figure = {"regions", "An instrument", RINGS, SPOKES, 3,
                                    names,     "a reading",     2,     panels};
    return gonio_i_figure_regions(f->context, figures, &figure);
}

static gonio_status sample_categories(fixture *f, gonio_i_figures *figures)
{
    static double values[5][SUPPORT_MERL];
    static const double factor[] = {1.25, 1.15, 1.1, 1.0, 0.5};
    static const char *const names[] = {"80 samples (K = 35)", "120 samples (K = 40)",
                                        "170 samples (K = 45)", "all samples (K = 45)",
                                        "bivariate"};
    gonio_i_series series[5];
    gonio_i_random random;
    gonio_i_random_seed(&random, 3, 0);
    for (int k = 0; k < SUPPORT_MERL; k++) {
        const double hard = 1.5 + 1.2 * exp(0.9 * gonio_i_random_normal(&random));
        for (int s = 0; s < 5; s++) {
            values[s][k] = hard * factor[s] * (1.0 + 0.08 * gonio_i_random_normal(&random));
        }
    }
    for (int s = 0; s < 5; s++) {
        series[s] = (gonio_i_series){names[s], values[s]};
    }
    const gonio_i_categories figure = {
        "fig-5", NULL,   "material", {"error E6", "%", false, 0, 0}, SUPPORT_MERL, support_merl,
        5,       series, 3};
    return gonio_i_figure_categories(f->context, figures, &figure);
}

typedef gonio_status (*sample)(fixture *f, gonio_i_figures *figures);

static const sample samples[] = {sample_spectrum,   sample_convergence, sample_counts,
                                 sample_methods,    sample_map,         sample_directions,
                                 sample_categories, sample_regions};

static const char *const sample_names[] = {"fig-2a",       "fig-2b", "fig-3a-curves", "fig-3b",
                                           "fig-3b-bands", "fig-3a", "fig-4",         "fig-4-one",
                                           "fig-5",        "regions"};

enum {
    SAMPLES = sizeof samples / sizeof *samples,
    NAMES = sizeof sample_names / sizeof *sample_names
};

static void make_samples(fixture *f, const char *folder)
{
    gonio_i_figures figures = {.folder = folder};
    for (int k = 0; k < SAMPLES; k++) {
        assert_int_equal(samples[k](f, &figures), GONIO_OK);
    }
}

/* ---- tests ---- */

static void test_samples(void **state)
{
    fixture *f = *state;
    static const char *const endings[] = {"csv", "gp", "svg", "pdf", "png"};
    static const char *const begins[] = {"\"", "# Run 'gnuplot", "<?xml", "%PDF", "\x89PNG"};
    char again[300];
    need_gnuplot();
    snprintf(again, sizeof again, "%s/again", f->folder);
    make_samples(f, kept_folder != NULL ? kept_folder : f->figures_path);
    make_samples(f, again);
    assert_int_equal(f->warnings + f->notes, 0);
    for (int k = 0; k < NAMES; k++) {
        for (int e = 0; e < 5; e++) {
            size_t size = 0, other = 0;
            char *one = read_file(kept_folder != NULL ? kept_folder : f->figures_path,
                                  sample_names[k], endings[e], &size);
            char *two = read_file(again, sample_names[k], endings[e], &other);
            assert_non_null(one);
            assert_non_null(two);
            assert_int_equal(size, other);
            assert_memory_equal(one, two, size);
            assert_memory_equal(one, begins[e], strlen(begins[e]));
            free(one);
            free(two);
        }
    }
}

/* As a person would: plain gnuplot in that folder. */
static void test_a_script_draws_again_by_hand(void **state)
{
    fixture *f = *state;
    char command[700];
    need_gnuplot();
    assert_int_equal(sample_map(f, &f->figures), GONIO_OK);
    char *before = read_file(f->figures_path, "fig-3a", "svg", NULL);
    snprintf(command, sizeof command, "cd '%s' && rm fig-3a.svg fig-3a.p* && gnuplot fig-3a.gp",
             f->figures_path);
    assert_int_equal(system(command), 0); /* NOLINT: a person's shell */
    char *after = read_file(f->figures_path, "fig-3a", "svg", NULL);
    assert_string_equal(before, after);
    free(before);
    free(after);
}

static const char *const hostile[] = {
    "`touch pwned`",
    "$(touch pwned)",
    "it's",
    "' . system('touch pwned') . '",
    "\"q\" \\\"",
    "new\nline\nsystem 'touch pwned'",
    "100%s %d %n %",
    "a_b^c{d}@e&f~g",
    "{",
    "}}",
    "# no comment",
    "back\\",
    "@macro",
    "\xff\xfe not UTF-8",
    "=1+1",
    "gr\xc3\xbcn, \xe6\x98\x8e",
    "a name that is much longer than what fits below an axis, and than gnuplot takes for a tic",
    "",
    "<b>&amp;</b>",
    "\x1b[31m"};

enum { HOSTILE = sizeof hostile / sizeof *hostile };

static gonio_status draw_hostile(fixture *f, const char *text)
{
    const double x[] = {1.0, 2.0, 3.0};
    const double grid[] = {1.0, 2.0, 3.0, 4.0, 5.0, NAN, 7.0, 8.0, 9.0};
    const gonio_i_axis axis = {text, text, false, 0, 0};
    const gonio_i_curve curve = {text, 3, x, x, x, x, false};
    const gonio_i_mark mark = {2.0, 2.0, text};
    const gonio_pair pair = {{0.1, 0.2}, {0.3, 0.4}};
    const gonio_i_panel panel = {text, 1, &pair};
    const gonio_i_series series = {text, x};
    const char *const categories[] = {text, "plain", text};
    const gonio_i_curves curves = {"a", text, axis, axis, GONIO_I_BAND, 1, &curve, 0.0, false};
    const gonio_i_map map = {"b", text, axis, axis, axis, 3, 3, x, x, grid, 0, NULL, 1, &mark};
    const gonio_i_directions directions = {"c", text, GONIO_I_EQUAL_ANGLE, 1, &panel};
    const gonio_i_categories many = {"d", text, text, axis, 3, categories, 1, &series, 0};
    gonio_status status = gonio_i_figure_curves(f->context, &f->figures, &curves);
    status = status != GONIO_OK ? status : gonio_i_figure_map(f->context, &f->figures, &map);
    status = status != GONIO_OK ? status
                                : gonio_i_figure_directions(f->context, &f->figures, &directions);
    status =
        status != GONIO_OK ? status : gonio_i_figure_categories(f->context, &f->figures, &many);
    const int region = 0;
    const gonio_i_region_panel part = {text, {0.1, 0.2}, &region, 1, &pair.outgoing};
    const gonio_i_regions regions = {"e", text, 1, 1, 1, &text, text, 1, &part};
    return status != GONIO_OK ? status : gonio_i_figure_regions(f->context, &f->figures, &regions);
}

static void test_hostile_text_is_only_shown(void **state)
{
    fixture *f = *state;
    char path[512];
    need_gnuplot();
    for (int k = 0; k < HOSTILE; k++) {
        f->warnings = 0;
        assert_int_equal(draw_hostile(f, hostile[k]), GONIO_OK);
        assert_true(f->warnings == 0 || strlen(hostile[k]) > 60); /* too long for the key */
        snprintf(path, sizeof path, "%s/pwned", f->figures_path);
        assert_int_equal(access(path, F_OK), -1);
        assert_int_equal(access("pwned", F_OK), -1);
        snprintf(path, sizeof path, "%s/a.part", f->figures_path);
        assert_int_equal(access(path, F_OK), -1); /* nor anything left */
    }
    assert_int_equal(draw_hostile(f, "`id` 'x' 5% _a"), GONIO_OK);
    static const char *const names[] = {"a", "b", "c", "d", "e"};
    for (int k = 0; k < 5; k++) { /* as it is */
        char *svg = read_file(f->figures_path, names[k], "svg", NULL);
        assert_non_null(strstr(svg, "`id` \xe2\x80\x99x\xe2\x80\x99 5% _a"));
        free(svg);
    }
}

static void test_the_data(void **state)
{
    fixture *f = *state;
    const double x[] = {1.0, 0.1, 1e-300}, y[] = {1.0 / 3.0, NAN, INFINITY};
    const gonio_i_curve curve = {"a \"b\", c", 3, x, y, NULL, NULL, false};
    const gonio_i_curves figure = {
        "data", NULL, {"x", "cm", false, 0, 0}, {"y", NULL, false, 0, 0}, GONIO_I_BAND, 1, &curve,
        0.0,    true};
    const gonio_i_axis axis = {"E6", "%", false, 0, 0};
    const double a[] = {3.0, NAN, 1.0, 2.0}, b[] = {30.0, 40.0, 10.0, 20.0};
    const gonio_i_series series[] = {{"a", a}, {"b", b}};
    const char *const names[] = {"three", "none", "one", "two"};
    const gonio_i_categories many = {"sorted", NULL, "material", axis, 4, names, 2, series, 0};
    assert_int_equal(gonio_i_figure_curves(f->context, &f->figures, &figure), GONIO_OK);
    char *text = read_file(f->figures_path, "data", "csv", NULL);
    assert_string_equal(text, "\"x (cm)\",\"y\",\"low\",\"high\",\"curve\",\"name\"\n"
                              "1,0.3333333333333333,NaN,NaN,1,\"a \"\"b\"\", c\"\n"
                              "0.1,NaN,NaN,NaN,1,\"a \"\"b\"\", c\"\n"
                              "1e-300,NaN,NaN,NaN,1,\"a \"\"b\"\", c\"\n");
    free(text);
    assert_int_equal(gonio_i_figure_categories(f->context, &f->figures, &many), GONIO_OK);
    text = read_file(f->figures_path, "sorted", "csv", NULL);
    assert_string_equal(text, "\"a: E6 (%)\",\"b: E6 (%)\",\"material\"\n"
                              "1,10,\"one\"\n2,20,\"two\"\n3,30,\"three\"\nNaN,40,\"none\"\n");
    free(text);
}

static void test_without_gnuplot(void **state)
{
    fixture *f = *state;
    char *path = strdup(getenv("PATH"));
    assert_int_equal(setenv("PATH", f->folder, 1), 0);
    make_samples(f, f->figures_path);
    assert_int_equal(sample_map(f, &f->figures), GONIO_OK);
    assert_int_equal(sample_map(f, &f->figures), GONIO_OK);
    assert_int_equal(setenv("PATH", path, 1), 0);
    free(path);
    assert_true(f->figures.undrawn);
    assert_int_equal(f->notes, 2); /* one for each set of figures */
    assert_non_null(strstr(f->note, "install it"));
    assert_non_null(strstr(f->note, f->figures_path));
    char *data = read_file(f->figures_path, "fig-3a", "csv", NULL);
    char *script = read_file(f->figures_path, "fig-3a", "gp", NULL);
    assert_non_null(data);
    assert_non_null(script);
    assert_null(read_file(f->figures_path, "fig-3a", "png", NULL));
    free(data);
    free(script);
}

/* A gnuplot that says something and fails. */
static void test_a_failing_gnuplot(void **state)
{
    fixture *f = *state;
    char gnuplot[300], old_path[4096], path[4500];
    snprintf(gnuplot, sizeof gnuplot, "%s/gnuplot", f->folder);
    snprintf(old_path, sizeof old_path, "%s", getenv("PATH"));
    snprintf(path, sizeof path, "%s:%s", f->folder, old_path);
    assert_int_equal(gonio_i_write_text(NULL, gnuplot,
                                        "#!/bin/sh\necho half >fig-3a.svg\n"
                                        "echo 'no such terminal' >&2\nexit 3\n"),
                     GONIO_OK);
    assert_int_equal(chmod(gnuplot, 0755), 0);
    assert_int_equal(setenv("PATH", path, 1), 0);
    const gonio_status status = sample_map(f, &f->figures);
    assert_int_equal(setenv("PATH", old_path, 1), 0);
    assert_int_equal(status, GONIO_ERROR_IO);
    assert_non_null(strstr(f->error, "gnuplot failed: no such terminal"));
    assert_null(read_file(f->figures_path, "fig-3a", "svg", NULL));
    char *script = read_file(f->figures_path, "fig-3a", "gp", NULL);
    assert_non_null(script); /* to see why */
    free(script);
}

static void test_what_cannot_be_shown(void **state)
{
    fixture *f = *state;
    const double x[] = {1.0, 0.0}, values[] = {1.0, 2.0, 3.0, 4.0};
    const gonio_i_axis plain = {"x", NULL, false, 0, 0}, logarithmic = {"y", NULL, true, 0, 0};
    const gonio_i_curve curve = {"c", 2, x, x, NULL, NULL, false};
    gonio_i_curves curves = {"c", NULL,   plain, logarithmic, GONIO_I_NO_INTERVALS,
                             1,   &curve, 0.0,   false};
    const gonio_i_map map = {"m", NULL, plain, plain, plain, 2, 2, x, x, values, 0, NULL, 0, NULL};
    const gonio_i_directions directions = {"d", NULL, GONIO_I_EQUAL_ANGLE, 0, NULL};
    const gonio_i_categories none = {.name = "n", .y = plain};
    assert_int_equal(gonio_i_figure_curves(f->context, &f->figures, &curves), GONIO_ERROR_DATA);
    assert_non_null(strstr(f->error, "figure c: y is 0"));
    curves.name = "../up";
    curves.y = plain;
    assert_int_equal(gonio_i_figure_curves(f->context, &f->figures, &curves), GONIO_ERROR_ARGUMENT);
    curves.name = "c";
    curves.count = 0;
    assert_int_equal(gonio_i_figure_curves(f->context, &f->figures, &curves), GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_i_figure_map(f->context, &f->figures, &map), GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_i_figure_directions(f->context, &f->figures, &directions),
                     GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_i_figure_categories(f->context, &f->figures, &none),
                     GONIO_ERROR_ARGUMENT);
    const gonio_i_regions regions = {.name = "r"};
    assert_int_equal(gonio_i_figure_regions(f->context, &f->figures, &regions),
                     GONIO_ERROR_ARGUMENT);
    assert_int_equal(access(f->figures_path, F_OK), -1);
    f->figures.folder = "/nowhere/at/all";
    assert_int_equal(sample_map(f, &f->figures), GONIO_ERROR_IO);
    assert_non_null(strstr(f->error, "/nowhere/at/all"));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    kept_folder = getenv("KEPT");
    const struct CMUnitTest tests[] = {
        TEST(test_samples),
        TEST(test_a_script_draws_again_by_hand),
        TEST(test_hostile_text_is_only_shown),
        TEST(test_the_data),
        TEST(test_without_gnuplot),
        TEST(test_a_failing_gnuplot),
        TEST(test_what_cannot_be_shown),
    };
    return cmocka_run_group_tests_name("figure", tests, NULL, NULL);
}
