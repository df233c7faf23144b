/* gonio benchmark: its simple methods, scores and means. */
#include "../support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "incidences.h"
#include "methods.h"
#include "score.h"
#include "summary.h"

enum { READINGS = 60, ELSEWHERE = 40 };

/* Directions spread over the hemisphere, none twice. */
static gonio_pair pair_at(int k)
{
    const double turn = 2.399963; /* the golden angle */
    return (gonio_pair){{1.2 * fmod(0.13 + 0.618034 * k, 1.0), 0.0},
                        {1.2 * fmod(0.37 + 0.754878 * k, 1.0), fmod(turn * k, 6.2)}};
}

/* A Lambertian part and a GGX lobe, by formulas other than the method's: Smith's G by Lambda. */
static double lambda(double theta, double a)
{
    return 0.5 * (sqrt(1.0 + pow(a * tan(theta), 2.0)) - 1.0);
}

static double model(gonio_pair pair, double d, double f0, double a)
{
    const gonio_half_difference at = gonio_half_difference_from_pair(pair);
    const double t = pow(tan(at.theta_h) / a, 2.0);
    const double lobe = 1.0 / (M_PI * a * a * pow(cos(at.theta_h), 4.0) * pow(1.0 + t, 2.0));
    const double g =
        1.0 / ((1.0 + lambda(pair.incident.theta, a)) * (1.0 + lambda(pair.outgoing.theta, a)));
    const double f = f0 + (1.0 - f0) * pow(1.0 - cos(at.theta_d), 5.0);
    return d / M_PI + f * lobe * g / (4.0 * cos(pair.incident.theta) * cos(pair.outgoing.theta));
}

static gonio_readings *read_model(void)
{
    gonio_pair pair[READINGS];
    double value[READINGS];
    gonio_readings *readings = NULL;
    for (int k = 0; k < READINGS; k++) {
        pair[k] = pair_at(k);
        value[k] = model(pair[k], 0.3, 0.06, 0.25);
    }
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = READINGS, .channels = 1, .pair = pair, .value = value};
    assert_int_equal(gonio_readings_create(NULL, &arrays, NULL, &readings), GONIO_OK);
    return readings;
}

static void complete(const benchmark_method *method, const gonio_readings *readings,
                     benchmark_completion *made)
{
    benchmark_setting setting;
    benchmark_setting_default(&setting);
    const benchmark_task task = {.setting = &setting, .readings = readings};
    assert_int_equal(method->complete(NULL, &task, made), GONIO_OK);
}

static void interpolation_keeps_readings(void **state)
{
    (void)state;
    gonio_readings *readings = read_model();
    const gonio_readings_view *view = gonio_readings_describe(readings);
    benchmark_completion made;
    double value[READINGS];
    complete(&benchmark_interpolation, readings, &made);
    assert_int_equal(made.predict(made.self, NULL, view->pair, READINGS, value, NULL), GONIO_OK);
    for (int k = 0; k < READINGS; k++) {
        assert_true(fabs(value[k] / view->value[k] - 1.0) < 1e-3);
    }
    benchmark_completion_free(&made);
    gonio_readings_free(&readings);
}

static void the_fit_finds_its_model(void **state)
{
    (void)state;
    gonio_readings *readings = read_model();
    benchmark_completion made;
    complete(&benchmark_lambert_ggx, readings, &made);
    for (int k = 0; k < ELSEWHERE; k++) {
        const gonio_pair pair = pair_at(READINGS + k);
        double value = 0.0;
        assert_int_equal(made.predict(made.self, NULL, &pair, 1, &value, NULL), GONIO_OK);
        assert_true(fabs(value / model(pair, 0.3, 0.06, 0.25) - 1.0) < 0.01);
    }
    benchmark_completion_free(&made);
    gonio_readings_free(&readings);
}

/* ---- scores ---- */

static double gain; /* of the predictions below */

static gonio_status predict_gained(void *self, gonio_context *context, const gonio_pair *pair,
                                   size_t count, double *values, double *deviations)
{
    (void)deviations;
    const gonio_status status = gonio_material_evaluate(context, self, pair, count, values);
    for (size_t k = 0; k < 3 * count; k++) {
        values[k] *= gain;
    }
    return status;
}

