/* Reconstruction: a material inside the span of the basis is given back. */
#include "../support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/random.h"
#include "made_material.h"
#include "made_readings.h"

enum { MATERIALS = 6, K = 5, READINGS = 14 };

typedef struct fixture {
    char *folder;
    gonio_context *context;
    gonio_basis *basis;
    const gonio_basis_view *view;
} fixture;

static gonio_basis *learn(gonio_representation representation, gonio_channel_model channels)
{
    static const char *const paths[MATERIALS] = {
        "atlas:gold-polished", "atlas:red-glossy-plastic", "atlas:burgundy-velvet",
        "atlas:oak-sawn",      "atlas:plaster-cast",       "atlas:steel-brushed"};
    const gonio_database_options how = {
        .size = sizeof how, .representation = representation, .channels = channels};
    const gonio_basis_options options = {.size = sizeof options, .components = K};
    gonio_database *database = NULL;
    gonio_basis *basis = NULL;
    assert_int_equal(gonio_database_create(NULL, paths, MATERIALS, &how, &database), GONIO_OK);
    assert_int_equal(gonio_basis_learn(NULL, database, &options, &basis), GONIO_OK);
    gonio_database_free(&database);
    return basis;
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->folder = support_folder();
    f->context = support_context();
    f->basis = learn(GONIO_BIVARIATE, GONIO_JOINT);
    f->view = gonio_basis_describe(f->basis);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_basis_free(&f->basis);
    gonio_context_free(&f->context);
    support_remove(f->folder);
    free(f);
    return 0;
}

/* The coefficients of a material near the mean, so that no value is clamped at 0. */
static const double truth[GONIO_CHANNELS * K] = {3.0, -2.0, 1.5, -1.0, 0.5, 2.0,  1.0, -0.5,
                                                 1.0, 0.25, -3., 2.0,  0.5, -1.5, 1.0};

static gonio_material *make_truth(const gonio_basis *basis)
{
    const bool joint = gonio_basis_describe(basis)->channels == GONIO_JOINT;
    double coefficients[GONIO_CHANNELS * K];
    memcpy(coefficients, truth, sizeof coefficients);
    const gonio_reconstruction known = {
        .components = K, .columns = joint ? 1 : 3, .coefficients = coefficients};
    gonio_material *material = NULL;
    assert_int_equal(gonio_reconstruction_material(NULL, basis, &known, "truth", &material),
                     GONIO_OK);
    return material;
}

static void assert_coefficients(const gonio_reconstruction *r, double tolerance)
{
    for (size_t k = 0; k < r->columns * r->components; k++) {
        if (!(fabs(r->coefficients[k] - truth[k]) <= tolerance)) {
            fail_msg("coefficient %zu is %.12g, not %.12g", k, r->coefficients[k], truth[k]);
        }
    }
}

/* E6 of a reconstruction as a material. */
static double error_of(const gonio_basis *basis, const gonio_reconstruction *r)
{
    gonio_material *expected = make_truth(basis);
    gonio_material *found = NULL;
    gonio_comparison comparison;
    assert_int_equal(gonio_reconstruction_material(NULL, basis, r, "found", &found), GONIO_OK);
    assert_int_equal(gonio_compare(NULL, expected, found, &comparison), GONIO_OK);
    assert_int_equal(comparison.bins, 1096216);
    gonio_material_free(&expected);
    gonio_material_free(&found);
    return comparison.all.value[GONIO_E6];
}

/* ---- from rows ---- */

