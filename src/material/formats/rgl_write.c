/* Writing isotropic materials as RGL .bsdf files (rgl.c has the format's equations).
 *
 * The file's values at a place s are rho cos theta_o 4 sigma / ndf in the direction that s is
 * warped to, so any ndf that is positive and any warp represent any material. The better ndf
 * resembles the material, the smoother the values are, which is what interpolation wants: ndf is
 * the material's mean luminance by theta_h, and sigma its area projected towards the incident
 * direction. vndf depends on u alone, which crowds places around the mirror direction already; it
 * is higher where values bend (rgl_places.c). Light is sampled by the field luminance together with
 * vndf, so luminance is what a place reflects, the solid angle of its half vectors included:
 *
 *     luminance(s) = L(s) ndf(u) <i, m> u sin theta_m / vndf(u), L of the values.
 *
 * Values are fitted to the material at directions between the places (rgl_fit.c).
 * Where the material has no data, the nearest places stand in. Beyond the angle up to which it was
 * measured, the values at that angle do. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/core.h"
#include "../sampler.h"
#include "../tensor_write.h"
#include "../warp.h"
#include "rgl.h"
#include "rgl_fit.h"
#include "rgl_places.h"
#include "writers.h"

enum {
    THETAS = 26,       /* incidences */
    SIDE = 84,         /* most places along s, */
    COARSE = 32,       /* and least, in spectra of many wavelengths */
    NUMBERS = 6 << 20, /* of values and luminance, that a spectral file holds about */
    NORMALS = GONIO_I_RGL_NORMALS
};

/* Incidences are denser towards grazing: theta_i = pi/2 (1 - (1 - x)^GRAZING), x evenly spaced. */
static const double GRAZING = 1.3;

/* The largest polar angle at which tables have data all around. */
static const double STEEPEST = 88.0 * M_PI / 180.0;

typedef struct writer {
    gonio_context *context;
    gonio_i_sampler sampler;
    const gonio_material_view *view;
    size_t channels; /* 3, or the wavelengths */
    size_t side;
    double limit;                          /* polar angle that directions are held to */
    float theta[THETAS];                   /* of incidence */
    float ndf[2][NORMALS];                 /* the rows are alike */
    float sigma[2][NORMALS];               /* the same */
    float vndf[THETAS][2][NORMALS];        /* all rows are alike */
    gonio_i_warp warp;                     /* of a slice */
    float *value;                          /* [THETAS][channels][side][side] */
    float *luminance;                      /* [THETAS][side][side] */
    unsigned char *valid;                  /* [bytes_of_bits(THETAS * side * side)] */
    double *weight;                        /* [channels]: of the luminance */
    size_t order[GONIO_I_RGL_WAVELENGTHS]; /* [channels]: which of the material */
} writer;

static size_t bytes_of_bits(size_t bits)
{
    return (bits + 7) / 8;
}

/* ---- the distribution of normals ---- */

