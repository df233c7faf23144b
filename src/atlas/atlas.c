/* The built-in analytic materials: one reflectance model, evaluated a row of phi_d at a time.
 *
 *     rho = surface F [(1 - haze) M(facets) + haze M(haze_facets)]
 *           + (1 - surface F0) t(ci) t(co) [N (diffuse / pi) R B + flake I M(flake_facets)]
 *           + relief V + sheen S
 *
 * with ci, co the cosines of the incident and the outgoing angle and
 *   M  a microfacet lobe D G / (4 ci co) with Smith's height-correlated G (Heitz 2014);
 *   F  Schlick's reflectance, less a dip near 82 degrees;
 *   t  1 - surface (1 - c/2)^5, N = 1/(1 - 5 surface/28): the coupling of Ashikhmin and Shirley
 *      (2000), which leaves to the base what the surface does not reflect, made linear in
 * `surface`; R  Oren-Nayar's rough diffuse factor as given by Fujii; B  Hapke's (1986)
 * shadow-hiding surge, divided by its peak; I  two-beam interference in a film; S  Estevez and
 * Kulla's (2017) cloth distribution with Neubelt and Pettineo's (2013) visibility. Each factor
 * depends on theta_h or theta_d, or is symmetric in ci and co: the whole is reciprocal. A lobe M
 * alone reflects at most 1; that the sum does, for every material, is tested. Compiled without
 * fused multiply-add, so that values do not depend on the processor. */
#include <gonio/atlas.h>

#include <math.h>
#include <string.h>

#include "../core/core.h"
#include "materials.h"
#include "random_materials.h"

static const double PI = 3.14159265358979323846;

/* Up to one row of bins: the same theta_h and theta_d, several phi_d. */
typedef struct bin_row {
    int count;
    double incident[GONIO_PHI_D_BINS]; /* cosines */
    double outgoing[GONIO_PHI_D_BINS];
    double rho[GONIO_CHANNELS][GONIO_PHI_D_BINS];
} bin_row;

/* What depends on theta_h only. */
typedef struct half_terms {
    double cosine;
    double sine;
    double facets; /* densities of facets, 1/sr */
    double haze;
    double flake;
    double relief;
    double sheen;
} half_terms;

/* What depends on theta_d only. */
typedef struct difference_terms {
    double cosine;
    double sine;
    double fresnel[GONIO_CHANNELS];
    double flake[GONIO_CHANNELS];
    double diffuse[GONIO_CHANNELS]; /* 1/sr */
} difference_terms;

int gonio_atlas_count(void)
{
    return gonio_i_atlas_material_count;
}

static bool is_named(int index)
{
    return index >= 0 && index < gonio_i_atlas_material_count;
}

/* The parameters of a material; false for an index out of range. */
static bool material_at(int index, gonio_i_atlas_material *material)
{
    if (is_named(index)) {
        *material = gonio_i_atlas_materials[index];
        return true;
    }
    if (index >= GONIO_ATLAS_RANDOM && index - GONIO_ATLAS_RANDOM < GONIO_ATLAS_RANDOM_COUNT) {
        *material = gonio_i_random_material(index - GONIO_ATLAS_RANDOM);
        return true;
    }
    return false;
}

const char *gonio_atlas_name(int index)
{
    return is_named(index) ? gonio_i_atlas_materials[index].name : NULL;
}

const char *gonio_atlas_class(int index)
{
    gonio_i_atlas_material material;
    return material_at(index, &material) ? material.material_class : NULL;
}

/* The index of random-0000 .. random-9999, or -1. */
static int find_random(const char *name)
{
    static const char first[] = "random-";
    const size_t digits = 4;
    if (strncmp(name, first, sizeof first - 1) != 0 ||
        strspn(name + sizeof first - 1, "0123456789") != digits ||
        strlen(name) != sizeof first - 1 + digits) {
        return -1;
    }
    int number = 0;
    for (const char *at = name + sizeof first - 1; *at != '\0'; at++) {
        number = 10 * number + (*at - '0');
    }
    return GONIO_ATLAS_RANDOM + number;
}

