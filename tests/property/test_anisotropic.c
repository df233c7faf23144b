/* Anisotropic reconstruction on a small basis of isotropic materials: stretched materials are
 * found, isotropic ones stay, plans go on, and threads do not matter. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "prior/stretch.h"
#include "../unit/made_basis.h"

enum { READ = 40, ASKED = 200 };

typedef struct fixture {
    gonio_context *context;
    gonio_basis *basis;
    gonio_pair read[READ];
    gonio_pair asked[ASKED];
} fixture;

static void draw(uint64_t seed, size_t count, gonio_pair *pairs)
{
    gonio_i_oriented *place = calloc(count, sizeof *place);
    assert_non_null(place);
    gonio_i_oriented_sample(seed, count, place);
    for (size_t k = 0; k < count; k++) {
        pairs[k] = gonio_i_oriented_pair(place[k]);
    }
    free(place);
}

static int set_up(void **state)
{
    static fixture f;
    const gonio_context_options two = {.size = sizeof two, .threads = 2};
    assert_int_equal(gonio_context_create(&f.context, &two), GONIO_OK);
    f.basis = made_basis(f.context, GONIO_SECTORED, GONIO_SEPARATE, 1);
    draw(11, READ, f.read);
    draw(12, ASKED, f.asked);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_basis_free(&f->basis);
    gonio_context_free(&f->context);
    return 0;
}

/* A material of the basis with every half vector stretched; for fibres, a polished wood, and for
 * facets, a ground metal. */
static void evaluate(const gonio_i_stretch *stretch, gonio_pair pair, double rho[GONIO_CHANNELS])
{
    const gonio_half_difference at = gonio_i_stretch_apply(stretch, gonio_i_oriented_of(pair));
    const char *name = stretch->fibres ? "mahogany-ribbon-polished" : "steel-belt-ground";
    if (stretch->fibres || stretch->facets) {
        gonio_atlas_anisotropic_value(gonio_atlas_anisotropic_find(name), pair, rho);
    } else {
        gonio_atlas_value(gonio_atlas_find("red-glossy-plastic"), at, rho);
    }
}

static gonio_readings *readings_of(const fixture *f, const gonio_i_stretch *stretch,
                                   const gonio_pair *pairs, size_t count)
{
    double *value = calloc(count * GONIO_CHANNELS, sizeof *value);
    gonio_readings *readings = NULL;
    assert_non_null(value);
    for (size_t k = 0; k < count; k++) {
        evaluate(stretch, pairs[k], value + k * GONIO_CHANNELS);
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = count,
                                          .channels = GONIO_CHANNELS,
                                          .pair = pairs,
                                          .value = value};
    assert_int_equal(gonio_readings_create(f->context, &arrays, NULL, &readings), GONIO_OK);
    free(value);
    return readings;
}

static gonio_anisotropic_reconstruction *reconstruct(const fixture *f,
                                                     const gonio_readings *readings)
{
    gonio_anisotropic_reconstruction *made = NULL;
    assert_int_equal(gonio_reconstruct_anisotropic(f->context, f->basis, readings, NULL, &made),
                     GONIO_OK);
    return made;
}

static double error_of(const gonio_i_stretch *stretch, const gonio_pair *pairs, size_t count,
                       const double *value)
{
    double error = 0.0;
    double square = 0.0;
    for (size_t k = 0; k < count; k++) {
        double rho[GONIO_CHANNELS];
        evaluate(stretch, pairs[k], rho);
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            const double g = log1p(rho[c] / gonio_log_scale(c));
            const double found = log1p(value[k * GONIO_CHANNELS + c] / gonio_log_scale(c));
            error += (g - found) * (g - found);
            square += g * g;
        }
    }
    return 100.0 * sqrt(error / square);
}

/* The error of the isotropic model at the pairs asked for, per cent. */
static double isotropic_error(const fixture *f, const gonio_i_stretch *stretch,
                              const gonio_readings *readings)
{
    gonio_reconstruct_options how;
    gonio_reconstruction *made = NULL;
    double value[ASKED * GONIO_CHANNELS];
    gonio_reconstruct_options_default(&how);
    how.no_checks = true;
    assert_int_equal(gonio_reconstruct(f->context, f->basis, readings, &how, &made), GONIO_OK);
    for (size_t k = 0; k < ASKED; k++) {
        assert_true(gonio_reconstruction_predict(f->basis, made,
                                                 gonio_half_difference_from_pair(f->asked[k]),
                                                 value + k * GONIO_CHANNELS, NULL));
    }
    gonio_reconstruction_free(&made);
    return error_of(stretch, f->asked, ASKED, value);
}

