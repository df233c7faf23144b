/* What fuzz targets share: a file of any bytes, and what they hold the library to: messages that
 * can be printed, one for each failure. The program fuzz-replay links all targets under other
 * names (FUZZ_RUN, FUZZ_MUTATE). */
#ifndef FUZZ_H
#define FUZZ_H

#include <fcntl.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <gonio/gonio.h>

#ifdef FUZZ_RUN
#define LLVMFuzzerTestOneInput FUZZ_RUN
#define LLVMFuzzerCustomMutator FUZZ_MUTATE
#endif

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed);

/* Has libFuzzer call fuzz_begin() first, so that it is no part of the first input's time. */
#ifdef FUZZ_RUN
#define FUZZ_INITIALIZE
#else
int LLVMFuzzerInitialize(int *argc, char ***argv);
#define FUZZ_INITIALIZE                                                                            \
    int LLVMFuzzerInitialize(int *argc, char ***argv)                                              \
    {                                                                                              \
        (void)argc;                                                                                \
        (void)argv;                                                                                \
        fuzz_begin();                                                                              \
        return 0;                                                                                  \
    }
#endif

static int errors; /* since the last check of a status */

static inline void check(bool holds, const char *what)
{
    if (!holds) {
        fprintf(stderr, "contract: %s\n", what);
        abort();
    }
}

static inline void count_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    errors += level == GONIO_MESSAGE_ERROR;
    check(*text != '\0', "a message says something");
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        check(*c >= 32 && *c != 127, "a message has no control characters");
    }
    if (getenv("FUZZ_SAY") != NULL) {
        fprintf(stderr, "%s\n", text);
    }
}

/* A failure tells one line, a success none. */
static inline void check_status(gonio_status status)
{
    check(status == GONIO_OK ? errors == 0 : errors == 1, "an error is one message");
    errors = 0;
}

/* The context of a target, on one thread. */
static inline gonio_context *fuzz_context(void)
{
    static gonio_context *context;
    const gonio_context_options options = {
        .size = sizeof options, .message = count_message, .threads = 1};
    if (context == NULL) {
        check(gonio_context_create(&context, &options) == GONIO_OK, "a context is made");
    }
    errors = 0;
    return context;
}

/* A path in memory, different for each process and name. */
static inline void fuzz_path(char path[128], const char *name)
{
    snprintf(path, 128, "%s/gonio-fuzz-%ld-%s",
             access("/dev/shm", W_OK) == 0 ? "/dev/shm" : P_tmpdir, (long)getpid(), name);
}

static inline void fuzz_write(const char *path, const void *data, size_t size)
{
    const int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    check(descriptor >= 0 && write(descriptor, data, size) == (ssize_t)size, "a file is written");
    close(descriptor);
}

/* ---- bytes as choices ---- */

typedef struct fuzz_bytes {
    const uint8_t *at;
    size_t left;
} fuzz_bytes;

/* The next byte; 0 at the end. */
static inline unsigned fuzz_byte(fuzz_bytes *b)
{
    if (b->left == 0) {
        return 0;
    }
    b->left--;
    return *b->at++;
}

/* A number: one that is hard to compute with, a small one, or any eight bytes. */
static inline double fuzz_number(fuzz_bytes *b)
{
    static const double hard[] = {0.0,    -1.0, 1e300, -1e300, 5e-324,   1e-310,    1e30, 1e31,
                                  1e-300, 1e4,  710.0, NAN,    INFINITY, -INFINITY, 1.0,  -0.0};
    const unsigned kind = fuzz_byte(b);
    double value = 0.0;
    if (kind < 128) {
        return 0.01 * (double)fuzz_byte(b) + 0.0001 * (double)kind;
    }
    if (kind < 240 || b->left < sizeof value) {
        return hard[kind % (sizeof hard / sizeof *hard)];
    }
    memcpy(&value, b->at, sizeof value);
    b->at += sizeof value;
    b->left -= sizeof value;
    return value;
}

#endif
