/* Many vectors as combinations of a few: see combinations.h. */
#include "combinations.h"

#include <math.h>
#include <stdlib.h>

#include "../linalg/linalg.h"

void gonio_i_combinations_release(gonio_i_combinations *c)
{
    free(c->few);
    free(c->weight);
    *c = (gonio_i_combinations){0};
}

/* The longest of the vectors by the squares of their lengths. */
static size_t find_longest(const double *square, size_t vectors)
{
    size_t longest = 0;
    for (size_t j = 1; j < vectors; j++) {
        longest = square[j] > square[longest] ? j : longest;
    }
    return longest;
}

/* Takes a unit vector out of a vector; returns its weight. */
static double take_out(const double *unit, size_t size, double *vector)
{
    const double weight = gonio_i_dot(unit, vector, size);
    for (size_t i = 0; i < size; i++) {
        vector[i] -= weight * unit[i];
    }
    return weight;
}

/* The unit vector of `from`, orthogonal to rounding to the `count` before it. */
static void make_unit(const double *from, size_t size, size_t count, double *few)
{
    double *unit = few + count * size;
    for (size_t i = 0; i < size; i++) {
        unit[i] = from[i];
    }
    for (size_t k = 0; k < count; k++) {
        (void)take_out(few + k * size, size, unit);
    }
    const double length = sqrt(gonio_i_dot(unit, unit, size));
    for (size_t i = 0; i < size; i++) {
        unit[i] /= length;
    }
}

/* weight: [vectors][most]. Returns how many there are, or 0 if `most` are not enough. */
static size_t find_few(gonio_context *context, double *vector, size_t vectors, size_t size,
                       double tolerance, size_t most, double *square, double *few, double *weight)
{
    for (size_t j = 0; j < vectors; j++) {
        square[j] = gonio_i_dot(vector + j * size, vector + j * size, size);
    }
    for (size_t count = 0; count <= most; count++) {
        const size_t longest = find_longest(square, vectors);
        if (square[longest] <= tolerance * tolerance) {
            return count;
        }
        if (count == most) {
            break;
        }
        make_unit(vector + longest * size, size, count, few);
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(context))
        for (size_t j = 0; j < vectors; j++) {
            double *v = vector + j * size;
            weight[j * most + count] = take_out(few + count * size, size, v);
            square[j] = gonio_i_dot(v, v, size);
        }
    }
    return 0;
}

/* From rows of `most` weights to rows of `count`: never ahead of what is read. */
static void move_together(double *weight, size_t vectors, size_t most, size_t count)
{
    for (size_t j = 0; j < vectors; j++) {
        for (size_t k = 0; k < count; k++) {
            weight[j * count + k] = weight[j * most + k];
        }
    }
}

gonio_status gonio_i_combinations_find(gonio_context *context, double *vector, size_t vectors,
                                       size_t size, double tolerance, size_t most,
                                       gonio_i_combinations *c)
{
    *c = (gonio_i_combinations){0};
    double *square = gonio_i_allocate(context, vectors, sizeof *square);
    c->few = gonio_i_allocate(context, most * size, sizeof *c->few);
    c->weight = gonio_i_allocate(context, vectors * most, sizeof *c->weight);
    const bool done = square != NULL && c->few != NULL && c->weight != NULL;
    if (done) {
        c->count =
            find_few(context, vector, vectors, size, tolerance, most, square, c->few, c->weight);
        move_together(c->weight, vectors, most, c->count);
    }
    free(square);
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}
