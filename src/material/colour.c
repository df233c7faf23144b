/* From spectra to colours: see colour.h. */
#include "colour.h"

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"

enum {
    FIRST = 380, /* nm */
    LAST = 780,
    STEP = 5,
    STEPS = (LAST - FIRST) / STEP + 1,
    DAYLIGHT_STEP = 10
};

/* ---- the observer ---- */

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

/* ---- illuminants, relative power ---- */

static double equal_energy(double wavelength)
{
    (void)wavelength;
    return 1.0;
}

/* CIE D65, every 10 nm from 380 nm on, to be interpolated linearly. */
static double daylight(double wavelength)
{
    static const double power[] = {
        49.98,  54.65,  82.75,  91.49,  93.43,  86.68,  104.86, 117.01, 117.81, 114.86, 115.92,
        108.81, 109.35, 107.80, 104.79, 107.69, 104.41, 104.05, 100.00, 96.33,  95.79,  88.69,
        90.01,  89.60,  87.70,  83.29,  83.70,  80.03,  80.21,  82.28,  78.28,  69.72,  71.61,
        74.35,  61.60,  69.89,  75.09,  63.59,  46.42,  66.81,  63.38};
    enum { POWERS = sizeof power / sizeof *power };
    const double place = (wavelength - FIRST) / DAYLIGHT_STEP;
    const int before = place < POWERS - 2 ? (int)place : POWERS - 2;
    return power[before] + (place - before) * (power[before + 1] - power[before]);
}

/* CIE A: Planck's law at 2,848 K with c2 of 14,350 um K. */
static double incandescent(double wavelength)
{
    const double c = 1.435e7 / 2848.0;
    return pow(560.0 / wavelength, 5.0) * expm1(c / 560.0) / expm1(c / wavelength);
}

static double (*const illuminants[])(double) = {[GONIO_ILLUMINANT_E] = equal_energy,
                                                [GONIO_ILLUMINANT_D65] = daylight,
                                                [GONIO_ILLUMINANT_A] = incandescent};

/* ---- the spectrum ---- */

typedef struct sample {
    double wavelength;
    size_t index; /* into the spectrum */
} sample;

static int compare_samples(const void *a, const void *b)
{
    const sample *x = a;
    const sample *y = b;
    return (x->wavelength > y->wavelength) - (x->wavelength < y->wavelength);
}

static sample *sort_samples(gonio_context *context, const double *wavelength, size_t count)
{
    sample *samples = gonio_i_allocate(context, count, sizeof *samples);
    if (samples != NULL) {
        for (size_t k = 0; k < count; k++) {
            samples[k] = (sample){wavelength[k], k};
        }
        qsort(samples, count, sizeof *samples, compare_samples);
    }
    return samples;
}

/* Distributes a power at one wavelength to the weights of the samples around it. */
static void share_out(const sample *samples, size_t count, double wavelength, double power,
                      double *weight)
{
    size_t after = 0;
    while (after < count && samples[after].wavelength <= wavelength) {
        after++;
    }
    if (after == 0 || after == count) {
        weight[samples[after == 0 ? 0 : count - 1].index] += power;
        return;
    }
    const sample *low = &samples[after - 1];
    const sample *high = &samples[after];
    const double share = (wavelength - low->wavelength) / (high->wavelength - low->wavelength);
    weight[low->index] += power * (1.0 - share);
    weight[high->index] += power * share;
}

gonio_status gonio_i_colour_weights(gonio_context *context, const double *wavelength, size_t count,
                                    gonio_illuminant illuminant, double *weight)
{
    sample *samples = sort_samples(context, wavelength, count);
    if (samples == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double white[GONIO_CHANNELS] = {0.0};
    for (size_t k = 0; k < GONIO_CHANNELS * count; k++) {
        weight[k] = 0.0;
    }
    for (int step = 0; step < STEPS; step++) {
        const double at = FIRST + STEP * step;
        double xyz[3];
        double rgb[GONIO_CHANNELS];
        match(at, xyz);
        to_linear(xyz, rgb);
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            const double power = illuminants[illuminant](at) * rgb[c];
            white[c] += power;
            share_out(samples, count, at, power, weight + c * count);
        }
    }
    for (size_t k = 0; k < GONIO_CHANNELS * count; k++) {
        weight[k] /= white[k / count];
    }
    free(samples);
    return GONIO_OK;
}

bool gonio_i_colours_known(const double *wavelength, size_t count)
{
    static const double APART = 60.0;
    double least = INFINITY;
    double most = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        if (wavelength[k] >= FIRST && wavelength[k] <= LAST) {
            least = fmin(least, wavelength[k]);
            most = fmax(most, wavelength[k]);
        }
    }
    return most - least >= APART;
}

void gonio_i_note_colours(gonio_context *context, const char *name, const double *wavelength,
                          size_t count)
{
    if (gonio_i_colours_known(wavelength, count)) {
        return;
    }
    if (count == 1) {
        gonio_i_note(context, "%s: %g nm alone does not determine colours; they are grey", name,
                     wavelength[0]);
    } else {
        gonio_i_note(context,
                     "%s: colours cannot be known from these %zu wavelengths, which are not 60 nm "
                     "apart in the visible; they are made of what there is",
                     name, count);
    }
}

void gonio_i_xyz_to_rgb(const double xyz[3], double rgb[GONIO_CHANNELS])
{
    static const double flat[3] = {1.0, 1.0, 1.0};
    double white[GONIO_CHANNELS];
    to_linear(xyz, rgb);
    to_linear(flat, white);
    for (size_t c = 0; c < GONIO_CHANNELS; c++) {
        rgb[c] /= white[c];
    }
}

void gonio_i_rgb_to_xyz(const double rgb[GONIO_CHANNELS], double xyz[3])
{
    static const double flat[3] = {1.0, 1.0, 1.0};
    static const double inverse[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                         {0.2126729, 0.7151522, 0.0721750},
                                         {0.0193339, 0.1191920, 0.9503041}};
    double white[GONIO_CHANNELS];
    to_linear(flat, white);
    for (size_t k = 0; k < 3; k++) {
        xyz[k] = 0.0;
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            xyz[k] += inverse[k][c] * white[c] * rgb[c];
        }
    }
}
