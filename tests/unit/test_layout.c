/* Rows, cells, bins and directions: one is found from the other. */
#include "../support.h"

#include <math.h>

#include "database/layout.h"

enum { REPRESENTATIONS = 3, VALID_BINS = 1096216 };

static void test_names_and_back(void **state)
{
    (void)state;
    for (int k = 0; k < REPRESENTATIONS; k++) {
        gonio_representation found = GONIO_BIVARIATE;
        assert_true(
            gonio_representation_parse(gonio_representation_name((gonio_representation)k), &found));
        assert_int_equal(found, k);
    }
    for (int k = 0; k < 2; k++) {
        gonio_channel_model channels = GONIO_JOINT;
        gonio_mapping mapping = GONIO_LOG;
        assert_true(
            gonio_channel_model_parse(gonio_channel_model_name((gonio_channel_model)k), &channels));
        assert_true(gonio_mapping_parse(gonio_mapping_name((gonio_mapping)k), &mapping));
        assert_int_equal(channels, k);
        assert_int_equal(mapping, k);
    }
    gonio_representation untouched = GONIO_SECTORED;
    assert_false(gonio_representation_parse("sectors", &untouched));
    assert_int_equal(untouched, GONIO_SECTORED);
    assert_null(gonio_representation_name((gonio_representation)REPRESENTATIONS));
    assert_null(gonio_channel_model_name((gonio_channel_model)2));
    assert_null(gonio_mapping_name((gonio_mapping)2));
}

static void test_rows_and_channels(void **state)
{
    (void)state;
    for (size_t row = 0; row < 1000; row++) {
        for (int k = 0; k < 2; k++) {
            const gonio_channel_model channels = (gonio_channel_model)k;
            const size_t position = gonio_i_position_of(channels, row);
            const int channel = gonio_i_channel_of(channels, row);
            assert_int_equal(gonio_i_row_of(channels, position, channel), row);
        }
    }
    assert_int_equal(gonio_i_row_of(GONIO_JOINT, 7, 2), 23);
    assert_int_equal(gonio_i_row_of(GONIO_SEPARATE, 7, 2), 7);
    assert_int_equal(gonio_i_columns_per_material(GONIO_JOINT), 1);
    assert_int_equal(gonio_i_columns_per_material(GONIO_SEPARATE), GONIO_CHANNELS);
}

/* The bins of the cells are all bins, each once, in order; the valid ones among them are counted
 * right. */
static void test_cells_have_all_bins(void **state)
{
    (void)state;
    for (int k = 0; k < REPRESENTATIONS; k++) {
        const gonio_representation representation = (gonio_representation)k;
        const int phi_cells = gonio_i_phi_cells(representation);
        int32_t next = 0;
        int valid = 0;
        for (int32_t cell = 0; cell < gonio_grid_cells(representation); cell++) {
            const gonio_i_bin_run bins = gonio_i_cell_bins(representation, cell);
            const gonio_i_cell_indices at = gonio_i_indices_of_cell(phi_cells, cell);
            assert_int_equal(gonio_bin_index(bins.first), next);
            assert_int_equal(at.theta_h, bins.first.theta_h);
            assert_int_equal(at.theta_d, bins.first.theta_d);
            assert_int_equal(gonio_i_cell_at(phi_cells, at), cell);
            assert_int_equal(
                gonio_cell_of_bin(representation, gonio_cell_bin(representation, cell)), cell);
            next += bins.count;
            valid += gonio_i_valid_bin_count(representation, cell);
        }
        assert_int_equal(next, GONIO_BINS);
        assert_int_equal(valid, VALID_BINS);
    }
}

/* A cell with valid bins has a direction above the horizon; an interpolation there, but where the
 * direction was moved, takes that cell alone. */
static void test_directions_of_cells(void **state)
{
    (void)state;
    for (int k = 0; k < REPRESENTATIONS; k++) {
        const gonio_representation representation = (gonio_representation)k;
        for (int32_t cell = 0; cell < gonio_grid_cells(representation); cell += 7) {
            const gonio_bin middle = gonio_cell_bin(representation, cell);
            const gonio_half_difference at =
                gonio_i_cell_direction(representation, cell, M_PI / 2.0);
            if (gonio_i_valid_bin_count(representation, cell) > 0) {
                double incident = 0.0;
                double outgoing = 0.0;
                gonio_cosines(at, &incident, &outgoing);
                assert_true(incident > 0.0 && outgoing > 0.0);
            }
            gonio_i_cell_weight around[GONIO_I_MOST_POINTS];
            const int points = gonio_i_cells_around(representation, at, around);
            double all = 0.0;
            double here = 0.0;
            for (int p = 0; p < points; p++) {
                all += around[p].weight;
                here += around[p].cell == cell ? around[p].weight : 0.0;
            }
            const bool moved = representation != GONIO_BIVARIATE && !gonio_bin_is_valid(middle);
            assert_true(fabs(all - 1.0) < 1e-12);
            assert_true(moved || fabs(here - 1.0) < 1e-9);
        }
    }
}

/* phi_d is free in a bivariate cell, as far as it is above the horizon. */
static void test_phi_d_of_a_bivariate_cell(void **state)
{
    (void)state;
    const gonio_half_difference low = gonio_i_cell_direction(GONIO_BIVARIATE, 5 * 90 + 5, 0.0);
    const gonio_half_difference grazing =
        gonio_i_cell_direction(GONIO_BIVARIATE, 80 * 90 + 60, 0.0);
    const int first = gonio_i_first_valid_phi(80, 60);
    assert_true(low.phi_d == 0.0);
    assert_true(first > 0 && fabs(grazing.phi_d - (first + 0.5) * M_PI / 180.0) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_and_back),
        cmocka_unit_test(test_rows_and_channels),
        cmocka_unit_test(test_cells_have_all_bins),
        cmocka_unit_test(test_directions_of_cells),
        cmocka_unit_test(test_phi_d_of_a_bivariate_cell),
    };
    return cmocka_run_group_tests_name("layout", tests, NULL, NULL);
}
