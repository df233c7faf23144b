/* Writing RGL .bsdf files: the distribution of normals. See rgl_write.c. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rgl_writing.h"

/* The mean luminance, in logarithms, by theta_h, of half vectors off the plane of incidence. */
static gonio_status find_luminance(const gonio_i_rgl_writing *w, double *luminance)
{
    enum { DIFFERENCES = 4 };
    gonio_pair pair[GONIO_I_RGL_NORMALS][DIFFERENCES];
    double *value = gonio_i_allocate(
        w->context, GONIO_I_RGL_NORMALS * DIFFERENCES * w->view->channels, sizeof *value);
    if (value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < GONIO_I_RGL_NORMALS; k++) {
        const double theta_h = gonio_i_rgl_theta((double)k / (GONIO_I_RGL_NORMALS - 1));
        for (size_t j = 0; j < DIFFERENCES; j++) {
            const double theta_d = (5.0 + 15.0 * (double)j) * M_PI / 180.0;
            pair[k][j] = gonio_pair_from_half_difference(
                (gonio_half_difference){theta_h, theta_d, M_PI / 2.0});
        }
    }
    const gonio_status status = gonio_i_sampler_values(
        w->context, &w->sampler, pair[0], (size_t)GONIO_I_RGL_NORMALS * DIFFERENCES, value);
    double before = 1.0;
    for (size_t k = 0; k < GONIO_I_RGL_NORMALS && status == GONIO_OK; k++) {
        double sum = 0.0;
        int count = 0;
        for (size_t j = 0; j < DIFFERENCES; j++) {
            const double *at = value + (k * DIFFERENCES + j) * w->view->channels;
            double here = 0.0;
            for (size_t c = 0; c < w->channels; c++) {
                const double v = at[w->view->channels == 1 ? 0 : c];
                here += w->weight[c] * (v > 0.0 ? v : 0.0);
            }
            if (!isnan(at[0])) {
                sum += log(here + 1e-6);
                count++;
            }
        }
        before = count > 0 ? exp(sum / count) : before;
        luminance[k] = before;
    }
    free(value);
    return status;
}

/* The solid angle and the cosine of half vectors around node k: the trapezoidal rule in u. */
static double projected_angle(size_t k)
{
    const double u = (double)k / (GONIO_I_RGL_NORMALS - 1);
    const double end = k == 0 || k == GONIO_I_RGL_NORMALS - 1 ? 0.5 : 1.0;
    const double theta = gonio_i_rgl_theta(u);
    return end * 2.0 * M_PI * sin(theta) * cos(theta) * M_PI * u / (GONIO_I_RGL_NORMALS - 1);
}

/* Scaled so that the area projected along the normal is 1. */
gonio_status gonio_i_rgl_find_ndf(gonio_i_rgl_writing *w)
{
    double luminance[GONIO_I_RGL_NORMALS];
    double all = 0.0;
    const gonio_status status = find_luminance(w, luminance);
    for (size_t k = 0; k < GONIO_I_RGL_NORMALS && status == GONIO_OK; k++) {
        all += luminance[k] * projected_angle(k);
    }
    for (size_t k = 0; k < GONIO_I_RGL_NORMALS && status == GONIO_OK; k++) {
        w->ndf[0][k] = w->ndf[1][k] = (float)(luminance[k] / all);
    }
    return status;
}

/* <i, m>, with m at azimuth phi from i. */
static double cosine_between(double theta_i, double theta_m, double phi)
{
    return sin(theta_i) * sin(theta_m) * cos(phi) + cos(theta_i) * cos(theta_m);
}

/* The area of all normals' facets that is seen from theta_i. */
static double project(const gonio_i_rgl_writing *w, double theta_i)
{
    enum { STEPS = 256 };
    double sum = 0.0;
    for (size_t k = 0; k < GONIO_I_RGL_NORMALS; k++) {
        const double u = (double)k / (GONIO_I_RGL_NORMALS - 1);
        const double theta = gonio_i_rgl_theta(u);
        const double end = k == 0 || k == GONIO_I_RGL_NORMALS - 1 ? 0.5 : 1.0;
        double seen = 0.0;
        for (int a = 0; a < STEPS; a++) {
            seen += fmax(cosine_between(theta_i, theta, 2.0 * M_PI * (a + 0.5) / STEPS), 0.0);
        }
        sum += end * (double)w->ndf[0][k] * seen * (2.0 * M_PI / STEPS) * sin(theta) * M_PI * u /
               (GONIO_I_RGL_NORMALS - 1);
    }
    return sum;
}

void gonio_i_rgl_find_sigma(gonio_i_rgl_writing *w)
{
    for (size_t k = 0; k < GONIO_I_RGL_NORMALS; k++) {
        const double theta = gonio_i_rgl_theta((double)k / (GONIO_I_RGL_NORMALS - 1));
        w->sigma[0][k] = w->sigma[1][k] = (float)project(w, theta);
    }
}

gonio_status gonio_i_rgl_find_vndf(gonio_i_rgl_writing *w)
{
    float *row = w->vndf[0][0];
    const gonio_status status =
        gonio_i_rgl_places(w->context, &w->sampler, w->ndf[0], w->limit, row);
    for (size_t k = 1; k < (size_t)GONIO_I_RGL_THETAS * 2; k++) {
        memcpy(row + k * GONIO_I_RGL_NORMALS, row, GONIO_I_RGL_NORMALS * sizeof *row);
    }
    return status == GONIO_OK
               ? gonio_i_warp_create(w->context, row, 1, 2, GONIO_I_RGL_NORMALS, &w->warp)
               : status;
}