int gonio_atlas_find(const char *name)
{
    if (!name)
        return -1;
    for (int i = 0; i < gonio_i_atlas_material_count; i++) {
        if (strcmp(gonio_i_atlas_materials[i].name, name) == 0)
            return i;
    }
    return find_random(name);
}

static double fifth_power(double x)
{
    double square = x * x;
    return square * square * x;
}

/* Density D of facets around a half vector, 1/sr: P/cos^4, P the density of slopes with
 * P = (g - 1)/(pi alpha^2) (1 + tan^2/alpha^2)^-g, g = 2 (GGX: Walter et al. 2007, eq. 33) and
 * g = 4 (light tails): two of the Student-t family of Ribardiere et al. (2017). Written without
 * tan, which has a pole at the horizon. */
static double facet_density(gonio_i_atlas_facets facets, double cosine, double sine)
{
    double alpha2 = facets.alpha * facets.alpha;
    double cosine2 = cosine * cosine;
    double root = 1.0 / (cosine2 + sine * sine / alpha2); /* cos^-2 (1 + tan^2/alpha^2)^-1 */
    double heavy = root * root;
    double light = 3.0 * heavy * heavy * cosine2 * cosine2;

    return (heavy + facets.light * (light - heavy)) / (PI * alpha2);
}

/* Density of relief facets, 1/sr: slopes r with P = exp(-(r - r0)^2/w^2) / Z,
 * Z = pi w^2 exp(-r0^2/w^2) + pi^(3/2) r0 w (1 + erf(r0/w)). */
static double relief_density(double slope, double width, double cosine, double sine)
{
    double offset = slope / width;
    double distance = (sine / cosine - slope) / width;
    double total =
        PI * width * width * (exp(-offset * offset) + sqrt(PI) * offset * (1.0 + erf(offset)));

    return exp(-distance * distance) / (total * cosine * cosine * cosine * cosine);
}

/* c Lambda(c), Smith's auxiliary function times the cosine, which stays finite at the horizon.
 * Heitz 2014: Lambda = 1/a int_a^inf (x - a) p(x) dx, a the cotangent and p the marginal density
 * of slopes. With q^2 = c^2 + alpha^2 (1 - c^2) and s = c/q the integral gives
 * Lambda = (1/s - 1)/2 for g = 2 and (3/s - 8 + 6 s - s^3)/16 for g = 4; a blend of densities
 * blends them. */
static inline double masking(double cosine, double alpha2, double light)
{
    double q = sqrt(cosine * cosine + alpha2 * (1.0 - cosine * cosine));
    double s = cosine / q;
    double heavy = 0.5 * (q - cosine);
    double thin = (3.0 * q - cosine * (8.0 - s * (6.0 - s * s))) * (1.0 / 16.0);

    return heavy + light * (thin - heavy);
}

/* Adds scale x D G / (4 ci co), G = 1/(1 + Lambda_i + Lambda_o). */
GONIO_I_VECTORISED static void add_lobe(bin_row *row, gonio_i_atlas_facets facets, double density,
                                        const double scale[GONIO_CHANNELS])
{
    const double alpha2 = facets.alpha * facets.alpha;
    const double light = facets.light;
    const double by_channel[GONIO_CHANNELS] = {scale[0], scale[1], scale[2]};

#pragma omp simd
    for (int k = 0; k < row->count; k++) {
        double incident = row->incident[k];
        double outgoing = row->outgoing[k];
        double shadow = outgoing * masking(incident, alpha2, light) +
                        incident * masking(outgoing, alpha2, light);
        double lobe = 0.25 * density / (incident * outgoing + shadow);

        for (int c = 0; c < GONIO_CHANNELS; c++)
            row->rho[c][k] += by_channel[c] * lobe;
    }
}

