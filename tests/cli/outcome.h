/* What faults and kills share: outputs of a command that are looked at after each run of it, in the
 * current folder. Before a run each holds "old". Errors of the test itself end the program. */
#ifndef CLI_OUTCOME_H
#define CLI_OUTCOME_H

#include <stdbool.h>
#include <stddef.h>

enum { MOST_OUTPUTS = 8 };

typedef struct content {
    char *data; /* ends with '\0'; NULL: there is no such file */
    size_t size;
} content;

/* The outputs and the command, of a command line: NAME[,NAME...] or "-", and the rest of it. */
typedef struct subject {
    char *list;
    const char *output[MOST_OUTPUTS];
    int outputs;
    char **command;
} subject;

/* What a run leaves. */
typedef struct outcome {
    int status;      /* of waitpid */
    content text[2]; /* of standard output and error */
    content output[MOST_OUTPUTS];
} outcome;

void die(const char *what);
subject subject_of(const char *outputs, char **command);

content read_content(const char *path);
bool is_same(content a, content b);
bool is_old(content c);
bool is_one_line(content c);

void put_old(const subject *s);

/* Replaces this process, a child, by the command. Its texts go to ../outcome.out and .err. */
void outcome_start(const subject *s);

/* What is there after a run. */
outcome outcome_take(const subject *s, int status);
void outcome_free(outcome *o, const subject *s);

/* Prints the command, and what it said. */
void outcome_print(const outcome *o, const subject *s);

#endif
