/* What must hold of renderings by their nature: energy, reciprocity, agreement with an analytic
 * model, convergence, independence of threads. */
#include "../support.h"

#include <gonio/gonio.h>
#include <math.h>
#include <string.h>

#include "../unit/made_material.h"
#include "core/random.h"
#include "direction/grid.h"
#include "render/environment.h"
#include "render/surface.h"

static gonio_image *render(const gonio_material *material, const gonio_render_options *options)
{
    gonio_image *image = NULL;
    assert_int_equal(gonio_render(NULL, material, options, &image), GONIO_OK);
    return image;
}

static gonio_render_options small(int side, int samples)
{
    gonio_render_options options;
    gonio_render_options_default(&options);
    options.width = options.height = side;
    options.samples = samples;
    return options;
}

static const float *pixel_of(const gonio_image *image, int x, int y)
{
    return image->rgba + (size_t)(y * image->width + x) * GONIO_IMAGE_CHANNELS;
}

/* ---- energy ---- */

static gonio_material *white(void)
{
    return made_material((made_constant){{M_1_PI, M_1_PI, M_1_PI}, NULL});
}

static void a_white_surface_is_white_in_the_furnace(void **state)
{
    (void)state;
    gonio_environment *furnace = NULL;
    assert_int_equal(gonio_environment_open(NULL, "furnace", false, &furnace), GONIO_OK);
    const int side = support_small() ? 32 : 64;
    gonio_render_options options = small(side, 256);
    options.environment = furnace;
    gonio_material *material = white();
    gonio_image *image = render(material, &options);
    double sum = 0.0;
    double worst = 0.0;
    int count = 0;
    for (int k = 0; k < side * side; k++) {
        const float *pixel = pixel_of(image, k % side, k / side);
        if (pixel[3] == 1.0F) {
            sum += (double)pixel[1];
            worst = fmax(worst, fabs((double)pixel[1] - 1.0));
            count++;
        }
    }
    assert_true(count > (support_small() ? 550 : 2500));
    assert_true(fabs(sum / count - 1.0) < 0.001);
    assert_true(worst < 0.05); /* the noise of one pixel */
    gonio_image_free(&image);
    gonio_material_free(&material);
    gonio_environment_free(&furnace);
}

/* Each pixel alone to 0.5 per cent, given samples enough. */
static void every_pixel_of_it_becomes_white(void **state)
{
    (void)state;
    gonio_environment *furnace = NULL;
    assert_int_equal(gonio_environment_open(NULL, "furnace", false, &furnace), GONIO_OK);
    const int side = support_small() ? 4 : 12;
    gonio_render_options options = small(side, 20000);
    options.environment = furnace;
    gonio_material *material = white();
    gonio_image *image = render(material, &options);
    int count = 0;
    for (int k = 0; k < side * side; k++) {
        const float *pixel = pixel_of(image, k % side, k / side);
        if (pixel[3] > 0.2F) {
            assert_true(fabs((double)pixel[0] / (double)pixel[3] - 1.0) < 0.005);
            count++;
        }
    }
    assert_true(count > side * side / 2);
    gonio_image_free(&image);
    gonio_material_free(&material);
    gonio_environment_free(&furnace);
}

/* A white Lambertian surface that faces either lamp, whose irradiance is pi there, has radiance 1.
 */
static void lamps_have_the_irradiance_they_say(void **state)
{
    (void)state;
    gonio_material *material = white();
    gonio_render_options options = small(33, 64);
    options.field_of_view = 0.0;
    options.lamp_position[0] = options.lamp_position[1] = 0.0;
    options.lamp_position[2] = 1.0;
    gonio_image *image = render(material, &options);
    assert_true(fabs((double)pixel_of(image, 16, 16)[0] - 1.0) < 2e-3);
    gonio_image_free(&image);
    options.lamp = GONIO_LAMP_POINT;
    options.lamp_position[2] = 5.0; /* 4 from the surface: (5/4)^2 brighter than at the origin */
    image = render(material, &options);
    assert_true(fabs((double)pixel_of(image, 16, 16)[0] - 25.0 / 16.0) < 4e-3);
    gonio_image_free(&image);
    gonio_material_free(&material);
}

