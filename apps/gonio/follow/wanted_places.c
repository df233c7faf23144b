/* Wanted directions by their polar angles: see wanted_places.h. */
#include "wanted_places.h"

#include <stdlib.h>
#include <string.h>

/* Cells of a degree by a degree; angles beyond belong to the last. */
enum { SIDE = 91, CELLS = SIDE * SIDE };

static int side_of(double degrees)
{
    return degrees >= 0.0 ? degrees < SIDE - 1 ? (int)degrees : SIDE - 1 : 0;
}

static int cell_of(const double theta[2])
{
    return side_of(theta[0]) * SIDE + side_of(theta[1]);
}

bool wanted_places_make(wanted_places *p, size_t count,
                        void (*angles)(const void *user, size_t k, double theta[2]),
                        const void *user)
{
    double theta[2];
    wanted_places_free(p);
    p->first = calloc(CELLS + 2, sizeof *p->first);
    p->at = calloc(count + 1, sizeof *p->at);
    p->near = calloc(count + 1, sizeof *p->near);
    if (p->first == NULL || p->at == NULL || p->near == NULL) {
        wanted_places_free(p);
        return false;
    }
    for (size_t k = 0; k < count; k++) {
        angles(user, k, theta);
        p->first[cell_of(theta) + 2]++;
    }
    for (int c = 1; c < CELLS + 2; c++) {
        p->first[c] += p->first[c - 1];
    }
    for (size_t k = 0; k < count; k++) { /* first[c + 1] goes on to the end of its cell */
        angles(user, k, theta);
        p->at[p->first[cell_of(theta) + 1]++] = k;
    }
    p->count = count;
    return true;
}

static int compare_numbers(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a;
    const size_t y = *(const size_t *)b;
    return (x > y) - (x < y);
}

size_t wanted_places_find(wanted_places *p, double theta_i, double theta_o)
{
    const int row = side_of(theta_i);
    const int column = side_of(theta_o);
    const int left = column > 0 ? column - 1 : 0;
    const int right = column < SIDE - 1 ? column + 1 : column;
    size_t count = 0;
    for (int r = row > 0 ? row - 1 : 0; r <= row + 1 && r < SIDE && p->count > 0; r++) {
        const size_t from = p->first[r * SIDE + left];
        const size_t to = p->first[r * SIDE + right + 1];
        memcpy(p->near + count, p->at + from, (to - from) * sizeof *p->near);
        count += to - from;
    }
    qsort(p->near, count, sizeof *p->near, compare_numbers);
    return count;
}

void wanted_places_free(wanted_places *p)
{
    free(p->first);
    free(p->at);
    free(p->near);
    *p = (wanted_places){0};
}
