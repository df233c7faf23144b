/* gonio demo: all steps on a built-in material that the basis was not learned from. */
#include "command_line.h"
#include "duration.h"
#include "json_output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_WORDS = 16 };

static const char page[] = "report.html";

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
    {"2. Choose the 20 directions that leave the least expected error.",
     cmd_plan,
     {"plan", "basis.gonio", "-n", "20", "-o", "plan.csv"}},
    {"3. Let a simulated instrument with 1 % noise read them.",
     cmd_measure,
     {"measure", "plan.csv", "atlas:red-glossy-plastic", "--noise", "1", "-o", "readings.csv"}},
    {"4. Turn the 20 readings into the whole BRDF, 1,096,216 directions in three channels, and say "
     "how certain each is.",
     cmd_reconstruct,
     {"reconstruct", "basis.gonio", "readings.csv", "--deviation", "deviation.binary", "-o",
      "reconstructed.binary"}},
    {"5. Compare with the truth.",
     cmd_compare,
     {"compare", "atlas:red-glossy-plastic", "reconstructed.binary", "--verbose"}},
    {"6. Where would five more readings help most, given these?",
     cmd_next,
     {"next", "basis.gonio", "readings.csv", "-n", "5", "-o", "more.csv"}},
#ifndef GONIO_WITHOUT_RENDER
    {"7. See it: spheres in a studio, and where they differ.",
     cmd_render,
     {"render", "--compare", "atlas:red-glossy-plastic", "reconstructed.binary", "--labels",
      "original,reconstruction", "--differences", "-o", "comparison.png"}},
#endif
    {"8. Look around: a page for a browser.",
     cmd_report,
     {"report", "atlas:red-glossy-plastic", "reconstructed.binary", "--readings", "readings.csv",
      "--deviation", "deviation.binary", "-o", page}},
};

enum { STEPS = sizeof steps / sizeof *steps };

static void announce(const step *s)
{
    printf("\n%s\n$ gonio", s->explanation);
    for (int k = 0; s->words[k] != NULL; k++) {
        printf(" %s", s->words[k]);
    }
    printf("\n");
    fflush(stdout);
}

static int run_step(const step *s)
{
    int count = 0;
    while (s->words[count] != NULL) {
        count++;
    }
    /* popt keeps the array. */
    const char *words[MOST_WORDS + 1] = {0};
    memcpy(words, s->words, sizeof s->words);
    return s->run(count, words);
}

/* Runs a step and appends its command and its result as JSON, in place of printing. */
static int run_step_as_json(const step *s, json_t *done)
{
    json_t *result = NULL;
    json_t *words = json_array();
    for (int k = 0; s->words[k] != NULL; k++) {
        json_array_append_new(words, tool_json_text(s->words[k]));
    }
    tool_keep_json(&result);
    const int code = run_step(s);
    tool_keep_json(NULL);
    json_array_append_new(done, json_pack("{s:o, s:o?}", "command", words, "result", result));
    return code;
}

static void say_where_the_page_is(const char *folder)
{
    if (gonio_page_is_built()) {
        printf("Open %s/%s in a browser to see original and reconstruction.\n", folder, page);
    } else {
        printf(
            "There is no page to see it on: this gonio was built without Node.js. Install nodejs "
            "(18.19 or\nnewer) and npm and run make again.\n");
    }
}

/* Creates the folder if necessary and changes to it: the commands run there. Returns an exit code.
 */
static int enter(const char *folder)
{
    if ((mkdir(folder, 0777) != 0 && errno != EEXIST) || chdir(folder) != 0) {
        fprintf(stderr, "gonio demo: %s: cannot use this folder: %s\n", folder, strerror(errno));
        return EXIT_DATA;
    }
    return 0;
}

static int run_steps_as_json(const tool *t, const char *folder, int count)
{
    json_t *done = json_array();
    int code = 0;
    for (int k = 0; k < count && code == 0; k++) {
        code = run_step_as_json(&steps[k], done);
    }
    if (code == 0) {
        return tool_print_json(t, json_pack("{s:o, s:s, s:o}", "folder", tool_json_text(folder),
                                            "material", material, "steps", done));
    }
    json_decref(done);
    return code;
}

static int run_steps(const char *folder, int count)
{
    const double start = tool_seconds();
    int code = 0;
    printf("Measuring '%s' with 20 readings. Files go to %s; type along in there.\n", material,
           folder);
    for (int k = 0; k < count && code == 0; k++) {
        announce(&steps[k]);
        code = run_step(&steps[k]);
    }
    if (code == 0) {
        printf(
            "\nDone in %.0f s. %s holds basis.gonio, plan.csv, readings.csv, the reconstruction, a "
            "MERL table\nthat renderers and BRDF viewers read, its deviation, and what was "
            "drawn.\n",
            tool_seconds() - start, folder);
        say_where_the_page_is(folder);
    }
    return code;
}

static int run(tool *t, void *given)
{
    const char *folder = *(const char **)given;
    size_t arguments = 0;
    tool_arguments(t, &arguments);
    if (arguments > 0) {
        tool_refuse(t, "no arguments are needed");
        return EXIT_USAGE;
    }
    const int count = gonio_page_is_built() ? STEPS : STEPS - 1;
    const int code = enter(folder);
    if (code != 0) {
        return code;
    }
    return tool_json ? run_steps_as_json(t, folder, count) : run_steps(folder, count);
}

int cmd_demo(int argc, const char **argv)
{
    const char *folder = "gonio-demo";
    const struct poptOption table[] = {{"output", 'o', POPT_ARG_STRING, &folder, 0,
                                        "The folder for the files (default: gonio-demo)", "DIR"},
                                       TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...]",
        .text = "Learns, plans, measures, reconstructs, compares and renders, in about a minute, "
                "and writes a page to see it on.",
        .work = run,
        .options = (void *)&folder};
    return tool_run(argc, argv, &line);
}
