/* Output files that appear whole or not at all: see output.h. */
#include "output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static gonio_status cannot_write(gonio_context *context, const char *path)
{
    return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot write: %s", path, strerror(errno));
}

/* ---- the file that is written ---- */

enum { ATTEMPTS = 100, MOST_NAME = 200 /* bytes of the target's name that are kept */ };

/* The bytes of a path up to its last slash, and that. */
static int folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? (int)(slash + 1 - path) : 0;
}

/* The name of a new file beside the target; NULL when out of memory. */
static char *name_beside(const char *path, int attempt)
{
    const int folder = folder_length(path);
    return gonio_i_format("%.*s%.*s.%ld-%d.part", folder, path, MOST_NAME, path + folder,
                          (long)getpid(), attempt);
}

/* A new file beside the target, with a name of its own. */
static int create_beside(const char *path, char **temporary)
{
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        char *name = name_beside(path, attempt);
        if (name == NULL) {
            errno = ENOMEM;
            return -1;
        }
        const int descriptor = open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            *temporary = name;
            return descriptor;
        }
        free(name);
        if (errno != EEXIST) {
            return -1;
        }
    }
    return -1;
}

/* A new file in the target's folder without a name, of which a kill leaves nothing; -1 where the
 * file system or the kernel has none. */
static int create_without_name(const char *path)
{
#if defined(__linux__) && defined(O_TMPFILE)
    const int length = folder_length(path);
    char *folder = length > 0 ? gonio_i_format("%.*s", length, path) : strdup(".");
    const int descriptor = folder != NULL && access("/proc/self/fd", X_OK) == 0
                               ? open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666)
                               : -1;
    free(folder);
    return descriptor;
#else
    (void)path;
    return -1;
#endif
}

/* Gives a file without a name one beside its target. */
static bool give_name(gonio_i_output *output)
{
    char open_file[64];
    snprintf(open_file, sizeof open_file, "/proc/self/fd/%d", output->descriptor);
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        char *name = name_beside(output->path, attempt);
        if (name == NULL) {
            errno = ENOMEM;
            return false;
        }
        if (linkat(AT_FDCWD, open_file, AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0) {
            output->temporary = name;
            output->nameless = false;
            return true;
        }
        free(name);
        if (errno != EEXIST) {
            return false;
        }
    }
    return false;
}

static void create_file(gonio_i_output *output)
{
    output->descriptor = create_without_name(output->path);
    output->nameless = output->descriptor >= 0;
    if (!output->nameless) {
        output->descriptor = create_beside(output->path, &output->temporary);
    }
}

/* Whether a new file is written, not standard output, a device or a pipe. */
static bool is_new_file(const gonio_i_output *output)
{
    return output->temporary != NULL || output->nameless;
}

/* ---- the target ---- */

/* Standard output goes where the shell sent it, also if that is a file with other things in it. */
static bool is_standard_output(const char *path)
{
    static const char *const names[] = {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"};
    bool is = false;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        is = is || strcmp(path, names[k]) == 0;
    }
    return is;
}

/* Whether writers must not seek in the open file. It may be a pipe, or standard output may be a
 * file that has contents already. Devices like /dev/null accept any offset. */
static bool is_sequential(int descriptor)
{
    struct stat status;
    return lseek(descriptor, 0, SEEK_CUR) < 0 ||
           (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode));
}

/* A temporary file without a name; -1 if it cannot be created. */
static int create_nameless(void)
{
    FILE *stream = tmpfile();
    const int descriptor = stream != NULL ? fcntl(fileno(stream), F_DUPFD_CLOEXEC, 0) : -1;
    if (stream != NULL) {
        fclose(stream);
    }
    return descriptor;
}

/* Opens standard output, a device or a pipe. */
static void open_special(const char *path, gonio_i_output *output)
{
    output->descriptor = is_standard_output(path) ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                                                  : open(path, O_WRONLY | O_CLOEXEC);
    if (output->descriptor >= 0 && is_sequential(output->descriptor)) {
        output->final = output->descriptor;
        output->descriptor = create_nameless();
    }
}

