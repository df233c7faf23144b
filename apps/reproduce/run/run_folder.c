/* The folder of a long run: see run_folder.h. */
#include "run_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/output.h"
#include "core/memory_stream.h"

gonio_status gonio_i_write_text(gonio_context *context, const char *path, const char *text)
{
    gonio_i_output output;
    gonio_status status = gonio_i_output_open(context, path, &output);
    if (status != GONIO_OK) {
        return status;
    }
    status = gonio_i_output_write(context, &output, text, strlen(text));
    return gonio_i_output_close(context, &output, status);
}

gonio_status gonio_i_make_folder(gonio_context *context, const char *path)
{
    struct stat status;
    if (mkdir(path, 0777) == 0 ||
        (errno == EEXIST && stat(path, &status) == 0 && S_ISDIR(status.st_mode))) {
        return GONIO_OK;
    }
    return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot make this folder: %s", path,
                        strerror(errno));
}

/* ---- what differs ---- */

enum { MOST_DIFFERENCES = 3 };

typedef struct differences {
    FILE *text;
    int count;
} differences;

/* A value in a few characters. */
static void put_value(FILE *text, const json_t *value)
{
    char *dump = value != NULL ? json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_SORT_KEYS |
                                                       JSON_REAL_PRECISION(17))
                               : NULL;
    fprintf(text, "%.60s%s", dump != NULL ? dump : "missing",
            dump != NULL && strlen(dump) > 60 ? "..." : "");
    free(dump);
}

static void tell_difference(differences *d, const char *path, const json_t *there,
                            const json_t *here)
{
    d->count++;
    if (d->count <= MOST_DIFFERENCES) {
        fprintf(d->text, "%s%s is ", d->count > 1 ? "; " : "", *path != '\0' ? path : "it");
        put_value(d->text, there);
        fputs(" there and ", d->text);
        put_value(d->text, here);
        fputs(" here", d->text);
    }
}

static void find_differences(differences *d, const char *path, const json_t *there,
                             const json_t *here);

static void find_under_key(differences *d, const char *path, const char *key, const json_t *there,
                           const json_t *here)
{
    char *inner = gonio_i_format("%s%s%s", path, *path != '\0' ? "." : "", key);
    find_differences(d, inner != NULL ? inner : key, json_object_get(there, key),
                     json_object_get(here, key));
    free(inner);
}

static void compare_objects(differences *d, const char *path, const json_t *there,
                            const json_t *here)
{
    const char *key = NULL;
    json_t *value = NULL;
    json_object_foreach((json_t *)there, key, value)
    {
        find_under_key(d, path, key, there, here);
    }
    json_object_foreach((json_t *)here, key, value)
    {
        if (json_object_get(there, key) == NULL) {
            find_under_key(d, path, key, there, here);
        }
    }
}

/* Into objects only, as the place in an array tells people little. */
static void find_differences(differences *d, const char *path, const json_t *there,
                             const json_t *here)
{
    if (json_is_object(there) && json_is_object(here)) {
        compare_objects(d, path, there, here);
    } else if (there == NULL || here == NULL || !json_equal(there, here)) {
        tell_difference(d, path, there, here);
    }
}

char *gonio_i_json_difference(const json_t *there, const json_t *here)
{
    char *text = NULL;
    size_t size = 0;
    differences d = {.text = gonio_i_memory_stream(&text, &size)};
    if (d.text == NULL) {
        return NULL;
    }
    find_differences(&d, "", there, here);
    if (d.count > MOST_DIFFERENCES) {
        fprintf(d.text, "; and %d more", d.count - MOST_DIFFERENCES);
    }
    if (fclose(d.text) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

/* ---- whose it is ---- */

static gonio_status refuse_other_run(gonio_context *context, const char *folder,
                                     const json_t *there, const json_t *run)
{
    char *difference = gonio_i_json_difference(there, run);
    if (difference == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    const gonio_status status =
        *difference == '\0'
            ? GONIO_OK
            : gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                           "%s holds another run: %s. Give another folder, or delete this one",
                           folder, difference);
    free(difference);
    return status;
}

static gonio_status check_run_file(gonio_context *context, const char *folder, const char *path,
                                   const json_t *run)
{
    json_error_t error;
    json_t *there = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!json_is_object(there) || json_object_get(there, "gonio") == NULL) {
        json_decref(there);
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: not a run of gonio, or damaged (%s): give another folder, or "
                            "delete this one",
                            path, *error.text != '\0' ? error.text : "no version in it");
    }
    const gonio_status status = refuse_other_run(context, folder, there, run);
    json_decref(there);
    return status;
}