/* The mean luminance, in logarithms, by theta_h, of half vectors off the plane of incidence. */
static gonio_status find_luminance(const writer *w, double *luminance)
{
    enum { DIFFERENCES = 4 };
    gonio_pair pair[NORMALS][DIFFERENCES];
    double *value =
        gonio_i_allocate(w->context, NORMALS * DIFFERENCES * w->view->channels, sizeof *value);
    if (value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < NORMALS; k++) {
        const double theta_h = gonio_i_rgl_theta((double)k / (NORMALS - 1));
        for (size_t j = 0; j < DIFFERENCES; j++) {
            const double theta_d = (5.0 + 15.0 * (double)j) * M_PI / 180.0;
            pair[k][j] = gonio_pair_from_half_difference(
                (gonio_half_difference){theta_h, theta_d, M_PI / 2.0});
        }
    }
    const gonio_status status = gonio_i_sampler_values(w->context, &w->sampler, pair[0],
                                                       (size_t)NORMALS * DIFFERENCES, value);
    double before = 1.0;
    for (size_t k = 0; k < NORMALS && status == GONIO_OK; k++) {
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
    const double u = (double)k / (NORMALS - 1);
    const double end = k == 0 || k == NORMALS - 1 ? 0.5 : 1.0;
    const double theta = gonio_i_rgl_theta(u);
    return end * 2.0 * M_PI * sin(theta) * cos(theta) * M_PI * u / (NORMALS - 1);
}

/* Scaled so that the area projected along the normal is 1. */
static gonio_status find_ndf(writer *w)
{
    double luminance[NORMALS];
    double all = 0.0;
    const gonio_status status = find_luminance(w, luminance);
    for (size_t k = 0; k < NORMALS && status == GONIO_OK; k++) {
        all += luminance[k] * projected_angle(k);
    }
    for (size_t k = 0; k < NORMALS && status == GONIO_OK; k++) {
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
static double project(const writer *w, double theta_i)
{
    enum { STEPS = 256 };
    double sum = 0.0;
    for (size_t k = 0; k < NORMALS; k++) {
        const double u = (double)k / (NORMALS - 1);
        const double theta = gonio_i_rgl_theta(u);
        const double end = k == 0 || k == NORMALS - 1 ? 0.5 : 1.0;
        double seen = 0.0;
        for (int a = 0; a < STEPS; a++) {
            seen += fmax(cosine_between(theta_i, theta, 2.0 * M_PI * (a + 0.5) / STEPS), 0.0);
        }
        sum += end * (double)w->ndf[0][k] * seen * (2.0 * M_PI / STEPS) * sin(theta) * M_PI * u /
               (NORMALS - 1);
    }
    return sum;
}

static void find_sigma(writer *w)
{
    for (size_t k = 0; k < NORMALS; k++) {
        const double theta = gonio_i_rgl_theta((double)k / (NORMALS - 1));
        w->sigma[0][k] = w->sigma[1][k] = (float)project(w, theta);
    }
}

static gonio_status find_vndf(writer *w)
{
    float *row = w->vndf[0][0];
    const gonio_status status =
        gonio_i_rgl_places(w->context, &w->sampler, w->ndf[0], w->limit, row);
    for (size_t k = 1; k < (size_t)THETAS * 2; k++) {
        memcpy(row + k * NORMALS, row, NORMALS * sizeof *row);
    }
    return status == GONIO_OK ? gonio_i_warp_create(w->context, row, 1, 2, NORMALS, &w->warp)
                              : status;
}

/* ---- the values ---- */

/* A place of the grid over s: the direction that it is warped to. */
typedef struct place {
    double factor; /* from rho to the file's value; negative below the horizon */
    double angle;  /* what the file's value counts for in sampling; 0 below the horizon */
    bool measured;
} place;

static place set_direction(const writer *w, size_t t, size_t node, gonio_pair *pair)
{
    const gonio_i_blend slice = {1, {0}, {1.0}};
    const double last = (double)(w->side - 1);
    const size_t row = node / w->side;
    const double s[2] = {(double)(node % w->side) / last, (double)row / last};
    const double theta_i = (double)w->theta[t];
    double u[2];
    const double density = gonio_i_warp_sample(&w->warp, &slice, s, u);
    const gonio_i_rgl_mirrored to = gonio_i_rgl_mirror(theta_i, u[0], u[1]);
    *pair = (gonio_pair){{fmin(theta_i, w->limit), 0.0},
                         {fmin(to.outgoing.theta, w->limit), to.outgoing.phi}};
    const double area = gonio_i_rgl_look_up(w->sigma[0], sqrt(theta_i * (2.0 / M_PI)));
    const double ndf = gonio_i_rgl_look_up(w->ndf[0], u[0]);
    const double angle = fmax(to.cosine_m, 0.0) * u[0] * sin(to.theta_m) / density;
    return (place){.factor = 4.0 * area * to.cosine_o / ndf,
                   .angle = to.cosine_o > 0.0 ? ndf * angle : 0.0,
                   .measured = theta_i <= w->limit && to.outgoing.theta <= w->limit};
}

/* Fills empty places with the mean of their neighbours, ring by ring, in all channels. */
static void fill_empty(double *value, size_t side, size_t channels, bool *known)
{
    const size_t nodes = side * side;
    bool more = true;
    while (more) {
        bool found[SIDE * SIDE] = {false};
        more = false;
        for (size_t node = 0; node < nodes; node++) {
            const size_t x = node % side;
            const size_t y = node / side;
            const size_t around[4] = {x > 0 ? node - 1 : node, x + 1 < side ? node + 1 : node,
                                      y > 0 ? node - side : node,
                                      y + 1 < side ? node + side : node};
            int count = 0;
            for (int k = 0; k < 4 && !known[node]; k++) {
                count += known[around[k]] ? 1 : 0;
            }
            for (size_t c = 0; c < channels && count > 0; c++) {
                double sum = 0.0;
                for (int k = 0; k < 4; k++) {
                    sum += known[around[k]] ? value[around[k] * channels + c] : 0.0;
                }
                value[node * channels + c] = sum / count;
            }
            found[node] = count > 0;
        }
        for (size_t node = 0; node < nodes; node++) {
            known[node] = known[node] || found[node];
            more = more || found[node];
        }
    }
}

/* rho of an incidence at all places: [node][view->channels], holes filled. Of channels without data
 * 0 if others have some. *any: whether there are data at all; without, rho is 0. */
static gonio_status read_incidence(const writer *w, const gonio_pair *pairs, double *rho,
                                   bool *known, bool *any)
{
    const size_t nodes = w->side * w->side;
    const size_t channels = w->view->channels;
    const gonio_status status = gonio_i_sampler_values(w->context, &w->sampler, pairs, nodes, rho);
    *any = false;
    for (size_t k = 0; k < nodes && status == GONIO_OK; k++) {
        known[k] = false;
        for (size_t c = 0; c < channels; c++) {
            known[k] = known[k] || !isnan(rho[k * channels + c]);
        }
        for (size_t c = 0; c < channels; c++) {
            rho[k * channels + c] = isnan(rho[k * channels + c]) ? 0.0 : rho[k * channels + c];
        }
        *any = *any || known[k];
    }
    if (status == GONIO_OK && *any) {
        fill_empty(rho, w->side, channels, known);
    }
    return status;
}

static void store_incidence(writer *w, size_t t, const place *places, const double *rho)
{
    const size_t nodes = w->side * w->side;
    const size_t channels = w->view->channels;
    for (size_t k = 0; k < nodes; k++) {
        for (size_t c = 0; c < w->channels; c++) {
            w->value[(t * w->channels + c) * nodes + k] =
                (float)(places[k].factor * rho[k * channels + w->order[c]]);
        }
        if (places[k].measured) {
            const size_t bit = t * nodes + k;
            w->valid[bit / 8] = (unsigned char)(w->valid[bit / 8] | (0x80U >> (bit % 8)));
        }
    }
}

static void store_luminance(writer *w, size_t t, const place *places)
{
    const size_t nodes = w->side * w->side;
    for (size_t k = 0; k < nodes; k++) {
        double luminance = 0.0;
        for (size_t c = 0; c < w->channels; c++) {
            luminance += w->weight[c] * (double)w->value[(t * w->channels + c) * nodes + k];
        }
        w->luminance[t * nodes + k] = (float)(fmax(luminance, 0.0) * places[k].angle);
    }
}

static void set_all_directions(const writer *w, size_t t, gonio_pair *pairs, place *places)
{
    for (size_t k = 0; k < w->side * w->side; k++) {
        places[k] = set_direction(w, t, k, &pairs[k]);
    }
}

/* Scratch of find_values. */
typedef struct workplace {
    gonio_pair *pairs;
    place *places;
    double *rho;    /* of an incidence */
    double *latest; /* of the last one with data */
    bool *known;
} workplace;

static gonio_status allocate(const writer *w, workplace *p)
{
    const size_t nodes = w->side * w->side;
    p->pairs = gonio_i_allocate(w->context, nodes, sizeof *p->pairs);
    p->places = gonio_i_allocate(w->context, nodes, sizeof *p->places);
    p->rho = gonio_i_allocate(w->context, nodes * w->view->channels, sizeof *p->rho);
    p->latest = gonio_i_allocate(w->context, nodes * w->view->channels, sizeof *p->latest);
    p->known = gonio_i_allocate(w->context, nodes, sizeof *p->known);
    return p->pairs != NULL && p->places != NULL && p->rho != NULL && p->latest != NULL &&
                   p->known != NULL
               ? GONIO_OK
               : GONIO_ERROR_MEMORY;
}

/* An incidence without any data, as beyond the largest measured angle, gets the values of the last
 * incidence with data before it, or of the first with data. */
static gonio_status read_all(writer *w, workplace *p)
{
    size_t missing = 0; /* before the first incidence with data */
    gonio_status status = GONIO_OK;
    for (size_t t = 0; t < THETAS && status == GONIO_OK; t++) {
        bool any = false;
        set_all_directions(w, t, p->pairs, p->places);
        status = read_incidence(w, p->pairs, p->rho, p->known, &any);
        if (status == GONIO_OK && any) {
            double *kept = p->latest;
            p->latest = p->rho;
            p->rho = kept;
        } else if (missing == t) {
            missing++;
        }
        for (size_t first = 0; any && first < missing; first++) {
            set_all_directions(w, first, p->pairs, p->places);
            store_incidence(w, first, p->places, p->latest);
        }
        missing = any ? 0 : missing;
        if (status == GONIO_OK) {
            set_all_directions(w, t, p->pairs, p->places);
            store_incidence(w, t, p->places, p->latest);
            status = gonio_i_progress(w->context, "writing", 0.3 * (double)(t + 1) / THETAS);
        }
    }
    return status;
}

static gonio_status fit_values(writer *w)
{
    const gonio_i_rgl_values values = {.thetas = THETAS,
                                       .theta = w->theta,
                                       .channels = w->channels,
                                       .order = w->order,
                                       .side = w->side,
                                       .value = w->value,
                                       .ndf = w->ndf[0],
                                       .sigma = w->sigma[0],
                                       .warp = &w->warp};
    return gonio_i_rgl_fit(w->context, &w->sampler, &values);
}

static gonio_status find_values(writer *w)
{
    workplace p = {0};
    gonio_status status = allocate(w, &p) == GONIO_OK ? read_all(w, &p) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = fit_values(w);
    }
    for (size_t t = 0; t < THETAS && status == GONIO_OK; t++) {
        set_all_directions(w, t, p.pairs, p.places);
        store_luminance(w, t, p.places);
    }
    free(p.pairs);
    free(p.places);
    free(p.rho);
    free(p.latest);
    free(p.known);
    return status;
}

/* ---- the file ---- */

static gonio_status write_fields(const writer *w, const char *path)
{
    const float phi = 0.0F;
    const uint32_t version[2] = {1, 0};
    const unsigned char jacobian = 1;
    float wavelength[GONIO_I_RGL_WAVELENGTHS];
    const bool spectral = w->view->wavelength != NULL;
    const uint64_t nodes = w->side * w->side;
    for (size_t k = 0; spectral && k < w->channels; k++) {
        wavelength[k] = (float)w->view->wavelength[w->order[k]];
    }
    const gonio_i_tensor_field fields[] = {
        {"version", GONIO_I_TENSOR_U32, 1, {2}, version},
        {"description", GONIO_I_TENSOR_U8, 1, {strlen(w->view->name)}, w->view->name},
        {"phi_i", GONIO_I_TENSOR_F32, 1, {1}, &phi},
        {"theta_i", GONIO_I_TENSOR_F32, 1, {THETAS}, w->theta},
        {"sigma", GONIO_I_TENSOR_F32, 2, {2, NORMALS}, w->sigma},
        {"ndf", GONIO_I_TENSOR_F32, 2, {2, NORMALS}, w->ndf},
        {"vndf", GONIO_I_TENSOR_F32, 4, {1, THETAS, 2, NORMALS}, w->vndf},
        {"luminance", GONIO_I_TENSOR_F32, 4, {1, THETAS, w->side, w->side}, w->luminance},
        {spectral ? "spectra" : "rgb",
         GONIO_I_TENSOR_F32,
         5,
         {1, THETAS, w->channels, w->side, w->side},
         w->value},
        {"jacobian", GONIO_I_TENSOR_U8, 1, {1}, &jacobian},
        {"valid", GONIO_I_TENSOR_U8, 1, {bytes_of_bits(THETAS * nodes)}, w->valid},
        {"wavelengths", GONIO_I_TENSOR_F32, 1, {w->channels}, wavelength},
    };
    const size_t count = sizeof fields / sizeof *fields - (spectral ? 0 : 1);
    return gonio_i_tensor_write(w->context, path, fields, count);
}

static size_t choose_side(size_t channels)
{
    const double side = sqrt((double)NUMBERS / (double)(THETAS * (channels + 1)));
    return (size_t)fmin(fmax(side, COARSE), SIDE);
}

/* The material's channel of each channel of the file, whose wavelengths ascend. */
static void find_order(writer *w)
{
    const double *wavelength = w->view->wavelength;
    for (size_t c = 0; c < w->channels; c++) {
        size_t before = 0;
        for (size_t k = 0; wavelength != NULL && k < w->channels; k++) {
            const double apart = wavelength[k] - wavelength[c];
            before += apart < 0.0 || (apart == 0.0 && k < c) ? 1 : 0;
        }
        w->order[wavelength != NULL ? before : c] = w->view->channels == 1 ? 0 : c;
    }
}

static gonio_status begin(writer *w, const gonio_material *material)
{
    w->view = gonio_material_describe(material);
    const bool spectral = w->view->wavelength != NULL;
    if (w->view->channels > GONIO_I_RGL_WAVELENGTHS) {
        return gonio_i_fail(w->context, GONIO_ERROR_ARGUMENT,
                            "%s: %zu wavelengths; a .bsdf is written with at most %d",
                            w->view->name, w->view->channels, GONIO_I_RGL_WAVELENGTHS);
    }
    w->channels = spectral ? w->view->channels : GONIO_CHANNELS;
    w->side = choose_side(w->channels);
    w->limit = w->view->theta_limit > 0.0 ? fmin(w->view->theta_limit, STEEPEST) : STEEPEST;
    for (size_t t = 0; t < THETAS; t++) {
        const double left = 1.0 - (double)t / (THETAS - 1);
        w->theta[t] = (float)(M_PI / 2.0 * (1.0 - pow(left, GRAZING)));
    }
    const size_t nodes = w->side * w->side;
    w->value = gonio_i_allocate(w->context, THETAS * w->channels * nodes, sizeof *w->value);
    w->luminance = gonio_i_allocate(w->context, THETAS * nodes, sizeof *w->luminance);
    w->valid = gonio_i_allocate(w->context, bytes_of_bits(THETAS * nodes), sizeof *w->valid);
    w->weight = gonio_i_allocate(w->context, w->channels, sizeof *w->weight);
    if (w->value == NULL || w->luminance == NULL || w->valid == NULL || w->weight == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    static const double rgb[GONIO_CHANNELS] = {0.2126, 0.7152, 0.0722};
    for (size_t c = 0; c < w->channels; c++) {
        w->weight[c] = spectral ? 1.0 / (double)w->channels : rgb[c];
    }
    find_order(w);
    return gonio_i_sampler_begin(w->context, material, true, &w->sampler);
}

static void end(writer *w)
{
    gonio_i_sampler_end(&w->sampler);
    gonio_i_warp_free(&w->warp);
    free(w->value);
    free(w->luminance);
    free(w->valid);
    free(w->weight);
}

gonio_status gonio_material_write_rgl(gonio_context *context, const gonio_material *material,
                                      const char *path)
{
    const gonio_i_rgl *same = gonio_i_rgl_of(material);
    if (same != NULL && same->luminance != NULL) {
        return gonio_i_rgl_copy(context, same, gonio_material_name(material), path);
    }
    writer *w = gonio_i_allocate(context, 1, sizeof *w);
    if (w == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *w = (writer){.context = context};
    gonio_status status = begin(w, material);
    if (status == GONIO_OK) {
        status = find_ndf(w);
    }
    if (status == GONIO_OK) {
        find_sigma(w);
        status = find_vndf(w);
    }
    if (status == GONIO_OK) {
        status = find_values(w);
    }
    if (status == GONIO_OK) {
        status = write_fields(w, path);
    }
    if (status == GONIO_OK) {
        status = gonio_i_progress(context, "writing", 1.0);
    }
    end(w);
    free(w);
    return status;
}

static gonio_status write_rgl(gonio_context *context, const gonio_material *material,
                              const char *path, const gonio_write_options *options)
{
    (void)options;
    return gonio_material_write_rgl(context, material, path);
}

const gonio_i_format_writer gonio_i_rgl_writer = {
    .name = "rgl",
    .extension = ".bsdf",
    .summary = "RGL BSDF of RGB or spectra, for Mitsuba 3 and pbrt-v4 (measured); isotropic",
    .write = write_rgl,
};