/* ---- reciprocity ---- */

static void random_direction(gonio_i_random *random, double d[3])
{
    const double cosine = gonio_i_random_uniform(random);
    const double phi = 2.0 * M_PI * gonio_i_random_uniform(random);
    const double sine = sqrt(1.0 - cosine * cosine);
    d[0] = sine * cos(phi);
    d[1] = sine * sin(phi);
    d[2] = cosine;
}

static gonio_i_surface *surface_of(const char *name)
{
    gonio_material *material = NULL;
    gonio_i_surface *surface = NULL;
    assert_int_equal(gonio_material_open(NULL, name, &material), GONIO_OK);
    assert_int_equal(gonio_i_surface_create(NULL, material, &surface), GONIO_OK);
    gonio_material_free(&material);
    return surface;
}

static void light_and_view_can_be_exchanged(void **state)
{
    (void)state;
    gonio_i_surface *surface = surface_of("atlas:gold-polished");
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, 0);
    for (int k = 0; k < 20000; k++) {
        double i[3];
        double o[3];
        double there[3];
        double back[3];
        random_direction(&random, i);
        random_direction(&random, o);
        const gonio_i_meeting forth = gonio_i_meet(i, o);
        const gonio_i_meeting reverse = gonio_i_meet(o, i);
        gonio_i_surface_value(surface, &forth, there);
        gonio_i_surface_value(surface, &reverse, back);
        for (int c = 0; c < 3; c++) {
            assert_true(there[c] >= 0.0);
            assert_true(fabs(there[c] - back[c]) <= 1e-9 * there[c]);
        }
    }
    gonio_i_surface_free(&surface);
}

/* ---- sampling ---- */

/* The densities are of what is sampled: the mean of 1/density over samples is the solid angle that
 * they can reach, for any function over which the samples are spread. Here cos/density, whose mean
 * is the integral of the cosine, pi. */
static void surfaces_are_sampled_as_densely_as_they_say(void **state)
{
    (void)state;
    static const char *const names[] = {"atlas:gold-polished", "atlas:red-cotton"};
    for (int m = 0; m < 2; m++) {
        gonio_i_surface *surface = surface_of(names[m]);
        gonio_i_random random;
        gonio_i_random_seed(&random, 2, 0);
        double o[3] = {0.6, 0.0, 0.8};
        double sum = 0.0;
        const int count = support_small() ? 40000 : 400000;
        for (int k = 0; k < count; k++) {
            double i[3];
            const double uniform[3] = {gonio_i_random_uniform(&random),
                                       gonio_i_random_uniform(&random),
                                       gonio_i_random_uniform(&random)};
            if (gonio_i_surface_sample(surface, o, uniform, i)) {
                const gonio_i_meeting meeting = gonio_i_meet(i, o);
                sum += i[2] / gonio_i_surface_density(surface, &meeting);
            }
        }
        assert_true(fabs(sum / count / M_PI - 1.0) < 0.01);
        gonio_i_surface_free(&surface);
    }
}

static void environments_are_sampled_as_densely_as_they_say(void **state)
{
    (void)state;
    for (int e = 0; gonio_environment_name(e) != NULL; e++) {
        gonio_environment *environment = NULL;
        gonio_i_random random;
        gonio_i_random_seed(&random, 3, (uint64_t)e);
        assert_int_equal(
            gonio_environment_open(NULL, gonio_environment_name(e), false, &environment), GONIO_OK);
        double sampled = 0.0;
        double uniformly = 0.0;
        const int count = support_small() ? 100000 : 1000000;
        for (int k = 0; k < count; k++) {
            double direction[3];
            double light[3];
            double density;
            const double uniform[2] = {gonio_i_random_uniform(&random),
                                       gonio_i_random_uniform(&random)};
            gonio_i_environment_sample(environment, uniform, direction);
            gonio_i_environment_look(environment, direction, light, &density);
            sampled += 1.0 / density; /* the whole sphere, as none of them has black pixels */
            random_direction(&random, direction);
            direction[1] *= k % 2 == 0 ? 1.0 : -1.0;
            direction[2] *= k % 3 == 0 ? 1.0 : -1.0;
            gonio_i_environment_look(environment, direction, light, &density);
            uniformly += density > 0.0 ? 1.0 : 0.0;
        }
        assert_true(uniformly == count);
        assert_true(fabs(sampled / count / (4.0 * M_PI) - 1.0) < 0.01);
        gonio_environment_free(&environment);
    }
}

