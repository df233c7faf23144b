/* What the sections of the benchmark share: time, results, materials, bases and processes. Any
 * failure ends the program with a message. */
#ifndef GONIO_BENCH_H
#define GONIO_BENCH_H

#include <gonio/gonio.h>

#include <stdio.h>
#include <stdlib.h>

#include <jansson.h>
#include <sys/resource.h>

enum { RUNS = 5, BASIS_MATERIALS = 80, TABLES = 100 };

typedef struct bench {
    json_t *results;
    char **paths; /* of the materials */
    size_t count;
    int processors;
} bench;

/* Seconds of a clock that only goes forward. */
double now(void);

/* Ends the program unless `fine`. Inline, so that static analysis sees it. */
static inline void check(bool fine, const char *what)
{
    if (!fine) {
        fprintf(stderr, "gonio-bench: %s failed\n", what);
        exit(1);
    }
}

/* Sorts the values. */
double median(double *values, size_t count);

/* The slope of log y against log x, by least squares. */
double exponent(const double *x, const double *y, size_t count);

/* One line of the table and of the JSON. */
void report(bench *b, const char *name, double value, const char *unit);

/* 0 threads: one for each processor. */
gonio_context *make_context(int threads);

/* ---- materials and bases ---- */

/* Lists the materials of a folder, or the built-in ones if it is NULL. */
void find_materials(bench *b, const char *folder);

/* Whether the first TABLES materials are MERL tables. */
bool are_tables(const bench *b);

/* recipe: NULL for the default. */
gonio_basis *learn(gonio_context *context, char *const *paths, size_t count,
                   const gonio_recipe *recipe);

/* By the paper's recipe. */
gonio_basis *learn_paper(gonio_context *context, char *const *paths, size_t count,
                         size_t components);

/* ---- folders and processes ---- */

/* A new folder for temporary files; released with free() after rmdir(). */
char *scratch_folder(void);

/* Wall-clock seconds of a program that writes to /dev/null, and what it used. */
double run_seconds(const char *program, char *const *argv, struct rusage *usage);

/* Seconds for a shell command, with `folder` as its working directory. */
double command_seconds(const char *folder, const char *command);

/* `cat` of TABLES tables to /dev/null. */
double cat_seconds(char *const *tables);

/* ---- sections ---- */

/* The benchmark starts itself with these first arguments to learn or to plan in a process of its
 * own, whose peak memory is that of the task alone. */
extern const char learn_child[];
extern const char plan_child[];

int learn_as_child(char *const *arguments, size_t count);
int plan_as_child(char *const *arguments, size_t count);

void bench_learn(bench *b);
void bench_plan(bench *b);
void bench_starts(bench *b);
void bench_full_plans(bench *b);
void bench_growth(bench *b);
void bench_reconstruct(bench *b);
void bench_default(bench *b);
void bench_instrument(bench *b);

#endif
