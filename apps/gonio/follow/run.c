/* What is wanted and what has come: see run.h. */
#include "run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "row.h"

enum { FIRST_ROOM = 64 };

/* Degrees that an instrument may be off. */
static const double REACHED = 1.0;

static const double DAY = 86400.0; /* s */

/* A repeated reading that differs by more than this part from the first takes its place. */
static const double AGREES = 0.1;

/* ---- beginning and end ---- */

static void to_degrees(gonio_pair pair, double degrees[4])
{
    const double scale = 180.0 / M_PI;
    degrees[0] = pair.incident.theta * scale;
    degrees[1] = pair.incident.phi * scale;
    degrees[2] = pair.outgoing.theta * scale;
    degrees[3] = pair.outgoing.phi * scale;
}

gonio_status run_begin(run *r, const gonio_readings *plan, const gonio_readings_options *how,
                       const char *path)
{
    const gonio_readings_view *view = gonio_readings_describe(plan);
    *r = (run){.how = *how, .path = path, .wanted_count = view->count, .latest = NAN};
    r->wanted = calloc(view->count + 1, sizeof *r->wanted);
    r->head = strdup("");
    r->seen = json_object();
    r->text = json_object();
    for (size_t k = 0; r->wanted != NULL && k < view->count; k++) {
        to_degrees(view->pair[k], r->wanted[k].degrees);
        r->wanted[k].row = RUN_NOWHERE;
    }
    return r->wanted != NULL && r->head != NULL && r->seen != NULL && r->text != NULL
               ? GONIO_OK
               : GONIO_ERROR_MEMORY;
}

void run_end(run *r)
{
    for (size_t k = 0; k < r->rows; k++) {
        free(r->row[k].text);
        free(r->row[k].value);
    }
    free(r->row);
    free(r->wanted);
    free(r->head);
    free(r->names);
    json_decref(r->seen);
    json_decref(r->text);
    wanted_places_free(&r->places);
    free(r->problem);
    *r = (run){0};
}

uint64_t run_fingerprint(const gonio_readings *plan)
{
    const gonio_readings_view *view = gonio_readings_describe(plan);
    uint64_t hash = 14695981039346656037U;
    for (size_t k = 0; k < view->count; k++) {
        double degrees[4];
        to_degrees(view->pair[k], degrees);
        for (int j = 0; j < 4; j++) {
            hash = (hash ^ (uint64_t)llround(degrees[j] * 1e6)) * 1099511628211U;
        }
    }
    return hash;
}

/* ---- which direction was read ---- */

/* The azimuth between the directions, 0 to 180 degrees. */
static double azimuth_between(const double degrees[4])
{
    return fabs(remainder(degrees[3] - degrees[1], 360.0));
}

/* How far a reading is from a direction, degrees: the largest difference of a polar angle, and of
 * the azimuth between, which counts less near the normal. */
static double distance(const double a[4], const double b[4])
{
    const double sine = fmin(sin(a[0] * M_PI / 180.0), sin(a[2] * M_PI / 180.0));
    const double turn = sine * fabs(azimuth_between(a) - azimuth_between(b));
    return fmax(turn, fmax(fabs(a[0] - b[0]), fabs(a[2] - b[2])));
}

static bool is_open(const run_wanted *w)
{
    return !w->dropped && (w->row == RUN_NOWHERE || w->asked);
}

static void polar_angles(const void *user, size_t k, double theta[2])
{
    const run_wanted *wanted = user;
    theta[0] = wanted[k].degrees[0];
    theta[1] = wanted[k].degrees[2];
}

/* The nearest direction that is reached. Of several that are as near, one that is to be read. */
static size_t find_wanted(run *r, const double degrees[4])
{
    size_t found = RUN_NOWHERE;
    double least = REACHED;
    const size_t near = wanted_places_find(&r->places, degrees[0], degrees[2]);
    for (size_t n = 0; n < near; n++) {
        const size_t k = r->places.near[n];
        const run_wanted *w = &r->wanted[k];
        const double off = w->dropped ? INFINITY : distance(degrees, w->degrees);
        const bool better = off < least - 1e-6;
        const bool first_open = off < least + 1e-6 && off <= REACHED && is_open(w) &&
                                (found == RUN_NOWHERE || !is_open(&r->wanted[found]));
        if (better || first_open) {
            found = k;
            least = off;
        }
    }
    return found;
}

