/* Writing anisotropic materials as RGL .bsdf files (rgl.c has the format's equations, rgl_write.c
 * how values, ndf, sigma and vndf depend on each other).
 *
 * Here ndf and sigma depend on the azimuth too: ndf is the mean luminance by the half vector, whose
 * azimuth is that of the sample. Places are denser in u where values bend, and even in the azimuth,
 * for all incidences alike. Azimuths of incidence fill half a turn if half a turn of the sample
 * changes nothing, otherwise a whole one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../tensor_write.h"
#include "rgl_writing.h"

enum {
    THETAS = 21,     /* incidences */
    HALF_TURN = 13,  /* azimuths of incidence over half a turn */
    WHOLE_TURN = 25, /* and over a whole one */
    NORMALS = GONIO_I_RGL_NORMALS,
    AZIMUTHS = 145,     /* rows of ndf */
    AREA_AZIMUTHS = 37, /* rows of sigma */
    AREA_THETAS = 64,
    DIFFERENCES = 4, /* theta_d that ndf is a mean over */
    FINEST = 48,     /* places along s */
    COARSEST = 24,
    NUMBERS = 12 << 20 /* of values and luminance, at most about */
};

static const double GRAZING = 1.3; /* as in rgl_write.c */
static const double STEEPEST = 88.0 * M_PI / 180.0;
static const double SAME = 1e-3; /* relative; values that half a turn does not change */

typedef struct writing {
    gonio_context *context;
    const gonio_material_view *view;
    gonio_i_sampler sampler;
    size_t channels; /* of the file */
    size_t side;
    size_t phis;
    double limit;
    double weight[GONIO_I_RGL_WAVELENGTHS]; /* of the luminance, [channels] */
    size_t order[GONIO_I_RGL_WAVELENGTHS];  /* [channels]: which of the material's each is */
    float phi[WHOLE_TURN];
    float theta[THETAS];
    float ndf[AZIMUTHS][NORMALS];
    float sigma[AREA_AZIMUTHS][AREA_THETAS];
    gonio_i_rgl_image normals; /* of ndf */
    gonio_i_rgl_image areas;   /* of sigma */
    float *vndf;               /* [phis][THETAS][2][NORMALS], all rows alike */
    gonio_i_warp warp;         /* of one slice */
    float *value;              /* [phis][THETAS][channels][side][side] */
    float *luminance;          /* [phis][THETAS][side][side] */
    unsigned char *valid;      /* a bit for each of these */
    /* Scratch, of an incidence. */
    gonio_pair *pair; /* [side side] */
    double *rho;      /* [side side][view.channels] */
    bool *known;      /* [side side] */
} writing;

static gonio_pair turned(gonio_pair pair, double angle)
{
    pair.incident.phi += angle;
    pair.outgoing.phi += angle;
    return pair;
}

static double azimuth_of(size_t row, size_t rows)
{
    return (2.0 * (double)row / (double)(rows - 1) - 1.0) * M_PI;
}

static double luminance_of(const writing *w, const double *rho)
{
    double sum = 0.0;
    for (size_t c = 0; c < w->channels; c++) {
        const double here = rho[w->order[c]];
        sum += w->weight[c] * (here > 0.0 ? here : 0.0);
    }
    return sum;
}

/* ---- what half a turn changes ---- */