/* What a link points to that may not be there; NULL when out of memory. */
static char *follow(const char *path)
{
    enum { MOST_LINKS = 40, LONGEST = 4096 };
    char *at = strdup(path);
    for (int k = 0; k < MOST_LINKS && at != NULL; k++) {
        char link[LONGEST];
        const ssize_t length = readlink(at, link, sizeof link - 1);
        if (length < 0) {
            break;
        }
        link[length] = '\0';
        char *next =
            link[0] == '/' ? strdup(link) : gonio_i_format("%.*s%s", folder_length(at), at, link);
        free(at);
        at = next;
    }
    return at;
}

static gonio_status open_target(gonio_context *context, const char *path, gonio_i_output *output)
{
    struct stat status;
    const bool standard = is_standard_output(path);
    const bool exists = !standard && stat(path, &status) == 0;
    const bool special = standard || (exists && !S_ISREG(status.st_mode)); /* a device or a pipe */
    char *resolved = special ? strdup(path) : exists ? realpath(path, NULL) : follow(path);
    *output = (gonio_i_output){.path = resolved, .descriptor = -1, .final = -1};
    if (resolved == NULL) {
        return cannot_write(context, path);
    }
    if (exists && S_ISDIR(status.st_mode)) {
        errno = EISDIR;
        return cannot_write(context, path);
    }
    if (exists && access(path, W_OK) != 0) {
        return cannot_write(context, path);
    }
    if (special) {
        open_special(path, output);
    } else {
        create_file(output);
    }
    if (output->descriptor < 0) {
        return cannot_write(context, path);
    }
    if (exists && !special) { /* a file that is replaced keeps who may read it */
        (void)fchmod(output->descriptor, status.st_mode & 0777);
    }
    return GONIO_OK;
}

gonio_status gonio_i_output_open(gonio_context *context, const char *path, gonio_i_output *output)
{
    const gonio_status status = open_target(context, path, output);
    if (status != GONIO_OK) {
        if (output->final >= 0) {
            close(output->final);
        }
        free(output->path);
        *output = (gonio_i_output){.descriptor = -1, .final = -1};
    }
    return status;
}

static gonio_status write_all(gonio_context *context, const gonio_i_output *output, int descriptor,
                              const void *data, size_t size)
{
    const char *from = data;
    while (size > 0) {
        const ssize_t written = write(descriptor, from, size);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written < 0) {
            return cannot_write(context, output->path);
        }
        from += written;
        size -= (size_t)written;
    }
    return GONIO_OK;
}

gonio_status gonio_i_output_write(gonio_context *context, gonio_i_output *output, const void *data,
                                  size_t size)
{
    return write_all(context, output, output->descriptor, data, size);
}

gonio_status gonio_i_output_write_at(gonio_context *context, gonio_i_output *output,
                                     const void *data, size_t size, off_t offset)
{
    const char *from = data;
    while (size > 0) {
        const ssize_t written = pwrite(output->descriptor, from, size, offset);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written < 0) {
            return cannot_write(context, output->path);
        }
        from += written;
        offset += written;
        size -= (size_t)written;
    }
    return GONIO_OK;
}

/* A file system that does not support this is no error; other errors show when writing. */
gonio_status gonio_i_output_reserve(gonio_context *context, gonio_i_output *output, off_t size)
{
#ifdef __linux__
    int result = 0;
    do {
        result = is_new_file(output) ? fallocate(output->descriptor, 0, 0, size) : 0;
    } while (result != 0 && errno == EINTR);
    if (result != 0 && (errno == ENOSPC || errno == EFBIG || errno == EDQUOT || errno == EIO)) {
        return cannot_write(context, output->path);
    }
#else
    (void)context;
    (void)output;
    (void)size;
#endif
    return GONIO_OK;
}

void gonio_i_output_start_flush(const gonio_i_output *output, off_t offset, off_t size)
{
#ifdef __linux__
    if (is_new_file(output)) {
        (void)sync_file_range(output->descriptor, offset, size, SYNC_FILE_RANGE_WRITE);
    }
#else
    (void)output;
    (void)offset;
    (void)size;
#endif
}

gonio_status gonio_i_output_flush(gonio_context *context, gonio_i_output *output)
{
    if (is_new_file(output) && !output->flushed && fsync(output->descriptor) != 0) {
        return cannot_write(context, output->path);
    }
    output->flushed = true;
    return GONIO_OK;
}

