/* What a run asks for: see requests.h. */
#include "requests.h"

#include <stdio.h>
#include <stdlib.h>

#include "say.h"
#include "records.h"
#include "settings.h"

enum { ADAPT_EVERY = 5 }; /* readings after which the rest is planned again */

void follow_ask(follower *f, size_t wanted, const char *why)
{
    if (run_ask(&f->run, wanted)) {
        follow_record(f, "ask", "%zu", wanted);
        follow_say_repeat(f, wanted, why);
    }
}

void follow_ask_for_doubts(follower *f)
{
    for (size_t k = 0; k < f->verdict.doubts; k++) {
        const judge_doubt *doubt = &f->verdict.doubt[k];
        const run_row *row = &f->run.row[doubt->row];
        char why[128];
        snprintf(why, sizeof why, "line %zu is %.3g times what the others predict", row->line,
                 doubt->ratio);
        if (row->wanted != RUN_NOWHERE) {
            follow_ask(f, row->wanted, why);
        } else {
            follow_say(f, GONIO_MESSAGE_NOTE, "%s:%zu: %s", f->run.path, row->line, why);
        }
    }
}

void follow_adapt(follower *f)
{
    double(*degrees)[4] = NULL;
    size_t count = 0;
    char *text = NULL;
    size_t size = 0;
    if (f->status != GONIO_OK || !f->o->adapt || f->run.rows < f->adapted_at + ADAPT_EVERY) {
        return;
    }
    f->status = judge_plan(&f->judge, &f->run, &degrees, &count);
    if (f->status == GONIO_OK) {
        f->status = follow_order(f, degrees, count);
    }
    FILE *stream = f->status == GONIO_OK && count > 0 ? open_memstream(&text, &size) : NULL;
    for (size_t k = 0; stream != NULL && k < 4 * count; k++) {
        fprintf(stream, " %.9f", degrees[k / 4][k % 4]);
    }
    if (stream != NULL && fclose(stream) == 0) {
        follow_record(f, "adapt", "%s", text);
        f->status = f->status == GONIO_OK ? run_replace(&f->run, (const double(*)[4])degrees, count)
                                          : f->status;
        f->adapted_at = f->run.rows;
    }
    free(text);
    free(degrees);
}