/* ---- taking lines ---- */

static char *joined(char *head, const char *line)
{
    char *longer = NULL;
    if (head == NULL || asprintf(&longer, "%s%s\n", head, line) < 0) {
        longer = NULL;
    }
    free(head);
    return longer;
}

/* Whether a line has no digits but those of units: a line of units below the names. */
static bool is_unit_line(const run *r, const char *text)
{
    return r->rows == 0 && text[strcspn(text, "023456789")] == '\0';
}

static run_fate add_to_head(run *r, const char *text, gonio_status *status)
{
    r->head = joined(r->head, text);
    *status = r->head == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    return RUN_KNOWN;
}

static run_fate take_names(run *r, const char *text, gonio_status *status)
{
    if (strncmp(text, "\xff\xfe", 2) == 0 || strncmp(text, "\xfe\xff", 2) == 0) {
        free(r->problem);
        if (asprintf(&r->problem,
                     "%s: this is UTF-16, which is not followed; have it written as UTF-8",
                     r->path) < 0) {
            r->problem = NULL;
        }
        return RUN_USELESS;
    }
    add_to_head(r, text, status);
    if (*status != GONIO_OK || strncasecmp(text, "sep=", 4) == 0) {
        return RUN_KNOWN;
    }
    r->names = strdup(text);
    *status = r->names == NULL ? GONIO_ERROR_MEMORY : row_check_names(r, r->head);
    if (*status == GONIO_ERROR_MEMORY) {
        return RUN_USELESS;
    }
    const bool understood = *status == GONIO_OK;
    *status = GONIO_OK;
    return understood ? RUN_KNOWN : RUN_USELESS;
}

static bool make_room(run *r)
{
    const size_t room = r->rows_room > 0 ? 2 * r->rows_room : FIRST_ROOM;
    if (r->rows < r->rows_room) {
        return true;
    }
    run_row *more = reallocarray(r->row, room, sizeof *more);
    r->row = more != NULL ? more : r->row;
    r->rows_room = more != NULL ? room : r->rows_room;
    return more != NULL;
}

/* Gives a text a number. Texts may hold any bytes. False when out of memory. */
static bool note_text(json_t *texts, const char *text, size_t number)
{
    return json_object_set_new_nocheck(texts, text, json_integer((json_int_t)number)) == 0;
}

/* Notes that a line came; *known: whether it came before. False when out of memory. */
static bool note_line(run *r, size_t line, const char *text, bool *known)
{
    char *place = NULL;
    if (asprintf(&place, "%zu:%s", line, text) < 0) {
        return false;
    }
    *known = json_object_get(r->seen, place) != NULL;
    const bool noted = *known || note_text(r->seen, place, line);
    free(place);
    return noted;
}

/* The last row with the same text; the number of rows if there is none. */
static size_t find_text(const run *r, const char *text)
{
    const json_t *row = json_object_get(r->text, text);
    return row != NULL ? (size_t)json_integer_value(row) : r->rows;
}

/* Whether the direction of a row is to be read again. */
static bool is_asked(const run *r, size_t row)
{
    const size_t wanted = r->row[row].wanted;
    return wanted != RUN_NOWHERE && r->wanted[wanted].asked;
}

static bool differ(const run_row *a, const run_row *b)
{
    bool other = a->channels != b->channels;
    for (size_t k = 0; k < a->channels && !other; k++) {
        const double scale = fmax(fabs(a->value[k]), fabs(b->value[k]));
        other = fabs(a->value[k] - b->value[k]) > AGREES * scale;
    }
    return other;
}

/* Passes over the directions that were read or dropped. */
static void go_to_unread(run *r)
{
    while (r->unread < r->wanted_count &&
           (r->wanted[r->unread].dropped || r->wanted[r->unread].row != RUN_NOWHERE)) {
        r->unread++;
    }
}

