/* Tensor files: what is well formed is read, what lies is refused; warps and their inverses. */
#include <gonio/evaluate.h>
#include <gonio/material.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/random.h"
#include "material/tensor_file.h"
#include "material/tensor_write.h"
#include "material/warp.h"

#include "../support.h"
#include "mutations.h"

/* A file under construction, little-endian. */
typedef struct bytes {
    unsigned char at[4096];
    size_t count;
} bytes;

static void add(bytes *b, const void *data, size_t size)
{
    memcpy(b->at + b->count, data, size);
    b->count += size;
}

static void add_header(bytes *b, uint32_t fields)
{
    const unsigned char version[2] = {1, 0};
    *b = (bytes){.count = 0};
    add(b, "tensor_file", 12);
    add(b, version, 2);
    add(b, &fields, 4);
}

static void add_field(bytes *b, const char *name, uint8_t type, uint64_t offset,
                      uint16_t dimensions, const uint64_t *shape)
{
    const uint16_t length = (uint16_t)strlen(name);
    add(b, &length, 2);
    add(b, name, length);
    add(b, &dimensions, 2);
    add(b, &type, 1);
    add(b, &offset, 8);
    add(b, shape, dimensions * sizeof *shape);
}

static void write_file(const char *path, const bytes *b, size_t count)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(b->at, 1, count, stream), count);
    assert_int_equal(fclose(stream), 0);
}

static gonio_status open_bytes(const bytes *b, size_t count, gonio_i_tensor_file *file)
{
    char *folder = support_folder();
    char path[4096];
    gonio_context *context = support_context();
    snprintf(path, sizeof path, "%s/x.bsdf", folder);
    write_file(path, b, count);
    const gonio_status status = gonio_i_tensor_open(context, path, file);
    assert_true(status == GONIO_OK || support_message()[0] != '\0');
    gonio_context_free(&context);
    support_remove(folder);
    return status;
}

static const uint64_t pair[2] = {2, 3};

static void make_good(bytes *b)
{
    const float values[6] = {0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F};
    add_header(b, 1);
    add_field(b, "rgb", GONIO_I_TENSOR_F32, 64, 2, pair);
    b->count = 64;
    add(b, values, sizeof values);
}

static void test_a_good_file(void **state)
{
    (void)state;
    bytes b;
    gonio_i_tensor_file file;
    const gonio_i_tensor *field = NULL;
    make_good(&b);
    assert_int_equal(open_bytes(&b, b.count, &file), GONIO_OK);
    assert_int_equal(file.fields, 1);
    assert_null(gonio_i_tensor_find(&file, "vndf"));
    assert_int_equal(gonio_i_tensor_expect(NULL, &file, "rgb", GONIO_I_TENSOR_F32, 2, &field),
                     GONIO_OK);
    assert_int_equal(field->count, 6);
    float values[3] = {0.0F};
    assert_int_equal(gonio_i_tensor_read(NULL, &file, field, 3, 3, values), GONIO_OK);
    assert_true(values[0] == 3.0F && values[2] == 5.0F);
    assert_int_equal(gonio_i_tensor_read(NULL, &file, field, 4, 3, values), GONIO_ERROR_FORMAT);
    assert_int_equal(gonio_i_tensor_expect(NULL, &file, "rgb", GONIO_I_TENSOR_U8, 2, &field),
                     GONIO_ERROR_FORMAT);
    assert_int_equal(gonio_i_tensor_expect(NULL, &file, "rgb", GONIO_I_TENSOR_F32, 3, &field),
                     GONIO_ERROR_FORMAT);
    gonio_i_tensor_close(&file);
}

/* Cut anywhere, the header is refused or the numbers are. */
static void test_truncated_files(void **state)
{
    (void)state;
    bytes b;
    make_good(&b);
    for (size_t count = 0; count < b.count; count++) {
        gonio_i_tensor_file file;
        const gonio_i_tensor *field = NULL;
        if (open_bytes(&b, count, &file) == GONIO_OK) {
            assert_int_equal(
                gonio_i_tensor_expect(NULL, &file, "rgb", GONIO_I_TENSOR_F32, 2, &field),
                GONIO_ERROR_FORMAT);
            gonio_i_tensor_close(&file);
        }
    }
}

