/* gonio check: an instrument in words, and a picture of what it reaches. */
#include "command_line.h"
#include "instrument_words.h"
#include "json_output.h"
#include "reach_figure.h"

#include <stdio.h>

typedef struct options {
    const char *output;
} options;

static int report(const tool *t, const gonio_instrument *instrument, const gonio_reach *reach)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    if (tool_json) {
        return tool_print_json(t, instrument_json(view, reach));
    }
    instrument_print(tool_results(), view, reach);
    return 0;
}

static int run(tool *t, void *given)
{
    const options *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count != 1) {
        tool_refuse(t, "INSTRUMENT is needed: a file or one of the words below");
        return EXIT_USAGE;
    }
    const gonio_freedom freedom = GONIO_ALL_FREEDOM;
    gonio_instrument *instrument = NULL;
    gonio_reach reach;
    gonio_status status = gonio_instrument_read(t->context, arguments[0], &instrument);
    if (status == GONIO_OK) {
        status = gonio_instrument_survey(t->context, instrument, freedom, &reach);
    }
    if (status == GONIO_OK && o->output != NULL) {
        status = reach_figure(t->context, instrument, o->output);
    }
    const int code = status == GONIO_OK ? report(t, instrument, &reach) : tool_exit_code(status);
    gonio_instrument_free(&instrument);
    return code;
}

int cmd_check(int argc, const char **argv)
{
    options o = {0};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "Draw what the instrument reaches in this folder: reach.svg, .pdf and .png", "DIR"},
        TOOL_OPTIONS};
    char words[512];
    size_t used = (size_t)snprintf(words, sizeof words, "Instruments that come with gonio:\n");
    for (int k = 0; gonio_instrument_word(k) != NULL && used < sizeof words; k++) {
        used += (size_t)snprintf(words + used, sizeof words - used, "  %-12s %s\n",
                                 gonio_instrument_word(k), gonio_instrument_summary(k));
    }
    snprintf(words + used, used < sizeof words ? sizeof words - used : 0,
             "Example: gonio check rig.json -o picture");
    const tool_command_line line = {.table = table,
                                    .usage = "[OPTION...] INSTRUMENT",
                                    .text = words,
                                    .work = run,
                                    .options = &o};
    return tool_run(argc, argv, &line);
}
