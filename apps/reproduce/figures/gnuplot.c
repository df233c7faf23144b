/* gnuplot, called as a program: see gnuplot.h. */
#include "gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* What gnuplot is told on top of this process's environment: pictures without today's date, text in
 * UTF-8 with decimal points. */
static char *const settings[] = {"SOURCE_DATE_EPOCH=0", "LC_ALL=C.UTF-8"};

enum { SETTINGS = sizeof settings / sizeof *settings };

static bool is_set_anew(const char *variable)
{
    for (int k = 0; k < SETTINGS; k++) {
        const size_t length = (size_t)(strchr(settings[k], '=') + 1 - settings[k]);
        if (strncmp(variable, settings[k], length) == 0) {
            return true;
        }
    }
    return false;
}

/* An environment for gnuplot; the strings are borrowed. */
static char **environment(gonio_context *context)
{
    size_t count = 0;
    while (environ != NULL && environ[count] != NULL) {
        count++;
    }
    char **made = gonio_i_allocate(context, count + SETTINGS + 1, sizeof *made);
    size_t kept = 0;
    for (size_t k = 0; made != NULL && k < count; k++) {
        if (!is_set_anew(environ[k])) {
            made[kept++] = environ[k];
        }
    }
    for (int k = 0; made != NULL && k < SETTINGS; k++) {
        made[kept++] = settings[k];
    }
    return made;
}

/* Starts it with its messages going to a pipe; an errno. */
static int start(const char *folder, const char *script, char **variables, int output, pid_t *child)
{
    char *const words[] = {"gnuplot", "-d", (char *)script, NULL};
    posix_spawn_file_actions_t actions;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed != 0) {
        return failed;
    }
    posix_spawn_file_actions_addchdir_np(&actions, folder);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
    failed = posix_spawnp(child, words[0], &actions, NULL, words, variables);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

/* Reads to the end, keeps the beginning as one line. */
static void listen(int input, char *text, size_t size)
{
    size_t length = 0;
    char rest[512];
    for (;;) {
        const bool room = length + 1 < size;
        const ssize_t got =
            room ? read(input, text + length, size - 1 - length) : read(input, rest, sizeof rest);
        if (got == 0 || (got < 0 && errno != EINTR)) {
            break;
        }
        length += room && got > 0 ? (size_t)got : 0;
    }
    while (length > 0 && text[length - 1] == '\n') {
        length--;
    }
    text[length] = '\0';
    for (char *c = text; *c != '\0'; c++) {
        *c = *c == '\n' ? ' ' : *c;
    }
}

static gonio_status finish(gonio_context *context, const char *script, pid_t child,
                           const char *said)
{
    int result = 0;
    while (waitpid(child, &result, 0) < 0) {
        if (errno != EINTR) {
            return gonio_i_fail(context, GONIO_ERROR_IO, "gnuplot: %s", strerror(errno));
        }
    }
    if (WIFEXITED(result) && WEXITSTATUS(result) == 0) {
        if (*said != '\0') {
            gonio_i_warn(context, "%s: gnuplot says: %s", script, said);
        }
        return GONIO_OK;
    }
    return gonio_i_fail(context, GONIO_ERROR_IO, "%s: gnuplot failed: %s", script,
                        *said != '\0' ? said : "it was stopped");
}

static gonio_status run(gonio_context *context, const char *folder, const char *script,
                        char **variables, bool *found)
{
    int ends[2];
    pid_t child = 0;
    if (pipe2(ends, O_CLOEXEC) != 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "gnuplot: no pipe: %s", strerror(errno));
    }
    const int failed = start(folder, script, variables, ends[1], &child);
    close(ends[1]);
    gonio_status status = GONIO_OK;
    *found = failed != ENOENT;
    if (failed == 0) {
        char said[1024];
        listen(ends[0], said, sizeof said);
        status = finish(context, script, child, said);
    } else if (failed != ENOENT) {
        status = gonio_i_fail(context, GONIO_ERROR_IO, "gnuplot: cannot be started: %s",
                              strerror(failed));
    }
    close(ends[0]);
    return status;
}

gonio_status gonio_i_gnuplot(gonio_context *context, const char *folder, const char *script,
                             bool *found)
{
    char **variables = environment(context);
    const gonio_status status =
        variables != NULL ? run(context, folder, script, variables, found) : GONIO_ERROR_MEMORY;
    free(variables);
    return status;
}
