/* Rendering: the BRDF looked up, tone mapping, differences, environments, spheres and meshes. */
#include "../support.h"

#include <gonio/gonio.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "made_direct.h"
#include "made_material.h"
#include "render/environment.h"
#include "render/surface.h"
#include "render_fixture.h"

static void direction_of(gonio_angles angles, double d[3])
{
    d[0] = sin(angles.theta) * cos(angles.phi);
    d[1] = sin(angles.theta) * sin(angles.phi);
    d[2] = cos(angles.theta);
}

static void bin_centres_give_their_own_values(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    gonio_i_surface *surface = NULL;
    gonio_table *table = NULL;
    assert_int_equal(gonio_material_open(NULL, "atlas:blue-pearl", &material), GONIO_OK);
    assert_int_equal(gonio_i_surface_create(NULL, material, &surface), GONIO_OK);
    table = made_table(material);
    const double *values = gonio_table_values(table);
    int tested = 0;
    for (int32_t at = 0; at < GONIO_BINS; at += 101) {
        const gonio_bin bin = gonio_bin_from_index(at);
        if (!gonio_bin_is_valid(bin)) {
            continue;
        }
        const gonio_pair pair = gonio_pair_from_half_difference(gonio_bin_centre(bin));
        double i[3];
        double o[3];
        double rho[3];
        direction_of(pair.incident, i);
        direction_of(pair.outgoing, o);
        const gonio_i_meeting meeting = gonio_i_meet(i, o);
        gonio_i_surface_value(surface, &meeting, rho);
        for (int c = 0; c < 3; c++) {
            const double own =
                values[(size_t)bin.theta_h * GONIO_SLAB_VALUES + (size_t)c * GONIO_SLAB_BINS +
                       (size_t)bin.theta_d * GONIO_PHI_D_BINS + (size_t)bin.phi_d];
            assert_close(rho[c] / own, 1.0, 1e-6); /* float32 */
        }
        tested++;
    }
    assert_true(tested > 10000);
    gonio_table_free(&table);
    gonio_i_surface_free(&surface);
    gonio_material_free(&material);
}

/* Between centres the same as the table's own interpolation, by way of other formulas. */
static void between_centres_it_is_the_tables_interpolation(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    gonio_i_surface *surface = NULL;
    assert_int_equal(gonio_material_open(NULL, "atlas:gold-polished", &material), GONIO_OK);
    assert_int_equal(gonio_i_surface_create(NULL, material, &surface), GONIO_OK);
    gonio_table *table = made_table(material);
    int tested = 0;
    for (int k = 0; k < 20000; k++) {
        const gonio_pair pair = {{1.5 * fmod(k * 0.618034, 1.0), 6.2 * fmod(k * 0.754878, 1.0)},
                                 {1.5 * fmod(k * 0.569840, 1.0), 6.2 * fmod(k * 0.324717, 1.0)}};
        double i[3];
        double o[3];
        double rho[3];
        double expected[3];
        direction_of(pair.incident, i);
        direction_of(pair.outgoing, o);
        const gonio_i_meeting meeting = gonio_i_meet(i, o);
        gonio_i_surface_value(surface, &meeting, rho);
        if (gonio_table_value(table, gonio_half_difference_from_pair(pair), expected)) {
            for (int c = 0; c < 3; c++) {
                assert_close(rho[c] / expected[c], 1.0, 1e-5);
            }
            tested++;
        }
    }
    assert_true(tested > 19000);
    gonio_table_free(&table);
    gonio_i_surface_free(&surface);
    gonio_material_free(&material);
}

static bool is_band(gonio_bin bin)
{
    return bin.theta_d >= 20 && bin.theta_d < 40;
}

static bool is_everything(gonio_bin bin)
{
    (void)bin;
    return true;
}

