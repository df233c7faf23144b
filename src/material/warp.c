/* Warps of the unit square: see warp.h. */
#include "warp.h"

#include <math.h>
#include <stdlib.h>

#include "../core/core.h"

gonio_i_step gonio_i_step_among(const double *node, size_t count, double at)
{
    size_t low = 0;
    size_t high = count - 1;
    if (count < 2) {
        return (gonio_i_step){0, 0.0};
    }
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (node[middle] <= at) {
            low = middle;
        } else {
            high = middle;
        }
    }
    const double length = node[high] - node[low];
    const double share = length > 0.0 ? (at - node[low]) / length : 0.0;
    return (gonio_i_step){low, fmin(fmax(share, 0.0), 1.0)};
}

gonio_i_step gonio_i_step_evenly(size_t count, double at)
{
    const double place = fmin(fmax(at, 0.0), 1.0) * (double)(count - 1);
    const size_t before = (size_t)place < count - 2 ? (size_t)place : count - 2;
    return (gonio_i_step){before, place - (double)before};
}

/* ---- making one ---- */

/* The integral along a row up to each node, by the trapezoidal rule with cells of unit length.
 * Returns the integral of the whole row. */
static double integrate_row(const double *density, size_t width, double *row)
{
    row[0] = 0.0;
    for (size_t x = 1; x < width; x++) {
        row[x] = row[x - 1] + 0.5 * (density[x - 1] + density[x]);
    }
    return row[width - 1];
}

static double integrate_slice(const gonio_i_warp *w, double *density, double *row, double *column)
{
    double before = integrate_row(density, w->width, row);
    column[0] = 0.0;
    for (size_t y = 1; y < w->height; y++) {
        const double here = integrate_row(density + y * w->width, w->width, row + y * w->width);
        column[y] = column[y - 1] + 0.5 * (before + here);
        before = here;
    }
    return column[w->height - 1];
}

static void scale(double *values, size_t count, double factor)
{
    for (size_t k = 0; k < count; k++) {
        values[k] *= factor;
    }
}

static void fill_slice(gonio_i_warp *w, const float *values, size_t slice)
{
    const size_t nodes = w->width * w->height;
    double *density = w->density + slice * nodes;
    double *row = w->row + slice * nodes;
    double *column = w->column + slice * w->height;
    for (size_t k = 0; k < nodes; k++) {
        density[k] = isfinite(values[k]) ? fmax((double)values[k], 0.0) : 0.0;
    }
    double all = integrate_slice(w, density, row, column);
    if (!(all > 0.0)) {
        for (size_t k = 0; k < nodes; k++) {
            density[k] = 1.0;
        }
        all = integrate_slice(w, density, row, column);
    }
    scale(density, nodes, 1.0 / all);
    scale(row, nodes, 1.0 / all);
    scale(column, w->height, 1.0 / all);
}

gonio_status gonio_i_warp_create(gonio_context *context, const float *values, size_t slices,
                                 size_t height, size_t width, gonio_i_warp *warp)
{
    const size_t nodes = width * height;
    *warp = (gonio_i_warp){.width = width, .height = height, .slices = slices};
    warp->density = gonio_i_allocate(context, slices * nodes, sizeof *warp->density);
    warp->row = gonio_i_allocate(context, slices * nodes, sizeof *warp->row);
    warp->column = gonio_i_allocate(context, slices * height, sizeof *warp->column);
    if (warp->density == NULL || warp->row == NULL || warp->column == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < slices; k++) {
        fill_slice(warp, values + k * nodes, k);
    }
    return GONIO_OK;
}

void gonio_i_warp_free(gonio_i_warp *warp)
{
    free(warp->density);
    free(warp->row);
    free(warp->column);
    *warp = (gonio_i_warp){0};
}

/* ---- using it ---- */

/* A node's value in the mixture of slices. */
static double blended(const double *values, size_t nodes, const gonio_i_blend *blend, size_t node)
{
    double sum = 0.0;
    for (int k = 0; k < blend->count; k++) {
        sum += blend->weight[k] * values[blend->slice[k] * nodes + node];
    }
    return sum;
}

/* The cell that holds a point: densities at its corners and integrals up to it. */
typedef struct cell {
    double density[2][2]; /* [y][x] */
    double row[2];        /* along either row up to the cell */
    double total[2];      /* along either whole row */
} cell;

static double mix(double from, double to, double share)
{
    return (1.0 - share) * from + share * to;
}

