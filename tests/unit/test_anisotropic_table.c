/* Anisotropic tables: the same as tables of isotropic materials where there is no phi_h, continuous
 * at the poles, reciprocal, made from any material and kept in HDF5, where damage is noticed. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "core/hdf_write.h"
#include "material/anisotropic_table.h"
#include "mutations.h"

enum { CELLS = GONIO_THETA_H_BINS * GONIO_THETA_D_BINS };

static const double floors[GONIO_CHANNELS] = {1e-4, 1e-4, 1e-4};

/* A table whose series are given by a function of the cell. */
static gonio_material *make_table(gonio_anisotropic_table sizes,
                                  float (*term)(size_t cell, size_t channel, size_t term))
{
    const size_t terms = 1 + 2 * (size_t)sizes.orders;
    const size_t cells = (size_t)CELLS * (size_t)sizes.phi_d_cells;
    float *coefficient = malloc(cells * sizes.channels * terms * sizeof *coefficient);
    gonio_material *material = NULL;
    assert_non_null(coefficient);
    for (size_t k = 0; k < cells * sizes.channels * terms; k++) {
        coefficient[k] = term(k / terms / sizes.channels, k / terms % sizes.channels, k % terms);
    }
    sizes.size = sizeof sizes;
    sizes.floor = floors;
    sizes.coefficient = coefficient;
    assert_int_equal(gonio_anisotropic_material(NULL, "made", "made for a test", &sizes, &material),
                     GONIO_OK);
    free(coefficient);
    return material;
}

static gonio_context *one_thread; /* for the many small tasks here */

static int begin(void **state)
{
    gonio_context_options options;
    (void)state;
    gonio_context_options_default(&options);
    options.threads = 1;
    return gonio_context_create(&one_thread, &options) == GONIO_OK ? 0 : -1;
}

static int end(void **state)
{
    (void)state;
    gonio_context_free(&one_thread);
    return 0;
}

static double value_at(const gonio_material *material, gonio_pair pair)
{
    double rho[GONIO_CHANNELS];
    assert_int_equal(gonio_material_evaluate(one_thread, material, &pair, 1, rho), GONIO_OK);
    return rho[0];
}

/* ---- without phi_h ---- */

static const gonio_table *plain;

static float plain_term(size_t cell, size_t channel, size_t term)
{
    const size_t slab = cell / GONIO_SLAB_BINS;
    const size_t at = (slab * GONIO_CHANNELS + channel) * GONIO_SLAB_BINS + cell % GONIO_SLAB_BINS;
    const double rho = gonio_table_values(plain)[at];
    return term > 0 ? 0.0F : rho >= 0.0 ? (float)log(rho + floors[channel]) : NAN;
}

static void test_without_phi_h_it_is_an_isotropic_table(void **state)
{
    (void)state;
    gonio_material *original = NULL;
    gonio_table *table = NULL;
    assert_int_equal(gonio_material_open(NULL, "atlas:oak-sawn", &original), GONIO_OK);
    assert_int_equal(gonio_table_load(NULL, original, &table), GONIO_OK);
    plain = table;
    gonio_material *made = make_table(
        (gonio_anisotropic_table){.channels = 3, .phi_d_cells = 180, .symmetry = 2}, plain_term);
    assert_false(gonio_material_describe(made)->anisotropic);
    for (int k = 0; k < 3000; k++) {
        const double small = k % 3 == 0 ? 1e-4 : 1.0; /* near the poles too */
        const gonio_pair pair = {
            {0.5 + 0.9 * sin(k), 1.3 * k},
            {0.5 + (k % 2 ? 0.9 : 0.9 * small) * sin(k + small), 1.3 * k + k % 7}};
        double expected[GONIO_CHANNELS];
        if (pair.incident.theta < 0.0 || pair.outgoing.theta < 0.0 ||
            !gonio_table_value(table, gonio_half_difference_from_pair(pair), expected)) {
            continue;
        }
        assert_true(fabs(value_at(made, pair) - expected[0]) < 1e-5 * expected[0]);
    }
    gonio_material_free(&made);
    gonio_table_free(&table);
    gonio_material_free(&original);
}

/* ---- with phi_h ---- */