static void holes_are_filled_from_what_is_near(void **state)
{
    (void)state;
    gonio_material *material = made_material((made_constant){{0.3, 0.2, 0.1}, is_band});
    gonio_i_surface *surface = NULL;
    assert_int_equal(gonio_i_surface_create(NULL, material, &surface), GONIO_OK);
    for (int degrees = 0; degrees < 88; degrees++) {
        const double angle = degrees * M_PI / 180.0;
        const double i[3] = {sin(angle), 0.0, cos(angle)};
        const double o[3] = {-sin(angle), 0.0, cos(angle)};
        double rho[3];
        const gonio_i_meeting meeting = gonio_i_meet(i, o);
        gonio_i_surface_value(surface, &meeting, rho);
        assert_close(rho[0], 0.3, 1e-6);
        assert_close(rho[2], 0.1, 1e-6);
    }
    gonio_i_surface_free(&surface);
    gonio_material_free(&material);
    material = made_material((made_constant){{0.3, 0.2, 0.1}, is_everything});
    assert_int_equal(gonio_i_surface_create(telling, material, &surface), GONIO_ERROR_DATA);
    assert_non_null(strstr(support_message(), "holds no data"));
    gonio_material_free(&material);
}

static gonio_image *image_of(int width, int height, const float *rgba)
{
    gonio_image *image = NULL;
    assert_int_equal(gonio_image_create(NULL, width, height, &image), GONIO_OK);
    memcpy(image->rgba, rgba, (size_t)(width * height) * 4 * sizeof(float));
    return image;
}

static void tones_are_those_of_the_formula(void **state)
{
    (void)state;
    static const float rgba[] = {1, 1, 1, 1, 4, 4, 4, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0.5F, 0, 0, 0.5F};
    gonio_image *image = image_of(5, 1, rgba);
    const gonio_tone tone = gonio_tone_measure(image, 0.18);
    /* The third shows nothing, the fourth is black, the last is pure red behind half a pixel. */
    const double average = exp((log(1.00001) + log(4.00001) + log(0.21261)) / 3.0);
    assert_close(tone.average, average, 1e-6);
    assert_close(tone.white, 0.18 * 4.0 / average, 1e-6);
    double shown[3];
    const double brightest[3] = {4.0, 4.0, 4.0};
    gonio_tone_apply(&tone, brightest, shown);
    assert_close(shown[0], 1.0, 1e-9);
    const double some[3] = {0.9, 0.5, 0.2};
    const double world = 0.2126 * 0.9 + 0.7152 * 0.5 + 0.0722 * 0.2;
    const double l = 0.18 * world / average;
    const double expected = l * (1.0 + l / (tone.white * tone.white)) / (1.0 + l);
    gonio_tone_apply(&tone, some, shown);
    for (int c = 0; c < 3; c++) {
        assert_close(shown[c], some[c] * expected / world, 1e-12);
    }
    gonio_image_free(&image);
    image = image_of(1, 1, (const float[]){0, 0, 0, 1});
    assert_close(gonio_tone_measure(image, 0.18).average, 1.0, 0.0);
    gonio_image_free(&image);
    assert_close(gonio_srgb_encode(0.0), 0.0, 0.0);
    assert_close(gonio_srgb_encode(1.0), 1.0, 1e-12);
    assert_close(gonio_srgb_encode(0.2140411), 0.5, 1e-6);
}

/* BT.2100: grey has Ct = Cp = 0 and I = PQ(luminance); PQ of 203 cd/m^2 is 0.58 (BT.2408), of 100
 * 0.508 (BT.2100's table), and BT.2124 multiplies by 720. */
static void delta_e_itp_is_that_of_bt2124(void **state)
{
    (void)state;
    const double white[3] = {1.0, 1.0, 1.0};
    const double hundred[3] = {100.0 / 203.0, 100.0 / 203.0, 100.0 / 203.0};
    const double black[3] = {0.0, 0.0, 0.0};
    assert_close(gonio_delta_e_itp(white, white), 0.0, 0.0);
    assert_close(gonio_delta_e_itp(white, black) / 720.0, 0.5807, 2e-4);
    assert_close(gonio_delta_e_itp(hundred, black) / 720.0, 0.5081, 2e-4);
    assert_close(gonio_delta_e_itp(hundred, white), gonio_delta_e_itp(white, hundred), 1e-12);
    /* BT.709 red at 203 cd/m^2 against white, worked out in 40 digits from the Recommendations. */
    const double red[3] = {1.0, 0.0, 0.0};
    assert_close(gonio_delta_e_itp(red, white), 232.6185, 1e-3);
}