static void test_rows_give_a_known_material_back(void **state)
{
    const fixture *f = *state;
    size_t rows[READINGS];
    double b[READINGS];
    gonio_reconstruction *r = NULL;
    for (size_t j = 0; j < READINGS; j++) {
        rows[j] = (j * 7919 + 31) % f->view->rows;
        b[j] = f->view->mean[rows[j]];
        double v[K];
        assert_int_equal(gonio_basis_rows(f->context, f->basis, rows[j], 1, K, v), GONIO_OK);
        for (size_t k = 0; k < K; k++) {
            b[j] += v[k] * truth[k];
        }
    }
    assert_int_equal(gonio_reconstruct_rows(f->context, f->basis, K, rows, READINGS, b, &r),
                     GONIO_OK);
    assert_int_equal(r->readings, READINGS);
    assert_int_equal(r->columns, 1);
    assert_coefficients(r, 1e-8);
    assert_true(r->residual < 1e-12);
    assert_true(error_of(f->basis, r) < 1e-8);
    gonio_reconstruction_free(&r);
    assert_null(r);

    assert_int_equal(gonio_reconstruct_rows(f->context, f->basis, K, rows, K - 1, b, &r),
                     GONIO_ERROR_UNDETERMINED);
    assert_non_null(strstr(support_message(), "4 readings of which 4 are independent"));
    for (size_t j = 0; j < READINGS; j++) {
        rows[j] = rows[j % 3];
    }
    assert_int_equal(gonio_reconstruct_rows(f->context, f->basis, K, rows, READINGS, b, &r),
                     GONIO_ERROR_UNDETERMINED);
    assert_non_null(strstr(support_message(), "14 readings of which 3 are independent"));
    assert_int_equal(gonio_reconstruct_rows(f->context, f->basis, K + 1, rows, READINGS, b, &r),
                     GONIO_ERROR_ARGUMENT);
    assert_null(r);
}

/* ---- from readings ---- */

/* Measures the known material at the directions of readings. */
static void measure(const fixture *f, const gonio_basis *basis, gonio_readings *readings)
{
    gonio_material *material = make_truth(basis);
    gonio_table *table = made_table(material);
    assert_int_equal(gonio_measure(f->context, readings, table, NULL), GONIO_OK);
    gonio_table_free(&table);
    gonio_material_free(&material);
}

static gonio_readings *make_plan(const gonio_basis *basis)
{
    gonio_readings *readings = NULL;
    gonio_plan_options options;
    gonio_plan *plan = NULL;
    gonio_plan_options_default(&options);
    options.count = READINGS;
    options.restarts = 1;
    assert_int_equal(gonio_plan_create(NULL, basis, &options, &plan), GONIO_OK);
    assert_int_equal(gonio_readings_create_from_plan(NULL, plan, &readings), GONIO_OK);
    gonio_plan_free(&plan);
    return readings;
}

static void assert_chain(const fixture *f, const gonio_basis *basis, bool all_channels,
                         size_t expected_readings)
{
    const gonio_reconstruct_options options = {.size = sizeof options,
                                               .all_channels = all_channels};
    gonio_reconstruction *r = NULL;
    gonio_readings *readings = make_plan(basis);
    measure(f, basis, readings);
    if (gonio_reconstruct(f->context, basis, readings, &options, &r) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    assert_int_equal(r->components, K);
    assert_int_equal(r->readings, expected_readings);
    assert_coefficients(r, 1e-5);
    assert_true(r->residual < 1e-6);
    assert_true(r->condition_number >= 1.0 && r->condition_number < 1e4);
    assert_true(error_of(basis, r) < 1e-5);
    gonio_reconstruction_free(&r);
    gonio_readings_free(&readings);
}

static void test_the_planned_channel_suffices(void **state)
{
    const fixture *f = *state;
    assert_chain(f, f->basis, false, READINGS);
}

/* A direction that is planned in several channels is read once: with all channels it counts once.
 */
static void test_all_channels_may_be_used(void **state)
{
    const fixture *f = *state;
    static const double row[6][4] = {{10, 0, 10, 180}, {10, 0, 10, 180}, {50, 0, 20, 180},
                                     {10, 0, 10, 180}, {30, 0, 70, 90},  {80, 0, 75, 170}};
    static const int planned[6] = {0, 2, 1, 1, 1, 2};
    const gonio_reconstruct_options all = {.size = sizeof all, .all_channels = true};
    gonio_reconstruction *r = NULL;
    gonio_pair pair[6];
    for (size_t k = 0; k < 6; k++) {
        pair[k] = made_pair(row[k]);
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = 6,
                                          .channels = GONIO_CHANNELS,
                                          .pair = pair,
                                          .planned = planned};
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_create(f->context, &arrays, NULL, &readings), GONIO_OK);
    measure(f, f->basis, readings);
    assert_int_equal(gonio_reconstruct(f->context, f->basis, readings, &all, &r), GONIO_OK);
    assert_int_equal(r->readings, 4 * GONIO_CHANNELS);
    gonio_reconstruction_free(&r);
    assert_int_equal(gonio_reconstruct(f->context, f->basis, readings, NULL, &r), GONIO_OK);
    assert_int_equal(r->readings, 6);
    gonio_reconstruction_free(&r);
    gonio_readings_free(&readings);
    assert_chain(f, f->basis, true, 3 * READINGS);
}

