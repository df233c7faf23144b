/* Anisotropic tables as materials: checks, and evaluation at any directions.
 *
 * Between the centres of cells rho is trilinear, as in tables of isotropic materials; only phi_h is
 * continuous already. At the poles of the coordinates two angles have no meaning of their own.
 * Where theta_d = 0, phi_d has none: values become the mean over phi_d. Where theta_h = 0, only
 * psi = phi_h + phi_d has one, the azimuth of the plane of incidence: values become the mean over
 * phi_d at the same psi. There an exchange of both directions turns psi by pi, so only what is even
 * under this turn remains. Where both are 0, values are a mean over all. Each takes over from the
 * first centre on, as the mean over phi_d does in isotropic tables (direction/grid.h). */
#include "anisotropic_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/core.h"
#include "../core/options.h"
#include "../direction/grid.h"
#include "inside.h"

enum {
    CELLS = GONIO_THETA_H_BINS * GONIO_THETA_D_BINS,
    MOST_TERMS = 1 + 2 * GONIO_ANISOTROPIC_ORDERS,
    POLE_POINTS = GONIO_I_MOST_POINTS - GONIO_I_TRILINEAR,
    MOST_SYMMETRY = 8
};

static const size_t MOST_BYTES = (size_t)1 << 30;

/* ---- sizes ---- */

static size_t terms_of(const gonio_anisotropic_table *t)
{
    return 1 + 2 * (size_t)t->orders;
}

size_t gonio_i_anisotropic_count(const gonio_anisotropic_table *t)
{
    return (size_t)CELLS * (size_t)t->phi_d_cells * t->channels * terms_of(t);
}

static bool has_sizes(const gonio_anisotropic_table *t)
{
    return t->phi_d_cells >= 1 && t->phi_d_cells <= GONIO_PHI_D_BINS &&
           GONIO_PHI_D_BINS % t->phi_d_cells == 0 && t->orders >= 0 &&
           t->orders <= GONIO_ANISOTROPIC_ORDERS && t->symmetry >= 1 &&
           t->symmetry <= MOST_SYMMETRY && t->channels >= 1 &&
           t->channels <= MOST_BYTES / sizeof(float) / CELLS;
}

bool gonio_i_anisotropic_fits(const gonio_anisotropic_table *t)
{
    const bool colours = t->channels == 1 || t->channels == GONIO_CHANNELS;
    bool fine = has_sizes(t) && (colours || t->wavelength != NULL) &&
                gonio_i_anisotropic_count(t) <= MOST_BYTES / sizeof(float) && t->floor != NULL &&
                isfinite(t->theta_limit);
    for (size_t c = 0; fine && c < t->channels; c++) {
        fine = t->floor[c] >= 0.0 && isfinite(t->floor[c]) &&
               (t->wavelength == NULL || (t->wavelength[c] > 0.0 && isfinite(t->wavelength[c])));
    }
    return fine;
}

gonio_status gonio_i_anisotropic_check(gonio_context *context, const gonio_anisotropic_table *t)
{
    return gonio_i_anisotropic_fits(t) && t->coefficient != NULL
               ? GONIO_OK
               : gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                              "not an anisotropic table: it needs channels, wavelengths unless "
                              "there are 1 or 3, cells of phi_d that divide 180, a symmetry of 1 "
                              "to %d, at most %d orders, floors of at least 0, and at most 1 GiB",
                              MOST_SYMMETRY, GONIO_ANISOTROPIC_ORDERS);
}

void gonio_i_anisotropic_clear(gonio_anisotropic_table *t)
{
    free((void *)t->wavelength);
    free((void *)t->floor);
    free((void *)t->coefficient);
    *t = (gonio_anisotropic_table){0};
}

char *gonio_i_anisotropic_describe(const gonio_anisotropic_table *t)
{
    return gonio_i_format(
        "gonio anisotropic BRDF table %d x %d x %d, %d orders of phi_h, %d-fold, "
        "%zu %s%s",
        GONIO_THETA_H_BINS, GONIO_THETA_D_BINS, t->phi_d_cells, t->orders, t->symmetry, t->channels,
        t->wavelength != NULL ? "wavelength" : "channel", t->channels == 1 ? "" : "s");
}