/* Smooth series, different in all cells and odd in phi_h too. */
static float wild_term(size_t cell, size_t channel, size_t term)
{
    const double phi_d = (double)(cell % 12) * M_PI / 6.0;
    return (float)((0.5 + 0.1 * (double)channel) * cos(2.0 * phi_d + (double)term));
}

static gonio_material *make_wild(int symmetry)
{
    return make_table(
        (gonio_anisotropic_table){
            .channels = 3, .phi_d_cells = 12, .symmetry = symmetry, .orders = 3},
        wild_term);
}

static gonio_pair swapped(gonio_pair pair)
{
    return (gonio_pair){pair.outgoing, pair.incident};
}

static gonio_pair turned(gonio_pair pair, double angle)
{
    pair.incident.phi += angle;
    pair.outgoing.phi += angle;
    return pair;
}

static void test_reciprocity_and_symmetry(void **state)
{
    (void)state;
    for (int symmetry = 1; symmetry <= 4; symmetry *= 2) {
        gonio_material *material = make_wild(symmetry);
        double half = 0.0;
        for (int k = 0; k < 500; k++) {
            const gonio_pair pair = {{0.1 + 1.4 * (k % 23) / 23.0, 0.7 * k},
                                     {0.05 + 1.4 * (k % 17) / 17.0, 0.31 * k}};
            const double rho = value_at(material, pair);
            const double turn = 2.0 * M_PI / symmetry;
            assert_true(fabs(value_at(material, swapped(pair)) - rho) < 1e-9 * rho);
            assert_true(fabs(value_at(material, turned(pair, turn)) - rho) < 1e-9 * rho);
            half = fmax(half, fabs(value_at(material, turned(pair, 0.5 * turn)) - rho));
        }
        assert_true(half > 0.1);
        gonio_material_free(&material);
    }
}

/* Where the half vector is the normal, or both directions are one, or both, directions that differ
 * by rounding have the same value. */
static void test_continuous_at_the_poles(void **state)
{
    (void)state;
    for (int symmetry = 1; symmetry <= 2; symmetry++) {
        gonio_material *material = make_wild(symmetry);
        for (int k = 0; k < 200; k++) {
            const double theta = k % 5 == 0 ? 0.0 : 0.2 + 0.006 * k;
            const double phi = 0.5 * k;
            const double off = 1e-9;
            const gonio_pair mirror = {{theta, phi}, {theta, phi + M_PI}};
            const gonio_pair back = {{theta, phi}, {theta, phi}};
            const gonio_pair near[2] = {
                {{theta + off * cos(k), phi + off}, {theta + off * sin(k), phi + M_PI - off}},
                {{theta + off * cos(k), phi + off}, {theta + off * sin(k), phi - off}}};
            const double a = value_at(material, mirror);
            const double b = value_at(material, back);
            assert_true(fabs(value_at(material, near[0]) - a) < 1e-3 * a);
            assert_true(fabs(value_at(material, near[1]) - b) < 1e-3 * b);
            assert_true(fabs(value_at(material, swapped(near[0])) - a) < 1e-3 * a);
        }
        gonio_material_free(&material);
    }
}

/* ---- wrong tables ---- */

static void refuse(gonio_anisotropic_table t)
{
    static const float some[1] = {0.0F};
    gonio_context *context = support_context();
    gonio_material *material = NULL;
    t.size = sizeof t;
    t.floor = floors;
    t.coefficient = some;
    assert_int_equal(gonio_anisotropic_material(context, "x", "y", &t, &material),
                     GONIO_ERROR_ARGUMENT);
    assert_non_null(strstr(support_message(), "not an anisotropic table"));
    gonio_context_free(&context);
}

static void test_wrong_sizes_are_refused(void **state)
{
    (void)state;
    static const double nm[400] = {500.0};
    refuse((gonio_anisotropic_table){.channels = 3, .phi_d_cells = 7, .symmetry = 2});
    refuse((gonio_anisotropic_table){.channels = 3, .phi_d_cells = 12});
    refuse(
        (gonio_anisotropic_table){.channels = 3, .phi_d_cells = 12, .symmetry = 2, .orders = 33});
    refuse((gonio_anisotropic_table){.channels = 5, .phi_d_cells = 12, .symmetry = 2});
    refuse((gonio_anisotropic_table){
        .channels = 400, .wavelength = nm, .phi_d_cells = 180, .symmetry = 2, .orders = 8});
}