/* ---- an analytic model ---- */

/* GGX with roughness 0.35 and Schlick's Fresnel term over a diffuse base. */
static double ggx(double cosine_i, double cosine_o, double cosine_h, double cosine_d)
{
    const double a2 = 0.35 * 0.35;
    const double t = cosine_h * cosine_h * (a2 - 1.0) + 1.0;
    const double d = a2 / (M_PI * t * t);
    const double g_i = 2.0 * cosine_i / (cosine_i + sqrt(a2 + (1.0 - a2) * cosine_i * cosine_i));
    const double g_o = 2.0 * cosine_o / (cosine_o + sqrt(a2 + (1.0 - a2) * cosine_o * cosine_o));
    const double f = 0.04 + 0.96 * pow(1.0 - cosine_d, 5.0);
    return 0.2 * M_1_PI + d * g_i * g_o * f / (4.0 * cosine_i * cosine_o);
}

static gonio_status read_ggx(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)self;
    (void)context;
    for (int k = 0; k < GONIO_SLAB_BINS; k++) {
        const gonio_bin bin = {theta_h, k / GONIO_PHI_D_BINS, k % GONIO_PHI_D_BINS};
        const gonio_half_difference c = gonio_bin_centre(bin);
        double cosine_i;
        double cosine_o;
        gonio_cosines(c, &cosine_i, &cosine_o);
        const double value = gonio_bin_is_valid(bin)
                                 ? ggx(cosine_i, cosine_o, cos(c.theta_h), cos(c.theta_d))
                                 : -1.0;
        rho[k] = rho[GONIO_SLAB_BINS + k] = rho[2 * GONIO_SLAB_BINS + k] = value;
    }
    return GONIO_OK;
}

/* The sphere's pixel by the model itself: parallel rays, `lamp` far away, 8 x 8 points a pixel. */
static double analytic_pixel(int x, int y, int side, const double lamp[3])
{
    enum { POINTS = 8 };
    double sum = 0.0;
    for (int k = 0; k < POINTS * POINTS; k++) {
        const double px = (x + (k % POINTS + 0.5) / POINTS - 0.5 * side) * 2.0 / side / 0.95;
        const double py = (0.5 * side - y - (k / POINTS + 0.5) / POINTS) * 2.0 / side / 0.95;
        const double r2 = px * px + py * py;
        if (r2 >= 1.0) {
            continue;
        }
        const double pz = sqrt(1.0 - r2); /* the normal, and the cosine of the view along z */
        const double cosine_i = px * lamp[0] + py * lamp[1] + pz * lamp[2];
        if (cosine_i <= 0.0) {
            continue;
        }
        double h[3] = {lamp[0], lamp[1], lamp[2] + 1.0};
        const double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
        const double cosine_h = (px * h[0] + py * h[1] + pz * h[2]) / length;
        sum += ggx(cosine_i, pz, cosine_h, 0.5 * length) * cosine_i * M_PI;
    }
    return sum / (POINTS * POINTS);
}

static void a_tabulated_model_renders_like_itself(void **state)
{
    (void)state;
    const int side = support_small() ? 16 : 48;
    gonio_material *material = NULL;
    const gonio_material_source source = {.size = sizeof source, .read_slab = read_ggx};
    assert_int_equal(gonio_material_create(NULL, "ggx", "made", &source, &material), GONIO_OK);
    gonio_render_options options = small(side, 512);
    options.field_of_view = 0.0;
    const double lamp[3] = {-0.48, 0.6, 0.64};
    memcpy(options.lamp_position, lamp, sizeof lamp);
    gonio_image *image = render(material, &options);
    double difference = 0.0;
    double all = 0.0;
    double worst = 0.0;
    for (int k = 0; k < side * side; k++) {
        const float *pixel = pixel_of(image, k % side, k / side);
        const double expected = analytic_pixel(k % side, k / side, side, lamp);
        const double error = fabs((double)pixel[0] - expected);
        difference += error;
        all += expected;
        if (pixel[3] == 1.0F && expected > 0.05) {
            worst = fmax(worst, error / expected);
        }
    }
    print_message("GGX: mean difference %.3f %%, worst pixel %.2f %%\n", 100.0 * difference / all,
                  100.0 * worst);
    assert_true(difference / all < 0.005);
    assert_true(worst < 0.05);
    gonio_image_free(&image);
    gonio_material_free(&material);
}