static gonio_status find_azimuths(writing *w)
{
    enum { PAIRS = 200 };
    gonio_pair pair[2 * PAIRS];
    double *rho = gonio_i_allocate(w->context, 2 * PAIRS * w->view->channels, sizeof *rho);
    double most = 0.0;
    for (size_t k = 0; k < PAIRS; k++) {
        const double root = fmod(0.618034 * (double)k, 1.0);
        const gonio_half_difference at = {root * root, fmod(0.754878 * (double)k, 1.0),
                                          fmod(0.56984 * (double)k, 1.0) * M_PI};
        pair[k] = turned(gonio_pair_from_half_difference(at), 2.4 * (double)k);
        pair[PAIRS + k] = turned(pair[k], M_PI);
    }
    const gonio_status status =
        rho != NULL ? gonio_i_sampler_values(w->context, &w->sampler, pair, 2 * PAIRS, rho)
                    : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < PAIRS && status == GONIO_OK; k++) {
        const double one = luminance_of(w, rho + k * w->view->channels);
        const double other = luminance_of(w, rho + (PAIRS + k) * w->view->channels);
        most = fmax(most, one > 0.0 && other > 0.0 ? fabs(one - other) / (one + other) : 0.0);
    }
    free(rho);
    w->phis = most < SAME ? HALF_TURN : WHOLE_TURN;
    for (size_t p = 0; p < w->phis; p++) {
        w->phi[p] = (float)(-M_PI + M_PI / (HALF_TURN - 1) * (double)p);
    }
    return status;
}

/* ---- the distribution of normals ---- */

/* A row of ndf: the mean luminance, in logarithms, of half vectors at an azimuth. */
static gonio_status find_row(writing *w, size_t row)
{
    gonio_pair pair[NORMALS][DIFFERENCES];
    const size_t channels = w->view->channels;
    double *rho = gonio_i_allocate(w->context, NORMALS * DIFFERENCES * channels, sizeof *rho);
    for (size_t k = 0; k < NORMALS; k++) {
        for (size_t j = 0; j < DIFFERENCES; j++) {
            const gonio_half_difference at = {gonio_i_rgl_theta((double)k / (NORMALS - 1)),
                                              (5.0 + 15.0 * (double)j) * M_PI / 180.0, M_PI / 2.0};
            pair[k][j] = turned(gonio_pair_from_half_difference(at), azimuth_of(row, AZIMUTHS));
        }
    }
    const gonio_status status = rho != NULL
                                    ? gonio_i_sampler_values(w->context, &w->sampler, pair[0],
                                                             (size_t)NORMALS * DIFFERENCES, rho)
                                    : GONIO_ERROR_MEMORY;
    double before = 1.0;
    for (size_t k = 0; k < NORMALS && status == GONIO_OK; k++) {
        double sum = 0.0;
        int count = 0;
        for (size_t j = 0; j < DIFFERENCES; j++) {
            const double *at = rho + (k * DIFFERENCES + j) * channels;
            sum += isnan(at[0]) ? 0.0 : log(luminance_of(w, at) + 1e-6);
            count += isnan(at[0]) ? 0 : 1;
        }
        before = count > 0 ? exp(sum / count) : before;
        w->ndf[row][k] = (float)before;
    }
    free(rho);
    return status;
}

/* The solid angle of half vectors around a node of ndf, by the trapezoidal rule in u. */
static double angle_of(size_t k)
{
    const double u = (double)k / (NORMALS - 1);
    const double end = k == 0 || k == NORMALS - 1 ? 0.5 : 1.0;
    return end * sin(gonio_i_rgl_theta(u)) * M_PI * u / (NORMALS - 1) * 2.0 * M_PI / (AZIMUTHS - 1);
}

/* The area of all normals' facets that is seen from a direction. */
static double project(const writing *w, double theta, double phi)
{
    double cosine[AZIMUTHS];
    double sum = 0.0;
    for (size_t row = 1; row < AZIMUTHS; row++) {
        cosine[row] = cos(azimuth_of(row, AZIMUTHS) - phi);
    }
    for (size_t k = 0; k < NORMALS; k++) {
        const double theta_m = gonio_i_rgl_theta((double)k / (NORMALS - 1));
        const double along = cos(theta) * cos(theta_m);
        const double across = sin(theta) * sin(theta_m);
        double seen = 0.0;
        for (size_t row = 1; row < AZIMUTHS; row++) { /* the first is the last */
            seen += (double)w->ndf[row][k] * fmax(along + across * cosine[row], 0.0);
        }
        sum += seen * angle_of(k);
    }
    return sum;
}

