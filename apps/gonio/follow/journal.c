/* The journal of a run: see journal.h. */
#include "journal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { CHECK_DIGITS = 8, LEAST_LINE = CHECK_DIGITS + 3 };

struct journal {
    int descriptor;
    bool pending; /* appended, but not flushed */
};

/* FNV-1a, of 32 bits. */
static uint32_t check_of(const char *text, size_t size)
{
    uint32_t hash = 2166136261U;
    for (size_t k = 0; k < size; k++) {
        hash = (hash ^ (unsigned char)text[k]) * 16777619U;
    }
    return hash;
}

static gonio_status failed(const char *path, const char *what, char **problem)
{
    const int error = errno;
    if (asprintf(problem, "%s: %s: %s", path, what, strerror(error)) < 0) {
        *problem = NULL;
    }
    return GONIO_ERROR_IO;
}

/* ---- reading ---- */

static bool is_whole(const char *line, size_t length)
{
    char check[CHECK_DIGITS + 1] = "";
    if (length < LEAST_LINE || line[CHECK_DIGITS] != ' ') {
        return false;
    }
    snprintf(check, sizeof check, "%08x",
             check_of(line + CHECK_DIGITS + 1, length - CHECK_DIGITS - 1));
    return memcmp(check, line, CHECK_DIGITS) == 0;
}

static bool is_check_digit(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
}

/* Whether a line that was not written whole can be the beginning of one. */
static bool is_begun(const char *line, size_t length)
{
    bool begun = true;
    for (size_t k = 0; k < length && begun; k++) {
        begun = k < CHECK_DIGITS    ? is_check_digit(line[k])
                : k == CHECK_DIGITS ? line[k] == ' '
                                    : (unsigned char)line[k] >= ' ';
    }
    return begun;
}

/* Whether what was read of a file is no journal, nor one that was ended in its first line. */
static bool is_foreign(const char *text, size_t size, const journal_found *found)
{
    const char *cut = text + size - found->cut;
    return found->records == 0 && (size > found->cut || !is_begun(cut, found->cut));
}

/* Hands out one line, which it changes. */
static gonio_status take_line(char *line, journal_reader reader, void *user)
{
    char *kind = line + CHECK_DIGITS + 1;
    char *text = strchr(kind, ' ');
    if (text != NULL) {
        *text++ = '\0';
    }
    return reader(user, kind, text != NULL ? text : "");
}

static gonio_status take_lines(char *text, size_t size, journal_reader reader, void *user,
                               journal_found *found)
{
    gonio_status status = GONIO_OK;
    char *line = text;
    char *end = NULL;
    while (status == GONIO_OK && (end = memchr(line, '\n', size - (size_t)(line - text))) != NULL) {
        *end = '\0';
        if (is_whole(line, (size_t)(end - line))) {
            found->records++;
            status = take_line(line, reader, user);
        } else {
            found->damaged++;
        }
        line = end + 1;
    }
    found->cut = size - (size_t)(line - text);
    return status;
}

static char *read_all(int descriptor, size_t *size)
{
    struct stat info;
    char *text = fstat(descriptor, &info) == 0 ? calloc((size_t)info.st_size + 1, 1) : NULL;
    *size = 0;
    while (text != NULL && *size < (size_t)info.st_size) {
        const ssize_t got =
            pread(descriptor, text + *size, (size_t)info.st_size - *size, (off_t)*size);
        if (got <= 0) {
            free(text);
            return NULL;
        }
        *size += (size_t)got;
    }
    return text;
}

/* Reads what is there and cuts off a last line that is not whole. */
static gonio_status take_all(const char *path, int descriptor, journal_reader reader, void *user,
                             journal_found *found, char **problem)
{
    size_t size = 0;
    char *text = read_all(descriptor, &size);
    if (text == NULL) {
        return failed(path, "cannot read", problem);
    }
    gonio_status status = take_lines(text, size, reader, user, found);
    const bool foreign = is_foreign(text, size, found);
    free(text);
    if (status == GONIO_OK && foreign) {
        if (asprintf(problem, "%s: this is not the journal of a run; give another --journal",
                     path) < 0) {
            *problem = NULL;
        }
        return GONIO_ERROR_FORMAT;
    }
    if (status == GONIO_OK && found->cut > 0 &&
        ftruncate(descriptor, (off_t)(size - found->cut)) != 0) {
        return failed(path, "cannot write", problem);
    }
    return status;
}

/* ---- opening ---- */

/* Makes sure that the name of a new file is on the disk too. */
static void flush_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash == NULL   ? strdup(".")
                   : slash == path ? strdup("/")
                                   : strndup(path, (size_t)(slash - path));
    const int descriptor = folder != NULL ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (descriptor >= 0) {
        fsync(descriptor);
        close(descriptor);
    }
    free(folder);
}

static gonio_status lock(const char *path, int descriptor, char **problem)
{
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
        return GONIO_OK;
    }
    if (errno != EWOULDBLOCK) {
        return GONIO_OK; /* a file system without locks */
    }
    if (asprintf(problem, "%s: another gonio is at this run", path) < 0) {
        *problem = NULL;
    }
    return GONIO_ERROR_IO;
}

gonio_status journal_open(const char *path, journal_reader reader, void *user, journal_found *found,
                          journal **opened, char **problem)
{
    *found = (journal_found){0};
    *problem = NULL;
    const int descriptor = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        return failed(path, "cannot write", problem);
    }
    gonio_status status = lock(path, descriptor, problem);
    if (status == GONIO_OK) {
        status = take_all(path, descriptor, reader, user, found, problem);
    }
    journal *j = status == GONIO_OK ? calloc(1, sizeof *j) : NULL;
    if (j == NULL) {
        close(descriptor);
        return status != GONIO_OK ? status : GONIO_ERROR_MEMORY;
    }
    flush_folder(path);
    j->descriptor = descriptor;
    *opened = j;
    return GONIO_OK;
}

void journal_close(journal **j)
{
    if (*j != NULL) {
        close((*j)->descriptor);
        free(*j);
        *j = NULL;
    }
}

/* ---- writing ---- */

static bool write_all(int descriptor, const char *text, size_t size)
{
    while (size > 0) {
        const ssize_t written = write(descriptor, text, size);
        if (written < 0 && errno != EINTR) {
            return false;
        }
        const size_t done = written > 0 ? (size_t)written : 0;
        text += done;
        size -= done;
    }
    return true;
}

bool journal_append(journal *j, const char *kind, const char *text)
{
    char *line = NULL;
    const int length = asprintf(&line, "00000000 %s %s\n", kind, text);
    if (length < 0) {
        errno = ENOMEM;
        return false;
    }
    const char *checked = line + CHECK_DIGITS + 1;
    char check[CHECK_DIGITS + 1];
    snprintf(check, sizeof check, "%08x", check_of(checked, (size_t)length - CHECK_DIGITS - 2));
    memcpy(line, check, CHECK_DIGITS);
    const bool written = write_all(j->descriptor, line, (size_t)length);
    free(line);
    j->pending = true;
    return written;
}

bool journal_flush(journal *j)
{
    const bool flushed = !j->pending || fdatasync(j->descriptor) == 0 || errno == EINVAL;
    j->pending = j->pending && !flushed;
    return flushed;
}
