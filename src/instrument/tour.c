/* Short paths: see tour.h.
 *
 * Method    The path is closed by a node at distance 0 of all others, which has to stand before
 *           node 0. 2-opt and Or-opt (segments of up to three nodes) with lists of near nodes and a
 *           queue of nodes to look at (Johnson and McGeoch 1997), then an iterated local search:
 *           exchanges of two neighbouring short segments (the double bridge of Martin, Otto and
 *           Felten 1991), undone where they do not help. */
#include "tour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/random.h"

enum { NEAR = 12, LONGEST_SEGMENT = 3, LONGEST_BRIDGE = 50, KICKS_PER_NODE = 40 };

/* The distance between the first and the closing node, which no exchange may part. */
static const double TIE = -1e6;

/* A gain that is not rounding. */
static const double LEAST_GAIN = 1e-7;

/* Nodes from a place on that were put in the other order. */
typedef struct reversal {
    size_t place, count;
} reversal;

typedef struct tour {
    const gonio_i_distances *distances;
    size_t nodes;  /* without the closing one */
    size_t n;      /* with it */
    size_t *at;    /* [n]: the node at each place */
    size_t *place; /* [n]: of each node */
    size_t *near;  /* [nodes][NEAR] */
    size_t nears;
    size_t *queue; /* [n]: nodes to look at */
    bool *queued;  /* [n] */
    size_t queue_first;
    size_t queue_count;
    reversal *made; /* [made_room]: the reversals since the best tour */
    size_t made_count;
    size_t made_room;
    bool logged;
    bool out_of_memory;
    double length;
    gonio_i_random random;
} tour;

static double distance(const tour *t, size_t a, size_t b)
{
    const gonio_i_distances *d = t->distances;
    return d->matrix != NULL ? d->matrix[a * d->nodes + b] : d->compute(d->data, a, b);
}

static double between(const tour *t, size_t a, size_t b)
{
    if (a == t->nodes || b == t->nodes) {
        return a == 0 || b == 0 ? TIE : 0.0;
    }
    return distance(t, a, b);
}

static size_t after(const tour *t, size_t node)
{
    const size_t place = t->place[node] + 1;
    return t->at[place == t->n ? 0 : place];
}

static size_t before(const tour *t, size_t node)
{
    const size_t place = t->place[node];
    return t->at[place == 0 ? t->n - 1 : place - 1];
}

static void look_again(tour *t, size_t node)
{
    if (!t->queued[node]) {
        t->queued[node] = true;
        t->queue[(t->queue_first + t->queue_count) % t->n] = node;
        t->queue_count++;
    }
}

/* ---- changes ---- */

static void turn_places(tour *t, reversal r)
{
    size_t a = r.place;
    size_t b = (r.place + r.count + t->n - 1) % t->n;
    for (size_t k = 0; k < r.count / 2; k++) {
        const size_t node = t->at[a];
        t->at[a] = t->at[b];
        t->at[b] = node;
        t->place[t->at[a]] = a;
        t->place[t->at[b]] = b;
        a = a + 1 == t->n ? 0 : a + 1;
        b = b == 0 ? t->n - 1 : b - 1;
    }
}

static void remember(tour *t, reversal r)
{
    if (t->made_count == t->made_room) {
        const size_t room = t->made_room > 0 ? 2 * t->made_room : 256;
        reversal *more = reallocarray(t->made, room, sizeof *more);
        if (more == NULL) {
            t->out_of_memory = true;
            return;
        }
        t->made = more;
        t->made_room = room;
    }
    t->made[t->made_count++] = r;
}

/* Reverses the nodes from place i on, `count` of them, around the end. */
static void reverse_places(tour *t, size_t i, size_t count)
{
    const reversal r = {i % t->n, count};
    if (count < 2) {
        return;
    }
    turn_places(t, r);
    if (t->logged) {
        remember(t, r);
    }
}

/* Reverses the path from node a to node b, or the rest, whichever is shorter. */
static void reverse_path(tour *t, size_t a, size_t b)
{
    const size_t count = (t->place[b] + t->n - t->place[a]) % t->n + 1;
    if (2 * count <= t->n) {
        reverse_places(t, t->place[a], count);
    } else {
        reverse_places(t, (t->place[b] + 1) % t->n, t->n - count);
    }
}

/* a-b and c-d, each in the direction of the tour, become a-c and b-d. */
static void exchange_edges(tour *t, size_t a, size_t b, size_t c, size_t d)
{
    reverse_path(t, b, c);
    look_again(t, a);
    look_again(t, b);
    look_again(t, c);
    look_again(t, d);
}

/* ---- 2-opt ---- */

