/* Indices that callers give (cells, bins, channels, rows, components, materials): those that are
 * out of range are refused, and nothing is written. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "made_basis.h"
#include "made_readings.h"

typedef struct fixture {
    gonio_context *context;
    gonio_database *database; /* joint */
    gonio_basis *joint;
    gonio_basis *separate;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    f.context = support_context();
    f.database = made_database(GONIO_BIVARIATE, GONIO_JOINT);
    assert_int_equal(gonio_basis_learn(f.context, f.database, NULL, &f.joint), GONIO_OK);
    f.separate = made_basis(f.context, GONIO_BIVARIATE, GONIO_SEPARATE, 1);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_basis_free(&f->separate);
    gonio_basis_free(&f->joint);
    gonio_database_free(&f->database);
    gonio_context_free(&f->context);
    return 0;
}

static void assert_refused(gonio_status status, gonio_status expected, const char *message)
{
    assert_int_equal(status, expected);
    assert_non_null(strstr(support_message(), message));
}

static void test_bins_and_cells(void **state)
{
    (void)state;
    static const gonio_representation all[] = {GONIO_BIVARIATE, GONIO_FULL, GONIO_SECTORED};
    static const gonio_bin outside[] = {{-1, 0, 0},  {GONIO_THETA_H_BINS, 0, 0},
                                        {0, -1, 90}, {0, GONIO_THETA_D_BINS, 90},
                                        {0, 0, -1},  {0, 0, GONIO_PHI_D_BINS}};
    for (size_t k = 0; k < sizeof outside / sizeof *outside; k++) {
        assert_false(gonio_bin_is_valid(outside[k]));
        for (size_t r = 0; r < sizeof all / sizeof *all; r++) {
            assert_int_equal(gonio_cell_of_bin(all[r], outside[k]), -1);
        }
    }
    for (size_t r = 0; r < sizeof all / sizeof *all; r++) {
        assert_int_equal(gonio_cell_bin(all[r], -1).theta_h, -1);
        assert_int_equal(gonio_cell_bin(all[r], gonio_grid_cells(all[r])).theta_h, -1);
        assert_int_equal(gonio_cell_bin(all[r], gonio_grid_cells(all[r]) - 1).theta_h,
                         GONIO_THETA_H_BINS - 1);
    }
    const gonio_representation none = (gonio_representation)7;
    assert_int_equal(gonio_grid_cells(none), 0);
    assert_int_equal(gonio_cell_bin(none, 0).phi_d, -1);
    assert_int_equal(gonio_cell_of_bin(none, (gonio_bin){0, 0, 0}), -1);
}

static void test_what_a_basis_does_not_have(void **state)
{
    const fixture *f = *state;
    const gonio_basis_view *view = gonio_basis_describe(f->joint);
    double mean = -1.0;
    double row[2] = {-1.0, -1.0};
    const gonio_half_difference at = gonio_bin_centre((gonio_bin){20, 30, 40});
    assert_int_equal(gonio_basis_position(f->joint, -1), view->cells);
    assert_int_equal(gonio_basis_position(f->joint, GONIO_CELLS), view->cells);
    assert_true(gonio_basis_position(f->joint, GONIO_CELLS - 1) < view->cells);
    assert_true(gonio_basis_singular_value(f->joint, view->variance_count) == 0.0);
    assert_true(gonio_basis_singular_value(f->joint, view->variance_count - 1) > 0.0);
    assert_false(gonio_basis_row_at(f->joint, at, -1, 1, &mean, row));
    assert_false(gonio_basis_row_at(f->joint, at, GONIO_CHANNELS, 1, &mean, row));
    assert_false(gonio_basis_row_at(f->joint, at, 0, view->components + 1, &mean, row));
    assert_true(mean == -1.0 && row[0] == -1.0);
    assert_true(gonio_basis_row_at(f->joint, at, 2, 1, &mean, row));
    assert_true(gonio_basis_row_at(f->separate, at, 30, 1, &mean, row));
    assert_refused(gonio_basis_rows(f->context, f->joint, view->rows, 1, 1, row),
                   GONIO_ERROR_ARGUMENT, "rows");
    assert_refused(gonio_basis_rows(f->context, f->joint, 0, 1, view->components + 1, row),
                   GONIO_ERROR_ARGUMENT, "components");
}

