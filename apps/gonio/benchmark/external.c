/* The method `external`: a program that is given readings and directions, and writes predictions.
 */
#include "methods.h"

#include <errno.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/core.h"
#include "core/number.h"
#include "run/text_file.h"

extern char **environ;

/* The files of one call, in a folder of their own. */
enum { READINGS, DIRECTIONS, PREDICTIONS, FILES };
static const char *const file_name[FILES] = {"readings.csv", "directions.csv", "predictions.csv"};

typedef struct call {
    char *folder;
    char *path[FILES];
} call;

static void end_call(call *c)
{
    for (int k = 0; k < FILES; k++) {
        if (c->path[k] != NULL) {
            unlink(c->path[k]);
        }
        free(c->path[k]);
    }
    if (c->folder != NULL) {
        rmdir(c->folder);
    }
    free(c->folder);
}

static gonio_status begin_call(gonio_context *context, call *c)
{
    const char *base = getenv("TMPDIR");
    *c = (call){.folder = gonio_i_format("%s/gonio-external-XXXXXX", base != NULL ? base : "/tmp")};
    if (c->folder == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    if (mkdtemp(c->folder) == NULL) {
        const int reason = errno;
        free(c->folder);
        c->folder = NULL;
        return gonio_i_fail(context, GONIO_ERROR_IO, "no scratch folder: %s", strerror(reason));
    }
    for (int k = 0; k < FILES; k++) {
        c->path[k] = gonio_i_format("%s/%s", c->folder, file_name[k]);
        if (c->path[k] == NULL) {
            return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
        }
    }
    return GONIO_OK;
}

static gonio_status write_directions(gonio_context *context, const call *c, const gonio_pair *pair,
                                     size_t count)
{
    static const double DEGREES = 180.0 / M_PI;
    gonio_i_text text;
    const gonio_status status = gonio_i_text_begin(context, &text);
    if (status != GONIO_OK) {
        return status;
    }
    fputs("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n", text.stream);
    for (size_t k = 0; k < count; k++) {
        fprintf(text.stream, "%.9g,%.9g,%.9g,%.9g\n", DEGREES * pair[k].incident.theta,
                DEGREES * pair[k].incident.phi, DEGREES * pair[k].outgoing.theta,
                DEGREES * pair[k].outgoing.phi);
    }
    return gonio_i_text_end(context, &text, c->folder, file_name[DIRECTIONS], GONIO_OK);
}

/* Runs `COMMAND READINGS DIRECTIONS PREDICTIONS` by the shell. */
static gonio_status run(gonio_context *context, const char *command, const call *c)
{
    char *line = gonio_i_format("%s \"$@\"", command);
    char shell[] = "sh";
    char option[] = "-c";
    char *words[] = {
        shell, option, line, shell, c->path[READINGS], c->path[DIRECTIONS], c->path[PREDICTIONS],
        NULL};
    pid_t child = 0;
    int code = -1;
    const int failed =
        line != NULL ? posix_spawn(&child, "/bin/sh", NULL, NULL, words, environ) : ENOMEM;
    while (failed == 0 && waitpid(child, &code, 0) < 0 && errno == EINTR) {
    }
    free(line);
    if (failed != 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "/bin/sh: %s", strerror(failed));
    }
    return code == 0 ? GONIO_OK
                     : gonio_i_fail(context, GONIO_ERROR_IO, "'%s' failed (%s %d)", command,
                                    WIFEXITED(code) ? "exit code" : "signal",
                                    WIFEXITED(code) ? WEXITSTATUS(code) : WTERMSIG(code));
}

/* The numbers of a line into values[channels]; false if it is not just these. */
static bool read_line(const char *line, size_t channels, double *values)
{
    const char *at = line;
    for (size_t c = 0; c < channels; c++) {
        char *end = NULL;
        values[c] = gonio_i_number(at, &end);
        const bool last = c + 1 == channels;
        if (end == at || !(values[c] >= 0.0 && isfinite(values[c])) || (!last && *end != ',')) {
            return false;
        }
        at = last ? end : end + 1;
    }
    return at[strspn(at, " \r\n")] == '\0';
}

static gonio_status read_predictions(gonio_context *context, const char *command, const call *c,
                                     size_t count, size_t channels, double *values)
{
    FILE *file = fopen(c->path[PREDICTIONS], "re");
    char *line = NULL;
    size_t room = 0;
    size_t read = 0;
    bool fine = file != NULL && getline(&line, &room, file) > 0; /* names */
    while (fine && read < count) {
        fine =
            getline(&line, &room, file) > 0 && read_line(line, channels, values + read * channels);
        read += fine;
    }
    fine = fine && getline(&line, &room, file) < 0;
    free(line);
    if (file != NULL) {
        fclose(file);
    }
    return fine ? GONIO_OK
                : gonio_i_fail(context, GONIO_ERROR_FORMAT,
                               "'%s' did not write a line of names and, for each of %zu "
                               "directions, a line of %zu numbers of at least 0: line %zu of its "
                               "predictions is not as it should be",
                               command, count, channels, read + 2);
}

static gonio_status predict(void *self, gonio_context *context, const gonio_pair *pair,
                            size_t count, double *values, double *deviations)
{
    const benchmark_task *task = self;
    const char *command = task->setting->external;
    call c;
    (void)deviations;
    gonio_status status = begin_call(context, &c);
    if (status == GONIO_OK) {
        status = gonio_readings_write(context, task->readings, NULL, c.path[READINGS]);
    }
    if (status == GONIO_OK) {
        status = write_directions(context, &c, pair, count);
    }
    if (status == GONIO_OK) {
        status = run(context, command, &c);
    }
    if (status == GONIO_OK) {
        status = read_predictions(context, command, &c, count,
                                  gonio_readings_describe(task->readings)->channels, values);
    }
    end_call(&c);
    return status;
}

/* All is done when predictions are asked for. */
static gonio_status complete(gonio_context *context, const benchmark_task *task,
                             benchmark_completion *completion)
{
    (void)context;
    *completion = (benchmark_completion){.self = (void *)task, .predict = predict, .expected = NAN};
    return GONIO_OK;
}

const benchmark_method benchmark_external = {
    .name = "external", .summary = "the program of --external", .complete = complete};
