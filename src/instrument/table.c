/* Kinematics of a table of reachable directions, for anything else. Rows are found by two indices:
 * by the sum of their polar angles, and by the sum of their axes. What is near in each angle, or in
 * each axis, is near in the sum. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "instrument.h"

/* ---- the indices ---- */

static int compare_keys(const void *a, const void *b)
{
    const gonio_i_row_key *x = a;
    const gonio_i_row_key *y = b;
    const int order = (x->key > y->key) - (x->key < y->key);
    return order != 0 ? order : (x->row > y->row) - (x->row < y->row);
}

static double sum_of_angles(const gonio_pair *pair)
{
    return pair->incident.theta + pair->outgoing.theta;
}

static double sum_of_axes(const double *axis, size_t axes)
{
    double sum = 0.0;
    for (size_t k = 0; k < axes; k++) {
        sum += axis[k];
    }
    return sum;
}

gonio_status gonio_i_table_index(gonio_context *context, gonio_instrument *instrument)
{
    const size_t rows = instrument->view.directions;
    instrument->by_angles = gonio_i_allocate(context, rows, sizeof *instrument->by_angles);
    instrument->by_axes = gonio_i_allocate(context, rows, sizeof *instrument->by_axes);
    if (instrument->by_angles == NULL || instrument->by_axes == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t row = 0; row < rows; row++) {
        const gonio_setting *at = &instrument->row[row];
        instrument->by_angles[row] = (gonio_i_row_key){sum_of_angles(&at->pair), row};
        instrument->by_axes[row] =
            (gonio_i_row_key){sum_of_axes(at->axis, instrument->view.axes), row};
    }
    qsort(instrument->by_angles, rows, sizeof *instrument->by_angles, compare_keys);
    qsort(instrument->by_axes, rows, sizeof *instrument->by_axes, compare_keys);
    instrument->same_row = GONIO_I_SAME_ROW;
    return GONIO_OK;
}

/* The first key that is not below a value. */
static size_t first_from(const gonio_i_row_key *key, size_t rows, double value)
{
    size_t low = 0;
    size_t high = rows;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        low = key[middle].key < value ? middle + 1 : low;
        high = key[middle].key < value ? high : middle;
    }
    return low;
}

/* ---- the row of a setting ---- */

typedef struct nearest {
    size_t row;
    double away;
} nearest;

static void try_row(const gonio_instrument *instrument, const double *axis, size_t row, nearest *n)
{
    double away = 0.0;
    for (size_t k = 0; k < instrument->view.axes; k++) {
        away += fabs(instrument->row[row].axis[k] - axis[k]);
    }
    if (away < n->away || (away == n->away && row < n->row)) {
        *n = (nearest){row, away};
    }
}

/* The row whose axes are nearest, the first of several. */
static gonio_pair pair_of(const gonio_instrument *instrument, const double *axis)
{
    const gonio_i_row_key *key = instrument->by_axes;
    const size_t rows = instrument->view.directions;
    const double sum = sum_of_axes(axis, instrument->view.axes);
    const double rounded = 1e-12 * (1.0 + fabs(sum));
    const size_t from = first_from(key, rows, sum);
    nearest n = {0, INFINITY};
    for (size_t k = from; k < rows && key[k].key - sum <= n.away + rounded; k++) {
        try_row(instrument, axis, key[k].row, &n);
    }
    for (size_t k = from; k-- > 0 && sum - key[k].key <= n.away + rounded;) {
        try_row(instrument, axis, key[k].row, &n);
    }
    return instrument->row[n.row].pair;
}

/* ---- the rows of a pair ---- */

/* The angle between two azimuths, on the sphere at theta. */
static double apart(double a, double b, double theta)
{
    const double turn = gonio_i_azimuth(a - b);
    return fmin(turn, 2.0 * M_PI - turn) * sin(theta);
}

static bool is_same(const gonio_pair *row, const gonio_pair *pair, bool isotropic, double same)
{
    if (fabs(row->incident.theta - pair->incident.theta) > same ||
        fabs(row->outgoing.theta - pair->outgoing.theta) > same) {
        return false;
    }
    if (isotropic) {
        return apart(gonio_i_azimuth_difference(row), gonio_i_azimuth_difference(pair),
                     fmin(row->incident.theta, row->outgoing.theta)) < same;
    }
    return apart(row->incident.phi, pair->incident.phi, row->incident.theta) < same &&
           apart(row->outgoing.phi, pair->outgoing.phi, row->outgoing.theta) < same;
}

/* Puts a row in its place among the first ones, in ascending order. Returns how many there are. */
static size_t keep_first(size_t found[GONIO_I_MOST_SOLUTIONS], size_t count, size_t row)
{
    size_t place = count;
    while (place > 0 && found[place - 1] > row) {
        place--;
    }
    if (place == GONIO_I_MOST_SOLUTIONS) {
        return count;
    }
    const size_t kept = count < GONIO_I_MOST_SOLUTIONS ? count : count - 1;
    memmove(found + place + 1, found + place, (kept - place) * sizeof *found);
    found[place] = row;
    return kept + 1;
}

static size_t settings_of(const gonio_instrument *instrument, gonio_pair pair, bool isotropic,
                          double axis[][GONIO_MOST_AXES])
{
    const double same = instrument->same_row;
    const double sum = sum_of_angles(&pair);
    const gonio_i_row_key *key = instrument->by_angles;
    const size_t rows = instrument->view.directions;
    const bool any = same > GONIO_I_SAME_ROW; /* rows near a pair need not be the first ones */
    size_t found[GONIO_I_MOST_SOLUTIONS];
    size_t count = 0;
    for (size_t k = first_from(key, rows, sum - 2.0 * same);
         k < rows && key[k].key <= sum + 2.0 * same && !(any && count == GONIO_I_MOST_SOLUTIONS);
         k++) {
        if (is_same(&instrument->row[key[k].row].pair, &pair, isotropic, same)) {
            count = keep_first(found, count, key[k].row);
        }
    }
    for (size_t k = 0; k < count; k++) {
        memcpy(axis[k], instrument->row[found[k]].axis, sizeof *axis);
    }
    return count;
}

const gonio_i_kinematics gonio_i_table_kinematics = {
    .name = "table",
    .summary = "a table of reachable directions",
    .incidence = -1,
    .pair = pair_of,
    .settings = settings_of,
};
