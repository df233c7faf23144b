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

/* The setting of the lessons as JSON, for the identity of a run: names and what is learned from. */
json_t *benchmark_lessons_json(const benchmark_lessons *lessons);

#endif
