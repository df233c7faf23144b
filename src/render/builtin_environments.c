/* The built-in environments: images made from formulas. */
#include <math.h>
#include <string.h>

#include "environment.h"
#include "geometry.h"

enum { WIDTH = 512, HEIGHT = 256 };

typedef void radiance_of(const double direction[3], double rgb[3]);

static double smooth_step(double low, double high, double x)
{
    const double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/* 1 within an upright rectangle at an azimuth (0: behind the viewer, positive to the right) and an
 * elevation, 0 outside. Its edge is soft over a twentieth of its size. Degrees. */
static double soft_box(const double d[3], double azimuth, double elevation, double half_width,
                       double half_height)
{
    const double degree = M_PI / 180.0;
    const double across = remainder(atan2(d[0], d[2]) / degree - azimuth, 360.0);
    const double up = asin(fmin(fmax(d[1], -1.0), 1.0)) / degree - elevation;
    return smooth_step(1.0, 0.9, fabs(across) / half_width) *
           smooth_step(1.0, 0.9, fabs(up) / half_height);
}

/* A large lamp up to the left, a tall one to the right, a strip from behind, and a dim room. */
static void studio(const double d[3], double rgb[3])
{
    const double room = 0.12 + 0.10 * smooth_step(-0.6, 1.0, d[1]);
    const double key = 9.0 * soft_box(d, -42.0, 38.0, 24.0, 20.0);
    const double fill = 3.0 * soft_box(d, 62.0, 8.0, 12.0, 34.0);
    const double rim = 5.0 * soft_box(d, 165.0, 30.0, 40.0, 8.0);
    const double floor = 0.08 * smooth_step(0.0, -0.5, d[1]);
    rgb[0] = room + 1.00 * key + 0.92 * fill + 1.00 * rim + 1.05 * floor;
    rgb[1] = room + 0.97 * key + 0.98 * fill + 0.98 * rim + 1.00 * floor;
    rgb[2] = room + 0.92 * key + 1.08 * fill + 0.96 * rim + 0.92 * floor;
}

/* A blue sky that pales towards the horizon, a sun of 3 degrees half-angle up to the left with its
 * glow, and brown ground. */
static void sky(const double d[3], double rgb[3])
{
    static const double sun[3] = {-0.5, 0.6, 0.6244997998398398};
    static const double zenith[3] = {0.18, 0.38, 0.85};
    static const double horizon[3] = {0.85, 0.90, 1.00};
    static const double ground[3] = {0.20, 0.16, 0.12};
    static const double warm[3] = {1.0, 0.92, 0.78};
    const double cosine = fmin(gonio_i_dot3(d, sun), 1.0);
    const double height = fmax(d[1], 0.0);
    const double above = smooth_step(-0.02, 0.02, d[1]);
    const double disc = 260.0 * smooth_step(3.4, 2.6, acos(cosine) * 180.0 / M_PI);
    const double glow = 1.2 * pow(fmax(cosine, 0.0), 48.0);
    for (int k = 0; k < 3; k++) {
        const double air = zenith[k] + (horizon[k] - zenith[k]) * exp(-4.0 * height);
        rgb[k] = above * (air + warm[k] * (disc + glow)) + (1.0 - above) * ground[k];
    }
}

/* Equal radiance from all directions: a surface reflects what it does not absorb. */
static void furnace(const double d[3], double rgb[3])
{
    (void)d;
    rgb[0] = rgb[1] = rgb[2] = 1.0;
}

static const struct {
    const char *name, *summary;
    radiance_of *radiance;
} builtin[] = {
    {"studio", "two soft lamps, a strip from behind, a dim room", studio},
    {"sky", "a clear sky with the sun up to the left", sky},
    {"furnace", "radiance 1 from everywhere", furnace},
};

enum { BUILTIN = sizeof builtin / sizeof *builtin };

const char *gonio_environment_name(int index)
{
    return index >= 0 && index < BUILTIN ? builtin[index].name : NULL;
}

const char *gonio_environment_summary(int index)
{
    return index >= 0 && index < BUILTIN ? builtin[index].summary : NULL;
}

/* Fills each pixel with the radiance at its middle. */
static void fill(radiance_of *radiance, gonio_image *image)
{
    for (int row = 0; row < HEIGHT; row++) {
        for (int column = 0; column < WIDTH; column++) {
            const double theta = M_PI * (row + 0.5) / HEIGHT;
            const double angle = 2.0 * M_PI * ((column + 0.5) / WIDTH - 0.5);
            const double direction[3] = {sin(theta) * sin(angle), cos(theta),
                                         -sin(theta) * cos(angle)};
            double rgb[3];
            radiance(direction, rgb);
            float *pixel = image->rgba + (size_t)(row * WIDTH + column) * GONIO_IMAGE_CHANNELS;
            for (int k = 0; k < 3; k++) {
                pixel[k] = (float)rgb[k];
            }
            pixel[3] = 1.0F;
        }
    }
}

gonio_status gonio_i_environment_make(gonio_context *context, const char *name, gonio_image **image)
{
    *image = NULL;
    for (int k = 0; k < BUILTIN; k++) {
        if (strcmp(builtin[k].name, name) == 0) {
            const gonio_status status = gonio_image_create(context, WIDTH, HEIGHT, image);
            if (status == GONIO_OK) {
                fill(builtin[k].radiance, *image);
            }
            return status;
        }
    }
    return GONIO_OK;
}