/* ---- series ---- */

/* The terms of the series at a phi_h: 1, cos s phi_h, sin s phi_h, cos 2 s phi_h, ... */
typedef struct series {
    double term[MOST_TERMS];
} series;

static void set_terms(const gonio_anisotropic_table *t, double phi_h, series *at)
{
    const double cosine = cos(t->symmetry * phi_h);
    const double sine = sin(t->symmetry * phi_h);
    double c = 1.0;
    double s = 0.0;
    at->term[0] = 1.0;
    for (int k = 1; k <= t->orders; k++) {
        const double next = c * cosine - s * sine;
        s = s * cosine + c * sine;
        c = next;
        at->term[2 * k - 1] = c;
        at->term[2 * k] = s;
    }
}

/* rho of a cell's channel at a phi_h; NaN as its first coefficient: no data. */
static double value_of(const float *coefficient, size_t terms, const series *at, double floor)
{
    double value = 0.0;
    for (size_t k = 0; k < terms; k++) {
        value += (double)coefficient[k] * at->term[k];
    }
    return fmax(exp(value) - floor, 0.0);
}

/* ---- evaluation ---- */

/* Directions while they are evaluated. */
typedef struct evaluation {
    const gonio_anisotropic_table *table;
    double *sum;   /* [channels] of weight times rho */
    double *total; /* [channels] of weights with data */
} evaluation;

/* Adds a cell's values. */
static void add_cell(const evaluation *e, gonio_bin bin, const series *at, double weight)
{
    const gonio_anisotropic_table *t = e->table;
    const size_t terms = terms_of(t);
    const size_t run = (size_t)(GONIO_PHI_D_BINS / t->phi_d_cells);
    const size_t place = (size_t)bin.theta_h * GONIO_THETA_D_BINS + (size_t)bin.theta_d;
    const size_t cell = place * (size_t)t->phi_d_cells + (size_t)bin.phi_d / run;
    const float *coefficient = t->coefficient + cell * t->channels * terms;
    for (size_t c = 0; c < t->channels && weight > 0.0; c++, coefficient += terms) {
        if (!isnan(coefficient[0])) {
            e->sum[c] += weight * value_of(coefficient, terms, at, t->floor[c]);
            e->total[c] += weight;
        }
    }
}

/* The coordinates of a pair, phi_h included. */
typedef struct coordinates {
    gonio_half_difference at;
    double phi_h;
    double with_h; /* how much theta_h is away from its pole: 1 from the first centre on */
    double with_d; /* the same of theta_d */
} coordinates;

static coordinates coordinates_of(gonio_pair pair)
{
    const gonio_angles *i = &pair.incident;
    const gonio_angles *o = &pair.outgoing;
    const double x = sin(i->theta) * cos(i->phi) + sin(o->theta) * cos(o->phi);
    const double y = sin(i->theta) * sin(i->phi) + sin(o->theta) * sin(o->phi);
    const gonio_half_difference first = gonio_bin_centre((gonio_bin){0, 0, 0});
    coordinates c = {.at = gonio_half_difference_from_pair(pair)};
    c.phi_h = hypot(x, y) > 0.0 ? atan2(y, x) : 0.0;
    c.with_h = fmin(c.at.theta_h / first.theta_h, 1.0);
    c.with_d = fmin(c.at.theta_d / first.theta_d, 1.0);
    return c;
}

