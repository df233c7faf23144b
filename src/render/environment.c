/* Environments: images of the light from all directions, looked up and sampled by luminance. */
#include "environment.h"

#include <math.h>
#include <stdlib.h>

#include "geometry.h"
#include "image.h"

struct gonio_environment {
    gonio_image *image;
    double *row_sum;        /* [height + 1]: power of all rows before */
    double *column_sum;     /* [height][width + 1]: the same within a row */
    double *row_cosine;     /* [height + 1]: of the polar angle of the rows' edges */
    uint32_t *row_guide;    /* [height]: see guide_to */
    uint32_t *column_guide; /* [height][width] */
};

void gonio_environment_free(gonio_environment **environment)
{
    if (environment == NULL || *environment == NULL) {
        return;
    }
    gonio_image_free(&(*environment)->image);
    free((*environment)->row_sum);
    free((*environment)->column_sum);
    free((*environment)->row_cosine);
    free((*environment)->row_guide);
    free((*environment)->column_guide);
    free(*environment);
    *environment = NULL;
}

/* ---- pixels and directions ---- */

static const float *pixel_at(const gonio_environment *e, int column, int row)
{
    return e->image->rgba +
           ((size_t)row * (size_t)e->image->width + (size_t)column) * GONIO_IMAGE_CHANNELS;
}

/* The place of a direction in pixels: 0 .. width from left to right, 0 .. height from the top. */
static void place_of(const gonio_environment *e, const double direction[3], double *x, double *y)
{
    const double revolutions = atan2(direction[0], -direction[2]) / (2.0 * M_PI) + 0.5;
    *x = revolutions * e->image->width;
    *y = acos(fmin(fmax(direction[1], -1.0), 1.0)) / M_PI * e->image->height;
}

static int clamp(int value, int count)
{
    return value < 0 ? 0 : value < count ? value : count - 1;
}

/* The solid angle of each pixel of a row: a band of the sphere in equal parts. */
static double solid_angle(const gonio_environment *e, int row)
{
    return 2.0 * M_PI / e->image->width * (e->row_cosine[row] - e->row_cosine[row + 1]);
}

static double luminance_of(const float *pixel)
{
    const double rgb[3] = {(double)pixel[0], (double)pixel[1], (double)pixel[2]};
    return gonio_i_luminance(rgb);
}

void gonio_i_environment_look(const gonio_environment *environment, const double direction[3],
                              double radiance[3], double *density)
{
    double x;
    double y;
    place_of(environment, direction, &x, &y);
    const float *pixel = pixel_at(environment, clamp((int)x, environment->image->width),
                                  clamp((int)y, environment->image->height));
    for (int k = 0; k < 3; k++) {
        radiance[k] = (double)pixel[k];
    }
    *density = luminance_of(pixel) / environment->row_sum[environment->image->height];
}

void gonio_i_environment_shown(const gonio_environment *environment, const double direction[3],
                               double radiance[3])
{
    double x;
    double y;
    const int width = environment->image->width;
    const int height = environment->image->height;
    place_of(environment, direction, &x, &y);
    const int left = (int)floor(x - 0.5);
    const int top = (int)floor(y - 0.5);
    radiance[0] = radiance[1] = radiance[2] = 0.0;
    for (int k = 0; k < 4; k++) {
        const int column = left + k % 2;
        const int row = top + k / 2;
        const double weight = (1.0 - fabs(x - 0.5 - column)) * (1.0 - fabs(y - 0.5 - row));
        const float *pixel = pixel_at(environment, (column + width) % width, clamp(row, height));
        for (int c = 0; c < 3; c++) {
            radiance[c] += weight * (double)pixel[c];
        }
    }
}

/* ---- sampling ---- */

/* Divides the range of an ascending list sum[count + 1], from 0 on, into `count` equal parts.
 * guide: the interval of the list that holds the beginning of each part. From there the interval
 * that holds a value is a step or two away (Chen and Asau 1974). */
static void guide_to(const double *sum, int count, uint32_t *guide)
{
    uint32_t at = 0;
    for (int k = 0; k < count; k++) {
        while ((int)at + 1 < count && sum[at + 1] <= sum[count] * k / count) {
            at++;
        }
        guide[k] = at;
    }
}

/* Chooses an interval in proportion to its length, and a place in it, 0 .. 1. */
static int choose(const double *sum, const uint32_t *guide, int count, double uniform,
                  double *within)
{
    const double value = uniform * sum[count];
    int at = (int)guide[clamp((int)(uniform * count), count)];
    while (at + 1 < count && sum[at + 1] <= value) {
        at++;
    }
    const double length = sum[at + 1] - sum[at];
    *within = length > 0.0 ? fmin((value - sum[at]) / length, 1.0) : 0.5;
    return at;
}

