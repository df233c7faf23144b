/* Looking up readings in other readings of the same material: see measurement.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "readings.h"

static const double SAME = 1e-4; /* radians */

/* Readings of an anisotropic sample differ by 28 % and more at other rotations of it (median), as
 * gonio_interpretation.anisotropic says. Noise and drift of instruments are below. */
static const double ANISOTROPIC = 0.25;
enum { ENOUGH_TURNED = 5 };

/* How a known reading matches directions that are looked up. Smaller is better. */
typedef enum likeness { EXACT, ROTATED, RECIPROCAL, NONE } likeness;

/* ---- the distance of two pairs of directions ---- */

/* |remainder(a - b, 2 pi)|. Differences below 2 pi are exact. */
static double turn_between(double a, double b)
{
    const double turn = fabs(a - b);
    return turn <= M_PI         ? turn
           : turn <= 2.0 * M_PI ? 2.0 * M_PI - turn
                                : fabs(remainder(turn, 2.0 * M_PI));
}

/* Directions that are looked up, with the sines of their polar angles. */
typedef struct sought {
    gonio_pair at;
    double incident; /* sines */
    double outgoing;
} sought;

static sought seek(gonio_pair at)
{
    return (sought){at, sin(fmin(at.incident.theta, M_PI / 2.0)),
                    sin(fmin(at.outgoing.theta, M_PI / 2.0))};
}

static sought exchange(const sought *s)
{
    return (sought){{s->at.outgoing, s->at.incident}, s->outgoing, s->incident};
}

static double theta_between(const sought *s, const gonio_pair *b)
{
    return fmax(fabs(s->at.incident.theta - b->incident.theta),
                fabs(s->at.outgoing.theta - b->outgoing.theta));
}

/* The largest difference of an angle, radians; azimuths count by the sine of theta. */
static double distance(const sought *s, const gonio_pair *b)
{
    const double incident = turn_between(s->at.incident.phi, b->incident.phi) * s->incident;
    const double outgoing = turn_between(s->at.outgoing.phi, b->outgoing.phi) * s->outgoing;
    return fmax(theta_between(s, b), fmax(incident, outgoing));
}

/* The distance for an isotropic material, when both directions may be rotated about the normal. The
 * direction nearer to the normal takes the difference in azimuth. */
static double distance_rotated(const sought *s, const gonio_pair *b)
{
    const double turn =
        turn_between(s->at.outgoing.phi - s->at.incident.phi, b->outgoing.phi - b->incident.phi);
    const bool first = s->at.incident.theta < s->at.outgoing.theta;
    return fmax(theta_between(s, b), turn * (first ? s->incident : s->outgoing));
}

/* turned: the rotation of the sample matters. */
static likeness compare(const sought *s, const gonio_pair *b, bool turned, double *apart)
{
    *apart = distance(s, b);
    if (*apart <= SAME) {
        return EXACT;
    }
    const sought exchanged = exchange(s);
    if (turned) {
        *apart = distance(&exchanged, b);
        return *apart <= SAME ? RECIPROCAL : NONE;
    }
    *apart = distance_rotated(s, b);
    if (*apart <= SAME) {
        return ROTATED;
    }
    *apart = distance_rotated(&exchanged, b);
    return *apart <= SAME ? RECIPROCAL : NONE;
}

/* ---- the nearest reading ---- */

/* A known reading, sorted by its polar angles. */
typedef struct place {
    int64_t column; /* of theta_i, in strips of the width SAME */
    double theta_o;
    size_t reading;
} place;

static int64_t column_of(double theta)
{
    return (int64_t)floor(theta / SAME);
}

static int compare_places(const void *a, const void *b)
{
    const place *x = a;
    const place *y = b;
    const int column = (x->column > y->column) - (x->column < y->column);
    const int theta = (x->theta_o > y->theta_o) - (x->theta_o < y->theta_o);
    const int reading = (x->reading > y->reading) - (x->reading < y->reading);
    return column != 0 ? column : theta != 0 ? theta : reading;
}

typedef struct known_places {
    const gonio_readings *readings;
    size_t count;    /* of places: repeats have that of the first of them */
    place *place;    /* [count], sorted */
    bool turned;     /* the rotation of the sample matters */
    double median;   /* by what readings at other rotations differ, |ln| */
    size_t compared; /* comparisons so far */
} known_places;

