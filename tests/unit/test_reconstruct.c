/* Reconstruction: a material inside the span of the basis is given back. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "made_material.h"

enum { MATERIALS = 6, K = 5, READINGS = 14 };

typedef struct fixture {
    char *folder;
    char path[256];
    gonio_context *context;
    gonio_basis *basis;
    gonio_basis_view view;
} fixture;

static gonio_basis *learn(gonio_channel_model channels)
{
    static const char *const paths[MATERIALS] = {
        "atlas:gold-polished", "atlas:red-glossy-plastic", "atlas:burgundy-velvet",
        "atlas:oak-sawn",      "atlas:plaster-cast",       "atlas:steel-brushed"};
    const gonio_database_options how = {GONIO_BIVARIATE, channels, NULL};
    const gonio_basis_options options = {.components = K};
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
    snprintf(f->path, sizeof f->path, "%s/readings.csv", f->folder);
    f->context = support_context();
    f->basis = learn(GONIO_JOINT);
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
    const bool joint = gonio_basis_describe(basis).channels == GONIO_JOINT;
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
    return comparison.all.e6;
}

/* ---- from rows ---- */

static void test_rows_give_a_known_material_back(void **state)
{
    const fixture *f = *state;
    size_t rows[READINGS];
    double b[READINGS];
    gonio_reconstruction *r = NULL;
    for (size_t j = 0; j < READINGS; j++) {
        rows[j] = (j * 7919 + 31) % f->view.rows;
        b[j] = f->view.mean[rows[j]];
        for (size_t k = 0; k < K; k++) {
            b[j] += f->view.vectors[rows[j] * K + k] * truth[k];
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

/* Measures the known material where a file says. */
static gonio_readings *measure(const fixture *f, const gonio_basis *basis)
{
    const gonio_readings_options plan = {.values_needed = false};
    gonio_material *material = make_truth(basis);
    gonio_table *table = made_table(material);
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_read(f->context, f->path, &plan, &readings), GONIO_OK);
    assert_int_equal(gonio_measure(f->context, readings, table, NULL), GONIO_OK);
    gonio_table_free(&table);
    gonio_material_free(&material);
    return readings;
}

static void write_plan(const fixture *f, const gonio_basis *basis)
{
    gonio_plan_options options;
    gonio_plan *plan = NULL;
    gonio_plan_options_default(&options);
    options.count = READINGS;
    options.restarts = 1;
    assert_int_equal(gonio_plan_create(NULL, basis, &options, &plan), GONIO_OK);
    assert_int_equal(gonio_plan_write(NULL, plan, NULL, f->path), GONIO_OK);
    gonio_plan_free(&plan);
}

/* Angles are kept to 1e-9 degrees, which the narrowest cells turn into about 1e-7. */
static void assert_chain(const fixture *f, const gonio_basis *basis, bool all_channels,
                         size_t expected_readings)
{
    const gonio_reconstruct_options options = {.all_channels = all_channels};
    gonio_reconstruction *r = NULL;
    write_plan(f, basis);
    gonio_readings *readings = measure(f, basis);
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
    static const char plan[] = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel\n"
                               "10,0,10,180,R\n10,0,10,180,B\n50,0,20,180,G\n10,0,10,180,G\n"
                               "30,0,70,90,G\n80,0,75,170,B\n";
    const gonio_reconstruct_options all = {.all_channels = true};
    gonio_reconstruction *r = NULL;
    FILE *file = fopen(f->path, "wb");
    assert_non_null(file);
    fputs(plan, file);
    assert_int_equal(fclose(file), 0);
    gonio_readings *readings = measure(f, f->basis);
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
    gonio_basis *basis = learn(GONIO_SEPARATE);
    assert_chain(f, basis, false, READINGS);
    gonio_basis_free(&basis);
}

/* Directions anywhere: readings that are interpolated in log space, as the basis is, are fitted
 * exactly. */
static void test_directions_between_centres(void **state)
{
    const fixture *f = *state;
    FILE *file = fopen(f->path, "wb");
    gonio_i_random random;
    gonio_reconstruction *r = NULL;
    gonio_i_random_seed(&random, 3, 0);
    assert_non_null(file);
    fputs("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel,R_per_sr,G_per_sr,B_per_sr\n", file);
    for (int j = 0; j < READINGS; j++) {
        const double degrees = M_PI / 180.0;
        const int channel = j % GONIO_CHANNELS;
        double angle[4], row[K];
        for (int k = 0; k < 4; k++) {
            angle[k] = round((k % 2 ? 360.0 : 80.0) * gonio_i_random_uniform(&random));
        }
        const gonio_half_difference c = gonio_half_difference_from_pair((gonio_pair){
            {angle[0] * degrees, angle[1] * degrees}, {angle[2] * degrees, angle[3] * degrees}});
        double g = 0.0;
        gonio_basis_row_at(f->basis, c, channel, K, &g, row);
        for (int k = 0; k < K; k++) {
            g += row[k] * truth[k];
        }
        fprintf(file, "%g,%g,%g,%g,%c", angle[0], angle[1], angle[2], angle[3], "RGB"[channel]);
        for (int k = 0; k < GONIO_CHANNELS; k++) {
            fprintf(file, k == channel ? ",%.17g" : ",", gonio_brdf_from_log(g, channel));
        }
        fputc('\n', file);
    }
    assert_int_equal(fclose(file), 0);
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_read(f->context, f->path, NULL, &readings), GONIO_OK);
    assert_int_equal(gonio_reconstruct(f->context, f->basis, readings, NULL, &r), GONIO_OK);
    assert_coefficients(r, 1e-8);
    assert_true(error_of(f->basis, r) < 1e-8);
    gonio_reconstruction_free(&r);
    gonio_readings_free(&readings);
}

static void test_what_does_not_belong_together(void **state)
{
    const fixture *f = *state;
    gonio_basis *other = learn(GONIO_SEPARATE);
    gonio_reconstruct_options options = {.other_basis = false};
    gonio_reconstruction *r = NULL;
    write_plan(f, f->basis);
    gonio_readings *readings = measure(f, f->basis);
    assert_int_equal(gonio_reconstruct(f->context, other, readings, &options, &r),
                     GONIO_ERROR_MISMATCH);
    options.other_basis = true;
    assert_int_equal(gonio_reconstruct(f->context, other, readings, &options, &r),
                     GONIO_ERROR_UNDETERMINED); /* each channel has but a third of the readings */
    assert_non_null(strstr(support_message(), f->path));
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_give_a_known_material_back),
        cmocka_unit_test(test_the_planned_channel_suffices),
        cmocka_unit_test(test_all_channels_may_be_used),
        cmocka_unit_test(test_separate_channels),
        cmocka_unit_test(test_directions_between_centres),
        cmocka_unit_test(test_what_does_not_belong_together),
    };
    return cmocka_run_group_tests_name("reconstruct", tests, set_up, tear_down);
}
