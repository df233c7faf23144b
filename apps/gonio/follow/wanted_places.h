/* The wanted directions by their polar angles, so that those near a reading are found at once. */
#ifndef GONIO_FOLLOW_WANTED_PLACES_H
#define GONIO_FOLLOW_WANTED_PLACES_H

#include <stdbool.h>
#include <stddef.h>

/* All 0 knows no directions. */
typedef struct wanted_places {
    size_t count;  /* directions that it knows */
    size_t *first; /* [cells + 1]: where the directions of a cell begin in `at` */
    size_t *at;    /* [count]: directions by cell, ascending within it */
    size_t *near;  /* [count]: of the last search */
} wanted_places;

/* Makes it anew of the polar angles of directions, degrees: angles(user, k, theta_i_theta_o). False
 * when out of memory. */
bool wanted_places_make(wanted_places *p, size_t count,
                        void (*angles)(const void *user, size_t k, double theta[2]),
                        const void *user);

/* All directions whose polar angles are both within a degree of these, and some beyond: p->near,
 * ascending. Returns how many. */
size_t wanted_places_find(wanted_places *p, double theta_i, double theta_o);

void wanted_places_free(wanted_places *p);

#endif
