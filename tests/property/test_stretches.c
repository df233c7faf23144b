/* Stretches that are weighed: what readings leave open of them, and planes of symmetry. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>

#include "../unit/made_basis.h"
#include "posterior/anisotropic.h"
#include "posterior/anisotropic_parts.h"
#include "posterior/stretch_spread.h"
#include "posterior/stretch_trials.h"

enum { READ = 30, ASKED = 40 };

#define GRAIN 1.1
static const gonio_i_stretch made_of = {.log_ratio = 1.0, .rotation = GRAIN};

typedef struct fixture {
    gonio_context *context;
    gonio_basis *basis;
    gonio_i_prior *prior;
    gonio_pair pair[READ];
    gonio_i_observation observation[READ];
    gonio_i_column column;
    gonio_i_oriented_columns columns;
} fixture;

/* In log space. It is not a stretched isotropic material alone, but the grain is a plane of
 * symmetry. */
static double truth_at(gonio_i_oriented here)
{
    double rho[GONIO_CHANNELS];
    gonio_atlas_value(gonio_atlas_find("red-glossy-plastic"), gonio_i_stretch_apply(&made_of, here),
                      rho);
    const double lobes = cos(2.0 * (here.phi_h - GRAIN)) + cos(4.0 * (here.phi_h - GRAIN));
    return gonio_log_from_brdf(rho[0] * exp(0.2 * sin(here.at.theta_h) * lobes), 0);
}

static int set_up(void **state)
{
    static fixture f;
    gonio_i_oriented place[READ];
    f.context = support_context();
    f.basis = made_basis(f.context, GONIO_SECTORED, GONIO_SEPARATE, 1);
    assert_int_equal(gonio_i_prior_create(f.context, f.basis, &f.prior), GONIO_OK);
    gonio_i_oriented_sample(7, READ, place);
    for (size_t k = 0; k < READ; k++) {
        f.pair[k] = gonio_i_oriented_pair(place[k]);
        f.observation[k] = (gonio_i_observation){
            .at = place[k].at, .g = truth_at(place[k]), .variance = 1e-3, .reading = k};
    }
    f.column = (gonio_i_column){READ, f.observation};
    f.columns = (gonio_i_oriented_columns){f.prior, f.pair, &f.column, 1, 0};
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    gonio_i_prior_free(&f->prior);
    gonio_basis_free(&f->basis);
    gonio_context_free(&f->context);
    return 0;
}

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g where %.17g is expected (within %g)", value, expected, tolerance);
    }
}

/* ---- steps ---- */

/* The ellipse of the ratio exp(-0.3) is that of exp(0.3) a quarter turn from it. */
static void test_a_step_beyond_circles_turns_the_grain(void **state)
{
    (void)state;
    const gonio_i_stretch from = {.log_ratio = 0.2, .rotation = 3.0, .symmetry = 2};
    const gonio_i_stretch to = gonio_i_stretch_moved(from, -0.5, 0.0);
    const gonio_i_stretch negative = {.log_ratio = -0.3, .rotation = 3.0, .symmetry = 2};
    assert_close(to.log_ratio, 0.3, 1e-12);
    for (int k = 0; k < 8; k++) {
        const gonio_i_oriented here = {{0.5, 0.4, 1.0}, 0.4 * k};
        assert_close(gonio_i_stretch_apply(&to, here).theta_h,
                     gonio_i_stretch_apply(&negative, here).theta_h, 1e-12);
    }
    const gonio_i_stretch on_the_way = gonio_i_stretch_moved(from, -0.2, 0.0);
    assert_true(on_the_way.log_ratio > 0.0); /* with the prior of a stretch */
}

static void test_large_and_small_ratios_are_less_likely(void **state)
{
    (void)state;
    assert_close(gonio_i_log_ratio_prior(0.0), 0.0, 0.0);
    assert_close(gonio_i_log_ratio_prior(1.0), 0.0, 1e-12);
    assert_close(gonio_i_log_ratio_prior(2.0), log(2.0) - 1.5, 1e-12);
    assert_true(gonio_i_log_ratio_prior(0.1) < -1.5);
    assert_true(gonio_i_log_ratio_prior(3.5) < gonio_i_log_ratio_prior(2.5));
}

/* ---- what is left open ---- */

