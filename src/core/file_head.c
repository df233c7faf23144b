/* The beginning of a file: see file_head.h. */
#include "file_head.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "gzip.h"

/* Replaces the head of a text compressed with gzip by the text's beginning. Other content stays. */
static void decompress_head(gonio_i_file *file)
{
    char text[GONIO_I_HEAD];
    if (!gonio_i_gzip_begins(file->head, file->head_size)) {
        return;
    }
    const size_t size = gonio_i_gzip_head(file->head, file->head_size, text, sizeof text);
    if (size > 0 && memchr(text, '\0', size) == NULL) {
        memcpy(file->head, text, size);
        file->head_size = size;
    }
}

gonio_status gonio_i_file_look(gonio_context *context, const char *path, gonio_i_file *file)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) { /* a pipe cannot be read in any order */
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path,
                            S_ISDIR(status.st_mode) ? strerror(EISDIR) : "not a regular file");
    }
    FILE *stream = fopen(path, "rbe");
    if (stream == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    }
    file->path = path;
    file->size = (uint64_t)status.st_size;
    file->head_size = fread(file->head, 1, GONIO_I_HEAD, stream);
    fclose(stream);
    decompress_head(file);
    file->head[file->head_size] = '\0';
    return GONIO_OK;
}

bool gonio_i_file_begins(const gonio_i_file *file, const char *bytes, size_t size)
{
    return file->head_size >= size && memcmp(file->head, bytes, size) == 0;
}

const char *gonio_i_first_line(const char *text, size_t size, size_t *length)
{
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    if (memchr(text, '\0', size) != NULL) {
        return NULL;
    }
    text += strncmp(text, byte_order_mark, 3) == 0 ? 3 : 0;
    text += strspn(text, " \t\r\n");
    while (*text == '#') {
        text += strcspn(text, "\n");
        text += strspn(text, " \t\r\n");
    }
    *length = strcspn(text, "\r\n");
    return text;
}