/* Copies the finished nameless file to its target. */
static gonio_status copy_to_final(gonio_context *context, gonio_i_output *output)
{
    char block[1 << 16];
    gonio_status status = GONIO_OK;
    off_t offset = 0;
    ssize_t got = 1;
    while (got > 0 && status == GONIO_OK) {
        got = pread(output->descriptor, block, sizeof block, offset);
        if (got < 0 && errno == EINTR) {
            got = 1;
            continue;
        }
        status = got < 0 ? cannot_write(context, output->path)
                         : write_all(context, output, output->final, block, (size_t)got);
        offset += got;
    }
    return status;
}

/* Flushes to disk before the rename, so that a crash cannot leave an empty file under the name. */
static gonio_status put_in_place(gonio_context *context, gonio_i_output *output)
{
    const gonio_status status =
        output->final >= 0 ? copy_to_final(context, output) : gonio_i_output_flush(context, output);
    if (status != GONIO_OK) {
        return status;
    }
    if ((output->nameless && !give_name(output)) ||
        (output->temporary != NULL && rename(output->temporary, output->path) != 0)) {
        return cannot_write(context, output->path);
    }
    return GONIO_OK;
}

/* Puts a file in place, or removes it after a failure. */
static gonio_status settle(gonio_context *context, gonio_i_output *output, gonio_status status)
{
    if (status == GONIO_OK) {
        status = put_in_place(context, output);
    }
    if (output->descriptor >= 0 && close(output->descriptor) != 0 && status == GONIO_OK) {
        status = cannot_write(context, output->path);
    }
    if (output->final >= 0 && close(output->final) != 0 && status == GONIO_OK) {
        status = cannot_write(context, output->path);
    }
    if (status != GONIO_OK && output->temporary != NULL) {
        unlink(output->temporary);
    }
    free(output->temporary);
    free(output->path);
    *output = (gonio_i_output){.descriptor = -1, .final = -1};
    return status;
}

/* ---- several that appear together ---- */

/* Outputs that are finished and wait for others. */
struct gonio_i_held {
    size_t count;
    gonio_i_output *output;
};

gonio_status gonio_outputs_hold(gonio_context *context)
{
    struct gonio_i_held **held = gonio_i_held_of(context);
    if (held == NULL || *held != NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            held == NULL ? "outputs are held under a context"
                                         : "outputs are held already");
    }
    *held = gonio_i_allocate(context, 1, sizeof **held);
    return *held != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

gonio_status gonio_outputs_release(gonio_context *context, gonio_status status)
{
    struct gonio_i_held **held = gonio_i_held_of(context);
    if (held == NULL || *held == NULL) {
        return status;
    }
    for (size_t k = 0; k < (*held)->count; k++) {
        status = settle(context, &(*held)->output[k], status);
    }
    free((*held)->output);
    free(*held);
    *held = NULL;
    return status;
}

/* Keeps a finished output until the others are; true if it need not be settled now. */
static bool hold(gonio_context *context, gonio_i_output *output, gonio_status *status)
{
    struct gonio_i_held **held = gonio_i_held_of(context);
    if (held == NULL || *held == NULL || *status != GONIO_OK) {
        return false;
    }
    *status = output->final >= 0 ? GONIO_OK : gonio_i_output_flush(context, output);
    gonio_i_output *more = *status == GONIO_OK ? reallocarray((*held)->output, (*held)->count + 1,
                                                              sizeof *(*held)->output)
                                               : NULL;
    if (more == NULL) {
        *status = *status != GONIO_OK ? *status
                                      : gonio_i_fail(context, GONIO_ERROR_MEMORY,
                                                     "%s: out of memory", output->path);
        return false;
    }
    (*held)->output = more;
    more[(*held)->count++] = *output;
    *output = (gonio_i_output){.descriptor = -1, .final = -1};
    return true;
}

gonio_status gonio_i_output_close(gonio_context *context, gonio_i_output *output,
                                  gonio_status status)
{
    bool held = false;
#pragma omp critical(gonio_held_outputs)
    held = hold(context, output, &status);
    return held ? GONIO_OK : settle(context, output, status);
}
