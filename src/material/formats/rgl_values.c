/* Writing RGL .bsdf files: values, luminance and mask at all places. See rgl_write.c. */
#include <math.h>
#include <stdlib.h>

#include "rgl_writing.h"

/* A place of the grid over s: the direction that it is warped to. */
typedef struct place {
    double factor; /* from rho to the file's value; negative below the horizon */
    double angle;  /* what the file's value counts for in sampling; 0 below the horizon */
    bool measured;
} place;

static place set_direction(const gonio_i_rgl_writing *w, size_t t, size_t node, gonio_pair *pair)
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

void gonio_i_rgl_fill_empty(double *value, size_t side, size_t channels, bool *known)
{
    const size_t nodes = side * side;
    bool more = true;
    while (more) {
        bool found[GONIO_I_RGL_SIDE * GONIO_I_RGL_SIDE] = {false};
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

void gonio_i_rgl_find_order(const gonio_material_view *view, size_t channels, size_t *order)
{
    const double *wavelength = view->wavelength;
    for (size_t c = 0; c < channels; c++) {
        size_t before = 0;
        for (size_t k = 0; wavelength != NULL && k < channels; k++) {
            const double apart = wavelength[k] - wavelength[c];
            before += apart < 0.0 || (apart == 0.0 && k < c) ? 1 : 0;
        }
        order[wavelength != NULL ? before : c] = view->channels == 1 ? 0 : c;
    }
}

/* rho of an incidence at all places: [node][view->channels], holes filled. Of channels without data
 * 0 if others have some. *any: whether there are data at all; without, rho is 0. */
static gonio_status read_incidence(const gonio_i_rgl_writing *w, const gonio_pair *pairs,
                                   double *rho, bool *known, bool *any)
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
        gonio_i_rgl_fill_empty(rho, w->side, channels, known);
    }
    return status;
}

static void store_incidence(gonio_i_rgl_writing *w, size_t t, const place *places,
                            const double *rho)
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

static void store_luminance(gonio_i_rgl_writing *w, size_t t, const place *places)
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

static void set_all_directions(const gonio_i_rgl_writing *w, size_t t, gonio_pair *pairs,
                               place *places)
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

static gonio_status allocate(const gonio_i_rgl_writing *w, workplace *p)
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
static gonio_status read_all(gonio_i_rgl_writing *w, workplace *p)
{
    size_t missing = 0; /* before the first incidence with data */
    gonio_status status = GONIO_OK;
    for (size_t t = 0; t < GONIO_I_RGL_THETAS && status == GONIO_OK; t++) {
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
            status =
                gonio_i_progress(w->context, "writing", 0.3 * (double)(t + 1) / GONIO_I_RGL_THETAS);
        }
    }
    return status;
}

/* The largest value of a channel around a node, in the cells of the interpolation that it is a
 * corner of. */
static float largest_around(const gonio_i_rgl_writing *w, size_t t, size_t channel, size_t node)
{
    const size_t x = node % w->side;
    const size_t y = node / w->side;
    float largest = 0.0F;
    for (size_t l = t > 0 ? t - 1 : t; l <= t + 1 && l < GONIO_I_RGL_THETAS; l++) {
        const float *value = w->value + (l * w->channels + channel) * w->side * w->side;
        for (size_t j = y > 0 ? y - 1 : y; j <= y + 1 && j < w->side; j++) {
            for (size_t i = x > 0 ? x - 1 : x; i <= x + 1 && i < w->side; i++) {
                largest = fmaxf(largest, value[j * w->side + i]);
            }
        }
    }
    return largest;
}

/* Values below the horizon are negative, so that the interpolation is 0 at the horizon. Their size
 * means nothing: it is at most that of the values around them, 0 where no direction above the
 * horizon is near. */
static void limit_below_horizon(gonio_i_rgl_writing *w)
{
    const size_t nodes = w->side * w->side;
    for (size_t t = 0; t < GONIO_I_RGL_THETAS; t++) {
        for (size_t k = 0; k < w->channels * nodes; k++) {
            float *value = &w->value[t * w->channels * nodes + k];
            if (*value < 0.0F) {
                *value = fmaxf(*value, -largest_around(w, t, k / nodes, k % nodes));
            }
        }
    }
}

static gonio_status fit_values(gonio_i_rgl_writing *w)
{
    const gonio_i_rgl_values values = {.thetas = GONIO_I_RGL_THETAS,
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

gonio_status gonio_i_rgl_find_values(gonio_i_rgl_writing *w)
{
    workplace p = {0};
    gonio_status status = allocate(w, &p) == GONIO_OK ? read_all(w, &p) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        limit_below_horizon(w);
        status = fit_values(w);
    }
    for (size_t t = 0; t < GONIO_I_RGL_THETAS && status == GONIO_OK; t++) {
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