static void test_separate_channels(void **state)
{
    const fixture *f = *state;
    gonio_basis *basis = learn(GONIO_BIVARIATE, GONIO_SEPARATE);
    assert_chain(f, basis, false, READINGS);
    gonio_basis_free(&basis);
}

/* Directions anywhere: readings that are interpolated in log space, as the basis is, are fitted
 * exactly. */
static void test_directions_between_centres(void **state)
{
    const fixture *f = *state;
    gonio_pair pair[READINGS];
    int planned[READINGS];
    double value[READINGS][GONIO_CHANNELS];
    gonio_i_random random;
    gonio_reconstruction *r = NULL;
    gonio_i_random_seed(&random, 3, 0);
    for (int j = 0; j < READINGS; j++) {
        const int channel = j % GONIO_CHANNELS;
        double angle[4], row[K];
        for (int k = 0; k < 4; k++) {
            angle[k] = round((k % 2 ? 360.0 : 80.0) * gonio_i_random_uniform(&random));
        }
        pair[j] = made_pair(angle);
        planned[j] = channel;
        const gonio_half_difference c = gonio_half_difference_from_pair(pair[j]);
        double g = 0.0;
        gonio_basis_row_at(f->basis, c, channel, K, &g, row);
        for (int k = 0; k < K; k++) {
            g += row[k] * truth[k];
        }
        for (int k = 0; k < GONIO_CHANNELS; k++) {
            value[j][k] = k == channel ? gonio_brdf_from_log(g, channel) : NAN;
        }
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = READINGS,
                                          .channels = GONIO_CHANNELS,
                                          .pair = pair,
                                          .planned = planned,
                                          .value = &value[0][0]};
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_create(f->context, &arrays, NULL, &readings), GONIO_OK);
    assert_int_equal(gonio_reconstruct(f->context, f->basis, readings, NULL, &r), GONIO_OK);
    assert_coefficients(r, 1e-8);
    assert_true(error_of(f->basis, r) < 1e-8);
    gonio_reconstruction_free(&r);
    gonio_readings_free(&readings);
}

static void test_what_does_not_belong_together(void **state)
{
    const fixture *f = *state;
    gonio_basis *other = learn(GONIO_BIVARIATE, GONIO_SEPARATE);
    gonio_reconstruct_options options = {.size = sizeof options, .other_basis = false};
    gonio_reconstruction *r = NULL;
    gonio_readings *readings = make_plan(f->basis);
    measure(f, f->basis, readings);
    assert_int_equal(gonio_reconstruct(f->context, other, readings, &options, &r),
                     GONIO_ERROR_MISMATCH);
    options.other_basis = true;
    assert_int_equal(gonio_reconstruct(f->context, other, readings, &options, &r),
                     GONIO_ERROR_UNDETERMINED); /* each channel has but a third of the readings */
    assert_non_null(strstr(support_message(), "plan: "));
    options.components = K + 1;
    assert_int_equal(gonio_reconstruct(f->context, f->basis, readings, &options, &r),
                     GONIO_ERROR_ARGUMENT);
    options.components = 2;
    assert_int_equal(gonio_reconstruct(f->context, f->basis, readings, &options, &r), GONIO_OK);
    assert_int_equal(r->components, 2);
    gonio_reconstruction_free(&r);
    gonio_readings_free(&readings);
    gonio_basis_free(&other);
}

/* ---- the values of the material ---- */