static gonio_status find_normals(writing *w)
{
    gonio_status status = GONIO_OK;
    for (size_t row = 0; row < AZIMUTHS && status == GONIO_OK; row++) {
        status = find_row(w, row);
    }
    const double all = project(w, 0.0, 0.0);
    for (size_t k = 0; k < (size_t)AZIMUTHS * NORMALS; k++) {
        float *ndf = &w->ndf[k / NORMALS][k % NORMALS];
        *ndf = (float)((double)*ndf / all);
    }
    for (size_t k = 0; k < (size_t)AREA_AZIMUTHS * AREA_THETAS; k++) {
        const double u = (double)(k % AREA_THETAS) / (AREA_THETAS - 1);
        w->sigma[k / AREA_THETAS][k % AREA_THETAS] =
            (float)project(w, gonio_i_rgl_theta(u), azimuth_of(k / AREA_THETAS, AREA_AZIMUTHS));
    }
    w->normals = (gonio_i_rgl_image){NORMALS, AZIMUTHS, w->ndf[0]};
    w->areas = (gonio_i_rgl_image){AREA_THETAS, AREA_AZIMUTHS, w->sigma[0]};
    return status;
}

/* The density of places: by ndf's mean over azimuths, in the logarithm. */
static gonio_status find_places(writing *w)
{
    float mean[NORMALS];
    for (size_t k = 0; k < NORMALS; k++) {
        double sum = 0.0;
        for (size_t row = 1; row < AZIMUTHS; row++) {
            sum += log((double)w->ndf[row][k]);
        }
        mean[k] = (float)exp(sum / (AZIMUTHS - 1));
    }
    const gonio_status status =
        gonio_i_rgl_places(w->context, &w->sampler, mean, w->limit, w->vndf);
    for (size_t k = 1; k < w->phis * THETAS * 2; k++) {
        memcpy(w->vndf + k * NORMALS, w->vndf, NORMALS * sizeof *w->vndf);
    }
    return status == GONIO_OK ? gonio_i_warp_create(w->context, w->vndf, 1, 2, NORMALS, &w->warp)
                              : status;
}

/* ---- values ---- */

/* A place of the grid over s at an incidence. */
typedef struct place {
    double factor; /* from rho to the file's value; negative below the horizon */
    double angle;  /* what the file's value counts for in sampling; 0 below the horizon */
    bool measured;
} place;

static place find_place(const writing *w, gonio_angles in, size_t node, gonio_pair *pair)
{
    const gonio_i_blend slice = {1, {0}, {1.0}};
    const double last = (double)(w->side - 1);
    const size_t row = node / w->side;
    const double s[2] = {(double)(node % w->side) / last, (double)row / last};
    double u[2];
    const double density = gonio_i_warp_sample(&w->warp, &slice, s, u);
    const gonio_i_rgl_mirrored to =
        gonio_i_rgl_mirror(in.theta, u[0], u[1] - in.phi / (2.0 * M_PI));
    *pair = (gonio_pair){{fmin(in.theta, w->limit), in.phi},
                         {fmin(to.outgoing.theta, w->limit), to.outgoing.phi + in.phi}};
    const double area = gonio_i_rgl_image_at(&w->areas, gonio_i_rgl_place_of_theta(in.theta),
                                             gonio_i_rgl_place_of_phi(in.phi));
    const double ndf = gonio_i_rgl_image_at(&w->normals, u[0], u[1]);
    const double angle = fmax(to.cosine_m, 0.0) * u[0] * sin(to.theta_m) / density;
    return (place){.factor = 4.0 * area * to.cosine_o / ndf,
                   .angle = to.cosine_o > 0.0 ? ndf * angle : 0.0,
                   .measured = in.theta <= w->limit && to.outgoing.theta <= w->limit};
}

