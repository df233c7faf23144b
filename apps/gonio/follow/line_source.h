/* Lines of a file that grows, or of standard input. A last line without an end is held back until
 * its end comes: it may be half of one. */
#ifndef GONIO_FOLLOW_LINE_SOURCE_H
#define GONIO_FOLLOW_LINE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

typedef struct line_source {
    const char *path; /* "-": standard input */
    int descriptor;   /* -1: the file is not there yet */
    off_t offset;     /* bytes read so far */
    char *text;       /* [size]: what is read; handed out up to `at` */
    size_t size;
    size_t at;
    size_t room;
    size_t line;  /* number of the line handed out last */
    bool ended;   /* standard input ended */
    bool renewed; /* the file became shorter and is read from its beginning: set once each time */
} line_source;

void line_source_begin(line_source *s, const char *path);
void line_source_end(line_source *s);

typedef enum line_state {
    LINE_READY,
    LINE_NONE,   /* nothing new now */
    LINE_FAILED, /* errno */
} line_state;

/* Reads what is new, without waiting. */
line_state line_source_read(line_source *s);

/* The next whole line, without its end, or NULL. Valid until more is read. */
char *line_source_next(line_source *s);

/* Bytes of a line whose end has not come. */
size_t line_source_pending(const line_source *s);

#endif
