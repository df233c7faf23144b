/* Differences of renderings as people see them: PSNR and Delta E_ITP. */
#include <math.h>

#include "image.h"

/* ---- ICtCp (Recommendation ITU-R BT.2100) ---- */

/* From BT.709 to BT.2020, both with the white D65 (Report ITU-R BT.2087). */
static const double to_2020[3][3] = {
    {0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0114}, {0.0164, 0.0880, 0.8956}};

static const double to_lms[3][3] = {{1688.0 / 4096.0, 2146.0 / 4096.0, 262.0 / 4096.0},
                                    {683.0 / 4096.0, 2951.0 / 4096.0, 462.0 / 4096.0},
                                    {99.0 / 4096.0, 309.0 / 4096.0, 3688.0 / 4096.0}};

static const double to_ictcp[3][3] = {{2048.0 / 4096.0, 2048.0 / 4096.0, 0.0},
                                      {6610.0 / 4096.0, -13613.0 / 4096.0, 7003.0 / 4096.0},
                                      {17933.0 / 4096.0, -17390.0 / 4096.0, -543.0 / 4096.0}};

static void multiply(const double m[3][3], const double x[3], double y[3])
{
    for (int i = 0; i < 3; i++) {
        y[i] = m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2];
    }
}

/* The inverse EOTF of PQ (SMPTE ST 2084): cd/m^2 to 0 .. 1. */
static double perceptual_quantiser(double luminance)
{
    const double m1 = 2610.0 / 16384.0;
    const double m2 = 2523.0 / 4096.0 * 128.0;
    const double c1 = 3424.0 / 4096.0;
    const double c2 = 2413.0 / 4096.0 * 32.0;
    const double c3 = 2392.0 / 4096.0 * 32.0;
    const double y = pow(fmax(luminance, 0.0) / 10000.0, m1);
    return pow((c1 + c2 * y) / (1.0 + c3 * y), m2);
}

/* I, T, P of BT.2124. */
static void itp(const double rgb[3], double result[3])
{
    double wide[3];
    double lms[3];
    multiply(to_2020, rgb, wide);
    multiply(to_lms, wide, lms);
    for (int k = 0; k < 3; k++) {
        lms[k] = perceptual_quantiser(GONIO_DISPLAY_WHITE * lms[k]);
    }
    multiply(to_ictcp, lms, result);
    result[1] *= 0.5;
}

double gonio_delta_e_itp(const double a[3], const double b[3])
{
    double first[3];
    double second[3];
    itp(a, first);
    itp(b, second);
    return 720.0 * sqrt((first[0] - second[0]) * (first[0] - second[0]) +
                        (first[1] - second[1]) * (first[1] - second[1]) +
                        (first[2] - second[2]) * (first[2] - second[2]));
}

/* ---- whole images ---- */

static double squared_difference(const double a[3], const double b[3])
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double d = gonio_srgb_encode(a[k]) - gonio_srgb_encode(b[k]);
        sum += d * d;
    }
    return sum;
}

gonio_status gonio_image_compare(gonio_context *context, const gonio_image *reference,
                                 const gonio_image *other, const gonio_tone *tone,
                                 gonio_image_error *error, float *map)
{
    if (reference->width != other->width || reference->height != other->height) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                            "images of %d x %d and %d x %d pixels cannot be compared",
                            reference->width, reference->height, other->width, other->height);
    }
    const size_t pixels = (size_t)reference->width * (size_t)reference->height;
    double squares = 0.0;
    double differences = 0.0;
    size_t count = 0;
    for (size_t k = 0; k < pixels; k++) {
        const float *a = reference->rgba + k * GONIO_IMAGE_CHANNELS;
        const float *b = other->rgba + k * GONIO_IMAGE_CHANNELS;
        double delta = 0.0;
        if (a[3] > 0.0F || b[3] > 0.0F) {
            double shown_a[3];
            double shown_b[3];
            gonio_i_shown(tone, a, shown_a);
            gonio_i_shown(tone, b, shown_b);
            delta = gonio_delta_e_itp(shown_a, shown_b);
            squares += squared_difference(shown_a, shown_b);
            differences += delta;
            count++;
        }
        if (map != NULL) {
            map[k] = (float)delta;
        }
    }
    if (count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "the images show nothing to compare");
    }
    error->psnr = -10.0 * log10(squares / (3.0 * (double)count));
    error->delta_e_itp = differences / (double)count;
    return GONIO_OK;
}
