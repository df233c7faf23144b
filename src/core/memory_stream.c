/* Streams whose text is in memory: see memory_stream.h. */
#include "memory_stream.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

typedef struct memory {
    char **text;
    size_t *size;
    size_t room; /* bytes, with the zero */
    bool failed;
} memory;

/* Room for more bytes; capacities double. */
static bool enlarge(memory *m, size_t more)
{
    size_t room = m->room;
    while (room - *m->size <= more) {
        room *= 2;
    }
    char *text = room > m->room ? realloc(*m->text, room) : *m->text;
    if (text == NULL) {
        return false;
    }
    *m->text = text;
    m->room = room;
    return true;
}

/* 0 is an error of the stream. */
static ssize_t append(void *self, const char *data, size_t size)
{
    memory *m = self;
    if (m->failed || !enlarge(m, size)) {
        m->failed = true;
        return 0;
    }
    memcpy(*m->text + *m->size, data, size);
    *m->size += size;
    (*m->text)[*m->size] = '\0';
    return (ssize_t)size;
}

static int finish(void *self)
{
    memory *m = self;
    const int code = m->failed ? EOF : 0;
    free(m);
    return code;
}

FILE *gonio_i_memory_stream(char **text, size_t *size)
{
    enum { FIRST_ROOM = 256 };
    memory *m = malloc(sizeof *m);
    *text = malloc(FIRST_ROOM);
    *size = 0;
    FILE *stream = NULL;
    if (m != NULL && *text != NULL) {
        **text = '\0';
        *m = (memory){.text = text, .size = size, .room = FIRST_ROOM};
        stream = fopencookie(m, "w", (cookie_io_functions_t){.write = append, .close = finish});
    }
    if (stream == NULL) {
        free(m);
        free(*text);
        *text = NULL;
    }
    return stream;
}