/* Gives a row to its direction. A repeat that was asked for and is another value takes the place of
 * what was doubted. */
static void give_to_wanted(run *r, size_t number)
{
    run_row *row = &r->row[number];
    double degrees[4];
    to_degrees(row->pair, degrees);
    const size_t next = run_next(r);
    row->wanted = row->of_sample ? find_wanted(r, degrees) : RUN_NOWHERE;
    if (row->wanted == RUN_NOWHERE) {
        return;
    }
    run_wanted *w = &r->wanted[row->wanted];
    r->unordered += w->row == RUN_NOWHERE && row->wanted != next && !r->wanted[next].asked;
    if (w->asked && w->row != RUN_NOWHERE && differ(row, &r->row[w->row])) {
        r->row[w->row].set_aside = true;
    } else if (w->row != RUN_NOWHERE && differ(row, &r->row[w->row])) {
        row->unlike = w->row;
    }
    r->asked -= w->asked;
    w->asked = false;
    w->row = number;
    go_to_unread(r);
}

/* Whether a clock without a date passed midnight between two times. */
static bool passes_midnight(double before, double after)
{
    return before < DAY && after >= 0.0 && before - after > DAY / 2.0;
}

static void note_time(run *r, const run_row *row)
{
    r->backwards += row->time < r->latest && !passes_midnight(r->latest, row->time);
    r->latest = isnan(row->time) ? r->latest : row->time;
}

/* Makes the places of the directions if there are other ones than before. */
static bool know_places(run *r)
{
    return (r->places.first != NULL && r->places.count == r->wanted_count) ||
           wanted_places_make(&r->places, r->wanted_count, polar_angles, r->wanted);
}

static run_fate take_row(run *r, size_t line, double seconds, const char *text,
                         gonio_status *status)
{
    run_row row = {.line = line, .seconds = seconds, .wanted = RUN_NOWHERE, .unlike = RUN_NOWHERE};
    free(r->problem);
    r->problem = NULL;
    if (!row_read(r, text, &row, status)) {
        if (*status == GONIO_OK && is_unit_line(r, text)) {
            return add_to_head(r, text, status);
        }
        r->unclear++;
        return RUN_UNCLEAR;
    }
    row.text = strdup(text);
    if (row.text == NULL || !make_room(r) || !know_places(r) ||
        !note_text(r->text, text, r->rows)) {
        free(row.text);
        free(row.value);
        *status = GONIO_ERROR_MEMORY;
        return RUN_UNCLEAR;
    }
    note_time(r, &row);
    r->row[r->rows++] = row;
    r->seconds = seconds;
    give_to_wanted(r, r->rows - 1);
    return RUN_READING;
}

run_fate run_take(run *r, size_t line, double seconds, const char *text, gonio_status *status)
{
    *status = GONIO_OK;
    if (line == 1 && strncmp(text, "\xef\xbb\xbf", 3) == 0) {
        text += 3;
    }
    if (text[strspn(text, " \t,;")] == '\0' || (r->names != NULL && strcmp(text, r->names) == 0)) {
        return RUN_KNOWN;
    }
    if (*text == '#' || strncmp(text, "\"#", 2) == 0) {
        return strstr(r->head, text) != NULL ? RUN_KNOWN : add_to_head(r, text, status);
    }
    if (r->names == NULL) {
        return take_names(r, text, status);
    }
    bool known = false;
    if (!note_line(r, line, text, &known)) {
        *status = GONIO_ERROR_MEMORY;
    }
    if (known || *status != GONIO_OK) {
        return RUN_KNOWN;
    }
    const size_t same = find_text(r, text);
    if (same < r->rows && !is_asked(r, same)) {
        r->copies++;
        return RUN_COPY;
    }
    return take_row(r, line, seconds, text, status);
}

/* ---- the plan ---- */