static void test_stretches_around_share_the_weight(void **state)
{
    const fixture *f = *state;
    gonio_i_search s;
    gonio_i_hypothesis around[GONIO_I_SPREAD];
    const gonio_i_hypothesis h = {
        {.log_ratio = 1.0, .rotation = GRAIN, .share = 0.1, .symmetry = 2},
        {0.7, 0.12, 0.0, 0.0},
        -3.0};
    double sum = 0.0;
    assert_int_equal(gonio_i_search_begin(f->context, &f->columns, GONIO_I_SEARCH_COLUMNS,
                                          GONIO_I_SEARCH_READINGS, &s),
                     GONIO_OK);
    assert_int_equal(gonio_i_stretch_spread(&s, &h, around), GONIO_OK);
    gonio_i_search_end(&s);
    for (size_t k = 0; k < GONIO_I_SPREAD; k++) {
        sum += exp(around[k].weight);
        assert_true(around[k].weight < h.weight);
        assert_true(gonio_i_model_is_same(&around[k].model, &h.model));
        for (size_t j = 0; j < k; j++) {
            assert_true(around[k].stretch.log_ratio != around[j].stretch.log_ratio ||
                        around[k].stretch.rotation != around[j].stretch.rotation);
        }
    }
    assert_close(sum, exp(h.weight), 1e-12);
    assert_close(around[4].stretch.log_ratio, 1.0, 1e-12);
    assert_close(around[4].stretch.rotation, GRAIN, 1e-12);
}

static void test_weights_add_up(void **state)
{
    const fixture *f = *state;
    gonio_i_stretches found;
    double sum = 0.0;
    size_t mirrored = 0;
    size_t ratios = 0;
    assert_int_equal(gonio_i_stretches_weigh(f->context, &f->columns, &found), GONIO_OK);
    for (size_t k = 0; k < found.count; k++) {
        const gonio_i_hypothesis *h = &found.hypothesis[k];
        sum += h->weight;
        assert_true(h->weight > 0.0);
        assert_true(k == 0 || h->weight <= found.hypothesis[k - 1].weight);
        mirrored += h->stretch.mirrored;
        ratios += k > 0 && h->stretch.mirrored == found.hypothesis[0].stretch.mirrored &&
                  h->stretch.log_ratio != found.hypothesis[0].stretch.log_ratio;
    }
    assert_close(sum, 1.0, 1e-12);
    assert_true(mirrored > 0);
    assert_true(ratios > 0); /* more than one */
}

/* The plane of symmetry is that of the grain, not the one a quarter turn from it. */
static void test_the_grain_is_told_from_a_quarter_turn(void **state)
{
    const fixture *f = *state;
    gonio_i_stretches found;
    assert_int_equal(gonio_i_stretches_weigh(f->context, &f->columns, &found), GONIO_OK);
    assert_true(found.likeliest.log_ratio > 0.5 && found.likeliest.log_ratio < 1.5);
    assert_true(fabs(remainder(found.likeliest.rotation - GRAIN, M_PI)) < 0.2);
}

/* ---- planes of symmetry ---- */

/* The largest difference of predictions at mirrored half vectors, if a mirrored hypothesis has all
 * weight. */
static double difference_of_images(const fixture *f)
{
    gonio_i_anisotropic *a = NULL;
    gonio_i_oriented place[ASKED];
    double most = 0.0;
    double g[2];
    double variance[2];
    assert_int_equal(gonio_i_anisotropic_find(f->context, &f->columns, &a), GONIO_OK);
    double *scratch = calloc(gonio_i_anisotropic_scratch(a), sizeof *scratch);
    assert_non_null(scratch);
    size_t kept = 0;
    while (kept < a->parts && !a->part[kept].hypothesis.stretch.mirrored) {
        kept++;
    }
    assert_true(kept < a->parts);
    for (size_t p = 0; p < a->parts; p++) {
        a->part[p].hypothesis.weight = p == kept ? 1.0 : 0.0;
    }
    gonio_i_oriented_sample(9, ASKED, place);
    for (size_t k = 0; k < ASKED; k++) {
        gonio_i_oriented image = place[k];
        image.phi_h = 2.0 * a->part[kept].hypothesis.stretch.rotation - place[k].phi_h;
        gonio_i_anisotropic_at(a, place[k], scratch, &g[0], &variance[0]);
        gonio_i_anisotropic_at(a, image, scratch, &g[1], &variance[1]);
        most = fmax(most, fabs(g[0] - g[1]) + fabs(variance[0] - variance[1]));
    }
    free(scratch);
    gonio_i_anisotropic_free(&a);
    return most;
}

static void test_mirrored_directions_are_predicted_alike(void **state)
{
    const fixture *f = *state;
    assert_close(difference_of_images(f), 0.0, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_step_beyond_circles_turns_the_grain),
        cmocka_unit_test(test_large_and_small_ratios_are_less_likely),
        cmocka_unit_test(test_stretches_around_share_the_weight),
        cmocka_unit_test(test_weights_add_up),
        cmocka_unit_test(test_the_grain_is_told_from_a_quarter_turn),
        cmocka_unit_test(test_mirrored_directions_are_predicted_alike),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
