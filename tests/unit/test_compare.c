/* Errors between materials, against sums that are known in closed form. */
#include "../support.h"

#include <math.h>

#include "made_material.h"

static const double values[GONIO_CHANNELS] = {0.05, 0.2, 3.0};

static void assert_close(double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected))) {
        fail_msg("%.17g where %.17g is expected (relative %g)", value, expected, relative);
    }
}

static gonio_material *scaled(double factor, bool (*is_hole)(gonio_bin bin))
{
    return made_material(
        (made_constant){{factor * values[0], factor * values[1], factor * values[2]}, is_hole});
}

static gonio_comparison compare(gonio_material *reference, gonio_material *other)
{
    gonio_comparison comparison;
    assert_int_equal(gonio_compare(NULL, reference, other, &comparison), GONIO_OK);
    gonio_material_free(&reference);
    gonio_material_free(&other);
    return comparison;
}

static void test_a_material_does_not_differ_from_itself(void **state)
{
    (void)state;
    const gonio_comparison c = compare(scaled(1.0, NULL), scaled(1.0, NULL));
    assert_true(c.all.value[GONIO_E6] == 0.0 && c.all.value[GONIO_CUBE_ROOT] == 0.0 &&
                c.all.value[GONIO_LOG_RELATIVE_ERROR] == 0.0);
    assert_int_equal(c.bins, 1096216);
    assert_int_equal(c.missing, 0);
}

/* The log-relative error of rho and s rho, summed over the bins. */
static double log_relative(double rho, double s)
{
    double sum = 0.0;
    int count = 0;
    for (int32_t index = 0; index < GONIO_BINS; index++) {
        const gonio_bin bin = gonio_bin_from_index(index);
        if (gonio_bin_is_valid(bin)) {
            double incident = 0.0;
            double outgoing = 0.0;
            gonio_cosines(gonio_bin_centre(bin), &incident, &outgoing);
            const double w = fmin(fmax(incident * outgoing, 0.01), 1.0);
            sum += pow(log((rho * w + 0.001) / (s * rho * w + 0.001)), 2.0);
            count++;
        }
    }
    return sqrt(sum / count);
}

static void test_a_scaled_material(void **state)
{
    (void)state;
    const double s = 1.7;
    const gonio_comparison c = compare(scaled(1.0, NULL), scaled(s, NULL));
    double difference = 0.0;
    double reference = 0.0;
    double mean_square = 0.0;
    for (int k = 0; k < GONIO_CHANNELS; k++) {
        const double g = gonio_log_from_brdf(values[k], k);
        const double d = gonio_log_from_brdf(s * values[k], k) - g;
        const double ratio = log_relative(values[k], s);
        difference += d * d;
        reference += g * g;
        mean_square += ratio * ratio / GONIO_CHANNELS;
        assert_close(c.channel[k].value[GONIO_E6], 100.0 * fabs(d) / g, 1e-10);
        assert_close(c.channel[k].value[GONIO_CUBE_ROOT], 100.0 * (cbrt(s) - 1.0), 1e-10);
        assert_close(c.channel[k].value[GONIO_LOG_RELATIVE_ERROR], ratio, 1e-10);
    }
    assert_close(c.all.value[GONIO_E6], 100.0 * sqrt(difference / reference), 1e-10);
    assert_close(c.all.value[GONIO_CUBE_ROOT], 100.0 * (cbrt(s) - 1.0), 1e-10);
    assert_close(c.all.value[GONIO_LOG_RELATIVE_ERROR], sqrt(mean_square), 1e-10);
}

static bool is_odd(gonio_bin bin)
{
    return bin.phi_d % 2 == 1;
}

static bool is_even(gonio_bin bin)
{
    return bin.phi_d % 2 == 0;
}