static void test_materials_that_a_database_does_not_have(void **state)
{
    const fixture *f = *state;
    static const size_t subset[] = {0, 1, MADE_MATERIALS};
    const gonio_basis_options options = {
        .size = sizeof options, .subset = subset, .subset_count = 3};
    gonio_basis *basis = NULL;
    assert_refused(gonio_basis_learn(f->context, f->database, &options, &basis),
                   GONIO_ERROR_ARGUMENT, "material 3 is outside a database of 3");
    assert_null(basis);
}

static void test_kinds_of_databases_that_there_are_not(void **state)
{
    const fixture *f = *state;
    gonio_database *database = NULL;
    for (int k = 0; k < 3; k++) {
        gonio_database_options options;
        gonio_database_options_default(&options);
        options.representation = k == 0 ? (gonio_representation)3 : options.representation;
        options.channels = k == 1 ? (gonio_channel_model)2 : options.channels;
        options.mapping = k == 2 ? (gonio_mapping)2 : options.mapping;
        assert_refused(
            gonio_database_create(f->context, made_paths, MADE_MATERIALS, &options, &database),
            GONIO_ERROR_ARGUMENT, "have the numbers");
        assert_null(database);
    }
}

static void test_rows_of_a_matrix(void **state)
{
    const fixture *f = *state;
    static const double vectors[] = {1.0, 2.0, 3.0, 4.0};
    static const size_t rows[] = {0, 2};
    size_t chosen[1] = {9};
    double condition = -1.0;
    gonio_plan_options options;
    gonio_selection_report report;
    gonio_plan_options_default(&options);
    options.count = 1;
    assert_refused(gonio_condition_number(f->context, vectors, 2, 2, 2, rows, 2, &condition),
                   GONIO_ERROR_ARGUMENT, "row 2 is outside a matrix of 2 rows");
    assert_refused(gonio_condition_number(f->context, vectors, 2, 2, 3, rows, 1, &condition),
                   GONIO_ERROR_ARGUMENT, "3 components requested, but the rows have 2");
    assert_refused(gonio_plan_select(f->context, vectors, 2, 2, 3, &options, chosen, &report),
                   GONIO_ERROR_ARGUMENT, "3 components requested, but the rows have 2");
    assert_true(condition == -1.0 && chosen[0] == 9);
}

static void test_rows_to_reconstruct_from(void **state)
{
    const fixture *f = *state;
    const size_t rows[] = {0, gonio_basis_describe(f->joint)->rows};
    static const double b[] = {0.0, 0.0};
    double read[2] = {-1.0, -1.0};
    gonio_material *gold = NULL;
    gonio_material *material = NULL;
    gonio_reconstruction *made = NULL;
    assert_int_equal(gonio_material_open(f->context, made_paths[0], &gold), GONIO_OK);
    assert_refused(gonio_reconstruct_rows(f->context, f->joint, 1, rows, 2, b, &made),
                   GONIO_ERROR_ARGUMENT, "outside a basis of");
    assert_refused(gonio_reconstruct_rows_with(f->context, f->joint, NULL, rows, 2, b, &made),
                   GONIO_ERROR_ARGUMENT, "outside a basis of");
    assert_refused(gonio_reconstruct_rows(f->context, f->joint, 1, rows, 0, b, &made),
                   GONIO_ERROR_ARGUMENT, "no rows");
    assert_refused(gonio_material_rows(f->context, f->joint, gold, rows, 2, read),
                   GONIO_ERROR_ARGUMENT, "outside a basis of");
    assert_refused(gonio_reconstruct_material(f->context, f->joint, gold, rows, 2, NULL, &material),
                   GONIO_ERROR_ARGUMENT, "outside a basis of");
    assert_true(made == NULL && material == NULL && read[0] == -1.0);
    gonio_material_free(&gold);
}

/* A plan's entries are of the grid and the channels of the basis that it was made for. */
static void test_plans_of_other_bases(void **state)
{
    const fixture *f = *state;
    gonio_plan_options options;
    gonio_plan *plan = NULL;
    size_t rows[2];
    gonio_plan_options_default(&options);
    options.count = 2;
    assert_int_equal(gonio_plan_create(f->context, f->joint, &options, &plan), GONIO_OK);
    assert_int_equal(gonio_plan_rows(f->context, plan, f->joint, rows), GONIO_OK);
    assert_true(rows[0] < rows[1]);
    assert_refused(gonio_plan_rows(f->context, plan, f->separate, rows), GONIO_ERROR_MISMATCH,
                   "another kind of basis");
    plan->entries[1].cell = GONIO_CELLS;
    assert_refused(gonio_plan_rows(f->context, plan, f->joint, rows), GONIO_ERROR_MISMATCH,
                   "entry 2");
    gonio_readings *readings = NULL;
    plan->entries[1].channel = GONIO_CHANNELS;
    assert_refused(gonio_readings_create_from_plan(f->context, plan, &readings),
                   GONIO_ERROR_ARGUMENT, "channel 3 is outside 3");
    assert_null(readings);
    gonio_plan_free(&plan);
}