/* The edge behind a (forward) or before it, against the one of a near node. */
static bool try_two_edges(tour *t, size_t a, size_t c, bool forward)
{
    const size_t b = forward ? after(t, a) : before(t, a);
    const size_t d = forward ? after(t, c) : before(t, c);
    if (c == b || d == a) {
        return false;
    }
    const double gain = between(t, a, b) + between(t, c, d) - between(t, a, c) - between(t, b, d);
    if (gain < LEAST_GAIN) {
        return false;
    }
    if (forward) {
        exchange_edges(t, a, b, c, d);
    } else {
        exchange_edges(t, d, c, b, a);
    }
    t->length -= gain;
    return true;
}

/* ---- Or-opt ---- */

/* A segment in the direction of the tour, from node s to node e, and its neighbours. */
typedef struct segment {
    size_t p, s, e, q;
} segment;

static bool in_segment(const tour *t, const segment *g, size_t node)
{
    const size_t length = (t->place[g->e] + t->n - t->place[g->s]) % t->n;
    return (t->place[node] + t->n - t->place[g->s]) % t->n <= length;
}

/* From place i on, `first` nodes and the `second` after them change places. */
static void swap_neighbours(tour *t, size_t i, size_t first, size_t second, bool turn_first,
                            bool turn_second)
{
    reverse_places(t, i, first + second);
    if (!turn_second) {
        reverse_places(t, i, second);
    }
    if (!turn_first) {
        reverse_places(t, i + second, first);
    }
}

/* Moves a segment between c and d, which follows c. The nodes between the old place and the new one
 * make room, on the side where they are fewer. */
static void shift_segment(tour *t, const segment *g, size_t c, size_t d, bool turned)
{
    const size_t n = t->n;
    const size_t length = (t->place[g->e] + n - t->place[g->s]) % n + 1;
    const size_t ahead = (t->place[c] + n - t->place[g->e]) % n;
    const size_t back = (t->place[g->s] + n - t->place[d]) % n;
    if (ahead <= back) {
        swap_neighbours(t, t->place[g->s], length, ahead, turned, false);
    } else {
        swap_neighbours(t, t->place[d], back, length, false, turned);
    }
}

static void move_segment(tour *t, const segment *g, size_t c, size_t d, bool turned)
{
    shift_segment(t, g, c, d, turned);
    const size_t ends[] = {g->p, g->q, g->s, g->e, c, d};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
        look_again(t, ends[k]);
    }
}

/* Whether moving the segment between c and the node after it helps, either way round. */
static bool try_place(tour *t, const segment *g, size_t c)
{
    const size_t d = after(t, c);
    if (in_segment(t, g, c) || in_segment(t, g, d)) {
        return false;
    }
    const double freed =
        between(t, g->p, g->s) + between(t, g->e, g->q) - between(t, g->p, g->q) + between(t, c, d);
    const double plain = freed - between(t, c, g->s) - between(t, g->e, d);
    const double turned = freed - between(t, c, g->e) - between(t, g->s, d);
    if (fmax(plain, turned) < LEAST_GAIN) {
        return false;
    }
    t->length -= fmax(plain, turned);
    move_segment(t, g, c, d, turned > plain);
    return true;
}

/* Segments that begin or end at `node`, beside the near node c. */
static bool try_segments(tour *t, size_t node, size_t c)
{
    bool moved = false;
    segment ahead = {before(t, node), node, node, 0};
    segment behind = {0, node, node, after(t, node)};
    for (int length = 1; length <= LONGEST_SEGMENT && !moved; length++) {
        ahead.q = after(t, ahead.e);
        behind.p = before(t, behind.s);
        if (ahead.q == ahead.p || ahead.e == t->nodes || behind.s == t->nodes) {
            break;
        }
        moved = try_place(t, &ahead, c) || try_place(t, &ahead, before(t, c)) ||
                try_place(t, &behind, c) || try_place(t, &behind, before(t, c));
        ahead.e = ahead.q;
        behind.s = behind.p;
    }
    return moved;
}

/* ---- local search ---- */

static bool improve_node(tour *t, size_t node)
{
    const bool closing = node == t->nodes;
    const size_t count = closing ? t->nodes : t->nears + 1;
    const double longest =
        fmax(between(t, before(t, node), node), between(t, node, after(t, node)));
    for (size_t k = 0; k < count; k++) {
        const size_t c = closing ? k : k == 0 ? t->nodes : t->near[node * NEAR + k - 1];
        if (between(t, node, c) > longest) {
            break;
        }
        if (try_two_edges(t, node, c, true) || try_two_edges(t, node, c, false) ||
            (!closing && try_segments(t, node, c))) {
            return true;
        }
    }
    return false;
}

static void descend(tour *t)
{
    while (t->queue_count > 0) {
        const size_t node = t->queue[t->queue_first];
        t->queue_first = (t->queue_first + 1) % t->n;
        t->queue_count--;
        t->queued[node] = false;
        if (improve_node(t, node)) {
            look_again(t, node);
        }
    }
}

static double length_of(const tour *t)
{
    double sum = 0.0;
    for (size_t k = 0; k < t->n; k++) {
        sum += between(t, t->at[k], t->at[k + 1 == t->n ? 0 : k + 1]);
    }
    return sum;
}