/* ---- files ---- */

static gonio_material *rewrite(const gonio_material *material, const char *path)
{
    gonio_material *again = NULL;
    assert_int_equal(gonio_material_write(NULL, material, path, NULL), GONIO_OK);
    assert_int_equal(gonio_material_open(NULL, path, &again), GONIO_OK);
    return again;
}

/* RMS difference in the log space of errors, in per cent, over directions up to 75 degrees that
 * crowd around the mirror direction. */
static double e6_between(const gonio_material *a, const gonio_material *b)
{
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < 4000; k++) {
        const double root = fmod(0.618034 * k, 1.0);
        const gonio_half_difference at = {root * root * 1.2, fmod(0.754878 * k, 1.0) * 1.4,
                                          fmod(0.569840 * k, 1.0) * M_PI};
        const gonio_pair pair = turned(gonio_pair_from_half_difference(at), 2.4 * k);
        if (fmax(pair.incident.theta, pair.outgoing.theta) < 1.3) {
            const double g = gonio_log_from_brdf(value_at(a, pair), 0);
            const double h = gonio_log_from_brdf(value_at(b, pair), 0);
            sum += (g - h) * (g - h) / (g * g);
            count++;
        }
    }
    return 100.0 * sqrt(sum / count);
}

/* A table of a few phi_d made from a material, as a material. */
static gonio_material *fit(const gonio_material *original, int phi_d_cells)
{
    gonio_i_sampler sampler;
    gonio_anisotropic_table table;
    gonio_material *made = NULL;
    assert_int_equal(gonio_i_sampler_begin(one_thread, original, false, &sampler), GONIO_OK);
    assert_int_equal(gonio_i_anisotropic_fit(one_thread, &sampler, phi_d_cells, &table), GONIO_OK);
    assert_int_equal(gonio_anisotropic_material(NULL, "made", "made", &table, &made), GONIO_OK);
    gonio_i_anisotropic_clear(&table);
    gonio_i_sampler_end(&sampler);
    return made;
}

/* Made from a material, written and read: the same values. Its symmetry is found. */
static void check_fit(const char *name, int symmetry, const char *folder)
{
    char path[4096];
    gonio_material *original = NULL;
    assert_int_equal(gonio_material_open(NULL, name, &original), GONIO_OK);
    gonio_material *made = fit(original, symmetry == 2 ? 4 : 2);
    snprintf(path, sizeof path, "%s/a.h5", folder);
    gonio_material *again = rewrite(made, path);
    const double error = e6_between(original, made);
    print_message("%s: %s, %.2f %%\n", name, gonio_material_format(again), error);
    assert_int_equal(gonio_i_anisotropic_of(made)->symmetry, symmetry);
    assert_true(gonio_material_describe(again)->anisotropic);
    assert_true(error < (symmetry == 2 ? 0.5 : 8.0)); /* of few phi_d */
    assert_true(e6_between(made, again) == 0.0);
    gonio_material_free(&again);
    gonio_material_free(&made);
    gonio_material_free(&original);
}

static void test_made_from_materials(void **state)
{
    (void)state;
    char *folder = support_folder();
    check_fit("atlas:navy-cotton-twill", 2, folder);
    check_fit("atlas:white-nylon-plain-weave", 4, folder);
    check_fit("atlas:maple-curly-varnished", 1, folder);
    support_remove(folder);
}

/* MERL tables and Zemax files of one rotation cannot hold what depends on phi_h. */
static void test_isotropic_formats_refuse(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    gonio_material *wild = make_wild(2);
    gonio_context *context = support_context();
    static const char *const formats[] = {"merl", "zemax"};
    snprintf(path, sizeof path, "%s/a", folder);
    for (size_t k = 0; k < 2; k++) {
        const gonio_write_options how = {.size = sizeof how, .format = formats[k]};
        assert_int_equal(gonio_material_write(context, wild, path, &how), GONIO_ERROR_ARGUMENT);
        assert_non_null(strstr(support_message(), "--average-azimuths"));
    }
    gonio_context_free(&context);
    gonio_material_free(&wild);
    support_remove(folder);
}

static float small_term(size_t cell, size_t channel, size_t term)
{
    return (float)channel - 0.01F * (float)(cell % 90) + 0.1F * (float)term;
}

