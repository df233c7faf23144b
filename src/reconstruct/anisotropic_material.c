/* An anisotropic reconstruction as a material: its mean in an anisotropic table. */
#include <math.h>
#include <stdlib.h>

#include "../material/anisotropic_table.h"
#include "../material/azimuth_series.h"
#include "../posterior/anisotropic_lines.h"
#include "../posterior/parallel_for.h"
#include "anisotropic.h"
#include "field.h"

enum {
    PHI_D_CELLS = 36,
    CELLS_OF_SECTOR = PHI_D_CELLS / GONIO_SECTORS,
    NODES = 16,      /* azimuths of a period of half a turn or less */
    WHOLE_NODES = 32 /* and of a whole turn */
};

static const double MOST_BYTES = 5.4e8; /* of a table, as in anisotropic_fit.c */

/* A table while it is filled. */
typedef struct filling {
    const gonio_i_anisotropic_lines *lines;
    gonio_anisotropic_table table;
    gonio_i_circle circle;
    const double *scale; /* [channels] */
    size_t terms;        /* of a series */
    float *coefficient;
} filling;

/* ---- lines to cells ---- */

static double *series_at(const filling *f, double *line, int sector, int theta_h)
{
    const size_t numbers = f->table.channels * f->terms;
    const int place = (sector + GONIO_SECTORS) % GONIO_SECTORS * GONIO_THETA_H_BINS + theta_h;
    return line + (size_t)place * numbers;
}

/* The series of one sector at all theta_h: to[theta_h][channels][terms]. g: scratch. */
static gonio_status fill_sector(const filling *f, gonio_context *context, int theta_d, int sector,
                                double *g, double *to)
{
    const size_t channels = f->table.channels;
    const size_t nodes = f->circle.nodes;
    const gonio_half_difference centre = gonio_bin_centre((gonio_bin){0, theta_d, 0});
    const gonio_status status = gonio_i_anisotropic_line(context, f->lines, centre.theta_d,
                                                         (sector + 0.5) * M_PI / GONIO_SECTORS, g);
    for (size_t k = 0; k < GONIO_THETA_H_BINS * channels && status == GONIO_OK; k++) {
        const size_t c = k % channels;
        double v[GONIO_I_MOST_AZIMUTHS];
        for (size_t n = 0; n < nodes; n++) {
            v[n] = log(f->scale[c]) +
                   fmin(g[(k / channels * nodes + n) * channels + c], GONIO_I_LARGEST_LOG);
        }
        gonio_i_circle_series(&f->circle, v, f->table.orders, to + k * f->terms);
    }
    return status;
}

/* A cell lies between the middles of two sectors, between which g is linear. */
static void fill_cell(const filling *f, double *line, int theta_h, int theta_d, int phi)
{
    const size_t numbers = f->table.channels * f->terms;
    const double place = (phi + 0.5) / CELLS_OF_SECTOR - 0.5;
    const int before = (int)floor(place);
    const double share = place - before;
    const double *first = series_at(f, line, before, theta_h);
    const double *second = series_at(f, line, before + 1, theta_h);
    const size_t cell = ((size_t)theta_h * GONIO_THETA_D_BINS + (size_t)theta_d) * PHI_D_CELLS;
    const bool data = gonio_i_first_valid_phi(theta_h, theta_d) < GONIO_PHI_D_BINS / 2;
    float *to = f->coefficient + (cell + (size_t)phi) * numbers;
    for (size_t k = 0; k < numbers; k++) {
        to[k] = data ? (float)(first[k] + share * (second[k] - first[k])) : NAN;
    }
}

static gonio_status fill_theta_d(void *data, gonio_context *context, size_t theta_d)
{
    const filling *f = data;
    const size_t series = GONIO_THETA_H_BINS * f->table.channels * f->terms;
    const size_t values = GONIO_THETA_H_BINS * f->table.channels * f->circle.nodes;
    double *line = gonio_i_allocate(context, GONIO_SECTORS * series, sizeof *line);
    double *g = gonio_i_allocate(context, values, sizeof *g);
    gonio_status status = line != NULL && g != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (int s = 0; s < GONIO_SECTORS && status == GONIO_OK; s++) {
        status = fill_sector(f, context, (int)theta_d, s, g, line + (size_t)s * series);
    }
    for (int k = 0; k < GONIO_THETA_H_BINS * PHI_D_CELLS && status == GONIO_OK; k++) {
        fill_cell(f, line, k / PHI_D_CELLS, (int)theta_d, k % PHI_D_CELLS);
    }
    free(line);
    free(g);
    return status;
}