/* Every bin against s (e^(m + V c) - 1), worked out bin by bin. */
static void assert_values(const gonio_basis *basis)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const bool joint = view->channels == GONIO_JOINT;
    gonio_material *material = make_truth(basis);
    gonio_table *table = made_table(material);
    const double *values = gonio_table_values(table);
    for (int32_t index = 0; index < GONIO_BINS; index += 7) {
        const gonio_bin bin = gonio_bin_from_index(index);
        const int32_t cell =
            view->representation == GONIO_BIVARIATE ? index / GONIO_PHI_D_BINS : index;
        const size_t position = gonio_basis_position(basis, cell);
        for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
            const size_t row = joint ? GONIO_CHANNELS * position + channel : position;
            double g = view->mean[row];
            double v[K];
            assert_int_equal(gonio_basis_rows(NULL, basis, row, 1, K, v), GONIO_OK);
            for (size_t k = 0; k < K; k++) {
                g += v[k] * truth[joint ? k : channel * K + k];
            }
            const double found =
                values[(size_t)bin.theta_h * GONIO_SLAB_VALUES + channel * GONIO_SLAB_BINS +
                       (size_t)(bin.theta_d * GONIO_PHI_D_BINS + bin.phi_d)];
            const double expected = !gonio_bin_is_valid(bin) ? -1.0
                                    : g > 0.0 ? gonio_log_scale((int)channel) * expm1(g)
                                              : 0.0;
            if (!(fabs(found - expected) <= 1e-11 * fabs(expected) + 1e-18)) {
                fail_msg("bin %d, channel %zu: %.17g, not %.17g", (int)index, channel, found,
                         expected);
            }
        }
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
}

static void test_every_bin_has_the_value_of_its_row(void **state)
{
    const fixture *f = *state;
    gonio_basis *separate = learn(GONIO_BIVARIATE, GONIO_SEPARATE);
    gonio_basis *full = learn(GONIO_FULL, GONIO_JOINT);
    assert_values(f->basis);
    assert_values(separate);
    assert_values(full);
    gonio_basis_free(&separate);
    gonio_basis_free(&full);
}

/* ---- several tables ---- */

enum { TABLES = 4 };

typedef struct several {
    gonio_readings *readings[TABLES];
    char *path[TABLES];
    gonio_reconstruction *made[TABLES];
} several;

/* Readings that differ, as noise does. */
static void make_several(const fixture *f, several *s)
{
    gonio_material *material = make_truth(f->basis);
    gonio_table *table = made_table(material);
    for (size_t k = 0; k < TABLES; k++) {
        const gonio_instrument_options noise = {.size = sizeof noise, .noise = 0.01, .seed = k};
        s->readings[k] = make_plan(f->basis);
        assert_int_equal(gonio_measure(f->context, s->readings[k], table, &noise), GONIO_OK);
        s->path[k] = malloc(512);
        assert_non_null(s->path[k]);
        snprintf(s->path[k], 512, "%s/table-%zu.binary", f->folder, k);
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
}

static void free_several(several *s)
{
    for (size_t k = 0; k < TABLES; k++) {
        gonio_readings_free(&s->readings[k]);
        free(s->path[k]);
    }
}

static gonio_status write_several(const fixture *f, gonio_context *context, several *s)
{
    return gonio_reconstruct_tables(context, f->basis, (const gonio_readings *const *)s->readings,
                                    (const char *const *)s->path, TABLES, NULL, s->made);
}

/* The first `count` are in place, whole, and reported, the others not; nothing else is left. */
static void assert_in_place(const fixture *f, several *s, size_t count)
{
    for (size_t k = 0; k < TABLES; k++) {
        gonio_material *material = NULL;
        const bool there = gonio_material_open(NULL, s->path[k], &material) == GONIO_OK;
        assert_int_equal(there, k < count);
        assert_int_equal(s->made[k] != NULL, k < count);
        gonio_material_free(&material);
        gonio_reconstruction_free(&s->made[k]);
        unlink(s->path[k]);
    }
    DIR *folder = opendir(f->folder);
    assert_non_null(folder);
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        assert_null(strstr(entry->d_name, ".part"));
    }
    closedir(folder);
}

static uint64_t fingerprint_of(const char *path)
{
    gonio_fingerprint *fingerprint = NULL;
    assert_int_equal(gonio_fingerprint_create(&fingerprint), GONIO_OK);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char block[4096];
    for (size_t got = 0; (got = fread(block, 1, sizeof block, file)) > 0;) {
        gonio_fingerprint_add(fingerprint, block, got);
    }
    fclose(file);
    const uint64_t value = gonio_fingerprint_value(fingerprint);
    gonio_fingerprint_free(&fingerprint);
    return value;
}