static void predict(const fixture *f, const gonio_anisotropic_reconstruction *made, double *value,
                    double *deviation)
{
    assert_int_equal(gonio_anisotropic_reconstruction_predict(f->context, made, f->asked, ASKED,
                                                              value, deviation),
                     GONIO_OK);
}

static void test_a_stretched_material_is_found(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch stretch = {.log_ratio = log(3.0), .rotation = 1.0};
    gonio_readings *readings = readings_of(f, &stretch, f->read, READ);
    gonio_anisotropic_reconstruction *made = reconstruct(f, readings);
    const gonio_anisotropic_reconstruction_view *view =
        gonio_anisotropic_reconstruction_describe(made);
    double value[ASKED * GONIO_CHANNELS];
    double deviation[ASKED * GONIO_CHANNELS];
    predict(f, made, value, deviation);
    assert_int_equal(view->readings, READ);
    assert_int_equal(view->channels, GONIO_CHANNELS);
    assert_true(view->anisotropy.probability > 0.99);
    assert_true(view->anisotropy.axis_ratio > 2.0 && view->anisotropy.axis_ratio < 4.5);
    assert_true(fabs(remainder(view->anisotropy.rotation - 1.0, M_PI)) < 0.15);
    assert_false(view->anisotropy.cannot_tell);
    assert_true(error_of(&stretch, f->asked, ASKED, value) <
                0.4 * isotropic_error(f, &stretch, readings));
    for (size_t k = 0; k < ASKED * GONIO_CHANNELS; k++) {
        assert_true(value[k] >= 0.0 && isfinite(value[k]));
        assert_true(deviation[k] > 0.0 && isfinite(deviation[k]));
    }
    gonio_anisotropic_reconstruction_free(&made);
    gonio_readings_free(&readings);
}

static void test_an_isotropic_material_stays(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch none = {0};
    gonio_readings *readings = readings_of(f, &none, f->read, READ);
    gonio_anisotropic_reconstruction *made = reconstruct(f, readings);
    double value[ASKED * GONIO_CHANNELS];
    predict(f, made, value, NULL);
    assert_true(gonio_anisotropic_reconstruction_describe(made)->anisotropy.probability < 0.5);
    assert_true(error_of(&none, f->asked, ASKED, value) <
                1.05 * isotropic_error(f, &none, readings) + 0.05);
    gonio_anisotropic_reconstruction_free(&made);
    gonio_readings_free(&readings);
}

static void test_threads_do_not_matter(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch stretch = {.log_ratio = 1.0, .rotation = 2.0};
    const gonio_context_options one = {.size = sizeof one, .threads = 1};
    fixture alone = *f;
    double value[2][ASKED * GONIO_CHANNELS];
    gonio_readings *readings = readings_of(f, &stretch, f->read, READ);
    assert_int_equal(gonio_context_create(&alone.context, &one), GONIO_OK);
    gonio_anisotropic_reconstruction *a = reconstruct(f, readings);
    gonio_anisotropic_reconstruction *b = reconstruct(&alone, readings);
    predict(f, a, value[0], NULL);
    predict(&alone, b, value[1], NULL);
    assert_memory_equal(value[0], value[1], sizeof value[0]);
    gonio_anisotropic_reconstruction_free(&a);
    gonio_anisotropic_reconstruction_free(&b);
    gonio_readings_free(&readings);
    gonio_context_free(&alone.context);
}

static void test_readings_are_predicted_with_deviations(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch stretch = {.log_ratio = 1.0, .rotation = 2.0};
    gonio_readings *readings = readings_of(f, &stretch, f->read, READ);
    gonio_anisotropic_reconstruction *made = reconstruct(f, readings);
    assert_int_equal(gonio_anisotropic_reconstruction_predict_readings(f->context, made, readings),
                     GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, READ);
    assert_non_null(view->deviation);
    gonio_anisotropic_reconstruction_free(&made);
    gonio_readings_free(&readings);
}

/* ---- as a material ---- */

/* RMS of the differences in log space of a material to predictions where both directions are. */
static double apart_in_log(const fixture *f, const gonio_material *material,
                           const double *predicted)
{
    double value[ASKED * GONIO_CHANNELS];
    double sum = 0.0;
    double square = 0.0;
    assert_int_equal(gonio_material_evaluate(f->context, material, f->asked, ASKED, value),
                     GONIO_OK);
    for (size_t k = 0; k < (size_t)ASKED * GONIO_CHANNELS; k++) {
        const int channel = (int)(k % GONIO_CHANNELS);
        const double g = gonio_log_from_brdf(predicted[k], channel);
        const double there = isnan(value[k]) ? g : gonio_log_from_brdf(value[k], channel);
        sum += (g - there) * (g - there);
        square += g * g;
    }
    return sqrt(sum / square);
}