static void test_holes_do_not_count(void **state)
{
    (void)state;
    const gonio_comparison whole = compare(scaled(1.0, NULL), scaled(2.0, NULL));
    const gonio_comparison missing = compare(scaled(1.0, NULL), scaled(2.0, is_odd));
    const gonio_comparison less = compare(scaled(1.0, is_odd), scaled(2.0, NULL));
    assert_int_equal(missing.bins + missing.missing, whole.bins);
    assert_int_equal(missing.bins, whole.bins / 2);
    assert_int_equal(less.bins, whole.bins / 2);
    assert_int_equal(less.missing, 0);
    assert_close(missing.all.value[GONIO_E6], whole.all.value[GONIO_E6], 1e-12);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    gonio_comparison first = {0};
    for (int threads = 1; threads <= 3; threads++) {
        const gonio_context_options options = {.size = sizeof options, .threads = threads};
        gonio_context *context = NULL;
        gonio_material *a = NULL;
        gonio_material *b = NULL;
        gonio_comparison c;
        assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
        assert_int_equal(gonio_material_open(context, "atlas:red-cotton", &a), GONIO_OK);
        assert_int_equal(gonio_material_open(context, "atlas:oak-sawn", &b), GONIO_OK);
        assert_int_equal(gonio_compare(context, a, b, &c), GONIO_OK);
        first = threads == 1 ? c : first;
        assert_memory_equal(&c.all, &first.all, sizeof c.all);
        assert_memory_equal(&c.channel, &first.channel, sizeof c.channel);
        gonio_material_free(&a);
        gonio_material_free(&b);
        gonio_context_free(&context);
    }
}

/* Materials that depend on phi_h are compared over it; against itself there is no error, and the
 * mean over azimuths has one. */
static void test_anisotropic_materials(void **state)
{
    (void)state;
    gonio_material *steel = NULL;
    gonio_material *brass = NULL;
    gonio_comparison same;
    gonio_comparison other;
    gonio_comparison swapped;
    assert_int_equal(gonio_material_open(NULL, "atlas:steel-belt-ground", &steel), GONIO_OK);
    assert_int_equal(gonio_material_open(NULL, "atlas:brass-satin", &brass), GONIO_OK);
    assert_int_equal(gonio_compare(NULL, steel, steel, &same), GONIO_OK);
    assert_int_equal(gonio_compare(NULL, steel, brass, &other), GONIO_OK);
    assert_int_equal(gonio_compare(NULL, brass, steel, &swapped), GONIO_OK);
    assert_true(same.all.value[GONIO_E6] == 0.0);
    assert_true(other.all.value[GONIO_E6] > 5.0);
    assert_true(same.bins > 2500000 && same.missing == 0);
    assert_int_equal(swapped.bins + swapped.missing, other.bins + other.missing);
    gonio_material_free(&steel);
    gonio_material_free(&brass);
}

static void assert_incomparable(gonio_material *reference, gonio_material *other)
{
    gonio_comparison c;
    gonio_context *context = support_context();
    assert_int_equal(gonio_compare(context, reference, other, &c), GONIO_ERROR_DATA);
    assert_true(support_message()[0] != '\0');
    gonio_context_free(&context);
    gonio_material_free(&reference);
    gonio_material_free(&other);
}

static void test_what_cannot_be_compared(void **state)
{
    (void)state;
    assert_incomparable(scaled(1.0, is_odd), scaled(1.0, is_even));
    assert_incomparable(scaled(0.0, NULL), scaled(1.0, NULL));
}

/* The average over phi_d of what does not depend on it is itself. */
static void test_bivariate_average(void **state)
{
    (void)state;
    gonio_material *original = scaled(1.0, is_odd);
    gonio_material *average = NULL;
    gonio_comparison c;
    assert_int_equal(gonio_bivariate_material(NULL, original, &average), GONIO_OK);
    assert_int_equal(gonio_compare(NULL, original, average, &c), GONIO_OK);
    assert_true(c.all.value[GONIO_E6] < 1e-11 && c.missing == 0);
    gonio_material_free(&average);
    gonio_material_free(&original);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_material_does_not_differ_from_itself),
        cmocka_unit_test(test_a_scaled_material),
        cmocka_unit_test(test_holes_do_not_count),
        cmocka_unit_test(test_anisotropic_materials),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_what_cannot_be_compared),
        cmocka_unit_test(test_bivariate_average),
    };
    return cmocka_run_group_tests_name("compare", tests, NULL, NULL);
}
