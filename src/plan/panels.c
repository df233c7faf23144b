/* The inner loops of the filter: see panels.h. */
#include "panels.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A panel's row of values as one value (an extension of gcc and clang), so that sums stay in
 * registers. */
typedef float lanes __attribute__((vector_size(GONIO_I_PANEL * sizeof(float))));

enum { WIDTH = GONIO_I_PANEL, COLUMNS = GONIO_I_COLUMNS };

static size_t round_up(size_t n, size_t multiple)
{
    return (n + multiple - 1) / multiple * multiple;
}

bool gonio_i_panels_make(gonio_context *context, const double *vectors, size_t rows,
                         size_t components, gonio_i_panels *panels)
{
    panels->count = (rows + WIDTH - 1) / WIDTH;
    panels->components = round_up(components, COLUMNS);
    const size_t stride = panels->components * WIDTH;
    /* Aligned to a register: the panels are read as such. */
    panels->values = aligned_alloc(sizeof(lanes), panels->count * stride * sizeof(float));
    panels->length = gonio_i_allocate(context, panels->count * WIDTH, sizeof *panels->length);
    if (panels->values == NULL || panels->length == NULL) {
        gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
        return false;
    }
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(context))
    for (size_t p = 0; p < panels->count; p++) {
        float *panel = panels->values + p * stride;
        memset(panel, 0, stride * sizeof *panel);
        for (size_t i = 0; i < WIDTH && p * WIDTH + i < rows; i++) {
            const double *u = vectors + (p * WIDTH + i) * components;
            double squares = 0.0;
            for (size_t k = 0; k < components; k++) {
                panel[k * WIDTH + i] = (float)u[k];
                squares += u[k] * u[k];
            }
            panels->length[p * WIDTH + i] = (float)(sqrt(squares) * (1.0 + 1e-6));
        }
    }
    return true;
}

void gonio_i_panels_free(gonio_i_panels *panels)
{
    free(panels->values);
    free(panels->length);
}

static const lanes *panel_at(const gonio_i_panels *panels, size_t p)
{
    return (const lanes *)(const void *)(panels->values + p * panels->components * WIDTH);
}

GONIO_I_VECTORISED void gonio_i_panels_gain(const gonio_i_panels *panels, size_t first, size_t last,
                                            const float *l, float *gain)
{
    const size_t k = panels->components;
    for (size_t p = first; p < last; p++) {
        const lanes *u = panel_at(panels, p);
        const lanes zero = {0.0F};
        lanes total = zero + 1.0F;
        for (size_t j = 0; j < k; j += COLUMNS) {
            lanes sum[COLUMNS] = {zero, zero, zero, zero, zero, zero, zero, zero};
            for (size_t i = j; i < k; i++) {
                for (size_t c = 0; c < COLUMNS; c++) {
                    sum[c] += u[i] * l[i * k + j + c];
                }
            }
            for (size_t c = 0; c < COLUMNS; c++) {
                total += sum[c] * sum[c];
            }
        }
        memcpy(gain + p * WIDTH, &total, sizeof total);
    }
}

GONIO_I_VECTORISED void gonio_i_panels_products(const gonio_i_panels *panels, size_t first,
                                                size_t last, const float *c, size_t rows, float *w)
{
    for (size_t p = first; p < last; p++) {
        const lanes *u = panel_at(panels, p);
        const lanes zero = {0.0F};
        lanes sum[COLUMNS] = {zero, zero, zero, zero, zero, zero, zero, zero};
        for (size_t i = 0; i < panels->components; i++) {
            for (size_t j = 0; j < COLUMNS; j++) {
                sum[j] += u[i] * c[i * COLUMNS + j];
            }
        }
        for (size_t j = 0; j < COLUMNS; j++) {
            memcpy(w + j * rows + p * WIDTH, &sum[j], sizeof sum[j]);
        }
    }
}

GONIO_I_VECTORISED void gonio_i_mark(size_t n, const float *gain, const float *w,
                                     const float *length, float loss, gonio_i_margins margins,
                                     unsigned char *pass)
{
    const float rounding = 8.0F * FLT_EPSILON;
    for (size_t u = 0; u < n; u++) {
        const float size = fabsf(w[u]);
        const float product_error = margins.product * length[u];
        const float factor_error = margins.gain * length[u];
        const float gain_error = factor_error * (2.0F * sqrtf(gain[u]) + factor_error);
        const float lost = loss * gain[u];
        const float margin = product_error * (2.0F * size + product_error) - loss * gain_error +
                             rounding * (size * size - lost);
        pass[u] = lost + size * size + margin > 0.0F;
    }
}