static void test_the_material_is_the_prediction(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch stretch = {.facets = true};
    const gonio_context_options one = {.size = sizeof one, .threads = 1};
    gonio_material *material[2] = {NULL, NULL};
    double value[2][ASKED * GONIO_CHANNELS];
    gonio_readings *readings = readings_of(f, &stretch, f->read, READ);
    gonio_anisotropic_reconstruction *made = reconstruct(f, readings);
    gonio_context *alone = NULL;
    predict(f, made, value[0], NULL);
    assert_int_equal(gonio_context_create(&alone, &one), GONIO_OK);
    assert_int_equal(gonio_anisotropic_reconstruction_material(f->context, made, "m", &material[0]),
                     GONIO_OK);
    assert_int_equal(gonio_anisotropic_reconstruction_material(alone, made, "m", &material[1]),
                     GONIO_OK);
    gonio_anisotropic_reconstruction_free(&made);
    assert_true(gonio_material_describe(material[0])->anisotropic);
    assert_true(apart_in_log(f, material[0], value[0]) < 0.01);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(
            gonio_material_evaluate(f->context, material[k], f->asked, ASKED, value[k]), GONIO_OK);
    }
    assert_memory_equal(value[0], value[1], sizeof value[0]);
    gonio_material_free(&material[0]);
    gonio_material_free(&material[1]);
    gonio_readings_free(&readings);
    gonio_context_free(&alone);
}

/* Kappa of fibres depends on theta_d, unlike that of stretches. */
static void test_the_material_of_fibres_is_the_prediction(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch fibres = {.fibres = true};
    double value[ASKED * GONIO_CHANNELS];
    gonio_material *material = NULL;
    gonio_readings *readings = readings_of(f, &fibres, f->read, READ);
    gonio_anisotropic_reconstruction *made = reconstruct(f, readings);
    predict(f, made, value, NULL);
    const gonio_anisotropy *found = &gonio_anisotropic_reconstruction_describe(made)->anisotropy;
    const double error = error_of(&fibres, f->asked, ASKED, value);
    assert_true(found->fibres && found->axis_ratio == 1.0);
    assert_true(fabs(remainder(found->rotation - 50.0 * M_PI / 180.0, M_PI)) < 0.15);
    assert_true(error < 0.4 * isotropic_error(f, &fibres, readings));
    assert_int_equal(gonio_anisotropic_reconstruction_material(f->context, made, "m", &material),
                     GONIO_OK);
    assert_true(apart_in_log(f, material, value) < 0.01);
    gonio_anisotropic_reconstruction_free(&made);
    gonio_material_free(&material);
    gonio_readings_free(&readings);
}

/* A lobe of facets is found, with its grain, also by a basis without metals. */
static void test_stretched_facets_are_found(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch facets = {.facets = true};
    double value[ASKED * GONIO_CHANNELS];
    gonio_readings *readings = readings_of(f, &facets, f->read, READ);
    gonio_anisotropic_reconstruction *made = reconstruct(f, readings);
    const gonio_anisotropic_reconstruction_view *view =
        gonio_anisotropic_reconstruction_describe(made);
    predict(f, made, value, NULL);
    assert_true(view->anisotropy.axis_ratio > 2.0);
    assert_true(fabs(remainder(view->anisotropy.rotation - M_PI / 6.0, M_PI)) < 0.1);
    assert_true(error_of(&facets, f->asked, ASKED, value) <
                0.25 * isotropic_error(f, &facets, readings));
    gonio_anisotropic_reconstruction_free(&made);
    gonio_readings_free(&readings);
}

/* The likeliest stretch of this material is a small one along the wrong axis, at 91 degrees. */
static void test_the_grain_is_that_of_the_predicted_lobe(void **state)
{
    const fixture *f = *state;
    const int metal = gonio_atlas_anisotropic_find("aluminium-fine-brushed");
    double value[READ * GONIO_CHANNELS];
    gonio_readings *readings = NULL;
    for (size_t k = 0; k < READ; k++) {
        gonio_atlas_anisotropic_value(metal, f->read[k], value + k * GONIO_CHANNELS);
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = READ,
                                          .channels = GONIO_CHANNELS,
                                          .pair = f->read,
                                          .value = value};
    assert_int_equal(gonio_readings_create(f->context, &arrays, NULL, &readings), GONIO_OK);
    gonio_anisotropic_reconstruction *made = reconstruct(f, readings);
    const double found = gonio_anisotropic_reconstruction_describe(made)->anisotropy.rotation;
    assert_true(found >= 0.0 && found < M_PI);
    assert_true(fabs(remainder(found, M_PI)) < 0.15);
    gonio_anisotropic_reconstruction_free(&made);
    gonio_readings_free(&readings);
}

/* ---- checks of isotropy ---- */

