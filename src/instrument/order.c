/* The order of readings in which a run takes the least time.
 *
 * Given     the settings that each reading may be made at, and where the axes are before
 * Returned  an order, and a setting for each reading
 * Method    The nearest reading next, at its nearest setting. Then, by turns, a tour through fixed
 *           settings (tour.h), and the best settings along a fixed order, by dynamic programming,
 *           until neither helps. Small runs begin again from each reading. */
#include "order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "instrument.h"
#include "tour.h"

enum { MOST_KEPT = 3000, MOST_ROUNDS = 8, SMALL = 12 };

/* By effort: how often tours are disturbed. */
static const size_t kicks[] = {[GONIO_I_ROUGH_ORDER] = 500, [GONIO_I_FINE_ORDER] = 8000};

typedef struct search {
    gonio_context *context;
    const gonio_instrument *instrument;
    const gonio_setting *setting;
    const size_t *first; /* [count + 1] */
    size_t count;
    gonio_i_order_effort effort;
    gonio_setting start;
    size_t *order;              /* [count]: readings */
    size_t *chosen;             /* [count]: the setting of each reading */
    double *cost;               /* [all settings] of dynamic programming */
    size_t *from;               /* [all settings]: the setting before */
    const gonio_setting **node; /* [count + 1] of tours: the start, then in the present order */
    double *matrix;             /* [count + 1][count + 1]: their distances; NULL: too many */
} search;

static double travel(const search *s, size_t from, size_t to)
{
    return gonio_instrument_travel(s->instrument, &s->setting[from], &s->setting[to]);
}

static double travel_from_start(const search *s, size_t to)
{
    return gonio_instrument_travel(s->instrument, &s->start, &s->setting[to]);
}

static double length_of(const search *s)
{
    double sum = 0.0;
    for (size_t k = 0; k < s->count; k++) {
        const size_t here = s->chosen[s->order[k]];
        sum += k == 0 ? travel_from_start(s, here) : travel(s, s->chosen[s->order[k - 1]], here);
    }
    return sum;
}

/* ---- the nearest next ---- */

/* The nearest setting of the readings order[k] and later; puts its reading at place k. */
static void take_nearest(search *s, size_t k)
{
    double least = INFINITY;
    size_t place = k;
    for (size_t j = k; j < s->count; j++) {
        const size_t reading = s->order[j];
        for (size_t one = s->first[reading]; one < s->first[reading + 1]; one++) {
            const double time =
                k == 0 ? travel_from_start(s, one) : travel(s, s->chosen[s->order[k - 1]], one);
            if (time < least) {
                least = time;
                place = j;
                s->chosen[reading] = one;
            }
        }
    }
    const size_t reading = s->order[place];
    s->order[place] = s->order[k];
    s->order[k] = reading;
}

/* From reading `begin` on; count or more: from the nearest to the start. */
static void order_by_nearest(search *s, size_t begin)
{
    for (size_t k = 0; k < s->count; k++) {
        s->order[k] = k;
    }
    size_t done = 0;
    if (begin < s->count) {
        s->order[0] = begin;
        s->order[begin] = 0;
        s->chosen[begin] = s->first[begin];
        done = 1;
    }
    for (; done < s->count; done++) {
        take_nearest(s, done);
    }
}

/* ---- the best settings along an order ---- */

static void reach_setting(search *s, size_t k, size_t one)
{
    if (k == 0) {
        s->cost[one] = travel_from_start(s, one);
        return;
    }
    const size_t before = s->order[k - 1];
    s->cost[one] = INFINITY;
    for (size_t j = s->first[before]; j < s->first[before + 1]; j++) {
        const double cost = s->cost[j] + travel(s, j, one);
        if (cost < s->cost[one]) {
            s->cost[one] = cost;
            s->from[one] = j;
        }
    }
}

static void choose_settings(search *s)
{
    for (size_t k = 0; k < s->count; k++) {
        const size_t reading = s->order[k];
        for (size_t one = s->first[reading]; one < s->first[reading + 1]; one++) {
            reach_setting(s, k, one);
        }
    }
    const size_t last = s->order[s->count - 1];
    size_t best = s->first[last];
    for (size_t one = best; one < s->first[last + 1]; one++) {
        best = s->cost[one] < s->cost[best] ? one : best;
    }
    for (size_t k = s->count; k > 0; k--) {
        s->chosen[s->order[k - 1]] = best;
        best = k > 1 ? s->from[best] : best;
    }
}

/* ---- tours through chosen settings ---- */

static double travel_of_nodes(const void *data, size_t a, size_t b)
{
    const search *s = data;
    return gonio_instrument_travel(s->instrument, s->node[a], s->node[b]);
}

