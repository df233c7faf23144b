/* The reference and the dark level during a run: see marks.h. */
#include "marks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { FIRST_ROOM = 8 };

static const double SAME_DIRECTION = 0.01; /* degrees */

typedef struct marking_word {
    const char *text;
    gonio_i_mark mark;
} marking_word;

static const marking_word words[] = {
    {"reference", GONIO_I_REFERENCE}, {"ref", GONIO_I_REFERENCE}, {"standard", GONIO_I_REFERENCE},
    {"white", GONIO_I_REFERENCE},     {"dark", GONIO_I_DARK},     {"blank", GONIO_I_DARK},
    {"black", GONIO_I_DARK},          {"covered", GONIO_I_DARK},
};

gonio_i_mark gonio_i_mark_of(const char *cell)
{
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        if (strcasecmp(cell, words[k].text) == 0) {
            return words[k].mark;
        }
    }
    return GONIO_I_SAMPLE;
}

/* ---- gathering ---- */

static bool make_room(gonio_i_marked_rows *rows, size_t channels)
{
    if (rows->count < rows->room) {
        return true;
    }
    const size_t room = rows->room > 0 ? 2 * rows->room : FIRST_ROOM;
    gonio_i_marked *row = reallocarray(rows->row, room, sizeof *row);
    rows->row = row != NULL ? row : rows->row;
    double *value = reallocarray(rows->value, room, channels * sizeof *value);
    rows->value = value != NULL ? value : rows->value;
    rows->room = row != NULL && value != NULL ? room : rows->room;
    return row != NULL && value != NULL;
}

gonio_status gonio_i_marked_add(gonio_context *context, gonio_i_marked_rows *rows, size_t channels,
                                const gonio_i_marked *row, const double *value)
{
    if (!make_room(rows, channels)) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    rows->row[rows->count] = *row;
    memcpy(rows->value + rows->count * channels, value, channels * sizeof *value);
    rows->count++;
    return GONIO_OK;
}

void gonio_i_marked_free(gonio_i_marked_rows *rows)
{
    free(rows->row);
    free(rows->value);
    *rows = (gonio_i_marked_rows){0};
}

/* ---- levels over time ---- */

/* Levels of one kind at some times. */
typedef struct history {
    size_t count;
    double *at;    /* [count], ascending */
    double *level; /* [count][channels] */
} history;

/* Whether every row and every reading has a time. */
static bool have_times(const gonio_readings *r, const gonio_i_marked_rows *rows)
{
    bool all = r->time != NULL;
    for (size_t k = 0; k < rows->count && all; k++) {
        all = !isnan(rows->row[k].time);
    }
    for (size_t k = 0; k < r->count && all; k++) {
        all = !isnan(r->time[k]);
    }
    return all;
}

static bool same_direction(const gonio_i_marked *a, const gonio_i_marked *b)
{
    bool same = true;
    for (int k = 0; k < 4; k++) {
        same = same && fabs(a->degrees[k] - b->degrees[k]) <= SAME_DIRECTION;
    }
    return same;
}

static bool has_values(const double *value, size_t channels)
{
    bool all = true;
    for (size_t k = 0; k < channels; k++) {
        all = all && isfinite(value[k]);
    }
    return all;
}

/* Puts a level in its place by time. */
static void insert(history *h, double at, const double *level, size_t channels)
{
    size_t place = h->count;
    while (place > 0 && h->at[place - 1] > at) {
        place--;
    }
    memmove(h->at + place + 1, h->at + place, (h->count - place) * sizeof *h->at);
    memmove(h->level + (place + 1) * channels, h->level + place * channels,
            (h->count - place) * channels * sizeof *h->level);
    h->at[place] = at;
    memcpy(h->level + place * channels, level, channels * sizeof *level);
    h->count++;
}

/* Gathers the rows of a mark. References at other directions than the first say nothing of drift.
 */
static gonio_status gather(gonio_context *context, const gonio_i_marked_rows *rows,
                           gonio_i_mark mark, size_t channels, bool timed, history *h)
{
    const gonio_i_marked *first = NULL;
    *h = (history){.at = gonio_i_allocate(context, rows->count + 1, sizeof *h->at),
                   .level =
                       gonio_i_allocate(context, (rows->count + 1) * channels, sizeof *h->level)};
    if (h->at == NULL || h->level == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < rows->count; k++) {
        const gonio_i_marked *row = &rows->row[k];
        const double *value = rows->value + k * channels;
        if (row->mark != mark || !has_values(value, channels)) {
            continue;
        }
        first = first != NULL ? first : row;
        if (mark == GONIO_I_DARK || same_direction(first, row)) {
            insert(h, timed ? row->time : (double)row->line, value, channels);
        }
    }
    return GONIO_OK;
}

static void release(history *h)
{
    free(h->at);
    free(h->level);
}