/* Whether readings at other rotations of the sample differ by more than noise, so that only the
 * readings of a rotation stand for it. */
static bool are_turned(gonio_context *context, const gonio_readings *known, known_places *k)
{
    size_t pairs = 0;
    const gonio_status status = gonio_i_readings_compare_turned(context, known, &pairs, &k->median);
    k->turned = status == GONIO_OK && pairs >= ENOUGH_TURNED && k->median > ANISOTROPIC;
    return status == GONIO_OK;
}

/* Whether the first reading of the direction is at exactly the same angles, so that it is always
 * found before this one. */
static bool is_repeat(const gonio_readings *known, size_t n)
{
    const gonio_pair *a = &known->pair[n];
    const gonio_pair *b = &known->pair[known->first_same[n]];
    return known->first_same[n] != n && a->incident.theta == b->incident.theta &&
           a->incident.phi == b->incident.phi && a->outgoing.theta == b->outgoing.theta &&
           a->outgoing.phi == b->outgoing.phi;
}

/* any_rotation: the rotation of the sample does not matter, whatever the readings say. */
static bool sort_places(gonio_context *context, const gonio_readings *known, bool any_rotation,
                        known_places *k)
{
    *k = (known_places){.readings = known,
                        .place = gonio_i_allocate(context, known->count, sizeof *k->place)};
    if (k->place != NULL && !any_rotation && !are_turned(context, known, k)) {
        free(k->place);
        k->place = NULL;
    }
    for (size_t n = 0; k->place != NULL && n < known->count; n++) {
        const gonio_pair *pair = &known->pair[n];
        k->place[k->count] = (place){column_of(pair->incident.theta), pair->outgoing.theta, n};
        k->count += !is_repeat(known, n);
    }
    if (k->place != NULL) {
        qsort(k->place, k->count, sizeof *k->place, compare_places);
    }
    return k->place != NULL;
}