/* rho of an incidence at all places, holes filled. */
static gonio_status read_incidence(writing *w, gonio_angles in)
{
    const size_t nodes = w->side * w->side;
    const size_t channels = w->view->channels;
    for (size_t k = 0; k < nodes; k++) {
        find_place(w, in, k, &w->pair[k]);
    }
    const gonio_status status =
        gonio_i_sampler_values(w->context, &w->sampler, w->pair, nodes, w->rho);
    for (size_t k = 0; k < nodes && status == GONIO_OK; k++) {
        double *rho = w->rho + k * channels;
        w->known[k] = false;
        for (size_t c = 0; c < channels; c++) {
            w->known[k] = w->known[k] || !isnan(rho[c]);
            rho[c] = isnan(rho[c]) ? 0.0 : rho[c];
        }
    }
    if (status == GONIO_OK) {
        gonio_i_rgl_fill_empty(w->rho, w->side, channels, w->known);
    }
    return status;
}

static void store_incidence(writing *w, size_t slice, gonio_angles in)
{
    const size_t nodes = w->side * w->side;
    for (size_t k = 0; k < nodes; k++) {
        gonio_pair pair;
        const place here = find_place(w, in, k, &pair);
        const double *rho = w->rho + k * w->view->channels;
        const size_t bit = slice * nodes + k;
        for (size_t c = 0; c < w->channels; c++) {
            w->value[(slice * w->channels + c) * nodes + k] =
                (float)(here.factor * rho[w->order[c]]);
        }
        w->luminance[bit] = (float)(fmax(here.factor, 0.0) * luminance_of(w, rho) * here.angle);
        if (here.measured) {
            w->valid[bit / 8] = (unsigned char)(w->valid[bit / 8] | (0x80U >> (bit % 8)));
        }
    }
}

static gonio_status find_values(writing *w)
{
    gonio_status status = GONIO_OK;
    for (size_t slice = 0; slice < w->phis * THETAS && status == GONIO_OK; slice++) {
        const gonio_angles in = {(double)w->theta[slice % THETAS], (double)w->phi[slice / THETAS]};
        status = read_incidence(w, in);
        if (status == GONIO_OK) {
            store_incidence(w, slice, in);
            status =
                gonio_i_progress(w->context, "writing",
                                 0.1 + 0.89 * (double)(slice + 1) / (double)(w->phis * THETAS));
        }
    }
    return status;
}

/* ---- the file ---- */

static gonio_status write_fields(const writing *w, const char *path)
{
    const uint32_t version[2] = {1, 0};
    const unsigned char jacobian = 1;
    const bool spectral = w->view->wavelength != NULL;
    const gonio_i_tensor_type f32 = GONIO_I_TENSOR_F32;
    const uint64_t nodes = w->side * w->side;
    float wavelength[GONIO_I_RGL_WAVELENGTHS];
    for (size_t k = 0; spectral && k < w->channels; k++) {
        wavelength[k] = (float)w->view->wavelength[w->order[k]];
    }
    const gonio_i_tensor_field fields[] = {
        {"version", GONIO_I_TENSOR_U32, 1, {2}, version},
        {"description", GONIO_I_TENSOR_U8, 1, {strlen(w->view->name)}, w->view->name},
        {"phi_i", f32, 1, {w->phis}, w->phi},
        {"theta_i", f32, 1, {THETAS}, w->theta},
        {"sigma", f32, 2, {AREA_AZIMUTHS, AREA_THETAS}, w->sigma},
        {"ndf", f32, 2, {AZIMUTHS, NORMALS}, w->ndf},
        {"vndf", f32, 4, {w->phis, THETAS, 2, NORMALS}, w->vndf},
        {"luminance", f32, 4, {w->phis, THETAS, w->side, w->side}, w->luminance},
        {spectral ? "spectra" : "rgb",
         f32,
         5,
         {w->phis, THETAS, w->channels, w->side, w->side},
         w->value},
        {"jacobian", GONIO_I_TENSOR_U8, 1, {1}, &jacobian},
        {"valid",
         GONIO_I_TENSOR_U8,
         1,
         {gonio_i_bytes_of_bits(w->phis * THETAS * nodes)},
         w->valid},
        {"wavelengths", f32, 1, {w->channels}, wavelength},
    };
    return gonio_i_tensor_write(w->context, path, fields,
                                sizeof fields / sizeof *fields - (spectral ? 0 : 1));
}

