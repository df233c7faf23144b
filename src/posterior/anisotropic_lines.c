/* The posterior mean along theta_h and phi_h: see anisotropic_lines.h.
 *
 * Under a hypothesis, with f and k where the stretch takes the half vector, the mean is
 *     m + f z + sum_i kappa_i (h^2 share f f_i' + alpha^2 k_i) (S^-1 (y - F z))_i,
 * with the part of the covariance that does not depend on azimuths in z already; values of facets
 * are multiplied by a factor of theta_h and phi_h. The stretch moves theta_h alone: m, f z and what
 * is in brackets are found at the centres of theta_h, and kappa_i depends on theta_h and phi_h
 * only, so that it is the same for all lines. That of fibres depends on sin theta_h cos theta_d and
 * phi_h, and has a factor of theta_d: it is looked up at another theta_h. */
#include "anisotropic_lines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"
#include "anisotropic_parts.h"

enum { THETAS = GONIO_THETA_H_BINS };

/* Columns that were read at the same directions, under one hypothesis. */
typedef struct group {
    const gonio_i_part *part;
    const gonio_i_sites *sites;
    size_t first; /* column */
    size_t count;
    double *solved;   /* [count][n] */
    double *linear;   /* [count][K] */
    double *kernel;   /* [THETAS][nodes][n]: kappa; of fibres, where theta_d is 0 */
    double *factor;   /* [THETAS][nodes]: ln of that of the values */
    double *position; /* [THETAS][nodes]: where the stretch takes theta_h, in its bins */
} group;

struct gonio_i_anisotropic_lines {
    const gonio_i_anisotropic *estimate;
    size_t nodes;
    double period;
    size_t groups;
    group *group;
};

/* ---- symmetry ---- */

static int symmetry_of(const gonio_i_stretch *s)
{
    const int turns = s->log_ratio != 0.0 && !s->fibres ? 2 : 0; /* an ellipse */
    return s->symmetry == 0 || (turns != 0 && turns < s->symmetry) ? turns : s->symmetry;
}

int gonio_i_anisotropic_symmetry(const gonio_i_anisotropic *a)
{
    int least = 0;
    for (size_t p = 0; p < a->parts; p++) {
        const int turns = symmetry_of(&a->part[p].hypothesis.stretch);
        least = least == 0 || (turns != 0 && turns < least) ? turns : least;
    }
    return least;
}

/* ---- preparation ---- */

/* In the bins of theta_h. */
static double position_of(double theta_h)
{
    const double bins = THETAS * sqrt(theta_h / (0.5 * M_PI)) - 0.5;
    return fmin(fmax(bins, 0.0), THETAS - 1);
}

static void place_node(const gonio_i_anisotropic_lines *l, const group *g, size_t theta,
                       size_t node)
{
    const gonio_i_stretch *stretch = &g->part->hypothesis.stretch;
    const size_t at = theta * l->nodes + node;
    const gonio_half_difference centre = gonio_bin_centre((gonio_bin){(int32_t)theta, 0, 0});
    const gonio_i_oriented here = {centre, l->period * (double)node / (double)l->nodes};
    const gonio_half_difference there = gonio_i_stretch_apply(stretch, here);
    const gonio_i_azimuth_point azimuth = gonio_i_azimuth_of(stretch, here);
    g->position[at] = position_of(there.theta_h);
    g->factor[at] = gonio_i_stretch_log_factor(stretch, here);
    for (size_t i = 0; i < g->sites->n; i++) {
        gonio_i_azimuth_point read = g->part->azimuth[g->first][i];
        read.depth = azimuth.depth; /* depth_of */
        g->kernel[at * g->sites->n + i] = gonio_i_azimuth_kernel(azimuth, read);
    }
}

static gonio_status make_group(gonio_context *context, const gonio_i_anisotropic_lines *l, group *g)
{
    const size_t n = g->sites->n;
    const size_t components = g->sites->components;
    g->solved = gonio_i_allocate(context, g->count * n, sizeof *g->solved);
    g->linear = gonio_i_allocate(context, g->count * components, sizeof *g->linear);
    g->kernel = gonio_i_allocate(context, THETAS * l->nodes * n, sizeof *g->kernel);
    g->position = gonio_i_allocate(context, THETAS * l->nodes, sizeof *g->position);
    g->factor = gonio_i_allocate(context, THETAS * l->nodes, sizeof *g->factor);
    if (g->solved == NULL || g->linear == NULL || g->kernel == NULL || g->position == NULL ||
        g->factor == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t c = 0; c < g->count; c++) {
        const gonio_i_solution *s = &g->part->solution[g->first + c];
        memcpy(g->solved + c * n, s->fit.solved, n * sizeof *g->solved);
        memcpy(g->linear + c * components, s->linear, components * sizeof *g->linear);
    }
    for (size_t at = 0; at < THETAS * l->nodes; at++) {
        place_node(l, g, at / l->nodes, at % l->nodes);
    }
    return GONIO_OK;
}