static void images_are_compared_where_they_show_something(void **state)
{
    (void)state;
    gonio_image_error error;
    float map[2];
    const gonio_tone tone = {0.18, 0.18, 1e9}; /* L/(1 + L) */
    gonio_image *a = image_of(2, 1, (const float[]){1, 1, 1, 1, 0, 0, 0, 0});
    gonio_image *b = image_of(2, 1, (const float[]){3, 3, 3, 1, 0, 0, 0, 0});
    assert_int_equal(gonio_image_compare(NULL, a, b, &tone, &error, map), GONIO_OK);
    const double d = gonio_srgb_encode(0.75) - gonio_srgb_encode(0.5);
    assert_close(error.psnr, -20.0 * log10(d), 1e-6);
    const double half[3] = {0.5, 0.5, 0.5};
    const double more[3] = {0.75, 0.75, 0.75};
    assert_close(error.delta_e_itp, gonio_delta_e_itp(half, more), 1e-6);
    assert_close((double)map[0], error.delta_e_itp, 1e-4);
    assert_true(map[1] == 0.0F);
    assert_int_equal(gonio_image_compare(NULL, a, a, &tone, &error, NULL), GONIO_OK);
    assert_true(isinf(error.psnr) && error.psnr > 0.0 && error.delta_e_itp == 0.0);
    gonio_image_free(&b);
    assert_int_equal(gonio_image_create(NULL, 1, 1, &b), GONIO_OK);
    assert_int_equal(gonio_image_compare(telling, a, b, &tone, &error, NULL), GONIO_ERROR_MISMATCH);
    assert_int_equal(gonio_image_compare(telling, b, b, &tone, &error, NULL), GONIO_ERROR_DATA);
    gonio_image_free(&a);
    gonio_image_free(&b);
}

/* A sphere of triangles as PLY text: rings x 2 rings. */
static char *sphere_text(int rings)
{
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    assert_non_null(f);
    fprintf(f, "# sphere\n");
    for (int i = 0; i <= rings; i++) {
        for (int j = 0; j < 2 * rings; j++) {
            const double theta = M_PI * i / rings;
            const double phi = M_PI * j / rings;
            fprintf(f, "v %.9f %.9f %.9f\n", 5.0 + 3.0 * sin(theta) * cos(phi), 3.0 * cos(theta),
                    3.0 * sin(theta) * sin(phi));
        }
    }
    for (int i = 0; i < rings; i++) {
        for (int j = 0; j < 2 * rings; j++) {
            const int a = 2 * rings * i + j + 1;
            const int b = 2 * rings * i + (j + 1) % (2 * rings) + 1;
            fprintf(f, "f %d %d %d %d\n", a, b, b + 2 * rings, a + 2 * rings);
        }
    }
    fclose(f);
    return text;
}

static void a_mesh_of_a_sphere_looks_like_the_sphere(void **state)
{
    (void)state;
    char *text = sphere_text(64);
    gonio_mesh *mesh = NULL;
    assert_int_equal(read_mesh(text, strlen(text), &mesh), GONIO_OK);
    gonio_material *material = made_material((made_constant){{0.3, 0.2, 0.1}, NULL});
    gonio_render_options options;
    gonio_render_options_default(&options);
    options.width = options.height = 40;
    gonio_image *image[2] = {NULL};
    for (int k = 0; k < 2; k++) {
        options.mesh = k == 0 ? NULL : mesh;
        assert_int_equal(gonio_render(NULL, material, &options, &image[k]), GONIO_OK);
    }
    double difference = 0.0;
    for (int k = 0; k < 40 * 40 * 4; k++) {
        difference += fabs((double)image[0]->rgba[k] - (double)image[1]->rgba[k]) / (40 * 40 * 4);
    }
    print_message("mean difference %.5f\n", difference);
    assert_true(difference < 2e-3);
    gonio_image_free(&image[0]);
    gonio_image_free(&image[1]);
    gonio_mesh_free(&mesh);
    gonio_material_free(&material);
    free(text);
}