/* A header with one field that lies. */
static gonio_status open_field(uint32_t fields, const char *name, uint8_t type, uint64_t offset,
                               uint16_t dimensions, const uint64_t *shape)
{
    bytes b;
    gonio_i_tensor_file file;
    const gonio_i_tensor *field = NULL;
    add_header(&b, fields);
    add_field(&b, name, type, offset, dimensions, shape);
    gonio_status status = open_bytes(&b, b.count, &file);
    if (status == GONIO_OK) {
        status = gonio_i_tensor_expect(NULL, &file, name, GONIO_I_TENSOR_F32, dimensions, &field);
        gonio_i_tensor_close(&file);
    }
    return status;
}

static void test_headers_that_lie(void **state)
{
    (void)state;
    const uint64_t huge[3] = {UINT64_C(1) << 40, UINT64_C(1) << 40, 2};
    const uint64_t many[1] = {UINT64_MAX / 8};
    const uint64_t deep[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    const uint64_t none[1] = {0};
    char name[80];
    memset(name, 'x', sizeof name);
    name[70] = '\0';
    assert_int_equal(open_field(1, "rgb", 10, 40, 3, huge), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(1, "rgb", 10, 40, 1, many), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(1, "rgb", 10, UINT64_MAX - 4, 2, pair), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(1, "rgb", 10, 40, 9, deep), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(1, "rgb", 10, 40, 1, none), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(1, "rgb", 12, 40, 2, pair), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(1, "rgb", 0, 40, 2, pair), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(1, name, 10, 40, 2, pair), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(1, "", 10, 40, 2, pair), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(2, "rgb", 10, 0, 2, pair), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(0, "rgb", 10, 0, 2, pair), GONIO_ERROR_FORMAT);
    assert_int_equal(open_field(UINT32_MAX, "rgb", 10, 0, 2, pair), GONIO_ERROR_FORMAT);
}

/* ---- warps ---- */

enum { WIDTH = 9, HEIGHT = 5, SLICES = 2 };

static void make_warp(gonio_i_warp *warp)
{
    float values[SLICES * HEIGHT * WIDTH];
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 0);
    for (size_t k = 0; k < SLICES * HEIGHT * WIDTH; k++) {
        values[k] = (float)fabs(gonio_i_random_normal(&random)) + 0.01F;
    }
    values[3] = 0.0F;
    values[4] = NAN;
    assert_int_equal(gonio_i_warp_create(NULL, values, SLICES, HEIGHT, WIDTH, warp), GONIO_OK);
}

static void test_a_warp_and_its_inverse(void **state)
{
    (void)state;
    gonio_i_warp warp;
    const gonio_i_blend blend = {2, {0, 1}, {0.3, 0.7}};
    make_warp(&warp);
    for (int k = 0; k < 1000; k++) {
        const double u[2] = {fmod(k * 0.618034, 1.0), (k + 0.5) / 1000.0};
        double s[2];
        double back[2];
        const double there = gonio_i_warp_invert(&warp, &blend, u, s);
        const double here = gonio_i_warp_sample(&warp, &blend, s, back);
        assert_true(s[0] >= 0.0 && s[0] <= 1.0 + 1e-12 && s[1] >= 0.0 && s[1] <= 1.0 + 1e-12);
        assert_true(fabs(back[0] - u[0]) < 1e-9 && fabs(back[1] - u[1]) < 1e-9);
        assert_true(fabs(there - here) < 1e-9 * there);
    }
    gonio_i_warp_free(&warp);
}