static void add_surface(bin_row *row, const gonio_i_atlas_material *material,
                        const half_terms *half, const difference_terms *difference)
{
    double sharp[GONIO_CHANNELS], hazy[GONIO_CHANNELS];

    for (int c = 0; c < GONIO_CHANNELS; c++) {
        double reflected = material->surface * difference->fresnel[c];
        sharp[c] = (1.0 - material->haze) * reflected;
        hazy[c] = material->haze * reflected;
    }
    if (material->surface > 0.0)
        add_lobe(row, material->facets, half->facets, sharp);
    if (material->surface > 0.0 && material->haze > 0.0)
        add_lobe(row, material->haze_facets, half->haze, hazy);
}

/* Adds the pigment: Fujii's form of Oren-Nayar, R = A (1 + r s/t), A = 1/(1 + r (1/2 - 2/(3 pi))),
 * s = i.o - ci co, t = max(ci, co) where s > 0 and 1 elsewhere; i.o = cos(2 theta_d). */
GONIO_I_VECTORISED static void add_diffuse(bin_row *row, const gonio_i_atlas_material *material,
                                           const difference_terms *difference)
{
    const double roughness = material->roughness;
    const double between = 2.0 * difference->cosine * difference->cosine - 1.0;
    const double level =
        1.0 / (1.0 + roughness * (0.5 - 2.0 / (3.0 * PI))) / (1.0 - material->surface * 5.0 / 28.0);

#pragma omp simd
    for (int k = 0; k < row->count; k++) {
        double s = between - row->incident[k] * row->outgoing[k];
        double larger = row->incident[k] > row->outgoing[k] ? row->incident[k] : row->outgoing[k];
        double t = s > 0.0 ? larger : 1.0;
        double rough = level * (1.0 + roughness * s / t);

        for (int c = 0; c < GONIO_CHANNELS; c++)
            row->rho[c][k] += rough * difference->diffuse[c];
    }
}

/* Multiplies what lies beneath the surface by (1 - surface F0) t(ci) t(co). */
GONIO_I_VECTORISED static void attenuate(bin_row *row, const gonio_i_atlas_material *material)
{
    const double surface = material->surface;
    double passed[GONIO_CHANNELS];

    for (int c = 0; c < GONIO_CHANNELS; c++)
        passed[c] = 1.0 - surface * material->f0[c];
#pragma omp simd
    for (int k = 0; k < row->count; k++) {
        double in = 1.0 - surface * fifth_power(1.0 - 0.5 * row->incident[k]);
        double out = 1.0 - surface * fifth_power(1.0 - 0.5 * row->outgoing[k]);

        for (int c = 0; c < GONIO_CHANNELS; c++)
            row->rho[c][k] *= passed[c] * (in * out);
    }
}

/* Adds relief x D G / (4 ci co), G = min(cd, 2 ch ci, 2 ch co) / cd. */
GONIO_I_VECTORISED static void add_relief(bin_row *row, const gonio_i_atlas_material *material,
                                          const half_terms *half,
                                          const difference_terms *difference)
{
    const double clear = difference->cosine;
    const double groove = 2.0 * half->cosine;
    const double scale = 0.25 * half->relief;

#pragma omp simd
    for (int k = 0; k < row->count; k++) {
        double incident = row->incident[k];
        double outgoing = row->outgoing[k];
        double smaller = groove * (incident < outgoing ? incident : outgoing);
        double open = smaller < clear ? smaller : clear;
        double lobe = scale * open / (clear * incident * outgoing);

        for (int c = 0; c < GONIO_CHANNELS; c++)
            row->rho[c][k] += material->relief[c] * lobe;
    }
}

/* Adds sheen D_s / (4 (ci + co - ci co)). */
GONIO_I_VECTORISED static void add_sheen(bin_row *row, const gonio_i_atlas_material *material,
                                         double density)
{
#pragma omp simd
    for (int k = 0; k < row->count; k++) {
        double incident = row->incident[k];
        double outgoing = row->outgoing[k];
        double lobe = 0.25 * density / (incident + outgoing - incident * outgoing);

        for (int c = 0; c < GONIO_CHANNELS; c++)
            row->rho[c][k] += material->sheen[c] * lobe;
    }
}

