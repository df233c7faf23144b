/* A material made ready for rendering: see surface.h. */
#include "surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../direction/grid.h"
#include "../material/source.h"
#include "geometry.h"

enum { VALUES = 4, HIGHLIGHT_THETA_D = 60 }; /* bins below 60 degrees show the highlight */

/* Bins of phi_d that share the value of an anisotropic material: its mean over azimuths is only for
 * the sampling, and for directions without data. */
enum { ANISOTROPIC_RUN = 12 };

/* The weight of a bin without data: it counts only if there is no bin with data. */
static const float hole_weight = 1e-9F;

struct gonio_i_surface {
    float (*bin)[VALUES];                      /* [GONIO_BINS]: R, G, B, and the bin's weight */
    double cumulative[GONIO_THETA_H_BINS + 1]; /* distribution of half vectors by theta_h */
    double density[GONIO_THETA_H_BINS];        /* of them, 1/sr */
    double highlight;                          /* the share of samples that are drawn by them */
    const gonio_material *direct; /* the material, if it is evaluated; NULL: bins are looked up */
};

void gonio_i_surface_free(gonio_i_surface **surface)
{
    if (surface == NULL || *surface == NULL) {
        return;
    }
    free((*surface)->bin);
    free(*surface);
    *surface = NULL;
}

/* ---- holes ---- */

/* Along a line of bins, gives each bin without a value that of the one before it. */
static void fill_forward(float (*bin)[VALUES], ptrdiff_t step, int count)
{
    for (int k = 1; k < count; k++) {
        float *here = bin[k * step];
        const float *before = bin[(k - 1) * step];
        if (here[3] == 0.0F && before[3] > 0.0F) {
            memcpy(here, before, 3 * sizeof *here);
            here[3] = hole_weight;
        }
    }
}

/* Fills a line of bins, first from lower indices, which are farther from the horizon. */
static void fill_line(float (*bin)[VALUES], ptrdiff_t step, int count)
{
    fill_forward(bin, step, count);
    fill_forward(bin + (count - 1) * step, -step, count);
}

static void fill_holes(float (*bin)[VALUES])
{
    for (int i = 0; i < GONIO_THETA_H_BINS; i++) {
        for (int k = 0; k < GONIO_PHI_D_BINS; k++) {
            fill_line(bin + (ptrdiff_t)i * GONIO_SLAB_BINS + k, GONIO_PHI_D_BINS,
                      GONIO_THETA_D_BINS);
        }
    }
    for (int k = 0; k < GONIO_SLAB_BINS; k++) {
        fill_line(bin + k, GONIO_SLAB_BINS, GONIO_THETA_H_BINS);
    }
    for (int cell = 0; cell < GONIO_CELLS; cell++) {
        fill_line(bin + (ptrdiff_t)cell * GONIO_PHI_D_BINS, 1, GONIO_PHI_D_BINS);
    }
}

/* ---- the highlight ---- */

/* The mean luminance of a slab's bins with data. */
static double mean_luminance(float (*slab)[VALUES])
{
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < HIGHLIGHT_THETA_D * GONIO_PHI_D_BINS; k++) {
        if (slab[k][3] == 1.0F) {
            const double rgb[3] = {(double)slab[k][0], (double)slab[k][1], (double)slab[k][2]};
            sum += gonio_i_luminance(rgb);
            count++;
        }
    }
    return count > 0 ? sum / count : 0.0;
}

/* The share of the reflected light that is in the highlight: the luminance above the least one,
 * which is taken as diffuse. d omega_o = 4 (i.h) d omega_h, here for incidence near the normal. The
 * share is limited, so that both parts are always sampled. */
static double share_of_highlight(const double *luminance, const double *angle)
{
    double least = luminance[0];
    double above = 0.0;
    for (int i = 0; i < GONIO_THETA_H_BINS / 2; i++) { /* below 22.5 degrees */
        least = fmin(least, luminance[i]);
    }
    for (int i = 0; i < GONIO_THETA_H_BINS / 2; i++) {
        above += 4.0 * (luminance[i] - least) * angle[i];
    }
    const double all = above + M_PI * least;
    return all > 0.0 ? fmin(fmax(above / all, 0.15), 0.85) : 0.5;
}

