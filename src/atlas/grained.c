/* The built-in anisotropic materials: one reflectance model, evaluated at pairs of directions.
 *
 *     rho = coat F M(coat) + (1 - coat F0) t(ci, coat) t(co, coat) base
 *     base = sum over lobes of weight F M(lobe) + T [N (diffuse / pi) + fibre C]
 *
 * with ci, co the cosines of the incident and the outgoing angle and
 *   M  a microfacet lobe D G / (4 ci co), of facets whose slopes are stretched across the lobe's
 *      direction, with Smith's height-correlated G (Heitz 2014, which covers stretched slopes);
 *   F  Schlick's reflectance, less a dip near 82 degrees for metals;
 *   t, N  the coupling of Ashikhmin and Shirley (2000), as in atlas.c; T the same coupling of the
 *      pigment with the lobes above it, of which the sum of weights is the share;
 *   C  fibres in a cone: a Gaussian of the sum of the two angles that the refracted directions make
 *      with the plane across the fibre, over the squared cosine of half their difference
 *      (Marschner et al. 2005, "Measuring and Modeling the Appearance of Finished Wood").
 * Every factor is symmetric in the two directions: the whole is reciprocal. A lobe M alone reflects
 * at most 1; that the sum does, for every material, incidence and azimuth, is tested. Compiled
 * without fused multiply-add, so that values do not depend on the processor. */
#include <gonio/atlas.h>

#include <math.h>
#include <string.h>

#include "grained.h"

static const double PI = 3.14159265358979323846;

static const double FINISH = 1.5; /* refractive index of what fibres lie in */

/* Directions in a frame whose x axis is the grain, or a lobe's direction. */
typedef struct vector {
    double x, y, z;
} vector;

typedef struct geometry {
    vector i, o, h;
    double cosine_d; /* between i and h */
} geometry;

int gonio_atlas_anisotropic_count(void)
{
    return gonio_i_grained_material_count;
}

static const gonio_i_grained_material *material_at(int index)
{
    return index >= 0 && index < gonio_i_grained_material_count ? &gonio_i_grained_materials[index]
                                                                : NULL;
}

const char *gonio_atlas_anisotropic_name(int index)
{
    const gonio_i_grained_material *material = material_at(index);
    return material != NULL ? material->name : NULL;
}

const char *gonio_atlas_anisotropic_class(int index)
{
    const gonio_i_grained_material *material = material_at(index);
    return material != NULL ? material->material_class : NULL;
}

int gonio_atlas_anisotropic_symmetry(int index)
{
    const gonio_i_grained_material *material = material_at(index);
    return material != NULL ? material->symmetry : 0;
}

int gonio_atlas_anisotropic_find(const char *name)
{
    for (int k = 0; name != NULL && k < gonio_i_grained_material_count; k++) {
        if (strcmp(gonio_i_grained_materials[k].name, name) == 0) {
            return k;
        }
    }
    return -1;
}

static double fifth_power(double x)
{
    const double square = x * x;
    return square * square * x;
}

/* Turned by -angle about the normal, so that a direction at azimuth `angle` comes to lie on x. */
static vector turned(vector v, double angle)
{
    const double c = cos(angle);
    const double s = sin(angle);
    return (vector){c * v.x + s * v.y, c * v.y - s * v.x, v.z};
}

static geometry turn_all(const geometry *g, double angle)
{
    return (geometry){turned(g->i, angle), turned(g->o, angle), turned(g->h, angle), g->cosine_d};
}

static geometry geometry_of(gonio_pair pair, double grain)
{
    const gonio_angles *a = &pair.incident;
    const gonio_angles *b = &pair.outgoing;
    const vector i = {sin(a->theta) * cos(a->phi), sin(a->theta) * sin(a->phi), cos(a->theta)};
    const vector o = {sin(b->theta) * cos(b->phi), sin(b->theta) * sin(b->phi), cos(b->theta)};
    const vector sum = {i.x + o.x, i.y + o.y, i.z + o.z};
    const double length = sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
    const geometry g = {i, o, {sum.x / length, sum.y / length, sum.z / length}, 0.5 * length};
    return turn_all(&g, grain);
}

/* Facets of a lobe in its own frame. */
typedef struct facets {
    double along2; /* squared slopes at which the tails begin */
    double across2;
    double light;
} facets;

/* Density D of facets around the half vector, 1/sr: P/cos^4, P the density of slopes, two
 * Student-t distributions (atlas.c) stretched by `along` and `across`. */
static double facet_density(const facets *f, vector h)
{
    const double z2 = h.z * h.z;
    const double root = 1.0 / (z2 + h.x * h.x / f->along2 + h.y * h.y / f->across2);
    const double heavy = root * root;
    const double light = 3.0 * heavy * heavy * z2 * z2;
    return (heavy + f->light * (light - heavy)) / (PI * sqrt(f->along2 * f->across2));
}

/* c Lambda(c), as in atlas.c. Of stretched slopes the width is that in the direction's azimuth. */
static double masking(const facets *f, vector v)
{
    const double q = sqrt(v.z * v.z + f->along2 * v.x * v.x + f->across2 * v.y * v.y);
    const double s = v.z / q;
    const double heavy = 0.5 * (q - v.z);
    const double thin = (3.0 * q - v.z * (8.0 - s * (6.0 - s * s))) * (1.0 / 16.0);
    return heavy + f->light * (thin - heavy);
}