static half_terms half_terms_at(const gonio_i_atlas_material *material, double theta_h)
{
    half_terms half = {.cosine = cos(theta_h), .sine = sin(theta_h)};
    double exponent = material->sheen_exponent;

    if (material->surface > 0.0)
        half.facets = facet_density(material->facets, half.cosine, half.sine);
    if (material->haze > 0.0)
        half.haze = facet_density(material->haze_facets, half.cosine, half.sine);
    if (material->flake_facets.alpha > 0.0)
        half.flake = facet_density(material->flake_facets, half.cosine, half.sine);
    if (material->relief_width > 0.0)
        half.relief =
            relief_density(material->relief_slope, material->relief_width, half.cosine, half.sine);
    if (exponent > 0.0)
        half.sheen = (2.0 + exponent) / (2.0 * PI) * pow(half.sine, exponent);
    return half;
}

/* Schlick's (1994) approximation, less a multiple of c (1 - c)^6, whose maximum is at c = 1/7
 * (82 degrees): metals dip there before they rise (Lazanyi and Szirmay-Kalos 2005). */
static double fresnel(double f0, double edge, double cosine)
{
    const double at_dip = 1.0 / 7.0;
    double schlick = f0 + (1.0 - f0) * fifth_power(1.0 - cosine);
    double schlick_at_dip = f0 + (1.0 - f0) * fifth_power(1.0 - at_dip);
    double dip = cosine * fifth_power(1.0 - cosine) * (1.0 - cosine);
    double deepest = at_dip * fifth_power(1.0 - at_dip) * (1.0 - at_dip);

    return schlick - edge * schlick_at_dip * dip / deepest;
}

/* Share of light that two beams from a film leave: path 2 n d cos(theta_t), n = 1.6, contrast 0.9,
 * at one wavelength a channel. */
static double film_reflectance(double optical_thickness, double sine, int channel)
{
    static const double wavelength[GONIO_CHANNELS] = {610.0, 550.0, 465.0}; /* nm */
    const double contrast = 0.9, index = 1.6;
    double refracted = sqrt(1.0 - sine * sine / (index * index));
    double phase = 4.0 * PI * optical_thickness * refracted / wavelength[channel];

    return 1.0 - 0.5 * contrast * (1.0 - cos(phase));
}

static difference_terms difference_terms_at(const gonio_i_atlas_material *material, double theta_d)
{
    difference_terms difference = {.cosine = cos(theta_d), .sine = sin(theta_d)};
    double surge = 1.0;

    if (material->opposition > 0.0) {
        double fall = difference.cosine * material->opposition_width;
        double peak = material->opposition * fall / (fall + difference.sine);
        surge = (1.0 + peak) / (1.0 + material->opposition);
    }
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        difference.fresnel[c] = fresnel(material->f0[c], material->edge, difference.cosine);
        difference.diffuse[c] = material->diffuse[c] * surge / PI;
        difference.flake[c] = material->flake[c];
        if (material->film > 0.0)
            difference.flake[c] *= film_reflectance(material->film, difference.sine, c);
    }
    return difference;
}

/* The BRDF of a row whose cosines are set and positive. */
static void evaluate(bin_row *row, const gonio_i_atlas_material *material, const half_terms *half,
                     const difference_terms *difference)
{
    for (int c = 0; c < GONIO_CHANNELS; c++)
        memset(row->rho[c], 0, (size_t)row->count * sizeof row->rho[c][0]);
    add_diffuse(row, material, difference);
    if (material->flake_facets.alpha > 0.0)
        add_lobe(row, material->flake_facets, half->flake, difference->flake);
    attenuate(row, material);
    add_surface(row, material, half, difference);
    if (material->relief_width > 0.0)
        add_relief(row, material, half, difference);
    if (material->sheen_exponent > 0.0)
        add_sheen(row, material, half->sheen);
}