/* Finds the distribution of half vectors, proportional to the luminance and their cosine. */
static void find_highlight(gonio_i_surface *s)
{
    double angle[GONIO_THETA_H_BINS];
    double luminance[GONIO_THETA_H_BINS];
    for (int i = 0; i < GONIO_THETA_H_BINS; i++) {
        const double low = (double)i / GONIO_THETA_H_BINS;
        const double high = (i + 1.0) / GONIO_THETA_H_BINS;
        const double c_low = cos(low * low * M_PI_2);
        const double c_high = cos(high * high * M_PI_2);
        angle[i] = 2.0 * M_PI * (c_low - c_high);
        luminance[i] = mean_luminance(s->bin + (size_t)i * GONIO_SLAB_BINS);
        s->density[i] = (1e-6 + luminance[i]) * 0.5 * (c_low + c_high);
        s->cumulative[i + 1] = s->cumulative[i] + s->density[i] * angle[i];
    }
    const double all = s->cumulative[GONIO_THETA_H_BINS];
    for (int i = 0; i < GONIO_THETA_H_BINS; i++) {
        s->density[i] /= all;
        s->cumulative[i + 1] /= all;
    }
    s->highlight = share_of_highlight(luminance, angle);
}

/* ---- making one ---- */

/* Copies the bins of a cell that have data. Returns the number of valid bins among them. */
static size_t copy_cell(const double *rho, int first_valid, float (*bin)[VALUES])
{
    size_t data = 0;
    for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
        if (rho[p] < 0.0) {
            continue;
        }
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            bin[p][channel] = (float)rho[channel * GONIO_SLAB_BINS + p];
        }
        bin[p][3] = 1.0F;
        data += p >= first_valid && p < GONIO_PHI_D_BINS - first_valid ? 1 : 0;
    }
    return data;
}

/* Copies all values. Returns the number of valid bins without data. */
static size_t copy_values(const gonio_table *table, float (*bin)[VALUES], size_t *data)
{
    size_t valid = 0;
    *data = 0;
    for (int cell = 0; cell < GONIO_CELLS; cell++) {
        const int theta_h = cell / GONIO_THETA_D_BINS;
        const int theta_d = cell % GONIO_THETA_D_BINS;
        const int first = gonio_i_first_valid_phi(theta_h, theta_d);
        const double *rho = gonio_table_values(table) + (size_t)theta_h * GONIO_SLAB_VALUES +
                            (size_t)theta_d * GONIO_PHI_D_BINS;
        *data += copy_cell(rho, first, bin + (size_t)cell * GONIO_PHI_D_BINS);
        valid += (size_t)(GONIO_PHI_D_BINS - 2 * first);
    }
    return valid - *data;
}

static gonio_status fill_bins(gonio_context *context, const gonio_material *material,
                              gonio_i_surface *surface)
{
    gonio_table *table = NULL;
    const bool direct = gonio_i_material_is_direct(material);
    const bool anisotropic = direct && gonio_material_describe(material)->anisotropic;
    const gonio_status status =
        gonio_i_table_load_runs(context, material, anisotropic ? ANISOTROPIC_RUN : 1, &table);
    if (status != GONIO_OK) {
        return status;
    }
    size_t data = 0;
    const size_t holes = copy_values(table, surface->bin, &data);
    gonio_table_free(&table);
    if (data == 0) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "%s: the material holds no data",
                            gonio_material_name(material));
    }
    if (holes > 0) {
        gonio_i_note(context,
                     "%s: %zu directions have no data; the nearest directions with data are used",
                     gonio_material_name(material), holes);
    }
    find_highlight(surface);
    fill_holes(surface->bin);
    surface->direct = direct ? material : NULL;
    return GONIO_OK;
}

gonio_status gonio_i_surface_create(gonio_context *context, const gonio_material *material,
                                    gonio_i_surface **surface)
{
    gonio_i_surface *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->bin = gonio_i_allocate(context, GONIO_BINS, sizeof *made->bin);
    const gonio_status status =
        made->bin == NULL ? GONIO_ERROR_MEMORY : fill_bins(context, material, made);
    if (status != GONIO_OK) {
        gonio_i_surface_free(&made);
        return status;
    }
    *surface = made;
    return GONIO_OK;
}

bool gonio_i_surface_is_anisotropic(const gonio_i_surface *surface)
{
    return surface->direct != NULL && gonio_material_describe(surface->direct)->anisotropic;
}

/* ---- looking up ---- */

/* theta_d is half the angle between the directions; phi_d the azimuth of the incident one about the
 * half vector, seen from the plane of normal and half vector. */