/* The first place that is not before `at`. */
static size_t lower_bound(const known_places *k, place at)
{
    size_t low = 0;
    size_t high = k->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_places(&k->place[middle], &at) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

typedef struct best {
    likeness like;
    double apart;
    double turn; /* of azimuths, also about the normal */
    size_t reading;
} best;

static void try_reading(const known_places *k, const sought *s, size_t reading, best *b)
{
    double apart = 0.0;
    const gonio_pair *here = &k->readings->pair[reading];
    const likeness like = compare(s, here, k->turned, &apart);
    if (like == NONE) {
        return;
    }
    const double turn = turn_between(s->at.incident.phi, here->incident.phi) +
                        turn_between(s->at.outgoing.phi, here->outgoing.phi);
    const bool first = turn < b->turn || (turn == b->turn && reading < b->reading);
    const bool nearer = apart < b->apart || (apart == b->apart && first);
    if (like < b->like || (like == b->like && nearer)) {
        *b = (best){like, apart, turn, reading};
    }
}

/* Compares the readings whose polar angles are near theta_i and theta_o. */
static void try_angles(known_places *k, const sought *s, double theta_i, double theta_o, best *b)
{
    for (int64_t column = column_of(theta_i) - 1; column <= column_of(theta_i) + 1; column++) {
        size_t n = lower_bound(k, (place){column, theta_o - SAME, 0});
        while (n < k->count && k->place[n].column == column &&
               k->place[n].theta_o <= theta_o + SAME) {
            try_reading(k, s, k->place[n].reading, b);
            k->compared++;
            n++;
        }
    }
}

/* Once in a while: whether a signal ends the search. */
static gonio_status ask(gonio_context *context, size_t n, size_t count)
{
    enum { OFTEN = 64 };
    return n % OFTEN == OFTEN - 1
               ? gonio_i_progress(context, "comparing directions", (double)n / (double)count)
               : GONIO_OK;
}

/* The best match, the nearest of several, the first of equals; `count` if there is none. */
static size_t find(known_places *k, gonio_pair at)
{
    const sought s = seek(at);
    best b = {NONE, INFINITY, INFINITY, k->readings->count};
    try_angles(k, &s, at.incident.theta, at.outgoing.theta, &b);
    if (b.like == NONE) {
        try_angles(k, &s, at.outgoing.theta, at.incident.theta, &b);
    }
    return b.reading;
}

gonio_status gonio_i_find_readings(gonio_context *context, const gonio_readings *readings,
                                   bool any_rotation, const gonio_pair *pair, size_t count,
                                   size_t most, size_t *found)
{
    known_places k;
    if (!sort_places(context, readings, any_rotation, &k)) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_OK;
    for (size_t n = 0; n < count && status == GONIO_OK; n++) {
        const sought s = seek(pair[n]);
        best b = {NONE, INFINITY, INFINITY, readings->count};
        if (k.compared < most) {
            try_angles(&k, &s, pair[n].incident.theta, pair[n].outgoing.theta, &b);
        }
        found[n] = b.like < RECIPROCAL ? b.reading : readings->count;
        status = ask(context, n, count);
    }
    free(k.place);
    return status;
}

gonio_status gonio_readings_find(gonio_context *context, const gonio_readings *readings,
                                 const gonio_readings *others, bool *same)
{
    known_places k;
    if (!sort_places(context, others, false, &k)) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_OK;
    for (size_t n = 0; n < readings->count && status == GONIO_OK; n++) {
        same[n] = find(&k, readings->pair[n]) < others->count;
        status = ask(context, n, readings->count);
    }
    free(k.place);
    return status;
}

/* ---- taking values ---- */

/* Links readings of equal directions: next[reading] is the following one plus 1; 0 is the end. */
static size_t *link_repeats(gonio_context *context, const gonio_readings *known)
{
    size_t *next = gonio_i_allocate(context, known->count, sizeof *next);
    for (size_t n = known->count; next != NULL && n-- > 0;) {
        const size_t first = known->first_same[n];
        if (first != n) {
            next[n] = next[first];
            next[first] = n + 1;
        }
    }
    return next;
}

/* The mean of the linked readings in one channel, and its deviation. Returns their number. */
static size_t average(const gonio_readings *known, const size_t *next, size_t first, size_t channel,
                      double *value, double *deviation)
{
    double sum = 0.0;
    double length = 0.0; /* of the deviations as a vector */
    size_t count = 0;
    for (size_t n = first + 1; n > 0; n = next[n - 1]) {
        const size_t at = (n - 1) * known->channels + channel;
        if (!isnan(known->value[at])) {
            sum += known->value[at];
            length = known->deviation != NULL ? hypot(length, known->deviation[at]) : NAN;
            count++;
        }
    }
    *value = count > 0 ? sum / (double)count : NAN;
    *deviation = count > 0 ? length / (double)count : NAN;
    return count;
}

/* Copies the values of a direction, whose first reading is `first`. Both have the same channels.
 * Returns whether several readings were averaged. */
static bool take_values(gonio_readings *plan, size_t row, const gonio_readings *known,
                        const size_t *next, size_t first)
{
    bool averaged = false;
    for (size_t c = 0; c < known->channels; c++) {
        const size_t at = row * known->channels + c;
        double deviation = 0.0;
        averaged = average(known, next, first, c, &plan->value[at], &deviation) > 1 || averaged;
        if (known->deviation != NULL) {
            plan->deviation[at] = deviation;
        }
    }
    return averaged;
}

/* Gives the plan the channels of the known readings, and room for values and deviations. */
static gonio_status take_channels(gonio_context *context, gonio_readings *plan,
                                  const gonio_readings *known)
{
    const gonio_status status =
        gonio_i_readings_set_channels(context, plan, known->channels, known->wavelength);
    if (status != GONIO_OK || known->deviation == NULL) {
        return status;
    }
    plan->deviation = gonio_i_allocate(context, plan->count * plan->channels, sizeof(double));
    gonio_i_readings_update_view(plan);
    return plan->deviation != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status refuse_unread(gonio_context *context, const gonio_readings *plan, size_t row,
                                  const known_places *k)
{
    char turned[96] = "";
    if (k->turned) {
        snprintf(turned, sizeof turned,
                 " and this rotation of the sample, by which readings differ (%.0f %%)",
                 100.0 * expm1(k->median));
    }
    return gonio_i_fail(context, GONIO_ERROR_DATA,
                        "%s:%zu: %s has no reading at these directions%s; plan with --candidates "
                        "to choose among those it has",
                        plan->path, plan->line[row], k->readings->path, turned);
}

/* What was taken for a direction of the known readings. */
typedef struct taken_row {
    size_t row;    /* of the plan, plus 1; 0: none yet */
    bool averaged; /* of several readings */
} taken_row;

/* Copies what another row of the plan has. */
static void copy_row(gonio_readings *plan, size_t from, size_t to)
{
    const size_t channels = plan->channels;
    memcpy(plan->value + to * channels, plan->value + from * channels,
           channels * sizeof *plan->value);
    if (plan->deviation != NULL) {
        memcpy(plan->deviation + to * channels, plan->deviation + from * channels,
               channels * sizeof *plan->deviation);
    }
}

/* taken: [known->count], all 0. */
static gonio_status take_rows(gonio_context *context, gonio_readings *plan, known_places *k,
                              const size_t *next, taken_row *taken, size_t *averaged)
{
    const gonio_readings *known = k->readings;
    gonio_status status = GONIO_OK;
    for (size_t n = 0; n < plan->count && status == GONIO_OK; n++) {
        const size_t from = find(k, plan->pair[n]);
        status = ask(context, n, plan->count);
        if (from == known->count) {
            return refuse_unread(context, plan, n, k);
        }
        const size_t first = known->first_same[from];
        if (taken[first].row > 0) {
            copy_row(plan, taken[first].row - 1, n);
        } else {
            taken[first].averaged = take_values(plan, n, known, next, first);
            taken[first].row = n + 1;
        }
        *averaged += taken[first].averaged;
    }
    return status;
}

static gonio_status fill(gonio_context *context, gonio_readings *plan, known_places *k,
                         const size_t *next)
{
    const gonio_readings *known = k->readings;
    size_t averaged = 0;
    taken_row *of = gonio_i_allocate(context, known->count, sizeof *of);
    const gonio_status status =
        of == NULL ? GONIO_ERROR_MEMORY : take_rows(context, plan, k, next, of, &averaged);
    free(of);
    if (status != GONIO_OK) {
        return status;
    }
    if (averaged > 0) {
        gonio_i_note(context, "%s: read more than once at %zu of %zu directions: means are taken",
                     known->path, averaged, plan->count);
    }
    return GONIO_OK;
}

gonio_status gonio_readings_look_up(gonio_context *context, gonio_readings *plan,
                                    const gonio_readings *known)
{
    known_places k;
    size_t *next = link_repeats(context, known);
    gonio_status status = sort_places(context, known, false, &k) && next != NULL
                              ? take_channels(context, plan, known)
                              : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = fill(context, plan, &k, next);
    }
    free(k.place);
    free(next);
    return status;
}

/* The mean values at one direction. Returns whether several readings were averaged. */
static bool average_direction(const gonio_readings *readings, const size_t *next, size_t first,
                              double *mean, double *deviation)
{
    bool averaged = false;
    for (size_t c = 0; c < readings->channels; c++) {
        averaged = average(readings, next, first, c, &mean[c], &deviation[c]) > 1 || averaged;
    }
    return averaged;
}

/* Replaces the values of a direction by their means. */
static void spread(gonio_readings *readings, const size_t *next, size_t first, const double *mean,
                   const double *deviation)
{
    for (size_t n = first + 1; n > 0; n = next[n - 1]) {
        const size_t at = (n - 1) * readings->channels;
        for (size_t c = 0; c < readings->channels; c++) {
            const bool read = !isnan(readings->value[at + c]);
            readings->value[at + c] = read ? mean[c] : NAN;
            if (readings->deviation != NULL && read) {
                readings->deviation[at + c] = deviation[c];
            }
        }
    }
}

gonio_status gonio_readings_average_repeats(gonio_context *context, gonio_readings *readings)
{
    size_t *next = link_repeats(context, readings);
    double *mean = gonio_i_allocate(context, 2 * readings->channels, sizeof *mean);
    const gonio_status status = next != NULL && mean != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    size_t averaged = 0;
    for (size_t n = 0; n < readings->count && status == GONIO_OK; n++) {
        if (next[n] > 0 && readings->first_same[n] == n &&
            average_direction(readings, next, n, mean, mean + readings->channels)) {
            spread(readings, next, n, mean, mean + readings->channels);
            averaged++;
        }
    }
    if (averaged > 0) {
        gonio_i_note(context, "%s: read more than once at %zu direction%s: means are taken",
                     readings->path, averaged, averaged == 1 ? "" : "s");
    }
    free(next);
    free(mean);
    return status;
}