/* Adds a point of the means that stand in at the poles. */
static void add_pole_point(const evaluation *e, const coordinates *c, const gonio_i_stencil *point,
                           int sector)
{
    const double of_d = c->with_h * (1.0 - c->with_d);
    const double of_h = (1.0 - c->with_h) * c->with_d;
    const double of_both = (1.0 - c->with_h) * (1.0 - c->with_d);
    const double whole = point->weight / (of_d + of_h + of_both);
    const double psi = c->phi_h + c->at.phi_d - gonio_bin_centre(point->bin).phi_d;
    series at = {0};
    set_terms(e->table, c->phi_h, &at);
    add_cell(e, point->bin, &at, whole * of_d);
    set_terms(e->table, psi, &at);
    add_cell(e, point->bin, &at, 0.5 * whole * of_h);
    set_terms(e->table, psi + M_PI, &at);
    add_cell(e, point->bin, &at, 0.5 * whole * of_h);
    set_terms(e->table, 5.0 * sector * 2.0 * M_PI / GONIO_SECTORS, &at);
    add_cell(e, point->bin, &at, whole * of_both);
}

static void evaluate_pair(const evaluation *e, gonio_pair pair, double *values)
{
    const gonio_anisotropic_table *t = e->table;
    const coordinates c = coordinates_of(pair);
    gonio_i_stencil stencil[GONIO_I_MOST_POINTS];
    const int points = gonio_i_trilinear_runs(c.at, GONIO_PHI_D_BINS / t->phi_d_cells, stencil);
    series at = {0};
    memset(e->sum, 0, t->channels * sizeof *e->sum);
    memset(e->total, 0, t->channels * sizeof *e->total);
    set_terms(t, c.phi_h, &at);
    for (int k = 0; k < GONIO_I_TRILINEAR; k++) {
        add_cell(e, stencil[k].bin, &at, stencil[k].weight);
    }
    for (int k = GONIO_I_TRILINEAR; k < points; k++) {
        add_pole_point(e, &c, &stencil[k], (k - GONIO_I_TRILINEAR) % GONIO_SECTORS);
    }
    for (size_t k = 0; k < t->channels; k++) {
        values[k] = e->total[k] > 0.0 ? e->sum[k] / e->total[k] : NAN;
    }
}

/* ---- means over phi_h ---- */

enum { PERIOD_AZIMUTHS = 32, TURN_AZIMUTHS = 64 };

/* Means of the cells of one theta_h and theta_d: cell[phi_d_cells][channels]. */
static void average_cells(const gonio_anisotropic_table *t, const float *coefficient, double *cell)
{
    const size_t azimuths = t->orders == 0 ? 1 : t->symmetry > 1 ? PERIOD_AZIMUTHS : TURN_AZIMUTHS;
    const size_t numbers = (size_t)t->phi_d_cells * t->channels;
    memset(cell, 0, numbers * sizeof *cell);
    for (size_t n = 0; n < azimuths; n++) {
        series at = {0};
        set_terms(t, 2.0 * M_PI * (double)n / (double)(azimuths * (size_t)t->symmetry), &at);
        for (size_t k = 0; k < numbers; k++) {
            const float *here = coefficient + k * terms_of(t);
            const double floor = t->floor[k % t->channels];
            cell[k] += isnan(here[0]) ? NAN : value_of(here, terms_of(t), &at, floor);
        }
    }
    for (size_t k = 0; k < numbers; k++) {
        cell[k] /= (double)azimuths;
    }
}

/* A bin between the middles of two cells. */
static double mean_between(double first, double second, double share)
{
    return isnan(first)                    ? (share > 0.0 ? second : NAN)
           : isnan(second) || share <= 0.0 ? first
                                           : first + share * (second - first);
}

