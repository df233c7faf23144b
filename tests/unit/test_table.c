/* Materials: look-ups in a table, albedo, log space, tables on disk. */
#include "../support.h"

#include <math.h>
#include <stdio.h>

#include "core/random.h"
#include "made_material.h"

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

static gonio_material *open_material(const char *path)
{
    gonio_material *material = NULL;
    assert_int_equal(gonio_material_open(NULL, path, &material), GONIO_OK);
    return material;
}

static double stored(const gonio_table *table, gonio_bin bin, int channel)
{
    return gonio_table_values(
        table)[(size_t)bin.theta_h * GONIO_SLAB_VALUES + (size_t)channel * GONIO_SLAB_BINS +
               (size_t)bin.theta_d * GONIO_PHI_D_BINS + (size_t)bin.phi_d];
}

static void test_value_at_a_centre_is_that_of_the_bin(void **state)
{
    (void)state;
    gonio_material *material = open_material("atlas:steel-brushed");
    gonio_table *table = made_table(material);
    for (int32_t index = 0; index < GONIO_BINS; index += 13) {
        const gonio_bin bin = gonio_bin_from_index(index);
        double rho[GONIO_CHANNELS];
        const bool found = gonio_table_value(table, gonio_bin_centre(bin), rho);
        assert_int_equal(found, gonio_bin_is_valid(bin));
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            const double expected = found ? stored(table, bin, channel) : 0.0;
            assert_close(rho[channel], expected, 1e-9 * fabs(expected));
        }
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
    assert_null(table);
}

static bool is_checkered(gonio_bin bin)
{
    return (bin.theta_h + bin.theta_d + bin.phi_d) % 2 == 0;
}

static bool is_far_from_mirror(gonio_bin bin)
{
    return bin.theta_h >= 30;
}

static void test_holes_are_bridged_while_a_neighbour_has_data(void **state)
{
    (void)state;
    gonio_material *material = made_material((made_constant){{0.1, 0.2, 0.3}, is_checkered});
    gonio_table *table = made_table(material);
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 0);
    for (int k = 0; k < 100000; k++) {
        const gonio_half_difference c = {gonio_i_random_uniform(&random),
                                         0.5 * gonio_i_random_uniform(&random),
                                         M_PI * gonio_i_random_uniform(&random)};
        double rho[GONIO_CHANNELS];
        assert_true(gonio_table_value(table, c, rho));
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            assert_close(rho[channel], 0.1 * (channel + 1), 1e-15);
        }
    }
    gonio_table_free(&table);
    gonio_material_free(&material);

    material = made_material((made_constant){{0.1, 0.2, 0.3}, is_far_from_mirror});
    table = made_table(material);
    double rho[GONIO_CHANNELS] = {7.0, 7.0, 7.0};
    assert_true(gonio_table_value(table, gonio_bin_centre((gonio_bin){29, 5, 90}), rho));
    assert_false(gonio_table_value(table, gonio_bin_centre((gonio_bin){40, 5, 90}), rho));
    assert_true(rho[0] == 0.0 && rho[1] == 0.0 && rho[2] == 0.0);
    gonio_table_free(&table);
    gonio_material_free(&material);
}

static void test_albedo_of_a_lambertian(void **state)
{
    (void)state;
    const double albedo[GONIO_CHANNELS] = {0.25, 0.5, 1.0};
    gonio_material *material = made_material(
        (made_constant){{albedo[0] / M_PI, albedo[1] / M_PI, albedo[2] / M_PI}, NULL});
    gonio_table *table = made_table(material);
    static const double degrees[] = {0.0, 30.0, 60.0, 75.0, 85.0};
    for (size_t k = 0; k < sizeof degrees / sizeof *degrees; k++) {
        double found[GONIO_CHANNELS];
        assert_close(gonio_table_albedo(table, degrees[k] * M_PI / 180.0, found), 1.0, 1e-12);
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            assert_close(found[channel], albedo[channel], 1e-3);
        }
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
}

static bool is_grazing(gonio_bin bin)
{
    const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
    return fmax(pair.incident.theta, pair.outgoing.theta) > 70.0 * M_PI / 180.0;
}

static void test_albedo_without_data(void **state)
{
    (void)state;
    gonio_material *material = made_material((made_constant){{0.1, 0.2, 0.3}, is_grazing});
    gonio_table *table = made_table(material);
    double albedo[GONIO_CHANNELS];
    assert_close(gonio_table_albedo(table, 85.0 * M_PI / 180.0, albedo), 0.0, 0.0);
    assert_true(isnan(albedo[0]) && isnan(albedo[1]) && isnan(albedo[2]));
    const double share = gonio_table_albedo(table, 40.0 * M_PI / 180.0, albedo);
    assert_true(albedo[0] > 0.2 && albedo[0] < 0.1 * M_PI); /* some is missing */
    assert_close(albedo[0] / (0.1 * M_PI), share, 1e-3);
    gonio_table_free(&table);
    gonio_material_free(&material);
}

