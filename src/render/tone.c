/* Tone mapping: the global operator of Reinhard et al. 2002, and the transfer function of sRGB. */
#include <math.h>

#include "geometry.h"
#include "image.h"

/* A pixel's colour without its opacity. False for a transparent pixel. */
static bool colour_of(const float rgba[GONIO_IMAGE_CHANNELS], double rgb[3])
{
    for (int k = 0; k < 3; k++) {
        rgb[k] = rgba[3] > 0.0F ? (double)rgba[k] / (double)rgba[3] : 0.0;
    }
    return rgba[3] > 0.0F;
}

gonio_tone gonio_tone_measure(const gonio_image *image, double key)
{
    const double delta = 1e-5;
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    double sum = 0.0;
    double largest = 0.0;
    size_t count = 0;
    for (size_t k = 0; k < pixels; k++) {
        double rgb[3];
        const bool something = colour_of(image->rgba + k * GONIO_IMAGE_CHANNELS, rgb);
        const double luminance = gonio_i_luminance(rgb);
        if (something && luminance > 0.0) {
            sum += log(delta + luminance);
            largest = fmax(largest, luminance);
            count++;
        }
    }
    if (count == 0) {
        return (gonio_tone){key, 1.0, 1.0};
    }
    const double average = exp(sum / (double)count);
    return (gonio_tone){key, average, key * largest / average};
}

void gonio_tone_apply(const gonio_tone *tone, const double rgb[3], double shown[3])
{
    const double world = gonio_i_luminance(rgb);
    const double scaled = tone->key * world / tone->average;
    const double displayed = scaled * (1.0 + scaled / (tone->white * tone->white)) / (1.0 + scaled);
    for (int k = 0; k < 3; k++) {
        shown[k] = world > 0.0 ? fmin(fmax(rgb[k] * displayed / world, 0.0), 1.0) : 0.0;
    }
}

double gonio_srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

void gonio_i_shown(const gonio_tone *tone, const float rgba[GONIO_IMAGE_CHANNELS], double shown[3])
{
    double rgb[3];
    colour_of(rgba, rgb);
    gonio_tone_apply(tone, rgb, shown);
    for (int k = 0; k < 3; k++) {
        shown[k] *= fmin((double)rgba[3], 1.0);
    }
}

void gonio_i_shown_bytes(const double shown[3], unsigned char bytes[3])
{
    for (int k = 0; k < 3; k++) {
        bytes[k] = (unsigned char)lround(255.0 * gonio_srgb_encode(shown[k]));
    }
}