void gonio_atlas_value(int index, gonio_half_difference coordinates, double rho[GONIO_CHANNELS])
{
    gonio_i_atlas_material material;
    bin_row one;

    for (int c = 0; c < GONIO_CHANNELS; c++)
        rho[c] = 0.0;
    gonio_cosines(coordinates, &one.incident[0], &one.outgoing[0]);
    if (!material_at(index, &material) || !(one.incident[0] > 0.0 && one.outgoing[0] > 0.0))
        return;

    half_terms half = half_terms_at(&material, coordinates.theta_h);
    difference_terms difference = difference_terms_at(&material, coordinates.theta_d);
    one.count = 1;
    evaluate(&one, &material, &half, &difference);
    for (int c = 0; c < GONIO_CHANNELS; c++)
        rho[c] = one.rho[c][0];
}

/* Sets the cosines of one (theta_h, theta_d) row, as gonio_cosines does but with the sines and
 * cosines taken once a row. Bins that are not valid get harmless cosines. */
static void set_cosines(bin_row *row, const half_terms *half, const difference_terms *difference,
                        const double cos_phi_d[GONIO_PHI_D_BINS], bool valid[GONIO_PHI_D_BINS])
{
    const double cosines = half->cosine * difference->cosine;
    const double sines = half->sine * difference->sine;

    row->count = GONIO_PHI_D_BINS;
    for (int k = 0; k < GONIO_PHI_D_BINS; k++) {
        double incident = cosines - sines * cos_phi_d[k];
        double outgoing = cosines + sines * cos_phi_d[k];

        valid[k] = incident > 0.0 && outgoing > 0.0;
        row->incident[k] = valid[k] ? incident : 1.0;
        row->outgoing[k] = valid[k] ? outgoing : 1.0;
    }
}

static void store_row(const bin_row *row, const bool valid[GONIO_PHI_D_BINS], int theta_d,
                      double *rho)
{
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        double *out = rho + (c * GONIO_THETA_D_BINS + theta_d) * GONIO_PHI_D_BINS;
        for (int k = 0; k < GONIO_PHI_D_BINS; k++)
            out[k] = valid[k] ? row->rho[c][k] : -1.0;
    }
}

/* Some rows of a slab, in their places. */
static void store_rows(const gonio_i_atlas_material *material, int theta_h, int first, int count,
                       double *rho)
{
    double cos_phi_d[GONIO_PHI_D_BINS];
    bool valid[GONIO_PHI_D_BINS];
    bin_row row;

    half_terms half =
        half_terms_at(material, gonio_bin_centre((gonio_bin){.theta_h = theta_h}).theta_h);
    for (int k = 0; k < GONIO_PHI_D_BINS; k++)
        cos_phi_d[k] = cos(gonio_bin_centre((gonio_bin){.phi_d = k}).phi_d);
    for (int j = first; j < first + count; j++) {
        double theta_d = gonio_bin_centre((gonio_bin){.theta_d = j}).theta_d;
        difference_terms difference = difference_terms_at(material, theta_d);

        set_cosines(&row, &half, &difference, cos_phi_d, valid);
        evaluate(&row, material, &half, &difference);
        store_row(&row, valid, j, rho);
    }
}

void gonio_i_atlas_row(int index, int theta_h, int theta_d, double *slab)
{
    gonio_i_atlas_material material;

    if (material_at(index, &material))
        store_rows(&material, theta_h, theta_d, 1, slab);
}

void gonio_atlas_slab(int index, int theta_h, double *rho)
{
    gonio_i_atlas_material material;

    if (!material_at(index, &material) || theta_h < 0 || theta_h >= GONIO_THETA_H_BINS) {
        for (int n = 0; n < GONIO_CHANNELS * GONIO_THETA_D_BINS * GONIO_PHI_D_BINS; n++)
            rho[n] = -1.0;
        return;
    }
    store_rows(&material, theta_h, 0, GONIO_THETA_D_BINS, rho);
}