/* The density is that of the map: its Jacobian, and its integral over the square is 1. */
static void test_the_density_of_a_warp(void **state)
{
    (void)state;
    const int steps = support_small() ? 100 : 400;
    static const double H = 1e-6;
    gonio_i_warp warp;
    const gonio_i_blend blend = {1, {1}, {1.0}};
    double all = 0.0;
    make_warp(&warp);
    for (int k = 0; k < steps * steps; k++) {
        const double u[2] = {(k % steps + 0.5) / steps, (k / steps + 0.5) / steps};
        double s[2];
        const double density = gonio_i_warp_invert(&warp, &blend, u, s);
        all += density / (steps * steps);
        if (k % 1234 == 0) {
            double x[2];
            double y[2];
            gonio_i_warp_invert(&warp, &blend, (double[2]){u[0] + H, u[1]}, x);
            gonio_i_warp_invert(&warp, &blend, (double[2]){u[0], u[1] + H}, y);
            const double area = (x[0] - s[0]) * (y[1] - s[1]) - (x[1] - s[1]) * (y[0] - s[0]);
            assert_true(fabs(area / (H * H) - density) < 1e-3 * density);
        }
    }
    assert_true(fabs(all - 1.0) < (support_small() ? 2e-3 : 1e-4));
    gonio_i_warp_free(&warp);
}

/* ---- materials as RGL files ---- */

static float *read_floats(const gonio_i_tensor_file *file, const char *name)
{
    float *values = NULL;
    const gonio_i_tensor *field = gonio_i_tensor_find(file, name);
    assert_non_null(field);
    assert_int_equal(gonio_i_tensor_floats(NULL, file, field, &values), GONIO_OK);
    return values;
}

/* The largest value among the corners of the cells that a node is a corner of. */
static float find_largest_around(const float *values, const uint64_t *shape, size_t t, size_t c,
                                 size_t node)
{
    const size_t side = (size_t)shape[4];
    const size_t from[3] = {t - (t > 0), node / side - (node / side > 0),
                            node % side - (node % side > 0)};
    float largest = 0.0F;
    for (size_t l = from[0]; l <= t + 1 && l < shape[1]; l++) {
        for (size_t y = from[1]; y <= node / side + 1 && y < side; y++) {
            for (size_t x = from[2]; x <= node % side + 1 && x < side; x++) {
                const size_t slice = l * (size_t)shape[2] + c;
                largest = fmaxf(largest, values[(slice * side + y) * side + x]);
            }
        }
    }
    return largest;
}

/* The least value below the horizon, in units of the largest value around it: about -1 at the
 * horizon. The fit that follows changes it a little. */
static double find_least_below_horizon(const char *path)
{
    gonio_i_tensor_file file;
    double least = 0.0;
    assert_int_equal(gonio_i_tensor_open(NULL, path, &file), GONIO_OK);
    const uint64_t *shape = gonio_i_tensor_find(&file, "rgb")->shape;
    const size_t nodes = (size_t)(shape[3] * shape[4]);
    float *values = read_floats(&file, "rgb");
    for (size_t k = 0; k < shape[1] * shape[2] * nodes; k++) {
        if (values[k] < 0.0F) {
            const size_t slice = k / nodes;
            const float largest =
                find_largest_around(values, shape, slice / shape[2], slice % shape[2], k % nodes);
            least = fmin(least, largest > 0.0F ? (double)(values[k] / largest) : -INFINITY);
        }
    }
    free(values);
    gonio_i_tensor_close(&file);
    return least;
}