static double e6_of(const benchmark_sample *sample, double reach, double times, size_t *values)
{
    const benchmark_completion truth = {
        .self = sample->material, .predict = predict_gained, .expected = NAN};
    benchmark_score score;
    gonio_material *whole = NULL;
    gain = times;
    assert_int_equal(benchmark_score_table(NULL, sample, reach, &truth, &score, &whole), GONIO_OK);
    gonio_material_free(&whole);
    *values = score.values;
    assert_true(isnan(score.inside));
    return score.error.value[GONIO_E6];
}

static void the_truth_has_no_error(void **state)
{
    (void)state;
    char path[] = "atlas:oak-sawn";
    const benchmark_subject subject = {.path = path};
    const benchmark_pairs none = {0};
    benchmark_setting setting;
    benchmark_sample sample;
    size_t all = 0;
    size_t below = 0;
    benchmark_setting_default(&setting);
    assert_int_equal(benchmark_sample_open(NULL, &setting, &subject, &none, &sample), GONIO_OK);
    assert_true(e6_of(&sample, 0.5 * M_PI, 1.0, &all) < 1e-6);
    assert_true(e6_of(&sample, 80.0 * M_PI / 180.0, 1.0, &below) < 1e-6);
    assert_int_equal(all, 3 * 1096216);
    assert_true(below < all && below > all / 2);
    assert_true(e6_of(&sample, 80.0 * M_PI / 180.0, 1.2, &below) > 1.0);
    benchmark_sample_free(&sample);
}

/* ---- means ---- */

static char set_name[] = "set";

static benchmark_row row_of(const benchmark_subject *subject, const char *method, double e6,
                            double expected)
{
    benchmark_row row = {.subject = subject,
                         .ways = benchmark_directions_at(0),
                         .method = method,
                         .simple = method[0] != 'p',
                         .n = 20,
                         .expected = expected,
                         .expected_here = NAN,
                         .inside = NAN,
                         .psnr = NAN,
                         .delta_e_itp = NAN};
    row.error.value[GONIO_E6] = e6;
    return row;
}

static void means_count_losses_and_honesty(void **state)
{
    (void)state;
    const benchmark_subject subject[2] = {{.set = set_name}, {.set = set_name}};
    benchmark_row row[] = {row_of(&subject[0], "posterior", 4.0, 4.0),
                           row_of(&subject[0], "interpolation", 5.0, NAN),
                           row_of(&subject[0], "lambert-ggx", 3.0, NAN),
                           row_of(&subject[1], "posterior", 9.0, 3.0),
                           row_of(&subject[1], "interpolation", 8.0, NAN),
                           row_of(&subject[1], "lambert-ggx", 7.0, NAN)};
    const benchmark_rows rows = {.count = 6, .row = row};
    benchmark_summary summary;
    assert_int_equal(benchmark_summarise(NULL, &rows, &summary), GONIO_OK);
    assert_int_equal(summary.sets, 1);
    assert_int_equal(summary.count, 3);
    const benchmark_mean *m = &summary.mean[0];
    assert_string_equal(m->method, "posterior");
    assert_int_equal(m->rows, 2);
    assert_true(fabs(m->error.value[GONIO_E6] - 6.5) < 1e-12 && m->worst_e6 == 9.0);
    assert_true(m->lost_any == 1.0 && m->lost_all == 0.5);
    assert_true(m->expected.rows == 2 && m->expected.within == 0.5);
    assert_true(fabs(m->expected.ratio - sqrt(3.0)) < 1e-12);
    assert_true(isnan(m->inside) && m->here.rows == 0);
    assert_true(isnan(summary.mean[1].lost_any));
    benchmark_summary_free(&summary);
}

/* ---- two incidences ---- */

enum { LEVELS = 4, STEPS = 21, PAIRS_OF_LEVELS = 6, CHOSEN = 9 };

/* Readings in the plane at 10, 30, 50 and 70 degrees, every 8 degrees of the detector, and one out
 * of the plane for each. */
