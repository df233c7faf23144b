/* The fast bivariate average against the plain one. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>

#include <gonio/atlas.h>

#include "database/slab_mean.h"
#include "direction/grid.h"

enum { THETA_H = 60 }; /* a slab with valid, partly valid and empty rows */

/* Compares both ways on a slab; returns how many cells have data. */
static int compare(const double *rho)
{
    uint8_t first_phi[GONIO_THETA_D_BINS];
    double mean[GONIO_THETA_D_BINS * GONIO_CHANNELS];
    double *g = malloc(GONIO_SLAB_VALUES * sizeof *g);
    bool *data = malloc(GONIO_SLAB_BINS * sizeof *data);
    const double inverse_scale[GONIO_CHANNELS] = {
        1.0 / gonio_log_scale(0), 1.0 / gonio_log_scale(1), 1.0 / gonio_log_scale(2)};
    gonio_slab_statistics plain;
    gonio_slab_mask(THETA_H, rho, data);
    gonio_slab_to_log(rho, g);
    gonio_slab_reduce(g, data, &plain);
    for (int d = 0; d < GONIO_THETA_D_BINS; d++) {
        first_phi[d] = (uint8_t)gonio_i_first_valid_phi(THETA_H, d);
    }
    gonio_i_slab_mean(first_phi, rho, inverse_scale, mean);
    int cells = 0;
    for (int d = 0; d < GONIO_THETA_D_BINS; d++) {
        cells += plain.count[d] > 0;
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            const double fast = mean[d * GONIO_CHANNELS + c];
            if (plain.count[d] == 0) {
                assert_true(isnan(fast));
            } else {
                assert_true(fabs(fast - plain.mean[d][c]) <= 1e-13 * (1.0 + plain.mean[d][c]));
            }
        }
    }
    free(g);
    free(data);
    return cells;
}

static void test_agreement(void **state)
{
    (void)state;
    double *rho = malloc(GONIO_SLAB_VALUES * sizeof *rho);
    gonio_atlas_slab(0, THETA_H, rho);
    const int cells = compare(rho);
    assert_true(cells > 50 && cells <= GONIO_THETA_D_BINS);
    /* Holes, and a row without any data. */
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        const bool hole = k % 7 == 3 || k / GONIO_PHI_D_BINS == 5;
        for (size_t c = 0; c < GONIO_CHANNELS && hole; c++) {
            rho[c * GONIO_SLAB_BINS + k] = -1.0;
        }
    }
    assert_int_equal(compare(rho), cells - 1);
    free(rho);
}

/* Values whose product overflows, and values far below the scale. */
static void test_extremes(void **state)
{
    (void)state;
    double *rho = malloc(GONIO_SLAB_VALUES * sizeof *rho);
    for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
        rho[k] = k % 3 == 0 ? 1e300 : k % 3 == 1 ? 1e-300 : 0.0;
    }
    assert_true(compare(rho) > 50);
    free(rho);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_agreement),
        cmocka_unit_test(test_extremes),
    };
    return cmocka_run_group_tests_name("slab mean", tests, NULL, NULL);
}