/* Little is lost of smooth and of sharp materials: E6 of at most 1 % where the file has data. */
static void check_written(const char *name, const char *path)
{
    gonio_material *original = NULL;
    gonio_material *written = NULL;
    gonio_comparison comparison;
    struct stat about;
    assert_int_equal(gonio_material_open(NULL, name, &original), GONIO_OK);
    assert_int_equal(gonio_material_write(NULL, original, path, NULL), GONIO_OK);
    assert_int_equal(stat(path, &about), 0);
    assert_true(about.st_size < 3000000);
    assert_int_equal(gonio_material_open(NULL, path, &written), GONIO_OK);
    assert_int_equal(gonio_compare(NULL, original, written, &comparison), GONIO_OK);
    print_message("%s: E6 %.2f %%\n", name, comparison.all.value[GONIO_E6]);
    assert_true(comparison.all.value[GONIO_E6] < 1.0);
    assert_true(find_least_below_horizon(path) > -1.25);
    const gonio_write_options unknown = {.size = sizeof unknown, .format = "exr"};
    assert_int_equal(gonio_material_write(NULL, original, path, &unknown), GONIO_ERROR_ARGUMENT);
    gonio_material_free(&original);
    gonio_material_free(&written);
}

static void test_a_material_written_and_read(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.bsdf", folder);
    check_written("atlas:white-linen", path);
    if (!support_small()) {
        check_written("atlas:chromium-mirror", path);
        check_written("atlas:red-glossy-plastic", path);
    }
    support_remove(folder);
}

/* Anisotropic materials keep their azimuths, over half a turn or a whole one. */
static void check_written_azimuths(const char *name, size_t azimuths, const char *path)
{
    gonio_material *original = NULL;
    gonio_material *written = NULL;
    gonio_comparison comparison;
    gonio_i_tensor_file file;
    const gonio_write_options mean = {
        .size = sizeof mean, .format = "rgl", .average_azimuths = true};
    assert_int_equal(gonio_material_open(NULL, name, &original), GONIO_OK);
    assert_int_equal(gonio_material_write(NULL, original, path, NULL), GONIO_OK);
    assert_int_equal(gonio_i_tensor_open(NULL, path, &file), GONIO_OK);
    static const char *const fields[] = {"phi_i", "vndf", "luminance", "rgb"};
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++) {
        assert_int_equal(gonio_i_tensor_find(&file, fields[k])->shape[0], azimuths);
    }
    gonio_i_tensor_close(&file);
    assert_int_equal(gonio_material_open(NULL, path, &written), GONIO_OK);
    assert_int_equal(gonio_compare(NULL, original, written, &comparison), GONIO_OK);
    print_message("%s: E6 %.2f %%\n", name, comparison.all.value[GONIO_E6]);
    assert_true(gonio_material_describe(written)->anisotropic);
    assert_true(comparison.all.value[GONIO_E6] < 0.5);
    gonio_material_free(&written);
    assert_int_equal(gonio_material_write(NULL, original, path, &mean), GONIO_OK);
    assert_int_equal(gonio_material_open(NULL, path, &written), GONIO_OK);
    assert_int_equal(gonio_compare(NULL, original, written, &comparison), GONIO_OK);
    assert_false(gonio_material_describe(written)->anisotropic);
    assert_true(comparison.all.value[GONIO_E6] > 2.0);
    gonio_material_free(&original);
    gonio_material_free(&written);
}

static void test_an_anisotropic_material_written_and_read(void **state)
{
    (void)state;
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.bsdf", folder);
    check_written_azimuths("atlas:steel-hairline", 13, path);
    if (!support_small()) {
        check_written_azimuths("atlas:maple-curly-varnished", 25, path);
    }
    support_remove(folder);
}

/* The relative variance of what samples of light from incidence t count for, in the grey of all
 * channels: light is sampled by luminance, then by vndf. */