/* Columns from `first` on that have its sites. */
static size_t count_alike(const gonio_i_part *p, size_t columns, size_t first)
{
    size_t count = 1;
    while (first + count < columns && p->sites[first + count] == p->sites[first]) {
        count++;
    }
    return count;
}

static gonio_status make_groups(gonio_context *context, gonio_i_anisotropic_lines *l)
{
    const gonio_i_anisotropic *a = l->estimate;
    gonio_status status = GONIO_OK;
    for (size_t p = 0; p < a->parts; p++) {
        const gonio_i_part *part = &a->part[p];
        for (size_t c = 0; c < a->columns && status == GONIO_OK;) {
            group *g = &l->group[l->groups++];
            *g = (group){.part = part,
                         .sites = part->sites[c],
                         .first = c,
                         .count = count_alike(part, a->columns, c)};
            c += g->count;
            status = make_group(context, l, g);
        }
    }
    return status;
}

gonio_status gonio_i_anisotropic_lines_create(gonio_context *context,
                                              const gonio_i_anisotropic *estimate, size_t nodes,
                                              double period, gonio_i_anisotropic_lines **lines)
{
    gonio_i_anisotropic_lines *l = gonio_i_allocate(context, 1, sizeof *l);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (l != NULL) {
        *l = (gonio_i_anisotropic_lines){.estimate = estimate, .nodes = nodes, .period = period};
        l->group = gonio_i_allocate(context, estimate->parts * estimate->columns, sizeof *l->group);
        status = l->group != NULL ? make_groups(context, l) : GONIO_ERROR_MEMORY;
    }
    if (status != GONIO_OK) {
        gonio_i_anisotropic_lines_free(&l);
    }
    *lines = l;
    return status;
}

void gonio_i_anisotropic_lines_free(gonio_i_anisotropic_lines **lines)
{
    if (lines == NULL || *lines == NULL) {
        return;
    }
    for (size_t k = 0; k < (*lines)->groups; k++) {
        group *g = &(*lines)->group[k];
        free(g->solved);
        free(g->linear);
        free(g->kernel);
        free(g->position);
        free(g->factor);
    }
    free((*lines)->group);
    free(*lines);
    *lines = NULL;
}

/* ---- a line ---- */

/* What a line is made from; the arrays are scratch. */
typedef struct line {
    gonio_context *context;
    const gonio_i_anisotropic_lines *lines;
    double theta_d;
    gonio_i_place place[THETAS];
    double *mean;   /* [THETAS]: m */
    double *f;      /* [THETAS][K] */
    double *common; /* [THETAS][columns]: m + f z */
    double *seen;   /* [THETAS][most]: what is in brackets */
    double *w;      /* [nodes][most]: the same at nodes, times kappa */
    double *moved;  /* [nodes][columns] */
} line;

static gonio_status allocate(line *x)
{
    const gonio_i_anisotropic *a = x->lines->estimate;
    const size_t nodes = x->lines->nodes;
    x->mean = gonio_i_allocate(x->context, THETAS, sizeof *x->mean);
    x->f = gonio_i_allocate(x->context, THETAS * a->prior->components, sizeof *x->f);
    x->common = gonio_i_allocate(x->context, THETAS * a->columns, sizeof *x->common);
    x->seen = gonio_i_allocate(x->context, THETAS * a->most, sizeof *x->seen);
    x->w = gonio_i_allocate(x->context, nodes * a->most, sizeof *x->w);
    x->moved = gonio_i_allocate(x->context, nodes * a->columns, sizeof *x->moved);
    return x->mean != NULL && x->f != NULL && x->common != NULL && x->seen != NULL &&
                   x->w != NULL && x->moved != NULL
               ? GONIO_OK
               : GONIO_ERROR_MEMORY;
}

static void release(line *x)
{
    free(x->mean);
    free(x->f);
    free(x->common);
    free(x->seen);
    free(x->w);
    free(x->moved);
}

static void see_prior(line *x, double theta_d, double phi_d)
{
    const gonio_i_prior *prior = x->lines->estimate->prior;
    for (int t = 0; t < THETAS; t++) {
        const double theta_h = gonio_bin_centre((gonio_bin){t, 0, 0}).theta_h;
        const gonio_half_difference at = {theta_h, theta_d, phi_d};
        x->place[t] = gonio_i_place_of(at);
        gonio_i_prior_at(prior, at, 0, &x->mean[t], x->f + (size_t)t * prior->components);
    }
}

/* What kappa of fibres is multiplied by for the theta_d of a line and a reading. */
static double depth_of(const line *x, const group *g, size_t reading)
{
    const gonio_i_oriented here = {{0.0, x->theta_d, 0.0}, 0.0};
    const gonio_i_azimuth_point a = gonio_i_azimuth_of(&g->part->hypothesis.stretch, here);
    const gonio_i_azimuth_point b = {a.x, a.y, g->part->azimuth[g->first][reading].depth};
    return gonio_i_azimuth_kernel(a, b);
}

