/* Readings along the chain from learning to prediction, in memory: of a plan, as arrays, from a
 * file; standard deviations and channels of any number in the posterior. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

enum { MATERIALS = 6, PLANNED = 10 };

static gonio_context *context;
static gonio_basis *basis;
static gonio_plan *plan;
static gonio_table *truth;

static const char *const names[MATERIALS] = {"atlas:gold-polished",   "atlas:red-glossy-plastic",
                                             "atlas:burgundy-velvet", "atlas:oak-sawn",
                                             "atlas:red-cotton",      "atlas:plaster-cast"};

static void open_materials(gonio_material *material[MATERIALS])
{
    for (size_t k = 0; k < MATERIALS; k++) {
        assert_int_equal(gonio_material_open(context, names[k], &material[k]), GONIO_OK);
    }
}

/* Materials in memory -> database -> basis. */
static gonio_basis *learn(void)
{
    const gonio_database_options grid = {
        .size = sizeof grid, .representation = GONIO_SECTORED, .channels = GONIO_SEPARATE};
    const gonio_basis_options how = {.size = sizeof how, .mixtures = 30};
    gonio_material *material[MATERIALS];
    gonio_database *database = NULL;
    gonio_basis *learned = NULL;
    open_materials(material);
    assert_int_equal(gonio_database_create_from_materials(context,
                                                          (const gonio_material *const *)material,
                                                          MATERIALS, &grid, &database),
                     GONIO_OK);
    for (size_t k = 0; k < MATERIALS; k++) {
        gonio_material_free(&material[k]);
    }
    assert_int_equal(gonio_basis_learn(context, database, &how, &learned), GONIO_OK);
    gonio_database_free(&database);
    return learned;
}

static int set_up(void **state)
{
    (void)state;
    gonio_plan_options how;
    gonio_material *material = NULL;
    context = support_context();
    basis = learn();
    gonio_plan_options_default(&how);
    how.count = PLANNED;
    assert_int_equal(gonio_plan_create(context, basis, &how, &plan), GONIO_OK);
    assert_int_equal(gonio_material_open(context, "atlas:white-linen", &material), GONIO_OK);
    assert_int_equal(gonio_table_load(context, material, &truth), GONIO_OK);
    gonio_material_free(&material);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    gonio_table_free(&truth);
    gonio_plan_free(&plan);
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    return 0;
}

static gonio_readings *measure_the_plan(void)
{
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_create_from_plan(context, plan, &readings), GONIO_OK);
    assert_int_equal(gonio_measure(context, readings, truth, NULL), GONIO_OK);
    return readings;
}

static gonio_reconstruction *reconstruct(const gonio_readings *readings, double noise)
{
    gonio_reconstruct_options how;
    gonio_reconstruction *made = NULL;
    gonio_reconstruct_options_default(&how);
    how.noise = noise;
    how.no_checks = true;
    if (gonio_reconstruct(context, basis, readings, &how, &made) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    return made;
}

static void assert_same_field(const gonio_reconstruction *a, const gonio_reconstruction *b,
                              double tolerance)
{
    const size_t values = a->columns * gonio_basis_describe(basis)->rows;
    assert_int_equal(a->columns, b->columns);
    for (size_t k = 0; k < values; k++) {
        assert_true(fabs(a->field[k] - b->field[k]) <= tolerance);
    }
}

/* ---- from a plan, from arrays, from a file ---- */

static void test_a_plan_as_readings(void **state)
{
    (void)state;
    gonio_readings *readings = NULL;
    assert_int_equal(gonio_readings_create_from_plan(context, plan, &readings), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(readings);
    assert_int_equal(view->count, PLANNED);
    assert_int_equal(view->channels, GONIO_CHANNELS);
    assert_true(gonio_readings_are_colours(readings));
    assert_true(view->basis == plan->basis);
    assert_int_equal(view->components, 0); /* as the file of such a plan */
    assert_string_equal(view->method, plan->method);
    for (size_t k = 0; k < PLANNED; k++) {
        assert_true(view->pair[k].incident.theta == plan->entries[k].pair.incident.theta);
        assert_true(view->pair[k].outgoing.phi == plan->entries[k].pair.outgoing.phi);
        assert_int_equal(view->planned[k], plan->entries[k].channel);
        assert_true(isnan(view->value[k * GONIO_CHANNELS]));
    }
    gonio_readings_free(&readings);
    assert_null(readings);
}

/* Learning, planning, measuring, reconstructing and predicting, without a file. */
static void test_the_chain_in_memory(void **state)
{
    (void)state;
    gonio_readings *readings = measure_the_plan();
    gonio_readings *predicted = NULL;
    gonio_reconstruction *made = reconstruct(readings, 0.01);
    gonio_error error;
    size_t compared = 0;
    assert_int_equal(gonio_readings_create_from_plan(context, plan, &predicted), GONIO_OK);
    assert_int_equal(gonio_reconstruction_predict_readings(context, basis, made, predicted),
                     GONIO_OK);
    assert_int_equal(gonio_compare_readings(context, readings, predicted, NULL, &error, &compared),
                     GONIO_OK);
    print_message("E6 %.2f %% at the %zu readings\n", error.value[GONIO_E6], compared);
    assert_int_equal(compared, PLANNED);
    assert_true(error.value[GONIO_E6] < 5.0);
    gonio_reconstruction_free(&made);
    gonio_readings_free(&predicted);
    gonio_readings_free(&readings);
}

/* The same numbers are the same readings, wherever they come from. */
static void test_arrays_and_files_agree(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[256];
    snprintf(path, sizeof path, "%s/r.csv", folder);
    gonio_readings *measured = measure_the_plan();
    gonio_readings *from_file = NULL;
    gonio_readings *from_arrays = NULL;
    assert_int_equal(gonio_readings_write(context, measured, NULL, path), GONIO_OK);
    assert_int_equal(gonio_readings_read(context, path, NULL, &from_file), GONIO_OK);
    const gonio_readings_view *view = gonio_readings_describe(from_file);
    assert_true(view->basis == plan->basis);
    assert_string_equal(view->method, plan->method);
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = view->count,
                                          .channels = view->channels,
                                          .pair = view->pair,
                                          .planned = view->planned,
                                          .value = view->value};
    assert_int_equal(gonio_readings_create(context, &arrays, NULL, &from_arrays), GONIO_OK);
    gonio_reconstruction *a = reconstruct(from_file, 0.01);
    gonio_reconstruction *b = reconstruct(from_arrays, 0.01);
    gonio_reconstruction *c = reconstruct(measured, 0.01);
    assert_same_field(a, b, 0.0);
    assert_same_field(a, c, 1e-5); /* a file has ten digits */
    gonio_reconstruction_free(&a);
    gonio_reconstruction_free(&b);
    gonio_reconstruction_free(&c);
    gonio_readings_free(&from_arrays);
    gonio_readings_free(&from_file);
    gonio_readings_free(&measured);
    support_remove(folder);
}

/* ---- in the posterior ---- */

static gonio_readings *copy_of(const gonio_readings *from, size_t channels, const double *value,
                               const double *deviation)
{
    const gonio_readings_view *view = gonio_readings_describe(from);
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = view->count,
                                          .channels = channels,
                                          .pair = view->pair,
                                          .value = value,
                                          .deviation = deviation};
    gonio_readings *made = NULL;
    assert_int_equal(gonio_readings_create(context, &arrays, NULL, &made), GONIO_OK);
    return made;
}

