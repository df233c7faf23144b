/* A text file, read whole: see text_file.h. */
#include "text_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "gzip.h"

enum { MOST_BYTES = 1 << 30, LEAST_ROOM = 1 << 16 };

/* The size of a regular file and one more byte, which detects its end; a guess for other files. */
static size_t first_room(int descriptor)
{
    struct stat info;
    const bool known =
        fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) && info.st_size < MOST_BYTES;
    return known && info.st_size >= LEAST_ROOM ? (size_t)info.st_size + 1 : LEAST_ROOM;
}

static bool enlarge(char **text, size_t *room)
{
    *room *= 2;
    char *more = realloc(*text, *room + 1);
    *text = more != NULL ? more : *text;
    return more != NULL;
}

/* After a call that failed: GONIO_OK if a signal interrupted it that does not end the work. */
static gonio_status ask_to_go_on(gonio_context *context, const char *path)
{
    if (errno == EINTR) {
        return gonio_i_progress(context, "reading", 0.0);
    }
    return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
}

/* Opens a file; a pipe's writer is waited for. */
static gonio_status open_to_read(gonio_context *context, const char *path, int *descriptor)
{
    gonio_status status = GONIO_OK;
    *descriptor = open(path, O_RDONLY | O_CLOEXEC);
    while (*descriptor < 0 && status == GONIO_OK) {
        status = ask_to_go_on(context, path);
        *descriptor = status == GONIO_OK ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    }
    return status;
}

/* Reads to the end. The caller owns the text, after an error too. */
static gonio_status read_descriptor(gonio_context *context, const char *path, int descriptor,
                                    char **text, size_t *size)
{
    size_t room = first_room(descriptor);
    *text = malloc(room + 1);
    while (*text != NULL) {
        const ssize_t got = read(descriptor, *text + *size, room - *size);
        if (got < 0) {
            const gonio_status status = ask_to_go_on(context, path);
            if (status != GONIO_OK) {
                return status;
            }
            continue;
        }
        if (got == 0) {
            (*text)[*size] = '\0';
            return GONIO_OK;
        }
        *size += (size_t)got;
        if (*size >= MOST_BYTES) {
            return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                                "%s: more than 1 GiB; this is not a table of readings", path);
        }
        if (*size == room && !enlarge(text, &room)) {
            break;
        }
    }
    return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
}

/* Replaces the text of a gzip file by the decompressed text. */
static gonio_status decompress(gonio_context *context, const char *path, char **text, size_t *size)
{
    char *plain = NULL;
    const gonio_status status =
        gonio_i_gzip_text(context, path, *text, *size, MOST_BYTES, &plain, size);
    free(*text);
    *text = plain;
    return status;
}

gonio_status gonio_i_text_read(gonio_context *context, const char *path, char **text, size_t *size)
{
    *text = NULL;
    *size = 0;
    int descriptor = -1;
    gonio_status status = open_to_read(context, path, &descriptor);
    if (status != GONIO_OK) {
        return status;
    }
    status = read_descriptor(context, path, descriptor, text, size);
    close(descriptor);
    if (status == GONIO_OK && gonio_i_gzip_begins(*text, *size)) {
        status = decompress(context, path, text, size);
    }
    if (status != GONIO_OK) {
        free(*text);
        *text = NULL;
    }
    return status;
}