/* Only a reconstruction by posterior has a field, and only on request deviations. */
static void test_predictions_that_there_are_not(void **state)
{
    const fixture *f = *state;
    static const double rows[][7] = {{30, 0, 50, 40, 0.1, 0.2, 0.3}, {10, 0, 20, 0, 0.3, 0.2, 0.1}};
    static const char *const methods[] = {"ridge", "posterior"};
    const gonio_half_difference at = gonio_bin_centre((gonio_bin){20, 30, 40});
    gonio_readings *readings = made_colours(rows, 2);
    for (int k = 0; k < 2; k++) {
        double value[GONIO_CHANNELS] = {-1.0, -1.0, -1.0};
        double deviation[GONIO_CHANNELS] = {-1.0, -1.0, -1.0};
        gonio_reconstruction *made = NULL;
        const gonio_reconstruct_options options = {.size = sizeof options, .method = methods[k]};
        assert_int_equal(gonio_reconstruct(f->context, f->separate, readings, &options, &made),
                         GONIO_OK);
        assert_false(gonio_reconstruction_predict(f->separate, made, at, value, deviation));
        assert_true(value[0] == -1.0 && deviation[0] == -1.0);
        assert_int_equal(gonio_reconstruction_predict(f->separate, made, at, value, NULL), k == 1);
        assert_int_equal(value[0] >= 0.0, k == 1);
        gonio_reconstruction_free(&made);
    }
    gonio_readings_free(&readings);
}

/* The material of deviations holds those that are predicted at the middles of cells. */
static void test_deviations_as_a_material(void **state)
{
    const fixture *f = *state;
    static const double rows[][7] = {{30, 0, 50, 40, 0.1, 0.2, 0.3}, {10, 0, 20, 0, 0.3, 0.2, 0.1}};
    gonio_readings *readings = made_colours(rows, 2);
    gonio_material *material = NULL;
    double *slab = malloc(GONIO_SLAB_VALUES * sizeof *slab);
    assert_non_null(slab);
    for (int k = 0; k < 2; k++) {
        gonio_reconstruction *made = NULL;
        const gonio_reconstruct_options options = {
            .size = sizeof options, .method = "posterior", .noise = 0.01, .deviation = k == 1};
        assert_int_equal(gonio_reconstruct(f->context, f->separate, readings, &options, &made),
                         GONIO_OK);
        assert_int_equal(
            gonio_reconstruction_deviation_material(f->context, f->separate, made, &material),
            k == 1 ? GONIO_OK : GONIO_ERROR_ARGUMENT);
        for (int theta_d = 0; theta_d < 60 && k == 1; theta_d += 7) {
            const gonio_bin bin = {25, theta_d, 90};
            const size_t at = (size_t)theta_d * GONIO_PHI_D_BINS + (size_t)bin.phi_d;
            double value[GONIO_CHANNELS], deviation[GONIO_CHANNELS];
            assert_int_equal(gonio_material_read_slab(f->context, material, 25, slab), GONIO_OK);
            assert_true(gonio_reconstruction_predict(f->separate, made, gonio_bin_centre(bin),
                                                     value, deviation));
            for (int c = 0; c < GONIO_CHANNELS; c++) {
                const double stored = slab[(size_t)c * GONIO_SLAB_BINS + at] / gonio_log_scale(c);
                assert_true(deviation[c] > 0.0);
                assert_true(fabs(stored / deviation[c] - 1.0) < 1e-9);
            }
        }
        gonio_material_free(&material);
        gonio_reconstruction_free(&made);
    }
    free(slab);
    gonio_readings_free(&readings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bins_and_cells),
        cmocka_unit_test(test_what_a_basis_does_not_have),
        cmocka_unit_test(test_materials_that_a_database_does_not_have),
        cmocka_unit_test(test_kinds_of_databases_that_there_are_not),
        cmocka_unit_test(test_rows_of_a_matrix),
        cmocka_unit_test(test_rows_to_reconstruct_from),
        cmocka_unit_test(test_plans_of_other_bases),
        cmocka_unit_test(test_predictions_that_there_are_not),
        cmocka_unit_test(test_deviations_as_a_material),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
