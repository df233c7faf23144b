/* One plan, timed. */
#ifndef GONIO_BENCH_PLAN_H
#define GONIO_BENCH_PLAN_H

#include "bench.h"

typedef struct planned {
    double seconds;
    double tests;
    double condition_number;
} planned;

/* By condition number: `restarts` starts of a kind. */
planned plan_once(const gonio_basis *basis, gonio_context *context, size_t k, size_t n,
                  uint64_t seed, int restarts, const char *start);

#endif
