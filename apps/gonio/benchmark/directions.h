/* Ways to choose the directions that are read: one list. */
#ifndef GONIO_BENCHMARK_DIRECTIONS_H
#define GONIO_BENCHMARK_DIRECTIONS_H

#include <jansson.h>

#include "bases.h"
#include "sample.h"

/* What directions are chosen for. */
typedef struct benchmark_choosing {
    const benchmark_setting *setting;
    const benchmark_sample *sample;
    benchmark_bases *bases;
    const json_t *plan; /* of tables, by benchmark_plan; NULL: plan for the sample alone */
    size_t draw;        /* of directions that are drawn */
} benchmark_choosing;

typedef struct benchmark_directions {
    const char *name;
    const char *summary;
    const char *plan_method; /* whose plans it takes; NULL: none */
    bool own_methods;        /* a published method, completed by its own reconstruction alone */
    bool drawn;              /* differs from draw to draw */
    bool on_the_way;         /* chosen by what was read */
    size_t repeats;          /* readings beyond n, of directions that were read before */
    /* Makes the first n + repeats of `chosen` the directions of n; there may be more. It holds
     * those of the next smaller n before, or none. Leaves fewer where there are not so many.
     * Errors: those of planning and reading. */
    gonio_status (*choose)(gonio_context *context, const benchmark_choosing *with, size_t n,
                           benchmark_pairs *chosen);
} benchmark_directions;

/* The ways at a place of the list; NULL past the last. By name: -1 if there is none. */
const benchmark_directions *benchmark_directions_at(int index);
int benchmark_directions_find(const char *name);

/* Plans for tables, which do not depend on what is read: [[theta_i, phi_i, theta_o, phi_o], ...]
 * for the largest n, or of published methods {"n": [...], ...}. */
gonio_status benchmark_plan(gonio_context *context, const benchmark_setting *setting,
                            benchmark_bases *bases, const benchmark_directions *ways,
                            const benchmark_pairs *candidates, json_t **plan);

/* Whether JSON from a file has the form of such a plan. If not, complaint[size] says so. */
bool benchmark_plan_accept(const benchmark_directions *ways, const json_t *plan, char *complaint,
                           size_t size);

#endif
