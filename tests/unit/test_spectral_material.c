/* Materials with spectra: their colours under illuminants, and reconstructions at wavelengths. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <gonio/gonio.h>

#include "made_basis.h"
#include "made_readings.h"

enum { WAVES = 31, THETA_H = 20 };

static double waves[WAVES]; /* 400, 410 .. 700 nm */

static int set_up(void **state)
{
    (void)state;
    for (int k = 0; k < WAVES; k++) {
        waves[k] = 400.0 + 10.0 * k;
    }
    return 0;
}

/* The same at all directions: 0.2 1/sr, or red. */
static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    (void)context;
    (void)pairs;
    for (size_t k = 0; k < count * WAVES; k++) {
        values[k] = *(const bool *)self && waves[k % WAVES] < 600.0 ? 0.02 : 0.2;
    }
    return GONIO_OK;
}

static gonio_material *make_spectral(bool *red)
{
    gonio_material *material = NULL;
    const gonio_material_source source = {.size = sizeof source,
                                          .evaluate = evaluate,
                                          .self = red,
                                          .channels = WAVES,
                                          .wavelength = waves};
    assert_int_equal(gonio_material_create(NULL, "made", "made for a test", &source, &material),
                     GONIO_OK);
    return material;
}

/* R, G, B of a bin that every material has. */
static void colours_of(const gonio_material *material, double rgb[GONIO_CHANNELS])
{
    double *slab = malloc(GONIO_SLAB_VALUES * sizeof *slab);
    assert_non_null(slab);
    assert_int_equal(gonio_material_read_slab(NULL, material, THETA_H, slab), GONIO_OK);
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        rgb[c] = slab[c * GONIO_SLAB_BINS + GONIO_PHI_D_BINS / 2];
    }
    free(slab);
}

/* A flat spectrum is white under each; another one has other colours. */
static void test_illuminants(void **state)
{
    (void)state;
    static const gonio_illuminant all[] = {GONIO_ILLUMINANT_E, GONIO_ILLUMINANT_D65,
                                           GONIO_ILLUMINANT_A};
    for (int kind = 0; kind < 2; kind++) {
        bool red = kind == 1;
        double rgb[3][GONIO_CHANNELS];
        gonio_material *material = make_spectral(&red);
        for (int k = 0; k < 3; k++) {
            assert_int_equal(gonio_material_set_illuminant(NULL, material, all[k]), GONIO_OK);
            colours_of(material, rgb[k]);
            for (int c = 0; c < GONIO_CHANNELS && !red; c++) {
                assert_true(fabs(rgb[k][c] - 0.2) < 1e-6);
            }
            assert_true(!red || (rgb[k][0] > 2.0 * rgb[k][1] && rgb[k][0] > 2.0 * rgb[k][2]));
        }
        assert_true(!red ||
                    (fabs(rgb[0][0] - rgb[1][0]) > 1e-4 && fabs(rgb[1][0] - rgb[2][0]) > 1e-4));
        gonio_material_free(&material);
    }
}

/* An RGL file keeps a spectrum that is the same at all directions. */
static void test_spectra_in_rgl_files(void **state)
{
    (void)state;
    bool red = true;
    gonio_material *material = make_spectral(&red);
    gonio_material *again = NULL;
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/red.bsdf", folder);
    assert_int_equal(gonio_material_write_rgl(NULL, material, path), GONIO_OK);
    assert_int_equal(gonio_material_open(NULL, path, &again), GONIO_OK);
    const gonio_material_view *view = gonio_material_describe(again);
    assert_int_equal(view->channels, WAVES);
    const gonio_pair pair = {{0.3, 0.0}, {0.5, 2.0}};
    double values[WAVES];
    assert_int_equal(gonio_material_evaluate(NULL, again, &pair, 1, values), GONIO_OK);
    for (int k = 0; k < WAVES; k++) {
        assert_true(fabs(view->wavelength[k] - waves[k]) < 1e-4);
        assert_true(fabs(values[k] / (waves[k] < 600.0 ? 0.02 : 0.2) - 1.0) < 1e-3);
    }
    gonio_material_free(&again);
    gonio_material_free(&material);
    support_remove(folder);
}

/* A reconstruction at wavelengths is a material of those wavelengths, with the predicted values. */
static void test_reconstructions_at_wavelengths(void **state)
{
    (void)state;
    enum { CHANNELS = 2 };
    static const double read[][4 + CHANNELS] = {{30, 0, 50, 40, 0.1, 0.2},
                                                {10, 0, 20, 0, 0.3, 0.4}};
    static const double at[CHANNELS] = {450.0, 650.0};
    const gonio_reconstruct_options options = {
        .size = sizeof options, .method = "posterior", .noise = 0.01};
    gonio_basis *basis = made_basis(NULL, GONIO_BIVARIATE, GONIO_SEPARATE, 1);
    gonio_readings *readings = made_spectra(&read[0][0], 2, CHANNELS, at, true);
    gonio_reconstruction *made = NULL;
    gonio_material *material = NULL;
    assert_int_equal(gonio_reconstruct(NULL, basis, readings, &options, &made), GONIO_OK);
    assert_int_equal(gonio_reconstruction_spectral_material(NULL, basis, made, "made", &material),
                     GONIO_OK);
    const gonio_material_view *view = gonio_material_describe(material);
    assert_int_equal(view->channels, CHANNELS);
    assert_true(view->wavelength[0] == at[0] && view->wavelength[1] == at[1]);
    for (int k = 0; k < 10; k++) {
        const gonio_pair pair = {{0.1 + 0.1 * k, 0.0}, {0.9 - 0.05 * k, 0.3 * k}};
        double value[CHANNELS], predicted[CHANNELS];
        assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, value), GONIO_OK);
        assert_true(gonio_reconstruction_predict(basis, made, gonio_half_difference_from_pair(pair),
                                                 predicted, NULL));
        for (int c = 0; c < CHANNELS; c++) {
            assert_true(fabs(value[c] - predicted[c]) <= 1e-12 * predicted[c]);
        }
    }
    gonio_material_free(&material);
    gonio_reconstruction_free(&made);
    gonio_readings_free(&readings);
    gonio_basis_free(&basis);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_illuminants),
        cmocka_unit_test(test_spectra_in_rgl_files),
        cmocka_unit_test(test_reconstructions_at_wavelengths),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
