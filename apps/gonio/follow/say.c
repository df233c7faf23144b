/* Messages of a run: see say.h. */
#include "say.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

void follow_say(follower *f, gonio_message_level level, const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&text, format, arguments) >= 0) {
        tool_say(&f->t->messages, level, text);
        free(text);
    }
    va_end(arguments);
}

gonio_status follow_fail(follower *f, gonio_status status, const char *path, const char *text)
{
    follow_say(f, GONIO_MESSAGE_ERROR, "%s: %s", path, text);
    f->status = status;
    return status;
}

void follow_say_repeat(follower *f, size_t wanted, const char *why)
{
    const run_wanted *w = &f->run.wanted[wanted];
    FILE *stream = tool_json ? stderr : tool_results();
    tool_clear_progress(&f->t->messages);
    if (!tool_quiet) {
        fprintf(stream, "read again: theta_i %.4g, phi_i %.4g, theta_o %.4g, phi_o %.4g: %s\n",
                w->degrees[0], w->degrees[1] + 0.0, w->degrees[2], w->degrees[3] + 0.0, why);
        fflush(stream);
    }
}

/* A number for a note without its numbers, and for plurals as for one. */
static uint64_t kind_of(const char *note)
{
    uint64_t hash = 14695981039346656037U;
    for (; *note != '\0'; note++) {
        const bool plural = *note == 's' && !isalpha((unsigned char)note[1]);
        if (isalpha((unsigned char)*note) && !plural) {
            hash = (hash ^ (unsigned char)*note) * 1099511628211U;
        }
    }
    return hash;
}

/* Whether a kind of note is new; it is not any more then. */
static bool is_new_kind(follower *f, uint64_t kind)
{
    size_t k = 0;
    while (k < f->said_count && f->said[k] != kind) {
        k++;
    }
    uint64_t *more =
        k == f->said_count ? reallocarray(f->said, f->said_count + 1, sizeof *more) : NULL;
    if (more == NULL) {
        return false;
    }
    f->said = more;
    f->said[f->said_count++] = kind;
    return true;
}

void follow_say_notes(follower *f, const gonio_readings_view *readings)
{
    for (size_t k = 0; k < readings->notes; k++) {
        if (is_new_kind(f, kind_of(readings->note[k]))) {
            follow_say(f, GONIO_MESSAGE_NOTE, "%s: %s", f->run.path, readings->note[k]);
        }
    }
}
