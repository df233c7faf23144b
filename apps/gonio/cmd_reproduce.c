/* gonio reproduce: the paper's experiments on the user's database. */
#include "command_line.h"
#include "group_command.h"
#include "json_output.h"
#include "material_list.h"

#include <stdio.h>

#include "reproduce.h"

typedef struct options {
    const char *output;
    const char *splits;
    const char *only;
    long seed;
    int quick;
    int skip_bad;
} options;

/* Reports the results. */
static int report(const tool *t, const options *o, size_t materials)
{
    if (tool_json) {
        return tool_print_json(t, json_pack("{s:s, s:s+, s:s+, s:I}", "folder", o->output, "report",
                                            o->output, "/report.md", "results", o->output,
                                            "/results.json", "materials", (json_int_t)materials));
    }
    if (!tool_quiet) {
        printf("%s: see report.md, figures, tables and results.json in it\n", o->output);
    }
    return 0;
}

static int reproduce(const tool *t, const options *o, const material_list *list,
                     const process_group *group)
{
    const gonio_reproduce_options how = {.splits = o->splits,
                                         .seed = (uint64_t)o->seed,
                                         .quick = o->quick != 0,
                                         .only = o->only,
                                         .skip_bad = o->skip_bad != 0,
                                         .group = group};
    const gonio_status status =
        gonio_reproduce(t->context, (const char *const *)list->path, list->count, o->output, &how);
    if (status != GONIO_OK) {
        return tool_exit_code(status);
    }
    return group->rank == 0 ? report(t, o, list->count) : 0;
}

static bool check(const tool *t, const options *o)
{
    if (!tool_check_count(t, "--seed", o->seed, 0)) {
        return false;
    }
    return (o->output != NULL && *o->output != '\0') || tool_refuse(t, "no output: give -o FOLDER");
}

/* Runs the experiments on the given materials, by default the built-in ones. */
static int run(tool *t, const void *given, const process_group *group)
{
    const options *o = given;
    static const char *const built_in[] = {"atlas:"};
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (!check(t, o)) {
        return EXIT_USAGE;
    }
    material_list list = {0};
    int code = count > 0 ? material_list_add_all(t, &list, arguments, count)
                         : material_list_add_all(t, &list, built_in, 1);
    if (code == 0) {
        code = reproduce(t, o, &list, group);
    }
    material_list_free(&list);
    return code;
}

int cmd_reproduce(int argc, const char **argv)
{
    options o = {.output = NULL};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "The folder to write: a new one, or one to resume", "OUT"},
        {"quick", '\0', POPT_ARG_NONE, &o.quick, 0,
         "Fewer splits and plans: about a minute for 100 materials", NULL},
        {"only", '\0', POPT_ARG_STRING, &o.only, 0,
         "Run only these: fig2a, fig2b, fig3a, fig3b, fig4, fig5, fig6, fig7", "NAME[,NAME...]"},
        {"splits", '\0', POPT_ARG_STRING, &o.splits, 0,
         "Take the splits from this JSON file instead of random ones", "FILE"},
        {"seed", '\0', POPT_ARG_LONG, &o.seed, 0, "Seed of random splits and plans (default: 0)",
         "N"},
        {"skip-bad", '\0', POPT_ARG_NONE, &o.skip_bad, 0, "Leave out materials that cannot be used",
         NULL},
        TOOL_OPTIONS};
    tool_group_work work = {run, &o};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] [DIR|FILE...] -o OUT",
        .text = "Runs the experiments of Ali et al. and compares the results with the paper's: "
                "OUT/report.md, figures, tables.\nDIR stands for its *.binary and *.h5 "
                "files. Without DIR the built-in materials are used.\nA run that was "
                "stopped resumes when the command is given again. With mpirun several "
                "machines share\nthe work. Example: gonio reproduce merl -o paper",
        .work = tool_run_in_group,
        .options = &work};
    return tool_run(argc, argv, &line);
}
