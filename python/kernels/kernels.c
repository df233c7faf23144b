/* Loops of the Python package: see kernels.h. */
#include "kernels.h"

#include <math.h>
#include <string.h>

enum { WORTH_THREADS = 4096 }; /* directions */

static void take_first(size_t *first, size_t k)
{
    if (k < *first) {
        *first = k;
    }
}

static void judge(const double *w, size_t k, gonio_python_vectors *found)
{
    const double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    if (!isfinite(length)) {
        take_first(&found->not_finite, k);
        return;
    }
    if (length < 1e-12) {
        take_first(&found->zero, k);
    }
    if (w[2] <= 1e-12 * length) {
        take_first(&found->below, k);
    }
    const double off = fabs(length - 1.0);
    if (off > found->off || (off == found->off && k < found->far)) {
        found->off = off;
        found->far = k;
    }
}

static void join(gonio_python_vectors *all, const gonio_python_vectors *part)
{
    take_first(&all->not_finite, part->not_finite);
    take_first(&all->zero, part->zero);
    take_first(&all->below, part->below);
    if (part->off > all->off || (part->off == all->off && part->far < all->far)) {
        all->off = part->off;
        all->far = part->far;
    }
}

void gonio_python_angles(const double *w, size_t count, int threads, double *at, size_t stride,
                         gonio_python_vectors *found)
{
    const gonio_python_vectors none = {count, count, count, count, 0.0};
    *found = none;
#pragma omp parallel num_threads(threads) if (count > WORTH_THREADS && threads > 1)
    {
        gonio_python_vectors own = none;
#pragma omp for schedule(static) nowait
        for (size_t k = 0; k < count; k++) {
            const double *v = w + 3 * k;
            judge(v, k, &own);
            at[k * stride] = atan2(sqrt(v[0] * v[0] + v[1] * v[1]), v[2]);
            at[k * stride + 1] = atan2(v[1], v[0]);
        }
#pragma omp critical
        join(found, &own);
    }
}

void gonio_python_unit_vectors(const double *at, size_t stride, size_t count, int threads,
                               double *w)
{
#pragma omp parallel for num_threads(threads) if (count > WORTH_THREADS && threads > 1)
    for (size_t k = 0; k < count; k++) {
        const double theta = at[k * stride];
        const double phi = at[k * stride + 1];
        w[3 * k] = sin(theta) * cos(phi);
        w[3 * k + 1] = sin(theta) * sin(phi);
        w[3 * k + 2] = cos(theta);
    }
}

static void fill_with_nan(double *values, size_t count)
{
    for (size_t k = 0; values != NULL && k < count; k++) {
        values[k] = NAN;
    }
}

void gonio_python_predict(const gonio_basis *basis, const gonio_reconstruction *reconstruction,
                          const gonio_pair *pairs, size_t count, size_t channels, int threads,
                          double *value, double *deviation)
{
#pragma omp parallel for num_threads(threads) if (count > 64 && threads > 1)
    for (size_t k = 0; k < count; k++) {
        double *sd = deviation != NULL ? deviation + k * channels : NULL;
        if (!gonio_reconstruction_predict(basis, reconstruction,
                                          gonio_half_difference_from_pair(pairs[k]),
                                          value + k * channels, sd)) {
            fill_with_nan(value + k * channels, channels);
            fill_with_nan(sd, channels);
        }
    }
}

void gonio_python_scales(gonio_mapping mapping, bool colours, const gonio_pair *pairs, size_t count,
                         size_t channels, int threads, double *scale)
{
#pragma omp parallel for num_threads(threads) if (count > WORTH_THREADS && threads > 1)
    for (size_t k = 0; k < count; k++) {
        const gonio_half_difference at = gonio_half_difference_from_pair(pairs[k]);
        for (size_t c = 0; c < channels; c++) {
            scale[k * channels + c] = gonio_mapping_scale(mapping, colours ? (int)c : -1, at);
        }
    }
}

void gonio_python_albedos(const gonio_table *table, const double *theta, size_t count, int threads,
                          double *albedo, double *share)
{
#pragma omp parallel for num_threads(threads) schedule(dynamic) if (count > 1 && threads > 1)
    for (size_t k = 0; k < count; k++) {
        share[k] = gonio_table_albedo(table, theta[k], albedo + 3 * k);
    }
}

void gonio_python_tone_map(const gonio_image *image, const gonio_tone *tone, int threads,
                           uint8_t *srgb)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
#pragma omp parallel for num_threads(threads) if (pixels > WORTH_THREADS && threads > 1)
    for (size_t k = 0; k < pixels; k++) {
        const float *p = image->rgba + 4 * k;
        const double alpha = p[3];
        double rgb[3] = {0.0, 0.0, 0.0};
        double shown[3];
        for (int c = 0; c < 3 && alpha > 0.0; c++) {
            rgb[c] = p[c] / alpha;
        }
        gonio_tone_apply(tone, rgb, shown);
        for (int c = 0; c < 3; c++) {
            srgb[3 * k + c] = (uint8_t)lrint(255.0 * gonio_srgb_encode(shown[c] * alpha));
        }
    }
}

static gonio_status read_array_slab(void *self, gonio_context *context, int theta_h, double *rho)
{
    const double *slab = (const double *)self + (size_t)theta_h * GONIO_SLAB_VALUES;
    (void)context;
    memcpy(rho, slab, GONIO_SLAB_VALUES * sizeof *rho);
    for (size_t b = 0; b < GONIO_SLAB_BINS; b++) {
        bool data = true;
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            data = data && rho[c * GONIO_SLAB_BINS + b] >= 0.0;
        }
        for (size_t c = 0; c < GONIO_CHANNELS && !data; c++) {
            rho[c * GONIO_SLAB_BINS + b] = -1.0;
        }
    }
    return GONIO_OK;
}

gonio_status gonio_python_array_material(gonio_context *context, const char *name,
                                         const double *rho, gonio_material **material)
{
    const gonio_material_source source = {
        .size = sizeof source, .read_slab = read_array_slab, .self = (void *)rho};
    return gonio_material_create(context, name, "array 90 x 90 x 180", &source, material);
}

gonio_status gonio_python_function_material(gonio_context *context, const char *name, void *self,
                                            size_t channels, const double *wavelength,
                                            bool anisotropic, gonio_python_evaluation evaluate,
                                            gonio_material **material)
{
    const gonio_material_source source = {.size = sizeof source,
                                          .evaluate = evaluate,
                                          .self = self,
                                          .channels = channels,
                                          .wavelength = wavelength,
                                          .anisotropic = anisotropic};
    return gonio_material_create(context, name, "a function of Python", &source, material);
}