static void environments_without_light_are_refused(void **state)
{
    (void)state;
    static const float bad[][4] = {{-1, 0, 0, 1}, {NAN, 0, 0, 1}, {INFINITY, 1, 1, 1}};
    gonio_environment *environment = NULL;
    for (size_t k = 0; k < 3; k++) {
        for (int repair = 0; repair < 2; repair++) {
            gonio_image *image = image_of(2, 1, (const float[]){1, 1, 1, 1, 0, 0, 0, 1});
            memcpy(image->rgba + 4, bad[k], sizeof bad[k]);
            const gonio_status status =
                gonio_i_environment_wrap(telling, "made", image, repair != 0, &environment);
            assert_int_equal(status, repair ? GONIO_OK : GONIO_ERROR_DATA);
            assert_true(repair || strstr(support_message(), "row 1, column 2") != NULL);
            gonio_environment_free(&environment);
        }
    }
    gonio_image *black = image_of(1, 1, (const float[]){0, 0, 0, 1});
    assert_int_equal(gonio_i_environment_wrap(telling, "made", black, true, &environment),
                     GONIO_ERROR_DATA);
}

/* The middle of a map is behind the object for the viewer, its left quarter to the left. */
static void environments_are_the_right_way_round(void **state)
{
    (void)state;
    gonio_environment *environment = NULL;
    gonio_image *image =
        image_of(4, 1, (const float[]){1, 1, 1, 1, 2, 2, 2, 1, 3, 3, 3, 1, 4, 4, 4, 1});
    assert_int_equal(gonio_i_environment_wrap(NULL, "made", image, false, &environment), GONIO_OK);
    static const double directions[4][3] = {
        {-0.1, 0, 0.99}, {-0.99, 0, -0.1}, {0.1, 0, -0.99}, {0.99, 0, 0.1}};
    for (int k = 0; k < 4; k++) {
        double light[3];
        double density;
        gonio_i_environment_look(environment, directions[k], light, &density);
        assert_close(light[0], k + 1.0, 0.0);
    }
    gonio_environment_free(&environment);
}

static void what_cannot_be_rendered_is_said(void **state)
{
    (void)state;
    gonio_material *material = made_material((made_constant){{0.3, 0.2, 0.1}, NULL});
    gonio_image *image = NULL;
    gonio_render_options options;
    for (int k = 0; k < 5; k++) {
        gonio_render_options_default(&options);
        options.samples = k == 0 ? 0 : 1;
        options.width = k == 1 ? 0 : 8;
        options.height = k == 2 ? GONIO_MOST_PIXELS + 1 : 8;
        options.field_of_view = k == 3 ? (double)NAN : 0.5;
        options.lamp = k == 4 ? GONIO_LAMP_POINT : GONIO_LAMP_DIRECTIONAL;
        options.lamp_position[0] = options.lamp_position[1] = 0.1;
        assert_int_equal(gonio_render(telling, material, &options, &image), GONIO_ERROR_ARGUMENT);
        assert_null(image);
    }
    gonio_material_free(&material);
}

/* A reference is the rendering of its material; what is compared with it is rendered as it was. */
static void a_reference_is_a_rendering_to_compare_with(void **state)
{
    (void)state;
    gonio_material *material = made_material((made_constant){{0.3, 0.2, 0.1}, NULL});
    gonio_material *other = made_material((made_constant){{0.25, 0.2, 0.1}, NULL});
    gonio_render_options options;
    gonio_reference *reference = NULL;
    gonio_image *image[2] = {NULL};
    gonio_image_error error, expected;
    gonio_render_options_default(&options);
    options.width = options.height = 24;
    options.samples = 4;
    assert_int_equal(gonio_reference_create(NULL, material, &options, &reference), GONIO_OK);
    assert_int_equal(gonio_render(NULL, material, &options, &image[0]), GONIO_OK);
    const size_t size = sizeof(float) * 24 * 24 * GONIO_IMAGE_CHANNELS;
    assert_memory_equal(gonio_reference_image(reference)->rgba, image[0]->rgba, size);
    const gonio_tone tone = gonio_reference_tone(reference);
    const gonio_tone measured = gonio_tone_measure(image[0], 0.18);
    assert_true(tone.key == measured.key && tone.average == measured.average &&
                tone.white == measured.white);
    assert_int_equal(gonio_reference_compare(NULL, reference, material, &error), GONIO_OK);
    assert_true(isinf(error.psnr) && error.delta_e_itp == 0.0);
    assert_int_equal(gonio_reference_render(NULL, reference, other, &image[1]), GONIO_OK);
    assert_int_equal(gonio_image_compare(NULL, image[0], image[1], &tone, &expected, NULL),
                     GONIO_OK);
    assert_int_equal(gonio_reference_compare(NULL, reference, other, &error), GONIO_OK);
    assert_true(error.psnr == expected.psnr && error.delta_e_itp == expected.delta_e_itp);
    assert_true(error.delta_e_itp > 0.5);
    gonio_image_free(&image[0]);
    gonio_image_free(&image[1]);
    gonio_reference_free(&reference);
    gonio_material_free(&other);
    gonio_material_free(&material);
}