static void fill_matrix(search *s)
{
    const size_t nodes = s->count + 1;
    for (size_t i = 0; i < nodes && s->matrix != NULL; i++) {
        for (size_t j = 0; j < i; j++) {
            const double time = travel_of_nodes(s, i, j);
            s->matrix[i * nodes + j] = time;
            s->matrix[j * nodes + i] = time;
        }
    }
}

/* Node 0 is the start, node k + 1 the reading at place k of the present order. */
static gonio_status improve_tour(search *s)
{
    const size_t nodes = s->count + 1;
    s->node[0] = &s->start;
    for (size_t k = 0; k < s->count; k++) {
        s->node[k + 1] = &s->setting[s->chosen[s->order[k]]];
    }
    fill_matrix(s);
    const gonio_i_distances distances = {nodes, s->matrix, travel_of_nodes, s};
    size_t *tour = gonio_i_allocate(s->context, 2 * nodes, sizeof *tour);
    gonio_status status = tour == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_i_shorten_path(s->context, &distances, kicks[s->effort], tour);
    }
    for (size_t k = 0; k < s->count && status == GONIO_OK; k++) {
        tour[nodes + k] = s->order[tour[k + 1] - 1];
    }
    if (status == GONIO_OK) {
        memcpy(s->order, tour + nodes, s->count * sizeof *s->order);
    }
    free(tour);
    return status;
}

/* By turns, until neither helps. */
static gonio_status improve(search *s, double *length)
{
    gonio_status status = GONIO_OK;
    *length = INFINITY;
    for (int round = 0; round < MOST_ROUNDS && status == GONIO_OK; round++) {
        choose_settings(s);
        status = improve_tour(s);
        const double now = length_of(s);
        const bool better = now < *length - 1e-9;
        *length = fmin(now, *length);
        if (!better) {
            break;
        }
    }
    choose_settings(s);
    *length = length_of(s);
    return status;
}

/* The best of searches that begin at the nearest reading and, in a small run, at each one. */
static gonio_status search_orders(search *s)
{
    const size_t begins = s->count <= SMALL ? s->count + 1 : 1;
    size_t *best = gonio_i_allocate(s->context, 2 * s->count, sizeof *best);
    double least = INFINITY;
    gonio_status status = best == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (size_t begin = 0; begin < begins && status == GONIO_OK; begin++) {
        double length = 0.0;
        order_by_nearest(s, begins - 1 - begin);
        status = improve(s, &length);
        if (status == GONIO_OK && length < least - 1e-9) {
            least = length;
            memcpy(best, s->order, s->count * sizeof *best);
            memcpy(best + s->count, s->chosen, s->count * sizeof *best);
        }
    }
    if (status == GONIO_OK) {
        memcpy(s->order, best, s->count * sizeof *best);
        memcpy(s->chosen, best + s->count, s->count * sizeof *best);
    }
    free(best);
    return status;
}

static gonio_status check(gonio_context *context, const size_t *first, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        if (first[k] >= first[k + 1]) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "reading %zu has no setting", k + 1);
        }
    }
    return GONIO_OK;
}

gonio_status gonio_i_order(gonio_context *context, const gonio_instrument *instrument,
                           const gonio_setting *setting, const size_t *first, size_t count,
                           const gonio_setting *start, gonio_i_order_effort effort, size_t *order,
                           gonio_setting *chosen)
{
    gonio_status status = check(context, first, count);
    if (status != GONIO_OK || count == 0) {
        return status;
    }
    search s = {.context = context,
                .instrument = instrument,
                .setting = setting,
                .first = first,
                .count = count,
                .effort = effort,
                .order = order,
                .chosen = gonio_i_allocate(context, count, sizeof *s.chosen),
                .cost = gonio_i_allocate(context, first[count], sizeof *s.cost),
                .from = gonio_i_allocate(context, first[count], sizeof *s.from),
                .node = gonio_i_allocate(context, count + 1, sizeof *s.node)};
    if (count <= MOST_KEPT) {
        s.matrix = gonio_i_allocate(context, (count + 1) * (count + 1), sizeof *s.matrix);
    }
    const bool whole = s.chosen && s.cost && s.from && s.node && (s.matrix || count > MOST_KEPT);
    status = whole ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (start != NULL) {
        s.start = *start;
    } else {
        gonio_instrument_home(instrument, &s.start);
    }
    if (status == GONIO_OK) {
        status = search_orders(&s);
    }
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        chosen[k] = setting[s.chosen[order[k]]];
    }
    free(s.chosen);
    free(s.cost);
    free(s.from);
    free(s.node);
    free(s.matrix);
    return status;
}

gonio_status gonio_instrument_order(gonio_context *context, const gonio_instrument *instrument,
                                    const gonio_setting *setting, const size_t *first, size_t count,
                                    const gonio_setting *start, size_t *order,
                                    gonio_setting *chosen)
{
    return gonio_i_order(context, instrument, setting, first, count, start, GONIO_I_FINE_ORDER,
                         order, chosen);
}
