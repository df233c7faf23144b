/* Readings one after another, as the readers of files find them: see readings.h. */
#include "readings.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reading_numbers.h"
#include "rules.h"

enum { FIRST_ROOM = 64 };

/* Enlarges a block. If there is no memory, *done is false and the block stays. */
static void *enlarge(void *block, size_t room, size_t size, bool *done)
{
    void *more = reallocarray(block, room, size);
    if (more == NULL) {
        *done = false;
        return block;
    }
    return more;
}

static gonio_status make_room(gonio_context *context, gonio_readings *r, bool deviations,
                              bool times)
{
    if (r->count < r->room) {
        return GONIO_OK;
    }
    const size_t first = r->expected > FIRST_ROOM ? r->expected : FIRST_ROOM;
    const size_t room = r->room > 0 ? 2 * r->room : first;
    const size_t values = r->channels * sizeof(double);
    bool done = true;
    r->pair = enlarge(r->pair, room, sizeof *r->pair, &done);
    r->planned = enlarge(r->planned, room, sizeof *r->planned, &done);
    r->line = enlarge(r->line, room, sizeof *r->line, &done);
    r->value = enlarge(r->value, room, values, &done);
    if (deviations) {
        r->deviation = enlarge(r->deviation, room, values, &done);
    }
    if (times) {
        r->time = enlarge(r->time, room, sizeof *r->time, &done);
    }
    if (r->keep_angles) {
        r->given = enlarge(r->given, room, sizeof *r->given, &done);
    }
    if (!done) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", r->path);
    }
    r->room = room;
    return GONIO_OK;
}

gonio_status gonio_i_readings_add(gonio_context *context, gonio_readings *r,
                                  const gonio_i_reading *reading)
{
    gonio_status status = make_room(context, r, reading->deviation != NULL, reading->timed);
    if (status == GONIO_OK) {
        status = gonio_i_check_angles(context, r, reading->line, reading->degrees);
    }
    const size_t first = r->count * r->channels;
    for (size_t k = 0; k < r->channels && status == GONIO_OK; k++) {
        r->below_zero += reading->value[k] < 0.0;
        status = gonio_i_take_value(context, r, reading->line, k, &r->options, reading->value[k],
                                    &r->value[first + k]);
        if (status == GONIO_OK && reading->deviation != NULL) {
            status = gonio_i_take_deviation(context, r, reading->line, k, reading->deviation[k],
                                            &r->deviation[first + k]);
        }
    }
    if (status != GONIO_OK) {
        return status;
    }
    const double *d = reading->degrees;
    r->pair[r->count] = (gonio_pair){gonio_i_angles_from_degrees(d[0], d[1]),
                                     gonio_i_angles_from_degrees(d[2], d[3])};
    r->planned[r->count] = reading->planned;
    r->line[r->count] = reading->line;
    if (reading->timed) {
        r->time[r->count] = reading->time;
    }
    if (r->keep_angles) {
        memcpy(r->given[r->count], d, sizeof *r->given);
    }
    r->count++;
    return GONIO_OK;
}

gonio_status gonio_i_readings_note(gonio_context *context, gonio_readings *readings,
                                   const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    const int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    const bool kept =
        length >= 0 && gonio_i_comments_add_text(&readings->note, text, (size_t)length);
    if (kept) {
        gonio_i_readings_update_view(readings);
        gonio_i_note(context, "%s: %s", readings->path, text);
    }
    free(length >= 0 ? text : NULL);
    return kept ? GONIO_OK
                : gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", readings->path);
}

static gonio_status note_poles(gonio_context *context, gonio_readings *readings)
{
    size_t repeats = 0;
    const gonio_status status = gonio_i_readings_count_pole_repeats(context, readings, &repeats);
    if (status != GONIO_OK || repeats == 0) {
        return status;
    }
    return gonio_i_readings_note(context, readings,
                                 "theta = 0 is one direction at any azimuth: %zu reading%s another",
                                 repeats, repeats > 1 ? "s repeat" : " repeats");
}

gonio_status gonio_i_readings_finish(gonio_context *context, gonio_readings *readings,
                                     bool measured)
{
    if (readings->count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "%s: no lines below the column names",
                            readings->path);
    }
    const char *method = gonio_i_comments_value(&readings->comment, "method");
    readings->method = method != NULL ? method : "";
    gonio_i_readings_update_view(readings);
    gonio_status status = gonio_i_readings_group(context, readings);
    if (status == GONIO_OK) {
        status = note_poles(context, readings);
    }
    if (status == GONIO_OK && gonio_i_readings_are_levels(readings)) {
        status = gonio_i_readings_note(
            context, readings,
            "the values are whole numbers up to 255, as levels of an image are, and taken as 1/sr; "
            "if they are in proportion to light, and 255 is white, divide them by 255 pi");
    }
    return status == GONIO_OK && !readings->options.average_repeats
               ? gonio_i_readings_refuse_repeats(context, readings, measured)
               : status;
}