static void test_tables_are_the_same_on_any_number_of_threads(void **state)
{
    const fixture *f = *state;
    several s = {0};
    uint64_t alone[TABLES];
    make_several(f, &s);
    for (size_t k = 0; k < TABLES; k++) {
        gonio_reconstruction *r = NULL;
        gonio_material *material = NULL;
        assert_int_equal(gonio_reconstruct(NULL, f->basis, s.readings[k], NULL, &r), GONIO_OK);
        assert_int_equal(gonio_reconstruction_material(NULL, f->basis, r, "one", &material),
                         GONIO_OK);
        assert_int_equal(gonio_material_write_merl(NULL, material, s.path[k]), GONIO_OK);
        alone[k] = fingerprint_of(s.path[k]);
        assert_true(k == 0 || alone[k] != alone[k - 1]);
        gonio_material_free(&material);
        gonio_reconstruction_free(&r);
    }
    static const int threads[] = {1, 2, 5};
    for (size_t t = 0; t < sizeof threads / sizeof *threads; t++) {
        const gonio_context_options options = {.size = sizeof options, .threads = threads[t]};
        gonio_context *context = NULL;
        assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
        assert_int_equal(write_several(f, context, &s), GONIO_OK);
        for (size_t k = 0; k < TABLES; k++) {
            assert_int_equal(s.made[k]->readings, READINGS);
            assert_true(fingerprint_of(s.path[k]) == alone[k]);
        }
        assert_in_place(f, &s, TABLES);
        gonio_context_free(&context);
    }
    free_several(&s);
}

static void test_tables_before_the_first_failure_are_written(void **state)
{
    const fixture *f = *state;
    several s = {0};
    make_several(f, &s);

    char *path = s.path[2];
    s.path[2] = strdup("/nowhere/table.binary");
    assert_int_equal(write_several(f, f->context, &s), GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), "/nowhere/table.binary: cannot write"));
    assert_in_place(f, &s, 2);
    free(s.path[2]);
    s.path[2] = path;

    static const double row[][7] = {{10, 0, 20, 180, 0.1, NAN, NAN}};
    for (size_t k = 1; k < TABLES; k += 2) {
        gonio_readings_free(&s.readings[k]);
        s.readings[k] = made_colours(row, 1);
    }
    assert_int_equal(write_several(f, f->context, &s), GONIO_ERROR_UNDETERMINED);
    assert_non_null(strstr(support_message(), "1 readings of which 1 are independent"));
    assert_in_place(f, &s, 1);
    free_several(&s);
}

typedef struct progress {
    int calls;
    int ends;
    int most; /* calls, after which the work is cancelled */
} progress;

static int on_progress(void *user, const char *task, double fraction)
{
    progress *p = user;
    assert_string_equal(task, "reconstructing");
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    p->calls++;
    p->ends += fraction == 1.0;
    return p->calls >= p->most;
}

static void test_cancelled_tables_leave_nothing(void **state)
{
    const fixture *f = *state;
    several s = {0};
    make_several(f, &s);
    for (int threads = 1; threads <= 2; threads++) {
        progress p = {.most = 10000};
        const gonio_context_options options = {
            .size = sizeof options, .progress = on_progress, .user = &p, .threads = threads};
        gonio_context *context = NULL;
        assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
        assert_int_equal(write_several(f, context, &s), GONIO_OK);
        assert_int_equal(p.calls, TABLES * GONIO_THETA_H_BINS + 1);
        assert_int_equal(p.ends, 1);
        assert_in_place(f, &s, TABLES);

        p = (progress){.most = 50};
        assert_int_equal(write_several(f, context, &s), GONIO_ERROR_CANCELLED);
        assert_int_equal(p.calls, 50);
        assert_in_place(f, &s, 0);
        gonio_context_free(&context);
    }
    free_several(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_give_a_known_material_back),
        cmocka_unit_test(test_the_planned_channel_suffices),
        cmocka_unit_test(test_all_channels_may_be_used),
        cmocka_unit_test(test_separate_channels),
        cmocka_unit_test(test_directions_between_centres),
        cmocka_unit_test(test_what_does_not_belong_together),
        cmocka_unit_test(test_every_bin_has_the_value_of_its_row),
        cmocka_unit_test(test_tables_are_the_same_on_any_number_of_threads),
        cmocka_unit_test(test_tables_before_the_first_failure_are_written),
        cmocka_unit_test(test_cancelled_tables_leave_nothing),
    };
    return cmocka_run_group_tests_name("reconstruct", tests, set_up, tear_down);
}