/* ---- convergence, threads ---- */

static double rms_difference(const gonio_image *a, const gonio_image *b)
{
    double sum = 0.0;
    const size_t count = (size_t)a->width * (size_t)a->height * GONIO_IMAGE_CHANNELS;
    for (size_t k = 0; k < count; k++) {
        const double d = (double)a->rgba[k] - (double)b->rgba[k];
        sum += d * d;
    }
    return sqrt(sum / (double)count);
}

static void the_error_falls_with_the_root_of_the_samples(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    gonio_environment *studio = NULL;
    assert_int_equal(gonio_material_open(NULL, "atlas:red-glossy-plastic", &material), GONIO_OK);
    assert_int_equal(gonio_environment_open(NULL, "studio", false, &studio), GONIO_OK);
    gonio_render_options options = small(32, 4096);
    options.environment = studio;
    options.seed = 99;
    gonio_image *truth = render(material, &options);
    double error[3];
    options.seed = 0;
    for (int k = 0; k < 3; k++) {
        options.samples = 16 << (2 * k);
        gonio_image *image = render(material, &options);
        error[k] = rms_difference(image, truth);
        gonio_image_free(&image);
    }
    print_message("RMS error with 16, 64, 256 samples: %.4f %.4f %.4f\n", error[0], error[1],
                  error[2]);
    assert_true(error[1] < error[0] / 1.7 && error[2] < error[1] / 1.7);
    assert_true(error[2] < error[0] / 3.6);
    assert_true(error[2] > error[0] / 16.0); /* and is no artefact of equal images */
    gonio_image_free(&truth);
    gonio_environment_free(&studio);
    gonio_material_free(&material);
}

static void threads_and_repetition_change_nothing(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    gonio_environment *sky = NULL;
    gonio_image *image[3] = {NULL};
    assert_int_equal(gonio_material_open(NULL, "atlas:oak-sawn", &material), GONIO_OK);
    assert_int_equal(gonio_environment_open(NULL, "sky", false, &sky), GONIO_OK);
    gonio_render_options options = small(24, 8);
    options.environment = sky;
    options.show_environment = true;
    for (int k = 0; k < 3; k++) {
        const gonio_context_options how = {.size = sizeof how, .threads = k == 0 ? 1 : 4};
        gonio_context *context = NULL;
        assert_int_equal(gonio_context_create(&context, &how), GONIO_OK);
        options.seed = k == 2 ? 1 : 0;
        assert_int_equal(gonio_render(context, material, &options, &image[k]), GONIO_OK);
        gonio_context_free(&context);
    }
    const size_t size = (size_t)24 * 24 * GONIO_IMAGE_CHANNELS * sizeof(float);
    assert_memory_equal(image[0]->rgba, image[1]->rgba, size);
    assert_true(memcmp(image[0]->rgba, image[2]->rgba, size) != 0);
    for (int k = 0; k < 3; k++) {
        gonio_image_free(&image[k]);
    }
    gonio_environment_free(&sky);
    gonio_material_free(&material);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_white_surface_is_white_in_the_furnace),
        cmocka_unit_test(every_pixel_of_it_becomes_white),
        cmocka_unit_test(lamps_have_the_irradiance_they_say),
        cmocka_unit_test(light_and_view_can_be_exchanged),
        cmocka_unit_test(surfaces_are_sampled_as_densely_as_they_say),
        cmocka_unit_test(environments_are_sampled_as_densely_as_they_say),
        cmocka_unit_test(a_tabulated_model_renders_like_itself),
        cmocka_unit_test(the_error_falls_with_the_root_of_the_samples),
        cmocka_unit_test(threads_and_repetition_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