/* The integral up to `share` of a function that is linear from `from` to `to` over a cell. */
static double partial(double from, double to, double share)
{
    return share * (from + 0.5 * share * (to - from));
}

/* The share at which that integral is `area`: the root of a quadratic, in the form without
 * cancellation. */
static double where_partial(double from, double to, double area)
{
    const double root = sqrt(fmax(from * from + 2.0 * area * (to - from), 0.0));
    const double below = from + root;
    return below > 0.0 ? fmin(fmax(2.0 * area / below, 0.0), 1.0) : 0.0;
}

static void fetch_rows(const gonio_i_warp *w, const gonio_i_blend *blend, size_t y, double total[2])
{
    const size_t nodes = w->width * w->height;
    for (size_t k = 0; k < 2; k++) {
        total[k] = blended(w->row, nodes, blend, (y + k + 1) * w->width - 1);
    }
}

static void fetch_cell(const gonio_i_warp *w, const gonio_i_blend *blend, size_t x, size_t y,
                       cell *c)
{
    const size_t nodes = w->width * w->height;
    for (size_t k = 0; k < 2; k++) {
        const size_t node = (y + k) * w->width + x;
        c->density[k][0] = blended(w->density, nodes, blend, node);
        c->density[k][1] = blended(w->density, nodes, blend, node + 1);
        c->row[k] = blended(w->row, nodes, blend, node);
    }
}

/* The density over the unit square: slices are scaled for cells of unit length. */
static double density_at(const gonio_i_warp *w, const cell *c, double in_x, double in_y)
{
    const double before = mix(c->density[0][0], c->density[1][0], in_y);
    const double after = mix(c->density[0][1], c->density[1][1], in_y);
    return mix(before, after, in_x) * (double)(w->width - 1) * (double)(w->height - 1);
}

double gonio_i_warp_invert(const gonio_i_warp *w, const gonio_i_blend *blend, const double u[2],
                           double s[2])
{
    const gonio_i_step x = gonio_i_step_evenly(w->width, u[0]);
    const gonio_i_step y = gonio_i_step_evenly(w->height, u[1]);
    cell c;
    fetch_cell(w, blend, x.before, y.before, &c);
    fetch_rows(w, blend, y.before, c.total);
    const double before = mix(c.density[0][0], c.density[1][0], y.share);
    const double after = mix(c.density[0][1], c.density[1][1], y.share);
    const double along = partial(before, after, x.share) + mix(c.row[0], c.row[1], y.share);
    const double total = mix(c.total[0], c.total[1], y.share);
    s[0] = total > 0.0 ? along / total : u[0];
    s[1] =
        partial(c.total[0], c.total[1], y.share) + blended(w->column, w->height, blend, y.before);
    return density_at(w, &c, x.share, y.share);
}

/* The last of count nodes before which less than `area` lies, but not the very last. */
static size_t find_row(const gonio_i_warp *w, const gonio_i_blend *blend, double area)
{
    size_t low = 0;
    size_t high = w->height - 1;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (blended(w->column, w->height, blend, middle) <= area) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static size_t find_column(const gonio_i_warp *w, const gonio_i_blend *blend, size_t y, double in_y,
                          double area)
{
    const size_t nodes = w->width * w->height;
    size_t low = 0;
    size_t high = w->width - 1;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        const double before = mix(blended(w->row, nodes, blend, y * w->width + middle),
                                  blended(w->row, nodes, blend, (y + 1) * w->width + middle), in_y);
        if (before <= area) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

double gonio_i_warp_sample(const gonio_i_warp *w, const gonio_i_blend *blend, const double s[2],
                           double u[2])
{
    const size_t y = find_row(w, blend, s[1]);
    cell c;
    fetch_rows(w, blend, y, c.total);
    const double in_y =
        where_partial(c.total[0], c.total[1], s[1] - blended(w->column, w->height, blend, y));
    const double area = s[0] * mix(c.total[0], c.total[1], in_y);
    const size_t x = find_column(w, blend, y, in_y, area);
    fetch_cell(w, blend, x, y, &c);
    const double in_x = where_partial(mix(c.density[0][0], c.density[1][0], in_y),
                                      mix(c.density[0][1], c.density[1][1], in_y),
                                      area - mix(c.row[0], c.row[1], in_y));
    u[0] = ((double)x + in_x) / (double)(w->width - 1);
    u[1] = ((double)y + in_y) / (double)(w->height - 1);
    return density_at(w, &c, in_x, in_y);
}