/* Structs whose size nobody set. */
static void what_was_not_initialised_is_refused(void **state)
{
    (void)state;
    static const size_t sizes[] = {0, SIZE_MAX};
    gonio_context *context = support_context();
    gonio_material *material = made_material((made_constant){{0.3, 0.2, 0.1}, NULL});
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        const gonio_render_options options = {.size = sizes[k]};
        const gonio_comparison_picture picture = {.size = sizes[k]};
        gonio_image *image = NULL;
        gonio_reference *reference = NULL;
        assert_int_equal(gonio_render(context, material, &options, &image), GONIO_ERROR_ARGUMENT);
        assert_non_null(strstr(support_message(), "call gonio_render_options_default first"));
        assert_int_equal(gonio_reference_create(context, material, &options, &reference),
                         GONIO_ERROR_ARGUMENT);
        assert_int_equal(gonio_comparison_picture_write_png(context, &picture, "/nonexistent"),
                         GONIO_ERROR_ARGUMENT);
        assert_non_null(strstr(support_message(), "set .size = sizeof(gonio_comparison_picture)"));
        assert_true(image == NULL && reference == NULL);
    }
    gonio_material_free(&material);
    gonio_context_free(&context);
}

/* A material that can be evaluated is, at the directions themselves, as far as it has data. */
static void what_can_be_evaluated_is_evaluated(void **state)
{
    (void)state;
    gonio_material *material = made_direct(3, NULL, 1.2);
    gonio_i_surface *surface = NULL;
    assert_int_equal(gonio_i_surface_create(NULL, material, &surface), GONIO_OK);
    for (int k = 0; k < 200; k++) {
        const gonio_pair pair = {{1.19 * k / 200.0, 0.1 * k}, {1.18 - 1.18 * k / 200.0, 2.0}};
        const gonio_pair beyond = {{1.3, 0.5}, {0.1, 0.0}};
        double i[3];
        double o[3];
        double rho[3];
        direction_of(pair.incident, i);
        direction_of(pair.outgoing, o);
        const gonio_i_meeting meeting = gonio_i_meet(i, o);
        gonio_i_surface_value(surface, &meeting, rho);
        for (size_t c = 0; c < 3; c++) {
            assert_close(rho[c], made_direct_value(pair, c), 1e-9);
        }
        direction_of(beyond.incident, i);
        direction_of(beyond.outgoing, o);
        const gonio_i_meeting outside = gonio_i_meet(i, o);
        gonio_i_surface_value(surface, &outside, rho);
        assert_true(rho[0] > 0.0); /* the nearest data stand in */
    }
    gonio_i_surface_free(&surface);
    gonio_material_free(&material);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bin_centres_give_their_own_values),
        cmocka_unit_test(what_can_be_evaluated_is_evaluated),
        cmocka_unit_test(between_centres_it_is_the_tables_interpolation),
        cmocka_unit_test(holes_are_filled_from_what_is_near),
        cmocka_unit_test(tones_are_those_of_the_formula),
        cmocka_unit_test(delta_e_itp_is_that_of_bt2124),
        cmocka_unit_test(images_are_compared_where_they_show_something),
        cmocka_unit_test(a_mesh_of_a_sphere_looks_like_the_sphere),
        cmocka_unit_test(environments_without_light_are_refused),
        cmocka_unit_test(environments_are_the_right_way_round),
        cmocka_unit_test(what_cannot_be_rendered_is_said),
        cmocka_unit_test(a_reference_is_a_rendering_to_compare_with),
        cmocka_unit_test(what_was_not_initialised_is_refused),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
