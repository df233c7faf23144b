/* Columns of a spectrum that need no fit of their own: see neighbours.h. */
#include "neighbours.h"

#include <math.h>
#include <stdlib.h>

#include "../linalg/linalg.h"

/* So few columns are all fitted; and one of so many is, whatever the readings. */
enum { FEW_COLUMNS = 16, MOST_APART = 64 };

/* How far readings of a column may be off those between its neighbours, in standard deviations of a
 * reading: root mean square, and the largest. Noise that differs from one wavelength to the next is
 * less, unless it is larger than stated. */
static const double MOST_OFF = 0.5;
static const double LARGEST_OFF = 2.5;

typedef struct choice {
    const gonio_i_column *columns;
    const double *wavelength;
    const size_t *order; /* columns by wavelength */
    gonio_i_neighbours *neighbours;
} choice;

void gonio_i_neighbours_none(gonio_i_neighbours *neighbours, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        neighbours[k] = (gonio_i_neighbours){{k, k}, {1.0, 0.0}};
    }
}

bool gonio_i_is_fitted(const gonio_i_neighbours *neighbours, size_t column)
{
    return neighbours[column].fit[0] == column;
}

double gonio_i_neighbour_weight(const gonio_i_neighbours *neighbours, size_t fit, size_t column)
{
    const gonio_i_neighbours *n = &neighbours[column];
    return n->fit[0] == fit ? n->weight[0] : n->fit[1] == fit ? n->weight[1] : 0.0;
}

/* ---- choosing ---- */

/* One wavelength and its column, for sorting. */
typedef struct line {
    double wavelength;
    size_t column;
} line;

static int compare_lines(const void *a, const void *b)
{
    const line *x = a;
    const line *y = b;
    return x->wavelength != y->wavelength ? (x->wavelength > y->wavelength ? 1 : -1)
                                          : (x->column > y->column) - (x->column < y->column);
}

static gonio_status sort_by_wavelength(gonio_context *context, const double *wavelength,
                                       const size_t *member, size_t count, size_t *order)
{
    line *lines = gonio_i_allocate(context, count, sizeof *lines);
    if (lines == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < count; k++) {
        lines[k] = (line){wavelength[member[k]], member[k]};
    }
    qsort(lines, count, sizeof *lines, compare_lines);
    for (size_t k = 0; k < count; k++) {
        order[k] = lines[k].column;
    }
    free(lines);
    return GONIO_OK;
}

/* Between the fits of two columns. */
static gonio_i_neighbours between(const choice *c, size_t column, size_t low, size_t high)
{
    const double width = c->wavelength[high] - c->wavelength[low];
    const double at = width > 0.0 ? (c->wavelength[column] - c->wavelength[low]) / width : 0.5;
    return (gonio_i_neighbours){{low, high}, {1.0 - at, at}};
}

/* Whether a column's readings lie between those of its neighbours. */
static bool lies_between(const choice *c, size_t column, const gonio_i_neighbours *n)
{
    const gonio_i_observation *o = c->columns[column].observation;
    const gonio_i_observation *low = c->columns[n->fit[0]].observation;
    const gonio_i_observation *high = c->columns[n->fit[1]].observation;
    const size_t count = c->columns[column].count;
    double sum = 0.0;
    double largest = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (o[i].bound > 0 || low[i].bound > 0 || high[i].bound > 0) {
            return false; /* saturated */
        }
        const double off = o[i].g - n->weight[0] * low[i].g - n->weight[1] * high[i].g;
        const double square = off * off / o[i].variance;
        sum += square;
        largest = fmax(largest, square);
    }
    return sum <= MOST_OFF * MOST_OFF * (double)count && largest <= LARGEST_OFF * LARGEST_OFF;
}

/* Fits columns between two fitted ones, low and high in c->order, until the others lie between. */
static void choose_between(const choice *c, size_t low, size_t high)
{
    const size_t middle = low + (high - low) / 2;
    bool enough = high - low <= MOST_APART;
    for (size_t k = low + 1; k < high; k++) {
        const size_t column = c->order[k];
        const gonio_i_neighbours n = between(c, column, c->order[low], c->order[high]);
        enough = enough && lies_between(c, column, &n);
        c->neighbours[column] = n;
    }
    if (!enough) {
        const size_t column = c->order[middle];
        c->neighbours[column] = (gonio_i_neighbours){{column, column}, {1.0, 0.0}};
        choose_between(c, low, middle);
        choose_between(c, middle, high);
    }
}

gonio_status gonio_i_neighbours_choose(gonio_context *context, const gonio_i_column *columns,
                                       const double *wavelength, const size_t *member, size_t count,
                                       gonio_i_neighbours *neighbours)
{
    if (count <= FEW_COLUMNS) {
        return GONIO_OK;
    }
    size_t *order = gonio_i_allocate(context, count, sizeof *order);
    const gonio_status status = order == NULL
                                    ? GONIO_ERROR_MEMORY
                                    : sort_by_wavelength(context, wavelength, member, count, order);
    if (status == GONIO_OK) {
        const choice c = {columns, wavelength, order, neighbours};
        choose_between(&c, 0, count - 1);
    }
    free(order);
    return status;
}

/* ---- estimates ---- */

gonio_status gonio_i_neighbours_estimate(const gonio_i_fit *e, size_t count, double *y, double *c)
{
    const double kept = e->model.h * e->model.h;
    for (size_t i = 0; i < count * e->n; i++) {
        y[i] -= e->y[i % e->n] - e->rest[i % e->n]; /* F z */
    }
    gonio_i_divide_triangle(y, count, e->n, e->lower);
    gonio_i_divide_lower(y, count, e->n, e->lower);
    const gonio_status status =
        gonio_i_product(e->context, y, count, e->n, e->sites->f, e->components, c);
    for (size_t k = 0; k < count * e->components && status == GONIO_OK; k++) {
        c[k] = e->centre[k % e->components] + kept * c[k];
    }
    return status;
}
