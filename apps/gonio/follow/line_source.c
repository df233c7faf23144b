/* Lines of a file that grows: see line_source.h. */
#include "line_source.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PIECE = 1 << 16 };

void line_source_begin(line_source *s, const char *path)
{
    *s = (line_source){.path = path, .descriptor = -1};
}

static bool is_standard_input(const line_source *s)
{
    return strcmp(s->path, "-") == 0;
}

void line_source_end(line_source *s)
{
    if (s->descriptor >= 0 && !is_standard_input(s)) {
        close(s->descriptor);
    }
    free(s->text);
    *s = (line_source){.descriptor = -1};
}

/* Opens the file once it is there. A pipe is opened without waiting for its writer. */
static bool open_source(line_source *s)
{
    if (s->descriptor < 0) {
        s->descriptor =
            is_standard_input(s) ? STDIN_FILENO : open(s->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    }
    return s->descriptor >= 0;
}

static void begin_again(line_source *s)
{
    close(s->descriptor);
    s->descriptor = -1;
    s->offset = 0;
    s->size = 0;
    s->at = 0;
    s->line = 0;
    s->renewed = true;
}

/* Whether the file is another one now, or shorter than what was read of it. */
static bool is_replaced(const line_source *s)
{
    struct stat here;
    struct stat named;
    if (is_standard_input(s) || fstat(s->descriptor, &here) != 0 || !S_ISREG(here.st_mode)) {
        return false;
    }
    const bool other =
        stat(s->path, &named) == 0 && (named.st_ino != here.st_ino || named.st_dev != here.st_dev);
    return other || here.st_size < s->offset;
}

/* Drops what was handed out. */
static void compact(line_source *s)
{
    if (s->at > 0) {
        memmove(s->text, s->text + s->at, s->size - s->at);
        s->size -= s->at;
        s->at = 0;
    }
}

static bool make_room(line_source *s)
{
    if (s->room - s->size > PIECE) {
        return true;
    }
    char *more = realloc(s->text, s->size + 2 * PIECE);
    s->text = more != NULL ? more : s->text;
    s->room = more != NULL ? s->size + 2 * PIECE : s->room;
    return more != NULL;
}

static bool is_readable(const line_source *s)
{
    struct pollfd wait = {.fd = s->descriptor, .events = POLLIN};
    return !is_standard_input(s) || poll(&wait, 1, 0) > 0;
}

line_state line_source_read(line_source *s)
{
    if (!open_source(s)) {
        return errno == ENOENT ? LINE_NONE : LINE_FAILED;
    }
    if (is_replaced(s)) {
        begin_again(s);
        return line_source_read(s);
    }
    compact(s);
    const size_t before = s->size;
    while (is_readable(s)) {
        const ssize_t got = make_room(s) ? read(s->descriptor, s->text + s->size, PIECE) : -1;
        if (got < 0) {
            return errno == EAGAIN || errno == EINTR ? LINE_NONE : LINE_FAILED;
        }
        s->ended = got == 0 && is_standard_input(s);
        if (got == 0) {
            break;
        }
        s->size += (size_t)got;
        s->offset += got;
    }
    return s->size > before ? LINE_READY : LINE_NONE;
}

char *line_source_next(line_source *s)
{
    char *line = s->text + s->at;
    char *end = s->size > s->at ? memchr(line, '\n', s->size - s->at) : NULL;
    if (end == NULL) {
        return NULL;
    }
    *end = '\0';
    if (end > line && end[-1] == '\r') {
        end[-1] = '\0';
    }
    s->at = (size_t)(end + 1 - s->text);
    s->line++;
    return line;
}

size_t line_source_pending(const line_source *s)
{
    return s->size - s->at;
}