/* The level of a channel at a time; 0 without any. */
static double level_at(const history *h, double at, size_t channel, size_t channels)
{
    size_t k = 0;
    if (h->count == 0) {
        return 0.0;
    }
    while (k < h->count && h->at[k] <= at) {
        k++;
    }
    const double *level = h->level + channel;
    if (k == 0 || k == h->count) {
        return level[(k == 0 ? 0 : k - 1) * channels];
    }
    const double part = (at - h->at[k - 1]) / (h->at[k] - h->at[k - 1]);
    return (1.0 - part) * level[(k - 1) * channels] + part * level[k * channels];
}

/* ---- correcting ---- */

typedef struct corrector {
    gonio_readings *readings;
    history dark;
    history reference; /* less the dark level, relative to the first */
    bool timed;
    size_t below; /* values that were below the dark level, */
    size_t known; /* of so many */
} corrector;

/* Makes reference levels gains. False if the reference is not brighter than the dark. */
static bool make_gains(corrector *c)
{
    const size_t channels = c->readings->channels;
    bool bright = true;
    for (size_t k = 0; k < c->reference.count; k++) {
        for (size_t j = 0; j < channels; j++) {
            double *level = &c->reference.level[k * channels + j];
            *level -= level_at(&c->dark, c->reference.at[k], j, channels);
            bright = bright && *level > 0.0;
        }
    }
    for (size_t k = c->reference.count; k-- > 0 && bright;) {
        for (size_t j = 0; j < channels; j++) {
            c->reference.level[k * channels + j] /= c->reference.level[j];
        }
    }
    return bright;
}

static void correct_reading(corrector *c, size_t reading)
{
    gonio_readings *r = c->readings;
    const size_t channels = r->channels;
    const double at = c->timed ? r->time[reading] : (double)r->line[reading];
    const double by =
        gonio_i_value_factor(&r->unit, gonio_i_readings_degrees(r, reading, 2) * M_PI / 180.0);
    for (size_t j = 0; j < channels; j++) {
        const size_t k = reading * channels + j;
        const double gain = c->reference.count > 0 ? level_at(&c->reference, at, j, channels) : 1.0;
        const double value = (r->value[k] - level_at(&c->dark, at, j, channels) / by) / gain;
        c->below += value < 0.0;
        c->known += !isnan(value);
        r->value[k] = value < 0.0 ? 0.0 : value;
        if (r->deviation != NULL) {
            r->deviation[k] /= gain;
        }
    }
}

static void range_of(const history *h, size_t channels, double *least, double *most)
{
    *least = INFINITY;
    *most = -INFINITY;
    for (size_t k = 0; k < h->count * channels; k++) {
        *least = fmin(*least, h->level[k]);
        *most = fmax(*most, h->level[k]);
    }
}

static gonio_status note_all(gonio_context *context, const corrector *c)
{
    const char *clock = c->timed ? "time" : "line, as not every row has a time";
    gonio_status status = GONIO_OK;
    double least = 0.0;
    double most = 0.0;
    if (c->dark.count > 0) {
        range_of(&c->dark, c->readings->channels, &least, &most);
        status = gonio_i_readings_note(
            context, c->readings,
            "%zu dark row%s subtracted (%.3g to %.3g, by %s); %zu value%s below it taken as 0%s",
            c->dark.count, c->dark.count > 1 ? "s" : "", least, most, clock, c->below,
            c->below == 1 ? "" : "s",
            2 * c->below > c->known ? ", most of all: was the light on in a dark row?" : "");
    }
    if (status == GONIO_OK && c->reference.count > 0) {
        range_of(&c->reference, c->readings->channels, &least, &most);
        status = gonio_i_readings_note(
            context, c->readings, "%zu reference row%s: drift corrected by %s (gain %.4g to %.4g)",
            c->reference.count, c->reference.count > 1 ? "s" : "", clock, least, most);
    }
    return status;
}

static gonio_status correct(gonio_context *context, corrector *c)
{
    if (!make_gains(c)) {
        c->reference.count = 0;
        const gonio_status status = gonio_i_readings_note(
            context, c->readings,
            "a reference row is not brighter than the dark level: drift is not corrected");
        if (status != GONIO_OK) {
            return status;
        }
    }
    for (size_t k = 0; k < c->readings->count; k++) {
        correct_reading(c, k);
    }
    return note_all(context, c);
}

gonio_status gonio_i_marked_apply(gonio_context *context, gonio_readings *readings,
                                  const gonio_i_marked_rows *rows)
{
    corrector c = {.readings = readings, .timed = have_times(readings, rows)};
    if (rows->count == 0) {
        return GONIO_OK;
    }
    gonio_status status = gather(context, rows, GONIO_I_DARK, readings->channels, c.timed, &c.dark);
    if (status == GONIO_OK) {
        status =
            gather(context, rows, GONIO_I_REFERENCE, readings->channels, c.timed, &c.reference);
    }
    if (status == GONIO_OK) {
        status = correct(context, &c);
    }
    release(&c.dark);
    release(&c.reference);
    return status;
}
