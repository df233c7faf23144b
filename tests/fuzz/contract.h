/* What fuzz targets hold the library to: messages that can be printed, one for each failure. */
#ifndef FUZZ_CONTRACT_H
#define FUZZ_CONTRACT_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include <gonio/gonio.h>

static int errors; /* since the last check of a status */

static void check(bool holds, const char *what)
{
    if (!holds) {
        fprintf(stderr, "contract: %s\n", what);
        abort();
    }
}

static void count_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    errors += level == GONIO_MESSAGE_ERROR;
    check(*text != '\0', "a message says something");
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        check(*c >= 32 && *c != 127, "a message has no control characters");
    }
}

/* A failure tells one line, a success none. */
static void check_status(gonio_status status)
{
    check(status == GONIO_OK ? errors == 0 : errors == 1, "an error is one message");
    errors = 0;
}

#endif
