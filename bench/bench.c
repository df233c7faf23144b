/* The benchmark: how fast gonio is, as ratios to what it is compared with, timed in turn in one
 * run.
 *
 *   gonio-bench [MATERIALS] [SECTION...]     sections: learn plan starts
 *                                            reconstruct full growth default instrument
 *
 * MATERIALS is a folder of at least 81 materials (default: the built-in ones). Prints a table and
 * writes bench.json in the working directory. docs/performance.md explains each line. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "library_settings.h"

/* To add a section, write a file after default.c and add a line. */
static const struct {
    const char *name;
    void (*run)(bench *b);
} sections[] = {
    {"learn", bench_learn},     {"plan", bench_plan},
    {"starts", bench_starts},   {"reconstruct", bench_reconstruct},
    {"full", bench_full_plans}, {"growth", bench_growth},
    {"default", bench_default}, {"instrument", bench_instrument},
};

static bool wanted(const char *name, int argc, char **argv)
{
    for (int k = 2; k < argc; k++) {
        if (strcmp(argv[k], name) == 0) {
            return true;
        }
    }
    return argc <= 2;
}

int main(int argc, char **argv)
{
    library_settings_choose(argv, true);
    if (argc > 4 && strcmp(argv[1], learn_child) == 0) {
        return learn_as_child(argv + 2, (size_t)argc - 2);
    }
    if (argc == 3 && strcmp(argv[1], plan_child) == 0) {
        return plan_as_child(argv + 2, 1);
    }
    bench b = {.results = json_object(), .processors = (int)sysconf(_SC_NPROCESSORS_ONLN)};
    find_materials(&b, argc > 1 && strcmp(argv[1], "atlas:") != 0 ? argv[1] : NULL);
    printf("%zu materials, %d processors\n", b.count, b.processors);
    for (size_t k = 0; k < sizeof sections / sizeof *sections; k++) {
        if (wanted(sections[k].name, argc, argv)) {
            sections[k].run(&b);
        }
    }
    check(json_dump_file(b.results, "bench.json", JSON_INDENT(2)) == 0, "writing bench.json");
    json_decref(b.results);
    for (size_t k = 0; k < b.count; k++) {
        free(b.paths[k]);
    }
    free(b.paths);
    return 0;
}