static size_t list_plane(gonio_pair *pair)
{
    size_t count = 0;
    for (int k = 0; k < LEVELS * STEPS; k++) {
        const double theta = (10.0 + 20.0 * (k % LEVELS)) * M_PI / 180.0;
        const double detector = (k / LEVELS - 10) * 8.0 * M_PI / 180.0;
        pair[count++] =
            (gonio_pair){{theta, 0.3}, {fabs(detector), detector > 0.0 ? 0.3 + M_PI : 0.3}};
        pair[count++] = (gonio_pair){{theta, 0.3}, {0.5, 1.3}};
    }
    return count;
}

/* Of each draw the two incidences, as a set of bits. */
static unsigned incidences_of(const benchmark_pairs *chosen)
{
    unsigned bits = 0;
    for (size_t k = 0; k < chosen->count; k++) {
        assert_true(benchmark_is_in_plane(&chosen->pair[k]));
        bits |= 1u << lround((chosen->pair[k].incident.theta * 180.0 / M_PI - 10.0) / 20.0);
        for (size_t j = 0; j < k; j++) {
            assert_memory_not_equal(&chosen->pair[j], &chosen->pair[k], sizeof(gonio_pair));
        }
    }
    return bits;
}

static void test_draws_take_all_pairs_of_incidences(void **state)
{
    (void)state;
    gonio_pair pair[2 * LEVELS * STEPS];
    benchmark_setting setting;
    benchmark_pairs chosen = {0};
    bool seen[1 << LEVELS] = {false};
    benchmark_setting_default(&setting);
    gonio_readings *known = read_model(); /* the sample is one of scattered readings */
    const benchmark_sample sample = {
        .known = known, .candidate = pair, .candidates = list_plane(pair)};
    for (size_t draw = 0; draw < PAIRS_OF_LEVELS; draw++) {
        const benchmark_choosing with = {.setting = &setting, .sample = &sample, .draw = draw};
        assert_int_equal(benchmark_choose_two_incidences(NULL, &with, CHOSEN, &chosen), GONIO_OK);
        assert_int_equal(chosen.count, CHOSEN);
        const unsigned bits = incidences_of(&chosen);
        assert_int_equal(__builtin_popcount(bits), 2);
        assert_false(seen[bits]);
        seen[bits] = true;
    }
    const benchmark_choosing with = {.setting = &setting, .sample = &sample};
    assert_int_equal(benchmark_choose_two_incidences(NULL, &with, 2 * STEPS + 1, &chosen),
                     GONIO_OK);
    assert_int_equal(chosen.count, 0); /* not so many at two incidences */
    free(chosen.pair);
    gonio_readings_free(&known);
}

/* Of tables any incidences; the detector keeps to the reach. */
static void test_two_incidences_of_tables(void **state)
{
    (void)state;
    benchmark_setting setting;
    benchmark_pairs chosen = {0};
    benchmark_setting_default(&setting);
    const benchmark_sample sample = {.known = NULL};
    const benchmark_choosing with = {.setting = &setting, .sample = &sample};
    assert_int_equal(benchmark_choose_two_incidences(NULL, &with, CHOSEN, &chosen), GONIO_OK);
    assert_int_equal(chosen.count, CHOSEN);
    for (size_t k = 0; k < CHOSEN; k++) {
        assert_true(benchmark_is_in_plane(&chosen.pair[k]));
        assert_true(chosen.pair[k].outgoing.theta <= setting.reach);
        assert_true(k == 0 || (k == 5) != (chosen.pair[k].incident.theta ==
                                           chosen.pair[k - 1].incident.theta));
    }
    free(chosen.pair);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(interpolation_keeps_readings),
                                       cmocka_unit_test(the_fit_finds_its_model),
                                       cmocka_unit_test(the_truth_has_no_error),
                                       cmocka_unit_test(means_count_losses_and_honesty),
                                       cmocka_unit_test(test_draws_take_all_pairs_of_incidences),
                                       cmocka_unit_test(test_two_incidences_of_tables)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