gonio_status run_replace(run *r, const double (*degrees)[4], size_t count)
{
    run_wanted *more = reallocarray(r->wanted, r->wanted_count + count + 1, sizeof *more);
    if (more == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    r->wanted = more;
    for (size_t k = 0; k < r->wanted_count; k++) {
        r->wanted[k].dropped = r->wanted[k].dropped || r->wanted[k].row == RUN_NOWHERE;
        r->asked -= r->wanted[k].dropped && r->wanted[k].asked;
        r->wanted[k].asked = r->wanted[k].asked && !r->wanted[k].dropped;
    }
    for (size_t k = 0; k < count; k++) {
        run_wanted *w = &r->wanted[r->wanted_count++];
        *w = (run_wanted){.row = RUN_NOWHERE};
        memcpy(w->degrees, degrees[k], sizeof w->degrees);
    }
    go_to_unread(r);
    return GONIO_OK;
}

bool run_ask(run *r, size_t wanted)
{
    run_wanted *w = &r->wanted[wanted];
    const bool first = !w->asked_once;
    r->asked += !w->asked && first && !w->dropped;
    w->asked = w->asked || (first && !w->dropped);
    w->asked_once = true;
    return first;
}

size_t run_left(const run *r)
{
    size_t left = 0;
    for (size_t k = 0; k < r->wanted_count; k++) {
        left += is_open(&r->wanted[k]);
    }
    return left;
}

size_t run_next(const run *r)
{
    for (size_t k = 0; k < r->wanted_count && r->asked > 0; k++) {
        if (r->wanted[k].asked) {
            return k;
        }
    }
    return r->unread < r->wanted_count ? r->unread : RUN_NOWHERE;
}

size_t run_unread(const run *r)
{
    size_t count = 0;
    for (size_t k = 0; k < r->wanted_count; k++) {
        count += !r->wanted[k].dropped && r->wanted[k].row == RUN_NOWHERE;
    }
    return count;
}

size_t run_list_open(const run *r, size_t *wanted)
{
    size_t count = 0;
    for (int again = 1; again >= 0; again--) {
        for (size_t k = 0; k < r->wanted_count; k++) {
            if (is_open(&r->wanted[k]) && r->wanted[k].asked == (again == 1)) {
                wanted[count++] = k;
            }
        }
    }
    return count;
}

size_t run_counted(const run *r)
{
    size_t counted = 0;
    for (size_t k = 0; k < r->rows; k++) {
        counted += r->row[k].of_sample && !r->row[k].set_aside;
    }
    return counted;
}

size_t run_directions_read(const run *r)
{
    size_t count = 0;
    for (size_t k = 0; k < r->wanted_count; k++) {
        count += r->wanted[k].row != RUN_NOWHERE;
    }
    return count;
}

size_t run_set_aside(const run *r)
{
    size_t count = 0;
    for (size_t k = 0; k < r->rows; k++) {
        count += r->row[k].set_aside;
    }
    return count;
}

double run_reading_time(const run *r)
{
    const double taken = r->rows > 1 ? r->row[r->rows - 1].seconds - r->row[0].seconds : 0.0;
    return taken > 0.0 ? taken / (double)(r->rows - 1) : NAN;
}

/* ---- as a text ---- */

static size_t lines_of(const char *text)
{
    size_t lines = 0;
    for (; *text != '\0'; text++) {
        lines += *text == '\n';
    }
    return lines;
}

static size_t size_of(const run *r)
{
    size_t size = strlen(r->head);
    for (size_t k = 0; k < r->rows; k++) {
        size += strlen(r->row[k].text) + 1;
    }
    return size;
}

char *run_text(const run *r, size_t *size, size_t **line_row)
{
    size_t line = lines_of(r->head);
    char *text = malloc(size_of(r) + 1);
    size_t *rows = line_row != NULL ? calloc(line + r->rows + 1, sizeof *rows) : NULL;
    if (text == NULL || (line_row != NULL && rows == NULL)) {
        free(text);
        free(rows);
        return NULL;
    }
    char *end = stpcpy(text, r->head);
    for (size_t k = 0; k < r->rows; k++) {
        if (!r->row[k].set_aside) {
            end = stpcpy(stpcpy(end, r->row[k].text), "\n");
            line++;
            if (rows != NULL) {
                rows[line] = k;
            }
        }
    }
    *size = (size_t)(end - text);
    if (line_row != NULL) {
        *line_row = rows;
    }
    return text;
}