gonio_status gonio_i_anisotropic_means(gonio_context *context, const gonio_anisotropic_table *t,
                                       int theta_h, int theta_d, double *mean)
{
    const size_t cells = (size_t)t->phi_d_cells;
    const size_t place = (size_t)theta_h * GONIO_THETA_D_BINS + (size_t)theta_d;
    double *cell = gonio_i_allocate(context, cells * t->channels, sizeof *cell);
    if (cell == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    average_cells(t, t->coefficient + place * cells * t->channels * terms_of(t), cell);
    for (size_t k = 0; k < GONIO_PHI_D_BINS * t->channels; k++) {
        const size_t c = k % t->channels;
        const size_t phi_d = k / t->channels;
        const double at =
            ((double)phi_d + 0.5) * (double)cells / GONIO_PHI_D_BINS - 0.5 + (double)cells;
        const size_t before = (size_t)at;
        mean[k] = mean_between(cell[before % cells * t->channels + c],
                               cell[(before + 1) % cells * t->channels + c], at - (double)before);
    }
    free(cell);
    return GONIO_OK;
}

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    enum { FEW = 8 };
    const gonio_anisotropic_table *t = self;
    double room[2 * FEW];
    double *sums =
        t->channels <= FEW ? room : gonio_i_allocate(context, 2 * t->channels, sizeof *sums);
    if (sums == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const evaluation e = {t, sums, sums + t->channels};
    for (size_t k = 0; k < count; k++) {
        evaluate_pair(&e, pairs[k], values + k * t->channels);
    }
    if (sums != room) {
        free(sums);
    }
    return GONIO_OK;
}

const gonio_anisotropic_table *gonio_i_anisotropic_of_source(const gonio_material_source *source)
{
    return source->evaluate == evaluate ? source->self : NULL;
}

const gonio_anisotropic_table *gonio_i_anisotropic_of(const gonio_material *material)
{
    return gonio_i_anisotropic_of_source(&material->source);
}

/* ---- as a material ---- */

static void release(void *self)
{
    gonio_i_anisotropic_clear(self);
    free(self);
}

gonio_status gonio_i_anisotropic_source(gonio_context *context, gonio_anisotropic_table *table,
                                        gonio_material_source *source)
{
    const gonio_status status = gonio_i_anisotropic_check(context, table);
    gonio_anisotropic_table *self =
        status == GONIO_OK ? gonio_i_allocate(context, 1, sizeof *self) : NULL;
    if (self == NULL) {
        return status == GONIO_OK ? GONIO_ERROR_MEMORY : status;
    }
    *self = *table;
    *source = (gonio_material_source){.size = sizeof *source,
                                      .evaluate = evaluate,
                                      .release = release,
                                      .self = self,
                                      .channels = self->channels,
                                      .wavelength = self->wavelength,
                                      .anisotropic = self->orders > 0,
                                      .theta_limit = self->theta_limit};
    return GONIO_OK;
}

static void *copy(gonio_context *context, const void *from, size_t count, size_t size)
{
    void *made = from != NULL ? gonio_i_allocate(context, count, size) : NULL;
    return made != NULL ? memcpy(made, from, count * size) : NULL;
}

gonio_status gonio_anisotropic_material(gonio_context *context, const char *name,
                                        const char *format, const gonio_anisotropic_table *table,
                                        gonio_material **material)
{
    gonio_anisotropic_table own;
    gonio_material_source source = {0};
    gonio_status status = GONIO_I_TAKE_PLAIN(context, gonio_anisotropic_table, table, &own);
    if (status == GONIO_OK) {
        status = gonio_i_anisotropic_check(context, &own);
    }
    if (status != GONIO_OK) {
        return status;
    }
    own.wavelength = copy(context, table->wavelength, own.channels, sizeof *own.wavelength);
    own.floor = copy(context, table->floor, own.channels, sizeof *own.floor);
    own.coefficient =
        copy(context, table->coefficient, gonio_i_anisotropic_count(&own), sizeof *own.coefficient);
    if (own.floor == NULL || own.coefficient == NULL ||
        (own.wavelength == NULL && table->wavelength != NULL)) {
        gonio_i_anisotropic_clear(&own);
        return GONIO_ERROR_MEMORY;
    }
    status = gonio_i_anisotropic_source(context, &own, &source);
    if (status != GONIO_OK) {
        gonio_i_anisotropic_clear(&own);
        return status;
    }
    status = gonio_material_create(context, name, format, &source, material);
    if (status != GONIO_OK) {
        release(source.self);
    }
    return status;
}