static double variance_of_samples(const gonio_i_tensor_file *file, size_t t)
{
    enum { NORMALS = 128 };
    const int steps = support_small() ? 100 : 500;
    const size_t side = (size_t)gonio_i_tensor_find(file, "luminance")->shape[3];
    const size_t nodes = side * side;
    float *luminance = read_floats(file, "luminance");
    float *values = read_floats(file, "rgb");
    float *ndf = read_floats(file, "ndf");
    float *theta = read_floats(file, "theta_i");
    const double weight[GONIO_CHANNELS] = {0.2126, 0.7152, 0.0722};
    const gonio_i_tensor *normals = gonio_i_tensor_find(file, "vndf");
    float *vndf = read_floats(file, "vndf");
    gonio_i_warp warp;
    gonio_i_warp to_normals;
    assert_int_equal(gonio_i_warp_create(NULL, luminance + t * nodes, 1, side, side, &warp),
                     GONIO_OK);
    assert_int_equal(gonio_i_warp_create(NULL, vndf + t * normals->shape[2] * normals->shape[3], 1,
                                         normals->shape[2], normals->shape[3], &to_normals),
                     GONIO_OK);
    const gonio_i_blend blend = {1, {0}, {1.0}};
    double sum = 0.0;
    double squares = 0.0;
    for (int k = 0; k < steps * steps; k++) {
        const double place[2] = {(k % steps + 0.5) / steps, (k / steps + 0.5) / steps};
        double s[2];
        double u[2];
        double density = gonio_i_warp_sample(&warp, &blend, place, s);
        density *= gonio_i_warp_sample(&to_normals, &blend, s, u);
        const gonio_i_step x = gonio_i_step_evenly(side, s[0]);
        const gonio_i_step y = gonio_i_step_evenly(side, s[1]);
        const gonio_i_step n = gonio_i_step_evenly(NORMALS, u[0]);
        double value = 0.0;
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            const float *v = values + (t * GONIO_CHANNELS + c) * nodes + y.before * side + x.before;
            value += weight[c] * ((1.0 - y.share) * ((1.0 - x.share) * v[0] + x.share * v[1]) +
                                  y.share * ((1.0 - x.share) * v[side] + x.share * v[side + 1]));
        }
        const double theta_m = u[0] * u[0] * M_PI / 2.0;
        const double cosine = sin(theta[t]) * sin(theta_m) * cos((2.0 * u[1] - 1.0) * M_PI) +
                              cos(theta[t]) * cos(theta_m);
        const double here = fmax(value, 0.0) * fmax(cosine, 0.0) * u[0] * sin(theta_m) *
                            ((1.0 - n.share) * ndf[n.before] + n.share * ndf[n.before + 1]) /
                            density;
        const bool above = 2.0 * cosine * cos(theta_m) - cos(theta[t]) > 0.0;
        sum += above ? here : 0.0;
        squares += above ? here * here : 0.0;
    }
    const double mean = sum / (steps * steps);
    gonio_i_warp_free(&warp);
    gonio_i_warp_free(&to_normals);
    free(vndf);
    free(luminance);
    free(values);
    free(ndf);
    free(theta);
    return squares / (steps * steps) / (mean * mean) - 1.0;
}

/* Renderers sample light well: weights hardly vary, down to grazing. */
static void test_samples_count_alike(void **state)
{
    (void)state;
    static const char *const names[] = {"atlas:white-linen", "atlas:chromium-mirror"};
    char *folder = support_folder();
    char path[4096];
    snprintf(path, sizeof path, "%s/x.bsdf", folder);
    for (size_t k = 0; k < (support_small() ? 1 : 2); k++) {
        gonio_material *material = NULL;
        gonio_i_tensor_file file;
        assert_int_equal(gonio_material_open(NULL, names[k], &material), GONIO_OK);
        assert_int_equal(gonio_material_write(NULL, material, path, NULL), GONIO_OK);
        assert_int_equal(gonio_i_tensor_open(NULL, path, &file), GONIO_OK);
        for (size_t t = 0; t < 22; t += 7) {
            const double variance = variance_of_samples(&file, t);
            print_message("%s, incidence %zu: variance %.4f\n", names[k], t, variance);
            assert_true(variance < 0.02);
        }
        gonio_i_tensor_close(&file);
        gonio_material_free(&material);
    }
    support_remove(folder);
}

/* A file of the format stays as it is: two azimuths of incidence at two polar angles, anisotropic
 * with point symmetry, values at random. */