/* m + f z and the brackets of a group. */
static gonio_status see_group(line *x, const group *g)
{
    const gonio_i_sites *sites = g->sites;
    const gonio_i_model *m = &g->part->hypothesis.model;
    const gonio_i_stretch *stretch = &g->part->hypothesis.stretch;
    const double turning = m->h * m->h * stretch->share;
    const double rest = m->alpha * m->alpha;
    gonio_status status = gonio_i_product_transposed(x->context, x->f, THETAS, sites->components,
                                                     g->linear, g->count, x->common, g->count);
    if (status == GONIO_OK && turning > 0.0) {
        status = gonio_i_product_transposed(x->context, x->f, THETAS, sites->components, sites->f,
                                            sites->n, x->seen, sites->n);
    }
    for (size_t k = 0; k < THETAS * g->count && status == GONIO_OK; k++) {
        x->common[k] += x->mean[k / g->count];
    }
    for (size_t k = 0; k < THETAS * sites->n && status == GONIO_OK; k++) {
        const gonio_i_place *here = &x->place[k / sites->n];
        const gonio_i_place *there = &sites->place[k % sites->n];
        x->seen[k] = turning > 0.0 ? turning * x->seen[k] : 0.0;
        x->seen[k] +=
            rest > 0.0 ? rest * gonio_i_stretch_remainder(stretch, here, there, m->peak, m->retro)
                       : 0.0;
        x->seen[k] *= stretch->fibres ? depth_of(x, g, k % sites->n) : 1.0;
    }
    return status;
}

/* The lines before and after a position, and the share of the second. */
typedef struct between {
    size_t before;
    size_t after;
    double share;
} between;

static between between_of(double position)
{
    const size_t before = (size_t)position;
    return (between){before, before + 1 < THETAS ? before + 1 : before, position - (double)before};
}

/* Where kappa of a theta_h is looked up. */
static between find_kernel(const line *x, const group *g, size_t theta)
{
    const double theta_h = gonio_bin_centre((gonio_bin){(int32_t)theta, 0, 0}).theta_h;
    return g->part->hypothesis.stretch.fibres
               ? between_of(position_of(asin(sin(theta_h) * cos(x->theta_d))))
               : (between){theta, theta, 0.0};
}

static void weigh_node(const line *x, const group *g, size_t theta, size_t node, double *restrict w)
{
    const size_t n = g->sites->n;
    const size_t nodes = x->lines->nodes;
    const between b = between_of(g->position[theta * nodes + node]);
    const between k = find_kernel(x, g, theta);
    const double *restrict first = x->seen + b.before * n;
    const double *restrict second = x->seen + b.after * n;
    const double *restrict kernel = g->kernel + (k.before * nodes + node) * n;
    const double *restrict next = g->kernel + (k.after * nodes + node) * n;
    for (size_t i = 0; i < n; i++) {
        w[i] = (kernel[i] + k.share * (next[i] - kernel[i])) *
               (first[i] + b.share * (second[i] - first[i]));
    }
}

/* Adds a group at a theta_h to g[nodes][columns]. */
static gonio_status add_group(const line *x, const group *g, size_t theta, double *sum)
{
    const size_t nodes = x->lines->nodes;
    const size_t columns = x->lines->estimate->columns;
    const size_t n = g->sites->n;
    const double weight = g->part->hypothesis.weight;
    for (size_t k = 0; k < nodes; k++) {
        weigh_node(x, g, theta, k, x->w + k * n);
    }
    const gonio_status status = gonio_i_product_transposed(x->context, x->w, nodes, n, g->solved,
                                                           g->count, x->moved, g->count);
    for (size_t k = 0; k < nodes && status == GONIO_OK; k++) {
        const between b = between_of(g->position[theta * nodes + k]);
        const double *first = x->common + b.before * g->count;
        const double *second = x->common + b.after * g->count;
        const double factor = g->factor[theta * nodes + k];
        for (size_t c = 0; c < g->count; c++) {
            double slope = 1.0;
            const double mean =
                first[c] + b.share * (second[c] - first[c]) + x->moved[k * g->count + c];
            sum[k * columns + g->first + c] += weight * gonio_i_multiplied(mean, factor, &slope);
        }
    }
    return status;
}

static gonio_status add_groups(line *x, double *g)
{
    const gonio_i_anisotropic_lines *l = x->lines;
    const size_t numbers = l->nodes * l->estimate->columns;
    gonio_status status = GONIO_OK;
    memset(g, 0, THETAS * numbers * sizeof *g);
    for (size_t k = 0; k < l->groups && status == GONIO_OK; k++) {
        status = see_group(x, &l->group[k]);
        for (size_t t = 0; t < THETAS && status == GONIO_OK; t++) {
            status = add_group(x, &l->group[k], t, g + t * numbers);
        }
    }
    return status;
}

gonio_status gonio_i_anisotropic_line(gonio_context *context,
                                      const gonio_i_anisotropic_lines *lines, double theta_d,
                                      double phi_d, double *g)
{
    line x = {.context = context, .lines = lines, .theta_d = theta_d};
    gonio_status status = allocate(&x);
    if (status == GONIO_OK) {
        see_prior(&x, theta_d, phi_d);
        status = add_groups(&x, g);
    }
    release(&x);
    return status;
}