void gonio_i_environment_sample(const gonio_environment *environment, const double uniform[2],
                                double direction[3])
{
    const gonio_environment *e = environment;
    const size_t width = (size_t)e->image->width;
    double down;
    double across;
    const int row = choose(e->row_sum, e->row_guide, e->image->height, uniform[0], &down);
    const int column =
        choose(e->column_sum + (size_t)row * (width + 1), e->column_guide + (size_t)row * width,
               e->image->width, uniform[1], &across);
    const double cosine = e->row_cosine[row] + down * (e->row_cosine[row + 1] - e->row_cosine[row]);
    const double sine = sqrt(fmax(0.0, 1.0 - cosine * cosine));
    const double angle = 2.0 * M_PI * ((column + across) / (double)width - 0.5);
    direction[0] = sine * sin(angle);
    direction[1] = cosine;
    direction[2] = -sine * cos(angle);
}

static gonio_status allocate(gonio_context *context, size_t width, size_t height,
                             gonio_environment *e)
{
    e->row_sum = gonio_i_allocate(context, height + 1, sizeof *e->row_sum);
    e->column_sum = gonio_i_allocate(context, height * (width + 1), sizeof *e->column_sum);
    e->row_cosine = gonio_i_allocate(context, height + 1, sizeof *e->row_cosine);
    e->row_guide = gonio_i_allocate(context, height, sizeof *e->row_guide);
    e->column_guide = gonio_i_allocate(context, height * width, sizeof *e->column_guide);
    return e->row_sum != NULL && e->column_sum != NULL && e->row_cosine != NULL &&
                   e->row_guide != NULL && e->column_guide != NULL
               ? GONIO_OK
               : GONIO_ERROR_MEMORY;
}

static void sum_power(gonio_environment *e)
{
    const size_t width = (size_t)e->image->width;
    const int height = e->image->height;
    for (int row = 0; row <= height; row++) {
        e->row_cosine[row] = cos(row * M_PI / height);
    }
    for (int row = 0; row < height; row++) {
        double *sum = e->column_sum + (size_t)row * (width + 1);
        const double angle = solid_angle(e, row);
        for (int column = 0; column < e->image->width; column++) {
            sum[column + 1] = sum[column] + angle * luminance_of(pixel_at(e, column, row));
        }
        guide_to(sum, e->image->width, e->column_guide + (size_t)row * width);
        e->row_sum[row + 1] = e->row_sum[row] + sum[width];
    }
    guide_to(e->row_sum, height, e->row_guide);
}

static gonio_status prepare(gonio_context *context, const char *name, gonio_environment *e)
{
    const gonio_status status =
        allocate(context, (size_t)e->image->width, (size_t)e->image->height, e);
    if (status != GONIO_OK) {
        return status;
    }
    sum_power(e);
    const double all = e->row_sum[e->image->height];
    if (!(all > 0.0)) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "%s: the environment is all black", name);
    }
    return isfinite(all)
               ? GONIO_OK
               : gonio_i_fail(context, GONIO_ERROR_DATA, "%s: the environment is too bright", name);
}

/* ---- opening ---- */

static bool is_light(const float *pixel)
{
    bool good = true;
    for (int k = 0; k < 3; k++) {
        good = good && isfinite(pixel[k]) && pixel[k] >= 0.0F;
    }
    return good;
}

static gonio_status check_pixels(gonio_context *context, const char *name, bool repair,
                                 gonio_image *image)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    size_t bad = 0;
    for (size_t k = 0; k < pixels; k++) {
        float *pixel = image->rgba + k * GONIO_IMAGE_CHANNELS;
        if (is_light(pixel)) {
            continue;
        }
        if (!repair) {
            return gonio_i_fail(context, GONIO_ERROR_DATA,
                                "%s: the pixel in row %zu, column %zu is (%g, %g, %g), which is "
                                "not a radiance; --repair replaces such pixels by black",
                                name, k / (size_t)image->width + 1, k % (size_t)image->width + 1,
                                (double)pixel[0], (double)pixel[1], (double)pixel[2]);
        }
        pixel[0] = pixel[1] = pixel[2] = 0.0F;
        bad++;
    }
    if (bad > 0) {
        gonio_i_warn(context, "%s: %zu of %zu pixels are not radiances and are replaced by black",
                     name, bad, pixels);
    }
    return GONIO_OK;
}

gonio_status gonio_i_environment_wrap(gonio_context *context, const char *name, gonio_image *image,
                                      bool repair, gonio_environment **environment)
{
    gonio_environment *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        gonio_image_free(&image);
        return GONIO_ERROR_MEMORY;
    }
    made->image = image;
    gonio_status status = check_pixels(context, name, repair, image);
    if (status == GONIO_OK) {
        status = prepare(context, name, made);
    }
    if (status != GONIO_OK) {
        gonio_environment_free(&made);
        return status;
    }
    *environment = made;
    return GONIO_OK;
}

gonio_status gonio_environment_open(gonio_context *context, const char *path, bool repair,
                                    gonio_environment **environment)
{
    gonio_image *image = NULL;
    gonio_status status = gonio_i_environment_make(context, path, &image);
    if (status == GONIO_OK && image == NULL) {
        status = gonio_image_read(context, path, &image);
    }
    return status == GONIO_OK ? gonio_i_environment_wrap(context, path, image, repair, environment)
                              : status;
}
