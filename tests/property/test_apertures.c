/* Readings through an aperture that is wider than the lobe: of a material that was left out, with
 * noise, the peak is nearer the truth when the aperture is told. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>

#include <gonio/gonio.h>

#include "core/random.h"

enum { INCIDENCES = 5, AWAY = 7, READ = INCIDENCES * AWAY, SPIRAL = 200, LEARNED = 8 };

/* Fewer readings under the sanitizers. */
static int incidences(void)
{
    return support_small() ? 2 : INCIDENCES;
}

static const double DEGREE = M_PI / 180.0;
static const double HALF_ANGLE = 2.0 * M_PI / 180.0;

typedef struct fixture {
    gonio_context *context;
    gonio_basis *basis;
    gonio_material *material;
    gonio_readings *readings; /* through the aperture */
} fixture;

static fixture f;

static gonio_pair pair_at(int k)
{
    static const double away[AWAY] = {0.0, 2.0, -3.0, 6.0, -12.0, 25.0, -50.0};
    const double theta = (5.0 + 13.0 * (k / AWAY)) * DEGREE;
    const double out = theta + away[k % AWAY] * DEGREE;
    return (gonio_pair){{theta, 0.0}, {fabs(out), out >= 0.0 ? M_PI : 0.0}};
}

/* The direction at an angle from another, on its side `turn`. */
static gonio_angles beside(gonio_angles centre, double away, double turn)
{
    const double x = sin(away) * cos(turn);
    const double y = sin(away) * sin(turn);
    const double z = cos(away);
    const double along = x * cos(centre.theta) + z * sin(centre.theta);
    const double up = z * cos(centre.theta) - x * sin(centre.theta);
    return (gonio_angles){fmin(atan2(hypot(along, y), up), 1.57), centre.phi + atan2(y, along)};
}

static double value_at(gonio_pair pair, int channel)
{
    double value[GONIO_CHANNELS];
    assert_int_equal(gonio_material_evaluate(f.context, f.material, &pair, 1, value), GONIO_OK);
    return value[channel];
}

/* The mean over the aperture of the detector: evenly along a spiral, by which the library does not
 * cover apertures. */
static double seen_at(gonio_pair pair, int channel)
{
    double sum = 0.0;
    for (int j = 0; j < SPIRAL; j++) {
        const double away = HALF_ANGLE * sqrt((j + 0.5) / SPIRAL);
        const gonio_pair one = {pair.incident,
                                beside(pair.outgoing, away, j * M_PI * (3.0 - sqrt(5.0)))};
        sum += value_at(one, channel) / SPIRAL;
    }
    return sum;
}

static void read_all(void)
{
    gonio_pair pair[READ];
    double value[READ * GONIO_CHANNELS];
    gonio_i_random random;
    gonio_i_random_seed(&random, 3, 0);
    for (int k = 0; k < incidences() * AWAY; k++) {
        pair[k] = pair_at(k);
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            value[k * GONIO_CHANNELS + c] =
                seen_at(pair[k], c) * (1.0 + 0.01 * gonio_i_random_normal(&random));
        }
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = (size_t)incidences() * AWAY,
                                          .channels = GONIO_CHANNELS,
                                          .pair = pair,
                                          .value = value};
    assert_int_equal(gonio_readings_create(f.context, &arrays, NULL, &f.readings), GONIO_OK);
}

static int set_up(void **state)
{
    (void)state;
    static const char *const paths[LEARNED] = {"atlas:gold-polished",  "atlas:steel-mirror",
                                               "atlas:bronze-mirror",  "atlas:copper-polished",
                                               "atlas:chromium-satin", "atlas:oak-sawn",
                                               "atlas:steel-brushed",  "atlas:red-glossy-plastic"};
    gonio_recipe recipe;
    gonio_recipe_default(&recipe);
    recipe.mixtures = 20;
    recipe.analytic = 0;
    f.context = support_context();
    assert_int_equal(gonio_material_open(f.context, "atlas:platinum-polished", &f.material),
                     GONIO_OK);
    assert_int_equal(gonio_learn(f.context, paths, LEARNED, &recipe, &f.basis), GONIO_OK);
    read_all();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    gonio_readings_free(&f.readings);
    gonio_material_free(&f.material);
    gonio_basis_free(&f.basis);
    gonio_context_free(&f.context);
    return 0;
}

static gonio_status reconstruct(double source, double detector, gonio_reconstruction **made)
{
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    how.no_checks = true;
    how.source_aperture = source;
    how.detector_aperture = detector;
    return gonio_reconstruct(f.context, f.basis, f.readings, &how, made);
}

/* The mean error of ln f at the mirror directions. */
static double error_of_peak(const gonio_reconstruction *made)
{
    double sum = 0.0;
    for (int k = 0; k < incidences() * AWAY; k += AWAY) {
        const gonio_pair mirror = pair_at(k);
        double value[GONIO_CHANNELS];
        assert_true(gonio_reconstruction_predict(
            f.basis, made, gonio_half_difference_from_pair(mirror), value, NULL));
        sum += fabs(log(value[1] / value_at(mirror, 1))) / incidences();
    }
    return sum;
}

static void test_the_peak(void **state)
{
    (void)state;
    gonio_reconstruction *points = NULL;
    gonio_reconstruction *through = NULL;
    assert_int_equal(reconstruct(0.0, 0.0, &points), GONIO_OK);
    assert_int_equal(reconstruct(0.0, HALF_ANGLE, &through), GONIO_OK);
    const double without = error_of_peak(points);
    const double with = error_of_peak(through);
    print_message("error of ln f at the peak: %.2f as points, %.2f through the aperture\n", without,
                  with);
    assert_true(with <= 0.5 * without);
    gonio_reconstruction_free(&points);
    gonio_reconstruction_free(&through);
}

static void test_half_angles_that_are_none(void **state)
{
    (void)state;
    gonio_reconstruction *made = NULL;
    assert_int_equal(reconstruct(-0.1, 0.0, &made), GONIO_ERROR_ARGUMENT);
    assert_int_equal(reconstruct(0.0, 0.8, &made), GONIO_ERROR_ARGUMENT);
    assert_int_equal(reconstruct(0.0, NAN, &made), GONIO_ERROR_ARGUMENT);
    assert_null(made);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_peak),
        cmocka_unit_test(test_half_angles_that_are_none),
    };
    return cmocka_run_group_tests_name("apertures", tests, set_up, tear_down);
}
