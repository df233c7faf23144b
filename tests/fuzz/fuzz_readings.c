/* libFuzzer on readings of any format: whatever the bytes are, a file is refused with one message
 * or is readings with angles and values in their ranges, which are the same when they are written
 * and read again.
 * The size of a file says how it is read: among others as which format. */
#include "fuzz.h"

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

/* Azimuths at the pole say nothing. */
static void check_same_angles(gonio_angles a, gonio_angles b)
{
    check(fabs(a.theta - b.theta) < 1e-9, "the same polar angles");
    check(a.theta == 0.0 || fabs(sin(0.5 * (a.phi - b.phi))) < 1e-9, "the same azimuths");
}

static void check_same(const gonio_readings_view *a, const gonio_readings_view *b)
{
    check(a->count == b->count && a->channels == b->channels, "as many are read again");
    check((a->wavelength == NULL) == (b->wavelength == NULL), "channels are named as before");
    for (size_t k = 0; k < a->count; k++) {
        check_same_angles(a->pair[k].incident, b->pair[k].incident);
        check_same_angles(a->pair[k].outgoing, b->pair[k].outgoing);
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

/* A format that the user names, whatever the content, or none. */
static const char *format_of(size_t size)
{
    enum { MORE_THAN_FORMATS = 32 };
    const size_t wanted = size / 8 % MORE_THAN_FORMATS;
    size_t k = 0;
    while (k < wanted && gonio_readings_format_word((int)k) != NULL) {
        k++;
    }
    return gonio_readings_format_word((int)k);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char path[128];
    char written[128];
    const gonio_readings_options how = {.size = sizeof how,
                                        .values_needed = size % 2 == 0,
                                        .average_repeats = size % 4 < 2,
                                        .negative_to_zero = size % 8 < 4,
                                        .as = {.format = format_of(size)}};
    gonio_readings *readings = NULL;
    fuzz_path(path, "readings");
    fuzz_path(written, "written.csv");
    fuzz_write(path, data, size);
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