/* Whether a file is what a run that was killed at its very beginning leaves behind. */
static bool is_left_behind(const char *name)
{
    const size_t length = strlen(name);
    return strcmp(name, ".") == 0 || strcmp(name, "..") == 0 || strcmp(name, "lost+found") == 0 ||
           (strncmp(name, "run.json.", 9) == 0 && strcmp(name + length - 5, ".part") == 0);
}

static gonio_status check_empty(gonio_context *context, const char *folder)
{
    DIR *entries = opendir(folder);
    if (entries == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read this folder: %s", folder,
                            strerror(errno));
    }
    gonio_status status = GONIO_OK;
    for (const struct dirent *entry = readdir(entries); entry != NULL && status == GONIO_OK;
         entry = readdir(entries)) {
        if (!is_left_behind(entry->d_name)) {
            status = gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                  "%s: holds '%s' but no run of gonio: give an empty or new folder",
                                  folder, entry->d_name);
        }
    }
    closedir(entries);
    return status;
}

static gonio_status write_run_file(gonio_context *context, const char *path, const json_t *run)
{
    char *text = json_dumps(run, JSON_INDENT(2) | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
    char *lines = text != NULL ? gonio_i_format("%s\n", text) : NULL;
    const gonio_status status =
        lines != NULL ? gonio_i_write_text(context, path, lines)
                      : gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    free(lines);
    free(text);
    return status;
}

/* Where the file system cannot lock a folder, the run goes on without. */
static gonio_status lock(gonio_context *context, const char *folder, int *descriptor)
{
    *descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (*descriptor < 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot open this folder: %s", folder,
                            strerror(errno));
    }
    if (flock(*descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        close(*descriptor);
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "%s: another run is using this folder: wait for it, or give "
                            "another folder",
                            folder);
    }
    return GONIO_OK;
}

static gonio_status take_up(gonio_context *context, const char *folder, const char *path,
                            const json_t *run)
{
    if (access(path, F_OK) == 0) {
        return check_run_file(context, folder, path, run);
    }
    const gonio_status status = check_empty(context, folder);
    return status == GONIO_OK ? write_run_file(context, path, run) : status;
}

gonio_status gonio_i_run_folder_take(gonio_context *context, const char *folder, json_t *run,
                                     int *descriptor)
{
    int locked = -1;
    char *path = gonio_i_format("%s/run.json", folder);
    if (path == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    gonio_status status = gonio_i_make_folder(context, folder);
    if (status == GONIO_OK) {
        status = lock(context, folder, &locked);
    }
    if (status == GONIO_OK) {
        status = take_up(context, folder, path, run);
        if (status == GONIO_OK) {
            *descriptor = locked;
        } else {
            close(locked);
        }
    }
    free(path);
    return status;
}

gonio_status gonio_i_run_folder_check(gonio_context *context, const char *folder, json_t *run)
{
    char *path = gonio_i_format("%s/run.json", folder);
    if (path == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    const gonio_status status =
        access(path, F_OK) == 0
            ? check_run_file(context, folder, path, run)
            : gonio_i_fail(
                  context, GONIO_ERROR_IO,
                  "%s: not every MPI process can see this folder: all machines must share it",
                  path);
    free(path);
    return status;
}
