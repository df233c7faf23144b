/* What is learned from before which subjects are tested. */
#ifndef GONIO_BENCHMARK_LESSONS_H
#define GONIO_BENCHMARK_LESSONS_H

#include <jansson.h>

#include "setting.h"
#include "subjects.h"

/* Something to learn from, and the subjects that are tested with it. */
typedef struct benchmark_lesson {
    char *name;        /* "given", "built-in", "merl fold 3" ... */
    const char *basis; /* a basis file; NULL: */
    const char **path; /* [count] materials to learn from */
    size_t count;
    size_t *subject; /* [subjects] */
    size_t subjects;
} benchmark_lesson;

typedef struct benchmark_lessons {
    size_t count;
    benchmark_lesson *lesson;
} benchmark_lessons;

/* Chooses the lessons of a setting. What is given to learn from serves all subjects. Otherwise the
 * splits of the file or, by folds, the tables of each set by turns; scattered readings are tested
 * with the built-in basis. Paths belong to the setting and the subjects. The lessons are to be
 * freed in any case. Errors: _DATA for a set of fewer than 4 tables without anything to learn from,
 * and for splits that name others; _IO, _FORMAT (the file of splits); _MEMORY. */
gonio_status benchmark_lessons_make(gonio_context *context, const benchmark_setting *setting,
                                    const benchmark_subjects *subjects, benchmark_lessons *lessons);
void benchmark_lessons_free(benchmark_lessons *lessons);

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

/* The setting of the lessons as JSON, for the identity of a run: names and what is learned from. */
json_t *benchmark_lessons_json(const benchmark_lessons *lessons);

#endif
