/* Every error metric of the table, against sums over single bins by formulas of its own. */
#include "../support.h"

#include <math.h>
#include <string.h>

#include "made_material.h"

/* One value of the sums: what is averaged, and what that is relative to. */
typedef struct term {
    double error;
    double reference;
} term;

static term e6_term(double rho, double other, double s, double cosines)
{
    (void)cosines;
    const double g = log(1.0 + rho / s);
    return (term){pow(g - log(1.0 + other / s), 2.0), g * g};
}

static term cube_root_term(double rho, double other, double s, double cosines)
{
    (void)s;
    const double r = pow(rho * cosines, 1.0 / 3.0);
    return (term){pow(r - pow(other * cosines, 1.0 / 3.0), 2.0), r * r};
}

static term log_relative_term(double rho, double other, double s, double cosines)
{
    (void)s;
    const double w = fmin(fmax(cosines, 0.01), 1.0);
    return (term){pow(log((rho * w + 0.001) / (other * w + 0.001)), 2.0), 1.0};
}

static term bias_term(double rho, double other, double s, double cosines)
{
    (void)cosines;
    return (term){log((s + other) / (s + rho)), 1.0};
}

static double percent_of_root(double ratio)
{
    return 100.0 * sqrt(ratio);
}

static double percent(double ratio)
{
    return 100.0 * ratio;
}

/* A metric without a row here has no independent computation, and fails. */
static const struct {
    const char *name;
    term (*term)(double rho, double other, double s, double cosines);
    double (*finish)(double ratio);
} direct[] = {
    {"e6", e6_term, percent_of_root},
    {"cube-root", cube_root_term, percent_of_root},
    {"log-relative", log_relative_term, sqrt},
    {"bias", bias_term, percent},
};

enum { DIRECT = sizeof direct / sizeof *direct };

/* Adds up to DIRECT pairs of sums over all channels of a bin. */
static void add_bin(gonio_bin bin, const double *rho, const double *other, term sums[DIRECT])
{
    double incident = 0.0;
    double outgoing = 0.0;
    gonio_cosines(gonio_bin_centre(bin), &incident, &outgoing);
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        for (size_t d = 0; d < DIRECT; d++) {
            const term t =
                direct[d].term(rho[c], other[c], gonio_log_scale(c), incident * outgoing);
            sums[d].error += t.error;
            sums[d].reference += t.reference;
        }
    }
}

static void sum_directly(const gonio_material *a, const gonio_material *b, term sums[DIRECT])
{
    gonio_table *reference = made_table(a);
    gonio_table *other = made_table(b);
    for (int32_t index = 0; index < GONIO_BINS; index++) {
        const gonio_bin bin = gonio_bin_from_index(index);
        double rho[GONIO_CHANNELS];
        double rho_other[GONIO_CHANNELS];
        if (gonio_bin_is_valid(bin) && gonio_table_value(reference, gonio_bin_centre(bin), rho) &&
            gonio_table_value(other, gonio_bin_centre(bin), rho_other)) {
            add_bin(bin, rho, rho_other, sums);
        }
    }
    gonio_table_free(&reference);
    gonio_table_free(&other);
}

static gonio_material *open(const char *path)
{
    gonio_material *material = NULL;
    assert_int_equal(gonio_material_open(NULL, path, &material), GONIO_OK);
    return material;
}

static gonio_error compare(const gonio_material *a, const gonio_material *b, int threads)
{
    const gonio_context_options options = {.size = sizeof options, .threads = threads};
    gonio_context *context = NULL;
    gonio_comparison comparison;
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    assert_int_equal(gonio_compare(context, a, b, &comparison), GONIO_OK);
    gonio_context_free(&context);
    return comparison.all;
}

static void assert_near(const char *name, double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%s: %.17g where %.17g is expected", name, value, expected);
    }
}

static void test_direct_sums(void **state)
{
    (void)state;
    gonio_material *a = open("atlas:oak-sawn");
    gonio_material *b = open("atlas:brass-satin");
    term sums[DIRECT] = {{0.0, 0.0}};
    sum_directly(a, b, sums);
    const gonio_error error = compare(a, b, 2);
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        const char *name = gonio_metric_describe(m)->name;
        size_t d = 0;
        while (d < DIRECT && strcmp(direct[d].name, name) != 0) {
            d++;
        }
        if (d == DIRECT) {
            fail_msg("%s has no independent computation in this test", name);
        }
        const double expected = direct[d].finish(sums[d].error / sums[d].reference);
        assert_near(name, error.value[m], expected, 1e-9 * fabs(expected));
    }
    gonio_material_free(&a);
    gonio_material_free(&b);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    gonio_material *a = open("atlas:red-cotton");
    gonio_material *b = open("atlas:oak-sawn");
    const gonio_error one = compare(a, b, 1);
    for (int threads = 2; threads <= 4; threads++) {
        const gonio_error more = compare(a, b, threads);
        assert_memory_equal(&more, &one, sizeof more);
    }
    gonio_material_free(&a);
    gonio_material_free(&b);
}

static void test_a_material_does_not_differ_from_itself(void **state)
{
    (void)state;
    gonio_material *a = open("atlas:white-linen");
    const gonio_error error = compare(a, a, 2);
    for (int m = 0; m < GONIO_MOST_METRICS; m++) {
        assert_true(error.value[m] == 0.0 && !signbit(error.value[m]));
    }
    gonio_material_free(&a);
}

static const double values[GONIO_CHANNELS] = {0.05, 0.2, 3.0};

static gonio_material *scaled(double factor)
{
    return made_material(
        (made_constant){{factor * values[0], factor * values[1], factor * values[2]}, NULL});
}

/* Too bright is above 0, too dark below, by as much; near 100 ln 1.1 where reflectance is far above
 * s. */
static void test_the_sign_and_size_of_bias(void **state)
{
    (void)state;
    gonio_material *plain = scaled(1.0);
    gonio_material *brighter = scaled(1.1);
    double expected = 0.0;
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        const double s = gonio_log_scale(c);
        expected += 100.0 * log((1.1 * values[c] + s) / (values[c] + s)) / GONIO_CHANNELS;
    }
    const double bright = compare(plain, brighter, 2).value[GONIO_BIAS];
    const double dark = compare(brighter, plain, 2).value[GONIO_BIAS];
    assert_near("brighter", bright, expected, 1e-9);
    assert_near("darker", dark, -expected, 1e-9);
    assert_near("about", bright, 100.0 * log(1.1), 0.1);
    gonio_material_free(&plain);
    gonio_material_free(&brighter);
}

static void test_names(void **state)
{
    (void)state;
    static const char *const known[] = {"e6", "cube-root", "log-relative", "bias"};
    static const gonio_metric metric[] = {GONIO_E6, GONIO_CUBE_ROOT, GONIO_LOG_RELATIVE_ERROR,
                                          GONIO_BIAS};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        assert_int_equal(gonio_metric_find(known[k]), (int)metric[k]);
    }
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        const gonio_metric_view *view = gonio_metric_describe(m);
        assert_int_equal(gonio_metric_find(view->name), m); /* so names differ */
        assert_true(strlen(view->key) > 0 && strlen(view->title) > 0 && strlen(view->summary) > 0);
        assert_true(strlen(view->heading) <= 9 && view->digits > 0);
    }
    assert_int_equal(gonio_metric_find("e7"), -1);
    assert_null(gonio_metric_describe(-1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_direct_sums),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_a_material_does_not_differ_from_itself),
        cmocka_unit_test(test_the_sign_and_size_of_bias),
        cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
