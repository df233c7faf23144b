/* libFuzzer on readings of any format: whatever the bytes are, a file is refused with one message
 * or is readings with angles and values in their ranges, which are the same when they are written
 * and read again.
 *
 *     cmake --preset fuzz && cmake --build --preset fuzz --target fuzz-readings
 *     build/fuzz/tests/fuzz/fuzz-readings FOLDER      a folder that begins with some small files */
#include <gonio/gonio.h>

#include <fcntl.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int errors;

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

static void check_direction(gonio_angles a)
{
    check(a.theta >= 0.0 && a.theta < M_PI / 2.0, "theta is above the horizon");
    check(a.phi >= 0.0 && a.phi <= 2.0 * M_PI, "phi is within a turn");
}

static void check_numbers(const gonio_readings_view *view)
{
    check(view->count > 0 && view->channels > 0, "there are readings and channels");
    for (size_t k = 0; k < view->count; k++) {
        check_direction(view->pair[k].incident);
        check_direction(view->pair[k].outgoing);
        check(view->planned[k] >= GONIO_ALL_CHANNELS && view->planned[k] < (int)view->channels,
              "a planned channel is one");
    }
    for (size_t k = 0; k < view->count * view->channels; k++) {
        check(isnan(view->value[k]) || (view->value[k] >= 0.0 && view->value[k] <= 1e30),
              "a value is none or a BRDF");
    }
    for (size_t k = 0; k < view->channels && view->wavelength != NULL; k++) {
        check(view->wavelength[k] >= 100.0 && view->wavelength[k] <= 1e6, "wavelengths are light");
    }
}

/* Files have ten digits of wavelengths. */
static bool are_wavelengths_apart(const gonio_readings_view *view)
{
    bool apart = view->channels < 200;
    for (size_t k = 0; k < view->channels && apart && view->wavelength != NULL; k++) {
        for (size_t j = 0; j < k && apart; j++) {
            apart = fabs(view->wavelength[k] - view->wavelength[j]) > 1e-8 * view->wavelength[k];
        }
    }
    return apart;
}

static void check_same(const gonio_readings_view *a, const gonio_readings_view *b)
{
    check(a->count == b->count && a->channels == b->channels, "as many are read again");
    check((a->wavelength == NULL) == (b->wavelength == NULL), "channels are named as before");
    for (size_t k = 0; k < a->count; k++) {
        check(fabs(a->pair[k].incident.theta - b->pair[k].incident.theta) < 1e-9,
              "the same angles");
        check(fabs(a->pair[k].outgoing.theta - b->pair[k].outgoing.theta) < 1e-9,
              "the same angles");
    }
    for (size_t k = 0; k < a->count * a->channels; k++) {
        check(isnan(a->value[k]) == isnan(b->value[k]), "the same values are there");
        check(isnan(a->value[k]) || fabs(a->value[k] - b->value[k]) <= 1e-8 * a->value[k],
              "the same values");
    }
}

static void write_and_read(gonio_context *context, const gonio_readings *readings, const char *path)
{
    gonio_readings_options options;
    gonio_readings *again = NULL;
    gonio_readings_options_default(&options);
    options.values_needed = false;
    options.average_repeats = true;
    gonio_status status = gonio_readings_write(context, readings, NULL, path);
    check_status(status);
    check(status == GONIO_OK, "readings are written");
    status = gonio_readings_read(context, path, &options, &again);
    check_status(status);
    check(status == GONIO_OK, "what was written is read");
    check_numbers(gonio_readings_describe(again));
    check_same(gonio_readings_describe(readings), gonio_readings_describe(again));
    gonio_readings_free(&again);
    unlink(path);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static gonio_context *context;
    static char path[64];
    static char written[80];
    const gonio_context_options options = {
        .size = sizeof options, .message = count_message, .threads = 1};
    if (context == NULL) {
        check(gonio_context_create(&context, &options) == GONIO_OK, "a context is made");
        snprintf(path, sizeof path, "/dev/shm/fuzz-readings-%ld", (long)getpid());
        snprintf(written, sizeof written, "%s.csv", path);
    }
    const int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    check(descriptor >= 0 && write(descriptor, data, size) == (ssize_t)size, "a file is written");
    close(descriptor);
    const gonio_readings_options how = {.size = sizeof how,
                                        .values_needed = size % 2 == 0,
                                        .average_repeats = size % 4 < 2,
                                        .negative_to_zero = size % 8 < 4};
    gonio_readings *readings = NULL;
    errors = 0;
    const gonio_status status = gonio_readings_read(context, path, &how, &readings);
    check_status(status);
    if (status == GONIO_OK) {
        check_numbers(gonio_readings_describe(readings));
        if (are_wavelengths_apart(gonio_readings_describe(readings))) {
            write_and_read(context, readings, written);
        }
    }
    gonio_readings_free(&readings);
    unlink(path);
    return 0;
}