/* A deviation that is the noise of the options is the same as they are; where it is not known they
 * count; one that is huge leaves a reading no say. */
static void test_deviations(void **state)
{
    (void)state;
    enum { VALUES = PLANNED * GONIO_CHANNELS };
    gonio_readings *measured = measure_the_plan();
    const double *value = gonio_readings_describe(measured)->value;
    double deviation[VALUES];
    for (size_t k = 0; k < VALUES; k++) {
        deviation[k] = k % 2 == 0 ? hypot(0.03 * value[k], 1e-5) : NAN;
    }
    gonio_readings *known = copy_of(measured, GONIO_CHANNELS, value, deviation);
    gonio_reconstruction *a = reconstruct(measured, 0.03);
    gonio_reconstruction *b = reconstruct(known, 0.03);
    assert_same_field(a, b, 1e-9);
    for (size_t k = 0; k < VALUES; k++) {
        deviation[k] = 1e3;
    }
    assert_int_equal(gonio_readings_set_deviations(context, known, deviation), GONIO_OK);
    gonio_reconstruction *c = reconstruct(known, 0.03);
    assert_true(c->predicted_e6 > 2.0 * a->predicted_e6);
    gonio_reconstruction_free(&a);
    gonio_reconstruction_free(&b);
    gonio_reconstruction_free(&c);
    gonio_readings_free(&known);
    gonio_readings_free(&measured);
}

/* One channel without a wavelength, as a laser's: its material is grey. */
static void test_a_single_channel(void **state)
{
    (void)state;
    gonio_readings *measured = measure_the_plan();
    double green[PLANNED];
    double *slab = malloc(GONIO_SLAB_VALUES * sizeof *slab);
    for (size_t k = 0; k < PLANNED; k++) {
        green[k] = gonio_readings_value(measured, k, 1);
    }
    gonio_readings *single = copy_of(measured, 1, green, NULL);
    gonio_reconstruction *made = reconstruct(single, 0.01);
    gonio_material *material = NULL;
    double value = -1.0;
    double off = 0.0;
    assert_int_equal(made->columns, 1);
    assert_int_equal(made->wavelengths, 0);
    const gonio_pair pair = gonio_readings_describe(single)->pair[0];
    gonio_reconstruction_predict(basis, made, gonio_half_difference_from_pair(pair), &value, NULL);
    assert_true(fabs(value / green[0] - 1.0) < 0.05);
    assert_int_equal(gonio_reconstruction_material(context, basis, made, "grey", &material),
                     GONIO_OK);
    assert_int_equal(gonio_material_read_slab(context, material, 20, slab), GONIO_OK);
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        off = fmax(off, fabs(slab[k] - slab[GONIO_SLAB_BINS + k]) / fabs(slab[k]));
    }
    print_message("grey to %.2g\n", off);
    assert_true(off < 1e-6); /* bins between cells are interpolated in each channel's log space */
    assert_int_equal(gonio_reconstruction_predict_readings(context, basis, made, measured),
                     GONIO_OK);
    assert_int_equal(gonio_readings_describe(measured)->channels, 1);
    free(slab);
    gonio_material_free(&material);
    gonio_reconstruction_free(&made);
    gonio_readings_free(&single);
    gonio_readings_free(&measured);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_plan_as_readings),     cmocka_unit_test(test_the_chain_in_memory),
        cmocka_unit_test(test_arrays_and_files_agree), cmocka_unit_test(test_deviations),
        cmocka_unit_test(test_a_single_channel),
    };
    return cmocka_run_group_tests_name("readings along the chain", tests, set_up, tear_down);
}