/* ---- kicks ---- */

/* Exchanges the segments from place i and from place j on, which meet: A B becomes B A. */
static void exchange_segments(tour *t, size_t i, size_t j, size_t end)
{
    const size_t before_a = t->at[i - 1];
    const size_t a = t->at[i];
    const size_t end_a = t->at[j - 1];
    const size_t b = t->at[j];
    const size_t end_b = t->at[end - 1];
    const size_t after_b = t->at[end % t->n];
    t->length += between(t, before_a, b) + between(t, end_b, a) + between(t, end_a, after_b) -
                 between(t, before_a, a) - between(t, end_a, b) - between(t, end_b, after_b);
    swap_neighbours(t, i, j - i, end - j, false, false);
    const size_t ends[] = {before_a, a, end_a, b, end_b, after_b};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
        look_again(t, ends[k]);
    }
}

static void kick(tour *t)
{
    const size_t most = t->n - 2 < LONGEST_BRIDGE ? t->n - 2 : LONGEST_BRIDGE;
    const size_t both = 2 + gonio_i_random_below(&t->random, most - 1);
    const size_t first = 1 + gonio_i_random_below(&t->random, both - 1);
    const size_t i = 1 + gonio_i_random_below(&t->random, t->n - both);
    exchange_segments(t, i, i + first, i + both);
}

/* Back to the best tour. */
static void restore(tour *t)
{
    while (t->made_count > 0) {
        turn_places(t, t->made[--t->made_count]);
    }
}

static gonio_status iterate(gonio_context *context, tour *t, size_t most_kicks)
{
    const size_t wanted = (size_t)KICKS_PER_NODE * t->n;
    const size_t kicks = t->n < 5 ? 0 : wanted < most_kicks ? wanted : most_kicks;
    gonio_status status = GONIO_OK;
    t->length = length_of(t);
    descend(t);
    t->length = length_of(t);
    double best = t->length;
    t->logged = true;
    for (size_t k = 0; k < kicks && status == GONIO_OK; k++) {
        kick(t);
        descend(t);
        if (t->length < best - LEAST_GAIN) {
            best = t->length;
            t->made_count = 0;
        } else {
            restore(t);
            t->length = best;
        }
        status = k % 256 == 0 ? gonio_i_progress(context, "ordering", (double)k / (double)kicks)
                              : GONIO_OK;
    }
    return t->out_of_memory ? gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory for orders")
                            : status;
}

/* ---- making it ---- */

/* The nearest nodes, the nearest first. */
static void find_near(tour *t, size_t node)
{
    double away[NEAR];
    size_t *near = t->near + node * NEAR;
    size_t count = 0;
    for (size_t other = 0; other < t->nodes; other++) {
        const double here = other == node ? INFINITY : distance(t, node, other);
        if (other == node || (count == NEAR && here >= away[NEAR - 1])) {
            continue;
        }
        size_t k = count < NEAR ? count++ : NEAR - 1;
        for (; k > 0 && away[k - 1] > here; k--) {
            near[k] = near[k - 1];
            away[k] = away[k - 1];
        }
        near[k] = other;
        away[k] = here;
    }
    t->nears = count;
}

static void begin(tour *t)
{
    for (size_t node = 0; node < t->nodes; node++) {
        find_near(t, node);
    }
    for (size_t k = 0; k < t->n; k++) {
        t->at[k] = k;
        t->place[k] = k;
        look_again(t, k);
    }
    gonio_i_random_seed(&t->random, 0, 0);
}

/* The path from node 0 on, away from the closing node. */
static void take_path(const tour *t, size_t *path)
{
    const bool forward = before(t, 0) == t->nodes;
    size_t node = 0;
    for (size_t k = 0; k < t->nodes; k++) {
        path[k] = node;
        node = forward ? after(t, node) : before(t, node);
    }
}

gonio_status gonio_i_shorten_path(gonio_context *context, const gonio_i_distances *distances,
                                  size_t kicks, size_t *path)
{
    const size_t nodes = distances->nodes;
    const size_t n = nodes + 1;
    tour t = {.distances = distances,
              .nodes = nodes,
              .n = n,
              .at = gonio_i_allocate(context, n, sizeof *t.at),
              .place = gonio_i_allocate(context, n, sizeof *t.place),
              .near = gonio_i_allocate(context, nodes * NEAR, sizeof *t.near),
              .queue = gonio_i_allocate(context, n, sizeof *t.queue),
              .queued = gonio_i_allocate(context, n, sizeof *t.queued)};
    const bool whole = t.at && t.place && t.near && t.queue && t.queued;
    gonio_status status = whole ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        begin(&t);
        status = iterate(context, &t, kicks);
    }
    if (status == GONIO_OK) {
        take_path(&t, path);
    }
    free(t.at);
    free(t.place);
    free(t.near);
    free(t.queue);
    free(t.queued);
    free(t.made);
    return status;
}