static void test_table_on_disk(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/made.binary", folder);
    gonio_material *material = made_material((made_constant){{0.0, 0.2, 300.0}, is_checkered});
    assert_int_equal(gonio_material_write_merl(NULL, material, path), GONIO_OK);
    gonio_material *again = open_material(path);
    assert_string_equal(gonio_material_name(again), "made");
    double *a = malloc(2 * GONIO_SLAB_VALUES * sizeof *a);
    double *b = a + GONIO_SLAB_VALUES;
    assert_non_null(a);
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h += 11) {
        assert_int_equal(gonio_material_read_slab(NULL, material, theta_h, a), GONIO_OK);
        assert_int_equal(gonio_material_read_slab(NULL, again, theta_h, b), GONIO_OK);
        for (int k = 0; k < GONIO_SLAB_VALUES; k++) {
            assert_close(b[k], a[k], 1e-15 * fabs(a[k]));
        }
    }
    assert_int_equal(gonio_material_read_slab(NULL, again, 90, a), GONIO_ERROR_ARGUMENT);
    assert_int_equal(gonio_material_read_slab(NULL, again, -1, a), GONIO_ERROR_ARGUMENT);
    free(a);
    gonio_material_free(&again);
    gonio_material_free(&material);
    support_remove(folder);
}

/* ---- log space ---- */

static void test_log_space_goes_round(void **state)
{
    (void)state;
    assert_close(gonio_log_scale(0) * 1500.0, 1.0, 1e-15);
    assert_close(gonio_log_scale(1) * 1500.0, 1.15, 1e-15);
    assert_close(gonio_log_scale(2) * 1500.0, 1.66, 1e-15);
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        for (double rho = 1e-10; rho < 1e8; rho *= 1.7) {
            const double g = gonio_log_from_brdf(rho, channel);
            const double x = rho / gonio_log_scale(channel);
            assert_close(expm1(g), x, 1e-13 * x * fmax(1.0, g));
            assert_close(gonio_brdf_from_log(g, channel), rho, 1e-13 * rho * fmax(1.0, g));
        }
        assert_true(gonio_log_from_brdf(0.0, channel) == 0.0);
        assert_true(gonio_brdf_from_log(-1.0, channel) == 0.0);
    }
}

static void test_slabs_in_log_space(void **state)
{
    (void)state;
    gonio_material *material = open_material("atlas:red-glossy-plastic");
    double *rho = malloc(2 * GONIO_SLAB_VALUES * sizeof *rho);
    double *g = rho + GONIO_SLAB_VALUES;
    static bool data[GONIO_SLAB_BINS];
    static gonio_slab_statistics statistics;
    assert_non_null(rho);
    for (int theta_h = 5; theta_h < GONIO_THETA_H_BINS; theta_h += 20) {
        assert_int_equal(gonio_material_read_slab(NULL, material, theta_h, rho), GONIO_OK);
        rho[7] = -1.0; /* one hole */
        rho[7 + GONIO_SLAB_BINS] = -1.0;
        rho[7 + 2 * GONIO_SLAB_BINS] = -1.0;
        gonio_slab_mask(theta_h, rho, data);
        gonio_slab_to_log(rho, g);
        gonio_slab_reduce(g, data, &statistics);
        assert_false(data[7]);
        for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
            for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
                double sum = 0.0;
                double squares = 0.0;
                int count = 0;
                for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
                    const int k = theta_d * GONIO_PHI_D_BINS + p;
                    const int v = channel * GONIO_SLAB_BINS + k;
                    assert_int_equal(
                        data[k], gonio_bin_is_valid((gonio_bin){theta_h, theta_d, p}) && k != 7);
                    const double expected = data[k] ? gonio_log_from_brdf(rho[v], channel) : 0.0;
                    assert_close(g[v], expected, 1e-14 * (1.0 + expected));
                    count += data[k];
                    sum += expected;
                    squares += expected * expected;
                }
                const double mean = count > 0 ? sum / count : 0.0;
                assert_int_equal(statistics.count[theta_d], count);
                assert_close(statistics.mean[theta_d][channel], mean, 1e-12);
                assert_close(statistics.scatter[theta_d][channel], squares - sum * mean,
                             1e-11 * (1.0 + squares));
            }
        }
    }
    free(rho);
    gonio_material_free(&material);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_value_at_a_centre_is_that_of_the_bin),
        cmocka_unit_test(test_holes_are_bridged_while_a_neighbour_has_data),
        cmocka_unit_test(test_albedo_of_a_lambertian),
        cmocka_unit_test(test_albedo_without_data),
        cmocka_unit_test(test_table_on_disk),
        cmocka_unit_test(test_log_space_goes_round),
        cmocka_unit_test(test_slabs_in_log_space),
    };
    return cmocka_run_group_tests_name("table", tests, NULL, NULL);
}