static void test_a_file_is_copied(void **state)
{
    (void)state;
    enum { PHIS = 3, THETAS = 2, SIDE = 4, VALUES = PHIS * THETAS * 3 * SIDE * SIDE };
    char *folder = support_folder();
    char path[4096];
    char again[4096];
    const float phi[PHIS] = {-3.1415927F, -1.5707964F, 0.0F};
    const float theta[THETAS] = {0.0F, 1.4F};
    float ones[PHIS * THETAS * SIDE * SIDE];
    float values[VALUES];
    const unsigned char jacobian = 0;
    gonio_i_random random;
    gonio_i_random_seed(&random, 7, 0);
    for (size_t k = 0; k < VALUES; k++) {
        values[k] = (float)gonio_i_random_uniform(&random);
        ones[k % (PHIS * THETAS * SIDE * SIDE)] = 1.0F;
    }
    const gonio_i_tensor_type f32 = GONIO_I_TENSOR_F32;
    const gonio_i_tensor_field fields[] = {
        {"description", GONIO_I_TENSOR_U8, 1, {5}, "brush"},
        {"phi_i", f32, 1, {PHIS}, phi},
        {"theta_i", f32, 1, {THETAS}, theta},
        {"ndf", f32, 2, {2, 2}, ones},
        {"sigma", f32, 2, {2, 2}, ones},
        {"vndf", f32, 4, {PHIS, THETAS, SIDE, SIDE}, ones},
        {"luminance", f32, 4, {PHIS, THETAS, SIDE, SIDE}, ones},
        {"rgb", f32, 5, {PHIS, THETAS, 3, SIDE, SIDE}, values},
        {"jacobian", GONIO_I_TENSOR_U8, 1, {1}, &jacobian},
    };
    snprintf(path, sizeof path, "%s/x.bsdf", folder);
    snprintf(again, sizeof again, "%s/y.bsdf", folder);
    assert_int_equal(gonio_i_tensor_write(NULL, path, fields, sizeof fields / sizeof *fields),
                     GONIO_OK);
    gonio_material *first = NULL;
    gonio_material *second = NULL;
    assert_int_equal(gonio_material_open(NULL, path, &first), GONIO_OK);
    assert_true(gonio_material_describe(first)->anisotropic);
    assert_int_equal(gonio_material_write(NULL, first, again, NULL), GONIO_OK);
    assert_int_equal(gonio_material_open(NULL, again, &second), GONIO_OK);
    for (int k = 0; k < 200; k++) {
        const gonio_pair at = {{1.3 * gonio_i_random_uniform(&random), 6.0 * k / 200.0},
                               {1.3 * gonio_i_random_uniform(&random), 5.0 - 6.0 * k / 200.0}};
        double a[GONIO_CHANNELS];
        double b[GONIO_CHANNELS];
        assert_int_equal(gonio_material_evaluate(NULL, first, &at, 1, a), GONIO_OK);
        assert_int_equal(gonio_material_evaluate(NULL, second, &at, 1, b), GONIO_OK);
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            assert_true(fabs(a[c] - b[c]) <= 1e-5 * a[c]);
            /* jacobian 0: values are rho cos theta_o, between 0 and 1 here */
            assert_true(a[c] * cos(at.outgoing.theta) <= 1.0);
        }
    }
    gonio_material_free(&first);
    gonio_material_free(&second);
    check_mutations(path, folder);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_good_file),
        cmocka_unit_test(test_truncated_files),
        cmocka_unit_test(test_headers_that_lie),
        cmocka_unit_test(test_a_warp_and_its_inverse),
        cmocka_unit_test(test_the_density_of_a_warp),
        cmocka_unit_test(test_a_material_written_and_read),
        cmocka_unit_test(test_an_anisotropic_material_written_and_read),
        cmocka_unit_test(test_samples_count_alike),
        cmocka_unit_test(test_a_file_is_copied),
    };
    return cmocka_run_group_tests_name("tensor_file", tests, NULL, NULL);
}
