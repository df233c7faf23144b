/* The bases that a lesson teaches: one for each kind that methods are meant for. */
#ifndef GONIO_BENCHMARK_BASES_H
#define GONIO_BENCHMARK_BASES_H

#include "lessons.h"

/* The bases of one lesson, one for each kind that methods are meant for, learned when asked for. */
typedef struct benchmark_bases {
    const benchmark_lesson *lesson;
    size_t most; /* components of bases of the full grid: the largest n */
    gonio_basis *basis[BENCHMARK_MOST_WORDS];
    gonio_plan_basis kind[BENCHMARK_MOST_WORDS];
    size_t count;
} benchmark_bases;

/* The basis of the kind that a planning method (gonio_plan_method_name) is meant for; it belongs to
 * `bases`. Threads may call it at the same time. Errors: those of gonio_learn and gonio_basis_read;
 * _MISMATCH if a basis was given that is of another kind. */
gonio_status benchmark_basis(gonio_context *context, benchmark_bases *bases, const char *method,
                             const gonio_basis **basis);
void benchmark_bases_free(benchmark_bases *bases);

/* Whether a basis file is of the kind of each of the planning methods, method[count]. The file is
 * read once. Errors: those of gonio_basis_read; _MISMATCH. */
gonio_status benchmark_check_basis(gonio_context *context, const char *path,
                                   const char *const *method, size_t count);

#endif
