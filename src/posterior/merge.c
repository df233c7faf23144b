/* Merging of readings: see merge.h. */
#include "merge.h"

#include <math.h>
#include <stdlib.h>

#include "leave_one_out.h"

static const double FINEST = 0.05;
static const double COARSER = 1.2;
static const double COARSEST = 20.0; /* one cell holds all that have the same signs */

/* Places that are the same. The lattice is moved, as rounded angles lie on the borders of cells. */
static const double SAME = 0.001;
static const double MOVED = 0.3819;

/* A part of every variance that does not average out. */
static const double LEFT_OPEN = GONIO_I_MODEL_DEVIATION * GONIO_I_MODEL_DEVIATION;

/* A reading and its cell of the lattice. */
typedef struct member {
    gonio_i_place place;
    int cell[4];
    int bound;
    int channel;
    size_t index;
} member;

static int compare_cells(const member *a, const member *b)
{
    for (int k = 0; k < 4; k++) {
        if (a->cell[k] != b->cell[k]) {
            return a->cell[k] < b->cell[k] ? -1 : 1;
        }
    }
    if (a->bound != b->bound) {
        return a->bound < b->bound ? -1 : 1;
    }
    return (a->channel > b->channel) - (a->channel < b->channel);
}

static int compare_members(const void *a, const void *b)
{
    const member *x = a;
    const member *y = b;
    const int cells = compare_cells(x, y);
    return cells != 0 ? cells : (x->index > y->index) - (x->index < y->index);
}

static void list_members(const gonio_i_column *column, member *members)
{
    for (size_t i = 0; i < column->count; i++) {
        const gonio_i_observation *o = &column->observation[i];
        members[i] = (member){
            .place = gonio_i_place_of(o->at), .bound = o->bound, .channel = o->channel, .index = i};
    }
}

/* Sorts members by their cells; returns the number of cells. */
static size_t sort_into_cells(member *members, size_t count, double pitch, double moved)
{
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 4; k++) {
            members[i].cell[k] = (int)floor(members[i].place.p[k] / pitch + moved);
        }
    }
    qsort(members, count, sizeof *members, compare_members);
    size_t cells = 0;
    for (size_t i = 0; i < count; i++) {
        cells += i == 0 || compare_cells(&members[i - 1], &members[i]) != 0;
    }
    return cells;
}

/* The member nearest to the middle of all. */
static size_t nearest_to_middle(const member *members, size_t count)
{
    gonio_i_place middle = {0};
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 4; k++) {
            middle.p[k] += members[i].place.p[k] / (double)count;
        }
    }
    size_t best = 0;
    double least = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const double square = gonio_i_place_distance(&members[i].place, &middle);
        if (square < least) {
            least = square;
            best = members[i].index;
        }
    }
    return best;
}

static gonio_i_observation merge_cell(const gonio_i_column *column, const member *members,
                                      size_t count)
{
    gonio_i_observation one = column->observation[nearest_to_middle(members, count)];
    double weights = 0.0;
    double sum = 0.0;
    double noise = 0.0;
    for (size_t i = 0; i < count; i++) {
        const gonio_i_observation *o = &column->observation[members[i].index];
        const double weight = 1.0 / o->variance;
        weights += weight;
        sum += weight * o->g;
        noise += weight * weight * fmax(o->variance - LEFT_OPEN, 0.0);
    }
    one.g = sum / weights;
    one.variance = LEFT_OPEN + noise / (weights * weights);
    return one;
}

static void merge_cells(const gonio_i_column *column, const member *members, gonio_i_column *merged)
{
    size_t first = 0;
    for (size_t end = 1; end <= column->count; end++) {
        if (end == column->count || compare_cells(&members[first], &members[end]) != 0) {
            merged->observation[merged->count++] = merge_cell(column, members + first, end - first);
            first = end;
        }
    }
}

static gonio_status merge_all(gonio_context *context, const gonio_i_column *column,
                              const member *members, size_t cells, gonio_i_column *merged)
{
    merged->observation = gonio_i_allocate(context, cells, sizeof *merged->observation);
    if (merged->observation == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    merge_cells(column, members, merged);
    return GONIO_OK;
}

gonio_status gonio_i_merge(gonio_context *context, const gonio_i_column *column, size_t most,
                           gonio_i_column *merged)
{
    *merged = (gonio_i_column){0};
    member *members = gonio_i_allocate(context, column->count, sizeof *members);
    if (members == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    list_members(column, members);
    double pitch = FINEST;
    size_t cells = sort_into_cells(members, column->count, pitch, 0.0);
    while (cells > most && pitch < COARSEST) {
        pitch *= COARSER;
        cells = sort_into_cells(members, column->count, pitch, 0.0);
    }
    const gonio_status status = merge_all(context, column, members, cells, merged);
    free(members);
    return status;
}

gonio_status gonio_i_merge_repeats(gonio_context *context, const gonio_i_column *column,
                                   gonio_i_column *merged)
{
    *merged = (gonio_i_column){0};
    member *members = gonio_i_allocate(context, column->count, sizeof *members);
    if (members == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    list_members(column, members);
    const size_t cells = sort_into_cells(members, column->count, SAME, MOVED);
    const gonio_status status = cells < column->count
                                    ? merge_all(context, column, members, cells, merged)
                                    : gonio_i_thin_copy(context, column, column->count, merged);
    free(members);
    return status;
}