static void test_damaged_files(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.h5", folder);
    gonio_material *small = make_table(
        (gonio_anisotropic_table){.channels = 1, .phi_d_cells = 1, .symmetry = 1, .orders = 1},
        small_term);
    assert_int_equal(gonio_material_write(NULL, small, path, NULL), GONIO_OK);
    check_mutations(path, folder);
    gonio_material_free(&small);
    support_remove(folder);
}

/* A table of which nothing is stored is refused before room is made for it. */
static void test_a_table_that_lies(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.h5", folder);
    const hsize_t extents[5] = {90, 90, 180, 3, 41};
    const hsize_t chunk[5] = {1, 90, 1, 3, 41};
    const double limit = 0.0;
    const size_t three = 3;
    const size_t one = 1;
    gonio_i_hdf_session session;
    assert_int_equal(gonio_i_hdf_load(NULL), GONIO_OK);
    gonio_i_hdf_enter(&session);
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(gonio_i_hdf_write_string(file, "format", "gonio anisotropic BRDF table"));
    assert_true(gonio_i_hdf_write_number(file, "version", 1));
    assert_true(gonio_i_hdf_write_number(file, "symmetry", 2));
    assert_true(gonio_i_hdf_write_array(file, "floor", 1, &three, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE,
                                        floors));
    assert_true(gonio_i_hdf_write_array(file, "theta_limit", 1, &one, H5T_NATIVE_DOUBLE,
                                        H5T_IEEE_F64LE, &limit));
    const hid_t space = H5Screate_simple(5, extents, NULL);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, 5, chunk);
    const hid_t set = H5Dcreate2(file, "coefficient", H5T_IEEE_F32LE, space, H5P_DEFAULT,
                                 properties, H5P_DEFAULT);
    assert_true(set >= 0);
    H5Dclose(set);
    H5Pclose(properties);
    H5Sclose(space);
    H5Fclose(file);
    gonio_i_hdf_leave(&session);
    gonio_context *context = support_context();
    gonio_material *material = NULL;
    assert_int_equal(gonio_material_open(context, path, &material), GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "coefficient"));
    gonio_context_free(&context);
    support_remove(folder);
}

/* On the grid a material has the mean over all azimuths, as a sum over many of them gives. */
static void check_mean(const gonio_material *material)
{
    enum { THETA_H = 30, THETA_D = 20, PHI_D = 40, MANY = 720 };
    double sum = 0.0;
    double *rho = malloc(GONIO_SLAB_VALUES * sizeof *rho);
    const gonio_pair pair =
        gonio_pair_from_half_difference(gonio_bin_centre((gonio_bin){THETA_H, THETA_D, PHI_D}));
    assert_int_equal(gonio_material_read_slab(one_thread, material, THETA_H, rho), GONIO_OK);
    for (int k = 0; k < MANY; k++) {
        const double angle = 2.0 * M_PI * k / MANY;
        gonio_pair turned = pair;
        turned.incident.phi += angle;
        turned.outgoing.phi += angle;
        sum += value_at(material, turned) / MANY;
    }
    assert_true(fabs(rho[THETA_D * GONIO_PHI_D_BINS + PHI_D] / sum - 1.0) < 0.01);
    free(rho);
}

static void test_mean(void **state)
{
    (void)state;
    gonio_material *steel = NULL;
    gonio_material *table = make_table(
        (gonio_anisotropic_table){.channels = 3, .phi_d_cells = 12, .symmetry = 2, .orders = 2},
        small_term);
    assert_int_equal(gonio_material_open(one_thread, "atlas:steel-hairline", &steel), GONIO_OK);
    check_mean(steel); /* a narrow lobe */
    check_mean(table);
    gonio_material_free(&steel);
    gonio_material_free(&table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_without_phi_h_it_is_an_isotropic_table),
        cmocka_unit_test(test_reciprocity_and_symmetry),
        cmocka_unit_test(test_continuous_at_the_poles),
        cmocka_unit_test(test_wrong_sizes_are_refused),
        cmocka_unit_test(test_made_from_materials),
        cmocka_unit_test(test_isotropic_formats_refuse),
        cmocka_unit_test(test_damaged_files),
        cmocka_unit_test(test_a_table_that_lies),
        cmocka_unit_test(test_mean),
    };
    return cmocka_run_group_tests_name("anisotropic_table", tests, begin, end);
}
