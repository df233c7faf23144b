/* gonio measure --follow and --exec: a run on a real instrument. */
#ifndef GONIO_FOLLOW_FOLLOW_H
#define GONIO_FOLLOW_FOLLOW_H

#include "../command_line.h"
#include "../posterior_options.h"

typedef struct follow_options {
    const char *output;
    const char *follow;     /* a file that grows, "-": standard input; or NULL */
    const char *command;    /* that reads; or NULL */
    const char *basis;      /* NULL: the built-in one */
    const char *journal;    /* NULL: OUTPUT.journal */
    const char *remaining;  /* a plan of what is left, written again and again; or NULL */
    const char *budget;     /* a duration; or NULL */
    const char *target;     /* per cent; or NULL */
    const char *candidates; /* of --adapt */
    const char *instrument; /* a file or a word; or NULL */
    const char *idle;       /* a duration; or NULL */
    int adapt;
    int no_basis;
    bool noise_given; /* otherwise that of the instrument counts */
    bool floor_given;
    posterior_options posterior;
} follow_options;

/* Checks the options. Returns false after an error message. */
bool follow_check(const tool *t, const follow_options *o, const char *const *arguments,
                  size_t count);

/* Follows a run of a plan to its end. Returns an exit code. */
int follow_run(tool *t, const follow_options *o, const char *plan);

#endif
