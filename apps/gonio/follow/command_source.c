/* Readings of a command: see command_source.h. */
#include "command_source.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_OUTPUT = 1 << 20, ROOM = 4096, ANGLE_ROOM = 32, MOST_ANGLES = 4 + COMMAND_MOST_AXES };

static void say(char **problem, const char *text, const char *more)
{
    if (*problem == NULL && asprintf(problem, text, more) < 0) {
        *problem = NULL;
    }
}

/* ---- running ---- */

/* Becomes the command. Only calls that are safe after a fork. */
static void become(char *const *arguments, const int ends[2])
{
    if (dup2(ends[1], STDOUT_FILENO) >= 0) {
        close(ends[0]);
        close(ends[1]);
        execv("/bin/sh", arguments);
    }
    _exit(127);
}

static char *read_all(int descriptor)
{
    size_t size = 0;
    size_t room = ROOM;
    char *text = malloc(room + 1);
    while (text != NULL) {
        const ssize_t got = read(descriptor, text + size, room - size);
        if (got == 0 || (got < 0 && errno != EINTR) || size >= MOST_OUTPUT) {
            break;
        }
        size += got > 0 ? (size_t)got : 0;
        if (size == room) {
            char *more = realloc(text, 2 * room + 1);
            if (more == NULL) {
                free(text);
                return NULL;
            }
            text = more;
            room *= 2;
        }
    }
    if (text != NULL) {
        text[size] = '\0';
    }
    return text;
}

static void wait_for(pid_t child, char **problem)
{
    int state = 0;
    pid_t got = 0;
    do {
        got = waitpid(child, &state, 0);
    } while (got < 0 && errno == EINTR);
    if (got == child && WIFEXITED(state) && WEXITSTATUS(state) != 0) {
        char code[16];
        snprintf(code, sizeof code, "%d", WEXITSTATUS(state));
        say(problem, "it ended with code %s", code);
    } else if (got == child && WIFSIGNALED(state)) {
        say(problem, "it was ended: %s", strsignal(WTERMSIG(state)));
    }
}

/* The command with the angles behind it. */
static char *with_angles(const char *command)
{
    char *whole = NULL;
    return asprintf(&whole, "%s \"$@\"", command) < 0 ? NULL : whole;
}

void command_source_run(const char *command, const double degrees[4], const double *axis,
                        size_t axes, char **output, char **problem)
{
    char angle[MOST_ANGLES][ANGLE_ROOM];
    char *arguments[MOST_ANGLES + 5] = {"sh", "-c", NULL, "sh"};
    int ends[2];
    *output = NULL;
    *problem = NULL;
    char *whole = with_angles(command);
    if (whole == NULL || pipe(ends) != 0) {
        say(problem, "it cannot be started: %s", strerror(errno));
        free(whole);
        return;
    }
    arguments[2] = whole;
    for (size_t k = 0; k < 4 + axes; k++) {
        snprintf(angle[k], sizeof angle[k], "%.9f", (k < 4 ? degrees[k] : axis[k - 4]) + 0.0);
        arguments[4 + k] = angle[k];
    }
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        become(arguments, ends);
    }
    close(ends[1]);
    if (child < 0) {
        say(problem, "it cannot be started: %s", strerror(errno));
    } else {
        *output = read_all(ends[0]);
        wait_for(child, problem);
    }
    close(ends[0]);
    free(whole);
}

/* ---- values ---- */

static bool is_number(const char *word)
{
    char *end = NULL;
    strtod(word, &end);
    end += *end == ',' ? strspn(end, ",0123456789eE+-") : 0;
    return end > word && *end == '\0';
}

/* The signs between cells of a line: semicolons or blanks if there are any, otherwise commas.
 * A comma with a blank behind it is no decimal comma. */
static const char *separators_of(const char *line)
{
    if (strchr(line, ';') != NULL) {
        return ";";
    }
    if (strstr(line, ", ") != NULL) {
        return ", \t";
    }
    return line[strcspn(line, " \t")] != '\0' ? " \t" : ",";
}

/* A line as cells between semicolons; *count: how many; *numbers: whether all are numbers. NULL
 * when out of memory. */
static char *cells_of(char *line, size_t *count, bool *numbers)
{
    char *place = NULL;
    char *cells = calloc(strlen(line) + 2, 1);
    char *end = cells;
    line += strspn(line, " \t");
    line[strcspn(line, "\r")] = '\0';
    for (size_t length = strlen(line); length > 0 && strchr(" \t", line[length - 1]) != NULL;) {
        line[--length] = '\0';
    }
    const char *between = separators_of(line);
    *count = 0;
    *numbers = true;
    for (char *word = strtok_r(line, between, &place); cells != NULL && word != NULL;
         word = strtok_r(NULL, between, &place)) {
        word += strspn(word, " \t");
        *numbers = *numbers && is_number(word);
        end = stpcpy(stpcpy(end, *count > 0 ? ";" : ""), word);
        (*count)++;
    }
    return cells;
}

/* The usual names of so many values; NULL for a number that has none. */
static const char *usual_names(size_t count)
{
    return count == 1 ? "value_per_sr" : count == 3 ? "R_per_sr;G_per_sr;B_per_sr" : NULL;
}

static void take_values(char *line, char **names, char **values, char **problem)
{
    size_t count = 0;
    bool numbers = false;
    *values = cells_of(line, &count, &numbers);
    if (!numbers || count == 0) {
        say(problem, "it printed no numbers%s", "");
    } else if (*names == NULL && usual_names(count) == NULL) {
        say(problem,
            "it printed neither one value nor R, G, B: let it print a line of names before the "
            "values (400nm_per_sr 500nm_per_sr), and blanks or semicolons between values with "
            "decimal commas%s",
            "");
    } else if (*names == NULL) {
        *names = strdup(usual_names(count));
    }
}

void command_source_values(const char *output, char **names, char **values, char **problem)
{
    char *text = strdup(output);
    char *place = NULL;
    char *line = text != NULL ? strtok_r(text, "\n", &place) : NULL;
    size_t count = 0;
    bool numbers = true;
    *names = NULL;
    *values = NULL;
    *problem = NULL;
    char *copy = line != NULL ? strdup(line) : NULL;
    char *first = copy != NULL ? cells_of(copy, &count, &numbers) : NULL;
    if (first != NULL && !numbers) {
        *names = first;
        first = NULL;
        line = strtok_r(NULL, "\n", &place);
    }
    if (line != NULL) {
        take_values(line, names, values, problem);
    } else {
        say(problem, "it printed no values%s", "");
    }
    free(first);
    free(copy);
    free(text);
    if (*problem != NULL || *names == NULL || *values == NULL) {
        say(problem, "out of memory%s", "");
        free(*names);
        free(*values);
        *names = NULL;
        *values = NULL;
    }
}