static void find_channels(writing *w)
{
    static const double rgb[GONIO_CHANNELS] = {0.2126, 0.7152, 0.0722};
    const bool spectral = w->view->wavelength != NULL;
    w->channels = spectral ? w->view->channels : GONIO_CHANNELS;
    gonio_i_rgl_find_order(w->view, w->channels, w->order);
    for (size_t c = 0; c < w->channels; c++) {
        w->weight[c] = spectral ? 1.0 / (double)w->channels : rgb[c % GONIO_CHANNELS];
    }
}

static gonio_status allocate(writing *w)
{
    const size_t slices = w->phis * THETAS;
    const double side = sqrt((double)NUMBERS / (double)(slices * (w->channels + 1)));
    w->side = (size_t)fmin(fmax(side, COARSEST), FINEST);
    const size_t nodes = w->side * w->side;
    w->vndf = gonio_i_allocate(w->context, slices * 2 * NORMALS, sizeof *w->vndf);
    w->value = gonio_i_allocate(w->context, slices * w->channels * nodes, sizeof *w->value);
    w->luminance = gonio_i_allocate(w->context, slices * nodes, sizeof *w->luminance);
    w->valid = gonio_i_allocate(w->context, gonio_i_bytes_of_bits(slices * nodes), 1);
    w->pair = gonio_i_allocate(w->context, nodes, sizeof *w->pair);
    w->rho = gonio_i_allocate(w->context, nodes * w->view->channels, sizeof *w->rho);
    w->known = gonio_i_allocate(w->context, nodes, sizeof *w->known);
    return w->vndf != NULL && w->value != NULL && w->luminance != NULL && w->valid != NULL &&
                   w->pair != NULL && w->rho != NULL && w->known != NULL
               ? GONIO_OK
               : GONIO_ERROR_MEMORY;
}

static void end(writing *w)
{
    gonio_i_sampler_end(&w->sampler);
    gonio_i_warp_free(&w->warp);
    free(w->vndf);
    free(w->value);
    free(w->luminance);
    free(w->valid);
    free(w->pair);
    free(w->rho);
    free(w->known);
    free(w);
}

static gonio_status write_all(writing *w, const char *path)
{
    gonio_status status = find_azimuths(w);
    if (status == GONIO_OK) {
        status = allocate(w);
    }
    if (status == GONIO_OK) {
        status = find_normals(w);
    }
    if (status == GONIO_OK) {
        status = find_places(w);
    }
    if (status == GONIO_OK) {
        status = find_values(w);
    }
    return status == GONIO_OK ? write_fields(w, path) : status;
}

gonio_status gonio_i_rgl_write_anisotropic(gonio_context *context, const gonio_material *material,
                                           const char *path)
{
    const gonio_material_view *view = gonio_material_describe(material);
    writing *w = gonio_i_allocate(context, 1, sizeof *w);
    if (w == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    w->context = context;
    w->view = view;
    w->limit = view->theta_limit > 0.0 ? fmin(view->theta_limit, STEEPEST) : STEEPEST;
    for (size_t t = 0; t < THETAS; t++) {
        const double left = 1.0 - (double)t / (THETAS - 1);
        w->theta[t] = (float)(M_PI / 2.0 * (1.0 - pow(left, GRAZING)));
    }
    gonio_status status = gonio_i_sampler_begin(context, material, false, &w->sampler);
    if (status == GONIO_OK) {
        find_channels(w);
        status = write_all(w, path);
    }
    end(w);
    return status == GONIO_OK ? gonio_i_progress(context, "writing", 1.0) : status;
}
