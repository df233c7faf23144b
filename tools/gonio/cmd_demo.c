/* gonio demo: the whole chain on a built-in material that the basis has not seen. */
#include "tool.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { MOST_WORDS = 16 };

typedef struct step {
    const char *explanation;
    int (*run)(int argc, const char **argv);
    const char *words[MOST_WORDS]; /* the command line without "gonio"; ends with NULL */
} step;

static const char material[] = "red-glossy-plastic";

static const step steps[] = {
    {"1. Learn what materials look like, from all built-in ones but the one to be measured.",
     cmd_learn,
     {"learn", "atlas:", "--without", material, "-o", "basis.gonio"}},
    {"2. Choose the 80 readings that determine 35 components best.",
     cmd_plan,
     {"plan", "basis.gonio", "--basis", "35", "-n", "80", "-o", "plan.csv"}},
    {"3. Let a simulated instrument with 1 % noise read them.",
     cmd_measure,
     {"measure", "plan.csv", "atlas:red-glossy-plastic", "--noise", "1", "-o", "readings.csv"}},
    {"4. Turn the 80 readings into the whole BRDF: 1,096,216 directions, three channels.",
     cmd_reconstruct,
     {"reconstruct", "basis.gonio", "readings.csv", "-o", "reconstructed.binary"}},
    {"5. Compare with the truth.",
     cmd_compare,
     {"compare", "atlas:red-glossy-plastic", "reconstructed.binary", "--verbose"}},
    {"6. An instrument reads all channels of a direction at once; using them all helps.",
     cmd_reconstruct,
     {"reconstruct", "basis.gonio", "readings.csv", "--all-channels", "-o",
      "reconstructed-all.binary"}},
    {"",
     cmd_compare,
     {"compare", "atlas:red-glossy-plastic", "reconstructed.binary", "reconstructed-all.binary"}},
#ifndef GONIO_WITHOUT_RENDER
    {"7. See it: spheres in a studio, and where they differ.",
     cmd_render,
     {"render", "--compare", "atlas:red-glossy-plastic", "reconstructed.binary",
      "reconstructed-all.binary", "--labels", "original,80 readings,all channels", "--differences",
      "-o", "comparison.png"}},
#endif
};

enum { STEPS = sizeof steps / sizeof *steps };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int run_step(const step *s)
{
    int count = 0;
    if (s->explanation[0] != '\0') {
        printf("\n%s\n", s->explanation);
    }
    printf("$ gonio");
    while (s->words[count] != NULL) {
        printf(" %s", s->words[count++]);
    }
    printf("\n");
    fflush(stdout);
    /* popt wants an array that it may keep. */
    const char *words[MOST_WORDS + 1] = {0};
    memcpy(words, s->words, sizeof s->words);
    return s->run(count, words);
}

static int run(const tool *t, const char *folder)
{
    size_t count = 0;
    tool_arguments(t, &count);
    if (count > 0) {
        return tool_usage_error(t, "no arguments are needed");
    }
    if ((mkdir(folder, 0777) != 0 && errno != EEXIST) || chdir(folder) != 0) {
        fprintf(stderr, "gonio demo: %s: cannot use this folder: %s\n", folder, strerror(errno));
        return EXIT_DATA;
    }
    const double start = now();
    printf("Measuring '%s' with 80 readings. Files go to %s; type along in there.\n", material,
           folder);
    int code = 0;
    for (int k = 0; k < STEPS && code == 0; k++) {
        code = run_step(&steps[k]);
    }
    if (code == 0) {
        printf("\nDone in %.0f s. %s holds basis.gonio, plan.csv, readings.csv, the two "
               "reconstructions,\nMERL tables that renderers and BRDF viewers read, and what was "
               "drawn.\n",
               now() - start, folder);
    }
    return code;
}

int cmd_demo(int argc, const char **argv)
{
    const char *folder = "gonio-demo";
    const struct poptOption table[] = {{"output", 'o', POPT_ARG_STRING, &folder, 0,
                                        "The folder for the files (default: gonio-demo)", "DIR"},
                                       TOOL_OPTIONS};
    tool t;
    int code = tool_begin(
        &t, argc, argv, table, "[OPTION...]",
        "Learns, plans, measures, reconstructs, compares and renders, in about a minute.");
    if (code < 0) {
        code = run(&t, folder);
    }
    tool_end(&t);
    return code;
}