/* D G / (4 ci co), G = 1/(1 + Lambda_i + Lambda_o). */
static double lobe_at(const facets *f, const geometry *g)
{
    const double shadow = g->o.z * masking(f, g->i) + g->i.z * masking(f, g->o);
    return 0.25 * facet_density(f, g->h) / (g->i.z * g->o.z + shadow);
}

/* Schlick's (1994) approximation, less a multiple of c (1 - c)^6, as in atlas.c. */
static double fresnel(double f0, double edge, double cosine)
{
    const double at_dip = 1.0 / 7.0;
    const double schlick = f0 + (1.0 - f0) * fifth_power(1.0 - cosine);
    const double schlick_at_dip = f0 + (1.0 - f0) * fifth_power(1.0 - at_dip);
    const double dip = cosine * fifth_power(1.0 - cosine) * (1.0 - cosine);
    const double deepest = at_dip * fifth_power(1.0 - at_dip) * (1.0 - at_dip);
    return schlick - edge * schlick_at_dip * dip / deepest;
}

/* What passes a surface of which `share` reflects, in and out, without its reflectance upright. */
static double passed(double share, const geometry *g)
{
    return (1.0 - share * fifth_power(1.0 - 0.5 * g->i.z)) *
           (1.0 - share * fifth_power(1.0 - 0.5 * g->o.z));
}

/* The sine of the angle that a direction makes with the plane across the fibre, once refracted. */
static double towards_fibre(vector v, double tilt)
{
    const double sine2 = (1.0 - v.z * v.z) / (FINISH * FINISH);
    return (v.x / FINISH) * cos(tilt) + sqrt(1.0 - sine2) * sin(tilt);
}

/* The reflection of fibres, 1/sr, of strength 1. */
static double fibres_at(const gonio_i_grained_material *m, const geometry *g)
{
    const double width = m->fibre_width * PI / 180.0;
    const double tilt = m->fibre_tilt * PI / 180.0;
    const double in = asin(towards_fibre(g->i, tilt));
    const double out = asin(towards_fibre(g->o, tilt));
    const double off = (in + out) / width;
    const double half = cos(0.5 * (out - in));
    return exp(-0.5 * off * off) / (width * sqrt(2.0 * PI) * half * half);
}

/* Adds the lobes. Gives their share of the area and their mean reflectance upright. */
static void add_lobes(const gonio_i_grained_material *m, const geometry *g,
                      double rho[GONIO_CHANNELS], double *share, double f0[GONIO_CHANNELS])
{
    *share = 0.0;
    for (int k = 0; k < GONIO_I_GRAINED_LOBES && m->lobe[k].weight > 0.0; k++) {
        const gonio_i_grained_lobe *lobe = &m->lobe[k];
        const facets f = {lobe->along * lobe->along, lobe->across * lobe->across, lobe->light};
        const geometry own = turn_all(g, lobe->turn * PI / 180.0);
        const double here = lobe->weight * lobe_at(&f, &own);
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            rho[c] += here * fresnel(lobe->f0[c], m->edge, g->cosine_d);
            f0[c] += lobe->weight * lobe->f0[c];
        }
        *share += lobe->weight;
    }
}

/* Adds what lies beneath the lobes: pigment and fibres. */
static void add_beneath(const gonio_i_grained_material *m, const geometry *g, double share,
                        const double f0[GONIO_CHANNELS], double rho[GONIO_CHANNELS])
{
    const double through = passed(share, g);
    const double level = 1.0 / ((1.0 - share * 5.0 / 28.0) * (1.0 - m->coat * 5.0 / 28.0));
    const double fibres = m->fibre_width > 0.0 ? fibres_at(m, g) : 0.0;
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        rho[c] += (1.0 - f0[c]) * through * (level * m->diffuse[c] / PI + m->fibre[c] * fibres);
    }
}

static void add_coat(const gonio_i_grained_material *m, const geometry *g,
                     double rho[GONIO_CHANNELS])
{
    const facets f = {m->coat_alpha * m->coat_alpha, m->coat_alpha * m->coat_alpha, 0.2};
    const double through = (1.0 - m->coat * m->coat_f0) * passed(m->coat, g);
    const double reflected = m->coat * fresnel(m->coat_f0, 0.0, g->cosine_d) * lobe_at(&f, g);
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        rho[c] = through * rho[c] + reflected;
    }
}

void gonio_atlas_anisotropic_value(int index, gonio_pair pair, double rho[GONIO_CHANNELS])
{
    const gonio_i_grained_material *m = material_at(index);
    rho[0] = rho[1] = rho[2] = 0.0;
    const double most = fmax(pair.incident.theta, pair.outgoing.theta);
    if (m == NULL || !(most < PI / 2.0)) {
        return;
    }
    const geometry g = geometry_of(pair, m->grain * PI / 180.0);
    double share = 0.0;
    double f0[GONIO_CHANNELS] = {0.0};
    add_lobes(m, &g, rho, &share, f0);
    add_beneath(m, &g, share, f0, rho);
    if (m->coat > 0.0) {
        add_coat(m, &g, rho);
    }
}
