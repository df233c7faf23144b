/* The mappings of reflectance to log space, g = ln(1 + rho/s), and their inverses. All of gonio
 * uses these. */
#include <gonio/database.h>

#include <math.h>
#include <string.h>

#include "../core/core.h"
#include "../core/vector_math.h"
#include "../direction/grid.h"
#include "../material/formats/merl.h"

/* Constants of the relative mapping (Nielsen et al. 2015, section 4): e in 1/sr, the least w. */
static const double relative_floor = 0.001;
static const double least_weight = 0.01;

double gonio_log_scale(int channel)
{
    return gonio_i_merl_scale[channel >= 0 && channel < GONIO_CHANNELS ? channel : 0];
}

static const char *const names[] = {[GONIO_LOG] = "log", [GONIO_LOG_RELATIVE] = "relative"};

enum { MAPPINGS = sizeof names / sizeof *names };

const char *gonio_mapping_name(gonio_mapping mapping)
{
    return (size_t)mapping < MAPPINGS ? names[mapping] : NULL;
}

bool gonio_mapping_parse(const char *name, gonio_mapping *mapping)
{
    for (int k = 0; k < MAPPINGS; k++) {
        if (strcmp(name, names[k]) == 0) {
            *mapping = (gonio_mapping)k;
            return true;
        }
    }
    return false;
}

static double relative_scale(double product_of_cosines)
{
    return relative_floor / fmin(fmax(product_of_cosines, least_weight), 1.0);
}

double gonio_mapping_scale(gonio_mapping mapping, int channel, gonio_half_difference at)
{
    if (mapping == GONIO_LOG) {
        return gonio_log_scale(channel);
    }
    double incident = 0.0;
    double outgoing = 0.0;
    gonio_cosines(at, &incident, &outgoing);
    return relative_scale(incident > 0.0 && outgoing > 0.0 ? incident * outgoing : 0.0);
}

double gonio_mapped_from_brdf(gonio_mapping mapping, double rho, int channel,
                              gonio_half_difference at)
{
    return log1p(rho / gonio_mapping_scale(mapping, channel, at));
}

double gonio_brdf_from_mapped(gonio_mapping mapping, double g, int channel,
                              gonio_half_difference at)
{
    return fmax(gonio_mapping_scale(mapping, channel, at) * expm1(g), 0.0);
}

double gonio_log_from_brdf(double rho, int channel)
{
    return log1p(rho / gonio_log_scale(channel));
}

double gonio_brdf_from_log(double g, int channel)
{
    return fmax(gonio_log_scale(channel) * expm1(g), 0.0);
}

/* ---- slabs ---- */

static void relative_slab_scale(int theta_h, double *scale)
{
    gonio_i_slab_cosines(theta_h, scale);
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        scale[k] = relative_scale(scale[k]);
    }
}

void gonio_slab_scale(gonio_mapping mapping, int channel, int theta_h, double *scale)
{
    if (mapping == GONIO_LOG_RELATIVE) {
        relative_slab_scale(theta_h, scale);
        return;
    }
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        scale[k] = gonio_log_scale(channel);
    }
}

GONIO_I_VECTORISED static void scale_and_clamp(const double *rho, double factor, double *x)
{
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        x[k] = rho[k] > 0.0 ? rho[k] * factor : 0.0;
    }
}

GONIO_I_VECTORISED static void divide_and_clamp(const double *rho, const double *scale, double *x)
{
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        x[k] = rho[k] > 0.0 ? rho[k] / scale[k] : 0.0;
    }
}

void gonio_slab_to_log(const double *rho, double *g)
{
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        const size_t plane = (size_t)channel * GONIO_SLAB_BINS;
        scale_and_clamp(rho + plane, 1.0 / gonio_log_scale(channel), g + plane);
        gonio_i_log1p(GONIO_SLAB_BINS, g + plane, g + plane);
    }
}

void gonio_slab_to_mapped(gonio_mapping mapping, int theta_h, const double *rho, double *g)
{
    if (mapping == GONIO_LOG) {
        gonio_slab_to_log(rho, g);
        return;
    }
    double scale[GONIO_SLAB_BINS];
    relative_slab_scale(theta_h, scale);
    for (size_t plane = 0; plane < GONIO_SLAB_VALUES; plane += GONIO_SLAB_BINS) {
        divide_and_clamp(rho + plane, scale, g + plane);
        gonio_i_log1p(GONIO_SLAB_BINS, g + plane, g + plane);
    }
}