gonio_i_meeting gonio_i_meet(const double i[3], const double o[3])
{
    const double sum[3] = {i[0] + o[0], i[1] + o[1], i[2] + o[2]};
    const double difference[3] = {i[0] - o[0], i[1] - o[1], i[2] - o[2]};
    const double radius = sqrt(sum[0] * sum[0] + sum[1] * sum[1]);
    const double length = gonio_i_length(sum);
    const double x = radius > 0.0 ? sum[0] / radius : 1.0;
    const double y = radius > 0.0 ? sum[1] / radius : 0.0;
    const double d_x = sum[2] * (x * difference[0] + y * difference[1]) - radius * difference[2];
    const double d_y = length * (x * difference[1] - y * difference[0]);
    double phi_d = atan2(d_y, d_x);
    phi_d = phi_d < 0.0 ? phi_d + M_PI : phi_d;
    return (gonio_i_meeting){.at = {.theta_h = atan2(radius, sum[2]),
                                    .theta_d = atan2(gonio_i_length(difference), length),
                                    .phi_d = phi_d < M_PI ? phi_d : 0.0},
                             .towards_light = {i[0], i[1], i[2]},
                             .towards_viewer = {o[0], o[1], o[2]},
                             .incident = i[2],
                             .half = 0.5 * length};
}

static gonio_angles angles_of(const double v[3])
{
    return (gonio_angles){atan2(sqrt(v[0] * v[0] + v[1] * v[1]), v[2]), atan2(v[1], v[0])};
}

void gonio_i_surface_value(const gonio_i_surface *surface, const gonio_i_meeting *meeting,
                           double rho[GONIO_CHANNELS])
{
    if (surface->direct != NULL) {
        const gonio_pair pair = {angles_of(meeting->towards_light),
                                 angles_of(meeting->towards_viewer)};
        if (gonio_i_material_colour(surface->direct, pair, rho)) {
            return;
        }
    }
    gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
    const int points = gonio_i_trilinear(meeting->at, stencil);
    double total = 0.0;
    rho[0] = rho[1] = rho[2] = 0.0;
    for (int k = 0; k < points; k++) {
        const float *bin = surface->bin[gonio_bin_index(stencil[k].bin)];
        const double weight = stencil[k].weight * (double)bin[3];
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            rho[channel] += weight * (double)bin[channel];
        }
        total += weight;
    }
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        rho[channel] /= total;
    }
}

/* ---- sampling ---- */

static void sample_half(const gonio_i_surface *s, const double uniform[2], double half[3])
{
    int low = 0;
    int high = GONIO_THETA_H_BINS;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (s->cumulative[middle] <= uniform[0]) {
            low = middle;
        } else {
            high = middle;
        }
    }
    const double below = (double)low / GONIO_THETA_H_BINS;
    const double above = (low + 1.0) / GONIO_THETA_H_BINS;
    const double within =
        (uniform[0] - s->cumulative[low]) / (s->cumulative[low + 1] - s->cumulative[low]);
    const double c_below = cos(below * below * M_PI_2);
    const double cosine = c_below + within * (cos(above * above * M_PI_2) - c_below);
    const double sine = sqrt(fmax(0.0, 1.0 - cosine * cosine));
    half[0] = sine * cos(2.0 * M_PI * uniform[1]);
    half[1] = sine * sin(2.0 * M_PI * uniform[1]);
    half[2] = cosine;
}

static void sample_cosine(const double uniform[2], double direction[3])
{
    const double radius = sqrt(uniform[0]);
    direction[0] = radius * cos(2.0 * M_PI * uniform[1]);
    direction[1] = radius * sin(2.0 * M_PI * uniform[1]);
    direction[2] = sqrt(fmax(0.0, 1.0 - uniform[0]));
}

bool gonio_i_surface_sample(const gonio_i_surface *surface, const double outgoing[3],
                            const double uniform[3], double incident[3])
{
    if (uniform[2] >= surface->highlight) {
        sample_cosine(uniform, incident);
        return incident[2] > 0.0;
    }
    double half[3];
    sample_half(surface, uniform, half);
    const double cosine = gonio_i_dot3(outgoing, half);
    for (int k = 0; k < 3; k++) {
        incident[k] = 2.0 * cosine * half[k] - outgoing[k];
    }
    return cosine > 0.0 && incident[2] > 0.0;
}

/* d omega_i = 4 (o.h) d omega_h. */
double gonio_i_surface_density(const gonio_i_surface *surface, const gonio_i_meeting *meeting)
{
    const int at = (int)(GONIO_THETA_H_BINS * sqrt(meeting->at.theta_h / M_PI_2));
    const double density = surface->density[at < GONIO_THETA_H_BINS ? at : GONIO_THETA_H_BINS - 1];
    return (1.0 - surface->highlight) * meeting->incident / M_PI +
           surface->highlight * density / (4.0 * meeting->half);
}