static gonio_isotropy_check check(const fixture *f, const gonio_i_stretch *stretch,
                                  const gonio_pair *pairs, size_t count)
{
    gonio_isotropy_check found;
    gonio_readings *readings = readings_of(f, stretch, pairs, count);
    assert_int_equal(gonio_check_isotropy(f->context, f->basis, readings, NULL, &found), GONIO_OK);
    gonio_readings_free(&readings);
    return found;
}

static void test_isotropy_is_checked(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch none = {0};
    const gonio_i_stretch stretch = {.log_ratio = log(2.0), .rotation = 0.3};
    const gonio_isotropy_check isotropic = check(f, &none, f->read, READ);
    const gonio_isotropy_check few = check(f, &none, f->read, 6);
    const gonio_isotropy_check anisotropic = check(f, &stretch, f->read, READ);
    assert_true(isotropic.anisotropy.probability < 0.2);
    assert_true(isotropic.ratio_limit < 2.0);
    assert_true(few.more > 0);
    assert_true(anisotropic.anisotropy.probability > 0.95);
    assert_int_equal(anisotropic.more, 0);
}

static void test_one_azimuth_cannot_tell(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch none = {0};
    gonio_i_oriented place[READ];
    gonio_pair pairs[READ];
    gonio_i_oriented_sample(4, READ, place);
    for (size_t k = 0; k < READ; k++) {
        place[k].phi_h = 0.7;
        pairs[k] = gonio_i_oriented_pair(place[k]);
    }
    assert_true(check(f, &none, pairs, READ).anisotropy.cannot_tell);
}

static void test_other_symmetries_are_refused(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch none = {0};
    gonio_isotropy_check found;
    gonio_reconstruct_options how;
    gonio_readings *readings = readings_of(f, &none, f->read, READ);
    gonio_reconstruct_options_default(&how);
    how.symmetry = 3;
    assert_int_equal(gonio_check_isotropy(f->context, f->basis, readings, &how, &found),
                     GONIO_ERROR_ARGUMENT);
    gonio_readings_free(&readings);
}

/* ---- plans ---- */

static double apart(gonio_pair a, gonio_pair b)
{
    return fabs(a.incident.theta - b.incident.theta) + fabs(a.outgoing.theta - b.outgoing.theta) +
           fabs(remainder(a.incident.phi - b.incident.phi, 2.0 * M_PI)) +
           fabs(remainder(a.outgoing.phi - b.outgoing.phi, 2.0 * M_PI));
}

static void test_a_plan_is_at_many_azimuths_and_goes_on(void **state)
{
    const fixture *f = *state;
    const gonio_i_stretch stretch = {.log_ratio = 1.0, .rotation = 2.0};
    gonio_plan_options how;
    gonio_plan *plan = NULL;
    gonio_plan *more = NULL;
    double now = 0.0;
    gonio_plan_options_default(&how);
    how.anisotropic = true;
    how.count = 10;
    how.candidates = f->asked;
    how.candidate_count = ASKED;
    assert_int_equal(gonio_plan_create(f->context, f->basis, &how, &plan), GONIO_OK);
    assert_int_equal(plan->count, 10);
    gonio_pair pairs[10];
    for (size_t k = 0; k < 10; k++) {
        pairs[k] = plan->entries[k].pair;
        assert_true(k == 0 || plan->expected[k] <= plan->expected[k - 1]);
    }
    gonio_readings *readings = readings_of(f, &stretch, pairs, 10);
    how.count = 5;
    assert_int_equal(gonio_plan_next(f->context, f->basis, readings, NULL, &how, &now, NULL, &more),
                     GONIO_OK);
    assert_int_equal(more->count, 5);
    assert_true(now > 0.0 && more->expected[4] < now);
    for (size_t k = 0; k < 5; k++) {
        for (size_t i = 0; i < 10; i++) {
            assert_true(apart(more->entries[k].pair, pairs[i]) > 1e-3);
        }
    }
    gonio_plan_free(&plan);
    gonio_plan_free(&more);
    gonio_readings_free(&readings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_stretched_material_is_found),
        cmocka_unit_test(test_an_isotropic_material_stays),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_readings_are_predicted_with_deviations),
        cmocka_unit_test(test_the_material_is_the_prediction),
        cmocka_unit_test(test_the_material_of_fibres_is_the_prediction),
        cmocka_unit_test(test_stretched_facets_are_found),
        cmocka_unit_test(test_the_grain_is_that_of_the_predicted_lobe),
        cmocka_unit_test(test_isotropy_is_checked),
        cmocka_unit_test(test_one_azimuth_cannot_tell),
        cmocka_unit_test(test_other_symmetries_are_refused),
        cmocka_unit_test(test_a_plan_is_at_many_azimuths_and_goes_on),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
