/* Random analytic materials: see random_materials.h. Reflectances are drawn so that no material
 * reflects more than it receives. */
#include "random_materials.h"

#include <math.h>

#include "../core/random.h"

static double between(gonio_i_random *random, double least, double most)
{
    return least + (most - least) * gonio_i_random_uniform(random);
}

/* Of any order of magnitude between the two. */
static double of_any_order(gonio_i_random *random, double least, double most)
{
    return least * pow(most / least, gonio_i_random_uniform(random));
}

static bool by_chance(gonio_i_random *random, double probability)
{
    return gonio_i_random_uniform(random) < probability;
}

/* A colour: a third are grey; channels of others are darker by up to a factor of 20. */
static void draw_colour(gonio_i_random *random, double least, double most,
                        double colour[GONIO_CHANNELS])
{
    const double brightest = of_any_order(random, least, most);
    const double saturation = by_chance(random, 0.3) ? 0.0 : between(random, 0.0, 3.0);
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        colour[c] = brightest * exp(-saturation * gonio_i_random_uniform(random));
    }
}

static gonio_i_atlas_facets draw_facets(gonio_i_random *random, double least, double most)
{
    gonio_i_atlas_facets facets;
    facets.alpha = of_any_order(random, least, most);
    facets.light = gonio_i_random_uniform(random);
    return facets;
}

/* A haze of the weight `most` or less, up to `wider` times wider than the lobe. */
static void draw_haze(gonio_i_random *random, double probability, double most, double wider,
                      gonio_i_atlas_material *m)
{
    const double widest = 0.95;
    if (by_chance(random, probability)) {
        m->haze = between(random, 0.0, most);
        m->haze_facets.alpha = fmin(widest, m->facets.alpha * of_any_order(random, 1.5, wider));
        m->haze_facets.light = gonio_i_random_uniform(random);
    }
}

static void draw_opposition(gonio_i_random *random, double most, gonio_i_atlas_material *m)
{
    if (by_chance(random, 0.6)) {
        m->opposition = of_any_order(random, 0.03, most);
        m->opposition_width = of_any_order(random, 0.04, 0.6);
    }
}

/* A clear surface of a share of the area, with one F0 for all channels. */
static void draw_surface(gonio_i_random *random, double whole, double widest,
                         gonio_i_atlas_material *m)
{
    const double f0 = between(random, 0.02, 0.065);
    m->surface = by_chance(random, whole) ? 1.0 : gonio_i_random_uniform(random);
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        m->f0[c] = f0;
    }
    m->facets = draw_facets(random, 0.01, widest);
}

static void draw_metal(gonio_i_random *random, gonio_i_atlas_material *m)
{
    m->surface = by_chance(random, 0.5) ? 1.0 : between(random, 0.6, 1.0);
    draw_colour(random, 0.25, 0.98, m->f0);
    m->edge = between(random, 0.0, 0.25);
    m->facets = draw_facets(random, 0.01, 0.5);
    draw_haze(random, 0.7, 0.6, 10.0, m);
}

static void draw_metallic_paint(gonio_i_random *random, gonio_i_atlas_material *m)
{
    draw_surface(random, 0.8, 0.3, m);
    draw_haze(random, 0.4, 0.3, 10.0, m);
    draw_colour(random, 0.05, 0.9, m->flake);
    m->flake_facets = draw_facets(random, 0.06, 0.7);
    m->film = by_chance(random, 0.3) ? of_any_order(random, 100.0, 2000.0) : 0.0;
    draw_colour(random, 0.005, 0.4, m->diffuse);
    m->roughness = by_chance(random, 0.5) ? 0.0 : between(random, 0.0, 0.5);
}

static void draw_pigment(gonio_i_random *random, gonio_i_atlas_material *m)
{
    draw_surface(random, 0.5, 0.7, m);
    draw_haze(random, 0.6, 0.5, 12.0, m);
    draw_colour(random, 0.005, 0.9, m->diffuse);
    m->roughness = by_chance(random, 0.4) ? 0.0 : gonio_i_random_uniform(random);
    draw_opposition(random, 2.0, m);
}

static void draw_cloth(gonio_i_random *random, gonio_i_atlas_material *m)
{
    draw_colour(random, 0.008, 0.9, m->diffuse);
    m->roughness = gonio_i_random_uniform(random);
    draw_opposition(random, 4.0, m);
    if (by_chance(random, 0.7)) {
        draw_colour(random, 0.02, 0.25, m->sheen);
        m->sheen_exponent = between(random, 1.2, 8.0);
    }
    if (by_chance(random, 0.6)) {
        draw_colour(random, 0.01, 0.45, m->flake);
        m->flake_facets = draw_facets(random, 0.15, 0.9);
    }
}

static void draw_relief(gonio_i_random *random, gonio_i_atlas_material *m)
{
    if (by_chance(random, 0.3)) {
        draw_colour(random, 0.004, 0.15, m->relief);
        m->relief_slope = of_any_order(random, 0.12, 1.5);
        m->relief_width = m->relief_slope * between(random, 0.2, 0.5);
    }
}

/* Makes all that is beside the surface darker until it reflects at most what the surface leaves. */
static void limit(gonio_i_atlas_material *m)
{
    const double most = 0.9;
    double factor = 1.0;
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        const double beside = m->diffuse[c] + m->flake[c] + m->relief[c] + m->sheen[c];
        const double left = m->f0[c] > 0.1 ? 1.0 - m->surface * m->f0[c] : most;
        factor = fmin(factor, fmax(left, 0.0) / fmax(beside, 1e-9));
    }
    for (int c = 0; c < GONIO_CHANNELS; c++) {
        m->diffuse[c] *= factor;
        m->flake[c] *= factor;
        m->relief[c] *= factor;
        m->sheen[c] *= factor;
    }
}

gonio_i_atlas_material gonio_i_random_material(int k)
{
    static const struct {
        double share;
        void (*draw)(gonio_i_random *random, gonio_i_atlas_material *m);
    } kinds[] = {
        {0.22, draw_metal}, {0.28, draw_metallic_paint}, {0.35, draw_pigment}, {0.15, draw_cloth}};
    const size_t count = sizeof kinds / sizeof *kinds;
    gonio_i_atlas_material m = {.material_class = "random"};
    gonio_i_random random;
    gonio_i_random_seed(&random, 1, (uint64_t)k);
    double left = gonio_i_random_uniform(&random);
    size_t kind = 0;
    while (kind + 1 < count && left >= kinds[kind].share) {
        left -= kinds[kind++].share;
    }
    kinds[kind].draw(&random, &m);
    draw_relief(&random, &m);
    limit(&m);
    return m;
}
