/* From spectra to colours: see spectrum.h. */
#include "spectrum.h"

#include <math.h>

/* One lobe of the multi-lobe fits of Wyman, Sloan and Shirley 2013 to the CIE 1931 colour-matching
 * functions: a Gaussian with a width for each side, nm. */
typedef struct lobe {
    double height;
    double middle;
    double below;
    double above;
} lobe;

static double lobe_at(const lobe *l, double wavelength)
{
    const double t = (wavelength - l->middle) / (wavelength < l->middle ? l->below : l->above);
    return l->height * exp(-0.5 * t * t);
}

static void match(double wavelength, double xyz[3])
{
    static const lobe lobes[3][3] = {
        {{1.056, 599.8, 37.9, 31.0}, {0.362, 442.0, 16.0, 26.7}, {-0.065, 501.1, 20.4, 26.2}},
        {{0.821, 568.8, 46.9, 40.5}, {0.286, 530.9, 16.3, 31.1}, {0.0, 0.0, 1.0, 1.0}},
        {{1.217, 437.0, 11.8, 36.0}, {0.681, 459.0, 26.0, 13.8}, {0.0, 0.0, 1.0, 1.0}}};
    for (int k = 0; k < 3; k++) {
        xyz[k] = 0.0;
        for (int j = 0; j < 3; j++) {
            xyz[k] += lobe_at(&lobes[k][j], wavelength);
        }
    }
}

/* IEC 61966-2-1. */
static void to_linear(const double xyz[3], double rgb[GONIO_CHANNELS])
{
    static const double matrix[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                        {-0.9692660, 1.8760108, 0.0415560},
                                        {0.0556434, -0.2040259, 1.0572252}};
    for (int k = 0; k < 3; k++) {
        rgb[k] = matrix[k][0] * xyz[0] + matrix[k][1] * xyz[1] + matrix[k][2] * xyz[2];
    }
}

/* How much of the axis a wavelength stands for. */
static double step_at(const double *wavelength, size_t count, size_t k)
{
    const double before = k > 0 ? wavelength[k] - wavelength[k - 1] : 0.0;
    const double after = k + 1 < count ? wavelength[k + 1] - wavelength[k] : 0.0;
    return count > 1 ? 0.5 * (fabs(before) + fabs(after)) : 1.0;
}

void gonio_i_spectrum_to_rgb(const double *wavelength, const double *value, size_t count,
                             double rgb[GONIO_CHANNELS])
{
    double seen[3] = {0.0};
    double flat[3] = {0.0};
    double white[GONIO_CHANNELS];
    for (size_t k = 0; k < count; k++) {
        double xyz[3];
        match(wavelength[k], xyz);
        for (int j = 0; j < 3; j++) {
            const double weight = step_at(wavelength, count, k) * xyz[j];
            seen[j] += weight * value[k];
            flat[j] += weight;
        }
    }
    to_linear(seen, rgb);
    to_linear(flat, white);
    for (int k = 0; k < GONIO_CHANNELS; k++) {
        rgb[k] = white[k] > 0.0 ? fmax(rgb[k] / white[k], 0.0) : 0.0;
    }
}