/* ---- the table ---- */

/* Chooses the nodes, and as many orders as they tell and there is room for. */
static size_t choose_orders(gonio_anisotropic_table *t, int symmetry)
{
    const size_t nodes = symmetry == 0 ? 1 : symmetry == 1 ? WHOLE_NODES : NODES;
    t->symmetry = symmetry > 0 ? symmetry : 1;
    t->orders = nodes > 1 ? (int)nodes / 2 - 1 : 0;
    while (t->orders > 1 &&
           (double)gonio_i_anisotropic_count(t) * (double)sizeof(float) > MOST_BYTES) {
        t->orders--;
    }
    return nodes;
}

static gonio_status make_arrays(gonio_context *context,
                                const gonio_anisotropic_reconstruction_view *view, filling *f)
{
    gonio_anisotropic_table *t = &f->table;
    double *floor = gonio_i_allocate(context, t->channels, sizeof *floor);
    double *wavelength = view->wavelength != NULL
                             ? gonio_i_allocate(context, t->channels, sizeof *wavelength)
                             : NULL;
    t->floor = floor;
    t->wavelength = wavelength;
    if (floor == NULL || (wavelength == NULL && view->wavelength != NULL)) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t c = 0; c < t->channels; c++) {
        floor[c] = f->scale[c];
        if (wavelength != NULL) {
            wavelength[c] = view->wavelength[c];
        }
    }
    if (!gonio_i_anisotropic_fits(t)) {
        return gonio_i_anisotropic_check(context, t);
    }
    f->coefficient =
        gonio_i_allocate(context, gonio_i_anisotropic_count(t), sizeof *f->coefficient);
    t->coefficient = f->coefficient;
    return f->coefficient != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status fill(gonio_context *context, const gonio_i_anisotropic *estimate, filling *f)
{
    gonio_i_steps steps = {.task = "completing", .all = GONIO_THETA_D_BINS};
    gonio_i_anisotropic_lines *lines = NULL;
    gonio_status status = gonio_i_anisotropic_lines_create(context, estimate, f->circle.nodes,
                                                           2.0 * M_PI / f->table.symmetry, &lines);
    f->lines = lines;
    if (status == GONIO_OK) {
        status = gonio_i_parallel_for(context, &steps, GONIO_THETA_D_BINS, fill_theta_d, f);
    }
    gonio_i_anisotropic_lines_free(&lines);
    return status;
}

static gonio_status make_material(gonio_context *context, const char *name,
                                  gonio_anisotropic_table *table, gonio_material **material)
{
    char *format = gonio_i_anisotropic_describe(table);
    gonio_material_source source;
    gonio_status status =
        format != NULL ? gonio_i_anisotropic_source(context, table, &source) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        *table = (gonio_anisotropic_table){0};
        status = gonio_material_create(context, name, format, &source, material);
        if (status != GONIO_OK) {
            source.release(source.self);
        }
    }
    free(format);
    return status;
}

gonio_status gonio_anisotropic_reconstruction_material(gonio_context *context,
                                                       const gonio_anisotropic_reconstruction *made,
                                                       const char *name, gonio_material **material)
{
    const gonio_anisotropic_reconstruction_view *view =
        gonio_anisotropic_reconstruction_describe(made);
    filling f = {
        .table = {.size = sizeof f.table, .channels = view->channels, .phi_d_cells = PHI_D_CELLS}};
    const gonio_i_anisotropic *estimate = gonio_i_anisotropic_estimate(made, &f.scale);
    f.circle = gonio_i_circle_of(choose_orders(&f.table, gonio_i_anisotropic_symmetry(estimate)));
    f.terms = 1 + 2 * (size_t)f.table.orders;
    gonio_status status = make_arrays(context, view, &f);
    if (status == GONIO_OK) {
        status = fill(context, estimate, &f);
    }
    if (status == GONIO_OK) {
        status = make_material(context, name, &f.table, material);
    }
    gonio_i_anisotropic_clear(&f.table);
    return status;
}
