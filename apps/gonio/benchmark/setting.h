/* The setting of a benchmark: what is read, how often, and by what it is completed. */
#ifndef GONIO_BENCHMARK_SETTING_H
#define GONIO_BENCHMARK_SETTING_H

#include <gonio/gonio.h>

#include "run/process_group.h"

enum {
    BENCHMARK_MOST_SIZES = 32,
    BENCHMARK_MOST_WORDS = 16,
    BENCHMARK_FIRST = 10 /* readings that are planned before, where more are chosen on the way */
};

typedef struct benchmark_setting {
    const char *basis;        /* a basis file; NULL: learn */
    const char *const *learn; /* [learn_count] materials to learn from; none: leave out by turns */
    size_t learn_count;
    const char *builtin; /* basis file for scattered readings, where materials are left out by
                          * turns; may be NULL if there are none */
    const char *splits;  /* a file of splits (reproduce.h); NULL: folds */
    size_t folds;        /* parts of a set of tables, each tested by what the others teach */
    size_t size[BENCHMARK_MOST_SIZES]; /* [sizes]: n, ascending */
    size_t sizes;
    int directions[BENCHMARK_MOST_WORDS]; /* [direction_count], of directions.h */
    size_t direction_count;
    int method[BENCHMARK_MOST_WORDS]; /* [method_count], of methods.h */
    size_t method_count;
    size_t draws;         /* of directions that are drawn at random */
    size_t candidates;    /* directions that can be read of a table; 0: any, anywhere on the grid */
    double reach;         /* largest polar angle that is read and compared, radians */
    size_t channels;      /* of scattered readings at most, evenly spread; 0: all */
    size_t batch;         /* readings that are chosen at a time on the way */
    double noise;         /* of readings of tables, relative */
    double floor;         /* the same, 1/sr */
    double outliers;      /* share of the directions of tables that are read wrongly */
    bool no_bands;        /* do without stated deviations, which take time */
    bool render;          /* compare renderings of tables too, of n = 8, 16, 32 */
    const char *external; /* command of the method `external`; NULL: none */
    gonio_readings_options reading; /* of files of readings: `as` and `instrument` count */
    uint64_t instrument_hash;       /* of the instrument's file; 0: none */
    uint64_t seed;
    const process_group *group; /* NULL for a process on its own */
} benchmark_setting;

/* The n from which renderings are compared, as published comparisons do. */
enum { BENCHMARK_RENDERED_SIZES = 3 };
extern const size_t benchmark_rendered_sizes[BENCHMARK_RENDERED_SIZES];

/* The command line's defaults, without directions and methods. */
void benchmark_setting_default(benchmark_setting *setting);

/* How gonio is asked to reconstruct and to go on. */
gonio_reconstruct_options benchmark_how(const benchmark_setting *setting);

#endif
