/* The readings that an instrument offers to a plan.
 *
 * Candidates lie on levels of theta_i, so that a run changes the incidence as few times as
 * possible. On each level half vectors crowd around the normal, where a peak is. With the freedom
 * of an isotropic sample the light is at phi = 0, and mirror images are left out.
 *
 * Where another axis than that of theta_i has a list of positions, such pairs would hardly meet
 * them. Candidates then are what the positions of the axes read. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "settings.h"

enum {
    MOST_LEVELS = 512,
    HALF_BINS = 90, /* of theta_h, as in the grid (direction.h) */
    TURNS = 12,     /* of phi_h in half a turn */
    COARSEST = 6,   /* times that the search is made coarser */
    MOST_TRIES = 1000000,
    MOST_OBSTACLES = 64
};

/* The finest distance of levels where the light takes any angle. */
static const double FINEST_LEVELS = 1.25 * M_PI / 180.0;

/* Candidates whose angles agree to this are the same, rad. */
static const double SAME = 2e-5;

/* What keeps settings out, and how many. */
typedef struct tally {
    const char *name[MOST_OBSTACLES];
    size_t times[MOST_OBSTACLES];
    size_t names;
} tally;

typedef struct search {
    gonio_context *context;
    const gonio_instrument *instrument;
    gonio_freedom freedom;
    size_t most; /* to find; the search ends then */
    gonio_setting *found;
    size_t count;
    size_t room;
    bool out_of_memory;
    tally obstacles;
} search;

/* ---- levels ---- */

static size_t listed_levels(const gonio_axis *axis, double level[])
{
    size_t count = 0;
    for (size_t k = 0; k < axis->positions && count < MOST_LEVELS; k++) {
        const double theta = fabs(axis->position[k]);
        bool known = false;
        for (size_t j = 0; j < count; j++) {
            known = known || fabs(level[j] - theta) < GONIO_I_EDGE;
        }
        level[count] = theta;
        count += !known && theta < 0.5 * M_PI;
    }
    return count;
}

/* The levels of theta_i. Where the light's axis has steps, the levels are multiples of them. */
static size_t find_levels(const gonio_instrument *instrument, double apart, double level[])
{
    const int incidence = instrument->kinematics->incidence;
    const gonio_axis *axis = incidence >= 0 ? &instrument->axis[incidence] : NULL;
    if (axis != NULL && axis->positions > 0) {
        return listed_levels(axis, level);
    }
    const double step = axis != NULL ? axis->step : 0.0;
    const double between = step > 0.0 ? step * fmax(1.0, round(apart / step)) : apart;
    size_t count = 0;
    if (axis != NULL && axis->low == axis->high) {
        level[0] = fabs(axis->low);
        return 1;
    }
    const double first = axis != NULL && axis->low > 0.0 ? axis->low : 0.0;
    const double last = axis != NULL ? fmin(axis->high, 0.5 * M_PI) : 0.5 * M_PI;
    for (; count + 1 < MOST_LEVELS && first + (double)count * between < last - GONIO_I_EDGE;
         count++) {
        level[count] = first + (double)count * between;
    }
    if (last < 0.5 * M_PI) {
        level[count++] = last;
    }
    return count;
}

/* ---- the search ---- */

static void count_obstacle(tally *t, const char *name)
{
    for (size_t k = 0; k < t->names; k++) {
        if (t->name[k] == name) {
            t->times[k]++;
            return;
        }
    }
    if (t->names < MOST_OBSTACLES) {
        t->name[t->names] = name;
        t->times[t->names++] = 1;
    }
}

static bool append(search *s, const gonio_setting *setting)
{
    if (s->count == s->room) {
        const size_t room = s->room > 0 ? 2 * s->room : 256;
        gonio_setting *more = reallocarray(s->found, room, sizeof *more);
        if (more == NULL) {
            s->out_of_memory = true;
            return false;
        }
        s->found = more;
        s->room = room;
    }
    s->found[s->count++] = *setting;
    return s->count < s->most;
}

/* Looks whether a pair can be read. Returns whether the search goes on. */
static bool try_pair(search *s, gonio_pair pair)
{
    gonio_setting one;
    gonio_i_settings settings = {.setting = &one, .most = 1};
    gonio_i_find_settings(s->instrument, pair, s->freedom, &settings);
    if (settings.count > 0) {
        return append(s, &one);
    }
    if (settings.obstacle != NULL) {
        count_obstacle(&s->obstacles, settings.obstacle);
    }
    return true;
}

/* The light at (theta, 0) and its reflection by the half vector. False if that is below the
 * horizon. */
static bool reflect(double theta, double theta_h, double phi_h, gonio_pair *pair)
{
    const double i[3] = {sin(theta), 0.0, cos(theta)};
    const double h[3] = {sin(theta_h) * cos(phi_h), sin(theta_h) * sin(phi_h), cos(theta_h)};
    const double twice = 2.0 * (i[0] * h[0] + i[2] * h[2]);
    const double o[3] = {twice * h[0] - i[0], twice * h[1], twice * h[2] - i[2]};
    const double across = hypot(o[0], o[1]);
    *pair = (gonio_pair){
        {theta, 0.0},
        {atan2(across, o[2]), across < 1e-9 ? 0.0 : gonio_i_azimuth(atan2(o[1], o[0]))}};
    return o[2] > 1e-3 && twice > 0.0;
}

/* All turns of the half vector at one theta_h; with the sample's freedom half of them. */
static bool try_half_vectors(search *s, double level, double theta_h)
{
    const bool half = s->freedom.isotropic && s->freedom.bilateral;
    const int turns = half ? TURNS + 1 : 2 * TURNS;
    gonio_pair pair;
    bool more = true;
    for (int k = 0; k < turns && more; k++) {
        if (reflect(level, theta_h, M_PI * k / TURNS, &pair)) {
            more = try_pair(s, pair);
        }
    }
    return more;
}

static bool try_level(search *s, double level, int skipped)
{
    bool more = true;
    for (int bin = 0; bin < HALF_BINS && more; bin += 1 + skipped) {
        const double root = (bin + 0.5) / HALF_BINS;
        more = try_half_vectors(s, level, root * root * 0.5 * M_PI);
    }
    return more;
}

static void try_rows(search *s)
{
    bool more = true;
    for (size_t row = 0; row < s->instrument->view.directions && more; row++) {
        more = try_pair(s, s->instrument->row[row].pair);
    }
}

/* ---- positions of the axes ---- */

static bool has_listed_axes(const gonio_instrument *instrument)
{
    bool any = false;
    for (size_t k = 0; k < instrument->view.axes; k++) {
        any = any ||
              (instrument->axis[k].positions > 0 && (int)k != instrument->kinematics->incidence);
    }
    return any;
}

/* How far apart positions are that are tried on an axis without a list. */
static double between_positions(const gonio_axis *axis, double apart)
{
    return axis->step > 0.0 ? axis->step * fmax(1.0, round(apart / axis->step)) : apart;
}

/* How many positions of an axis are tried. */
static size_t positions_of(const gonio_axis *axis, double apart)
{
    return axis->positions > 0
               ? axis->positions
               : (size_t)ceil((axis->high - axis->low) / between_positions(axis, apart) -
                              GONIO_I_EDGE) +
                     1;
}

static double position_at(const gonio_axis *axis, double apart, size_t k)
{
    return axis->positions > 0
               ? axis->position[k]
               : fmin(axis->low + (double)k * between_positions(axis, apart), axis->high);
}

/* How many settings that makes. */
static double settings_apart(const gonio_instrument *instrument, double apart)
{
    double count = 1.0;
    for (size_t k = 0; k < instrument->view.axes; k++) {
        count *= (double)positions_of(&instrument->axis[k], apart);
    }
    return count;
}

/* The pair of which a plan knows by the freedom: the light at phi = 0, no mirror image. */
static gonio_pair standing_for(gonio_pair pair, gonio_freedom freedom)
{
    if (!freedom.isotropic) {
        return pair;
    }
    const double difference = gonio_i_azimuth_difference(&pair);
    const double smallest = fmin(difference, 2.0 * M_PI - difference);
    return (gonio_pair){{pair.incident.theta, 0.0},
                        {pair.outgoing.theta, freedom.bilateral ? smallest : difference}};
}

/* Setting `number` of the grid, counted axis by axis. Returns whether the search goes on. */
static bool try_setting(search *s, double apart, size_t number)
{
    gonio_setting one = {0};
    for (size_t k = 0; k < s->instrument->view.axes; k++) {
        const gonio_axis *axis = &s->instrument->axis[k];
        const size_t positions = positions_of(axis, apart);
        one.axis[k] = position_at(axis, apart, number % positions);
        number /= positions;
    }
    const char *obstacle = gonio_i_take_position(s->instrument, &one);
    if (obstacle != NULL) {
        count_obstacle(&s->obstacles, obstacle);
        return true;
    }
    one.pair = standing_for(one.pair, s->freedom);
    return append(s, &one);
}

static double apart_of(int coarser)
{
    return FINEST_LEVELS * (double)(1 << coarser);
}

static void try_positions(search *s, int coarser)
{
    const double settings = settings_apart(s->instrument, apart_of(coarser));
    bool more = true;
    for (size_t k = 0; (double)k < settings && k < MOST_TRIES && more; k++) {
        more = try_setting(s, apart_of(coarser), k);
    }
}

/* ---- the same candidates ---- */

static int compare_settings(const void *a, const void *b)
{
    const gonio_setting *x = a;
    const gonio_setting *y = b;
    const double left[4] = {x->pair.incident.theta, x->pair.outgoing.theta, x->pair.incident.phi,
                            x->pair.outgoing.phi};
    const double right[4] = {y->pair.incident.theta, y->pair.outgoing.theta, y->pair.incident.phi,
                             y->pair.outgoing.phi};
    int order = 0;
    for (int k = 0; k < 4 && order == 0; k++) {
        const long long l = llround(left[k] / SAME);
        const long long r = llround(right[k] / SAME);
        order = (l > r) - (l < r);
    }
    return order;
}

static void leave_out_repeats(search *s)
{
    size_t kept = 0;
    if (s->count == 0) {
        return;
    }
    qsort(s->found, s->count, sizeof *s->found, compare_settings);
    for (size_t k = 0; k < s->count; k++) {
        if (kept == 0 || compare_settings(&s->found[k], &s->found[kept - 1]) != 0) {
            s->found[kept++] = s->found[k];
        }
    }
    s->count = kept;
}

/* ---- all ---- */

/* At 0 the finest levels and half vectors; each time one of them twice as far apart. */
static void search_directions(search *s, int coarser)
{
    double level[MOST_LEVELS] = {0.0};
    const size_t levels =
        find_levels(s->instrument, FINEST_LEVELS * (double)(1 << ((coarser + 1) / 2)), level);
    bool more = true;
    for (size_t k = 0; k < levels && more; k++) {
        more = try_level(s, level[k], (1 << (coarser / 2)) - 1);
    }
}

static void run(search *s, int coarser)
{
    s->count = 0;
    if (s->instrument->view.directions > 0) {
        try_rows(s);
    } else if (has_listed_axes(s->instrument)) {
        try_positions(s, coarser);
    } else {
        search_directions(s, coarser);
    }
    leave_out_repeats(s);
}

static bool takes_too_long(const search *s, int coarser)
{
    return has_listed_axes(s->instrument) &&
           settings_apart(s->instrument, apart_of(coarser)) > MOST_TRIES;
}

/* Ever more finely while there is room for twice as many. */
static void search_as_finely(search *s, size_t most)
{
    int coarser = s->instrument->view.directions > 0 ? 0 : COARSEST;
    run(s, coarser);
    while (coarser > 0 && !s->out_of_memory && s->count <= most / 2 &&
           !takes_too_long(s, coarser - 1)) {
        run(s, --coarser);
    }
    if (coarser < COARSEST && s->count > most && s->instrument->view.directions == 0) {
        run(s, coarser + 1);
    }
}

/* Keeps `most`, evenly spread over the order: at all incidences, not at the lowest alone. */
static void thin(search *s, size_t most)
{
    if (s->count <= most) {
        return;
    }
    for (size_t k = 0; k < most; k++) {
        s->found[k] = s->found[k * s->count / most];
    }
    s->count = most;
}

static gonio_status say_empty(const search *s)
{
    const tally *t = &s->obstacles;
    size_t worst = 0;
    for (size_t k = 1; k < t->names; k++) {
        const bool axis = gonio_i_is_axis(s->instrument, t->name[k]);
        const bool other = gonio_i_is_axis(s->instrument, t->name[worst]);
        const bool more = axis == other ? t->times[k] > t->times[worst] : other;
        worst = more ? k : worst;
    }
    return gonio_i_fail(s->context, GONIO_ERROR_DATA,
                        "%s: no pair of directions can be reached; most are kept out by '%s'",
                        s->instrument->view.path, t->names > 0 ? t->name[worst] : "kinematics");
}

gonio_status gonio_instrument_candidates(gonio_context *context, const gonio_instrument *instrument,
                                         gonio_freedom freedom, size_t most,
                                         gonio_setting **setting, size_t *count)
{
    search s = {.context = context, .instrument = instrument, .freedom = freedom, .most = SIZE_MAX};
    search_as_finely(&s, most);
    gonio_status status = GONIO_OK;
    if (s.out_of_memory) {
        status = gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory for directions");
    } else if (s.count == 0) {
        status = say_empty(&s);
    } else {
        thin(&s, most);
        *setting = s.found;
        *count = s.count;
    }
    if (status != GONIO_OK) {
        free(s.found);
    }
    return status;
}

gonio_status gonio_i_check_reach(gonio_context *context, const gonio_instrument *instrument)
{
    search s = {
        .context = context, .instrument = instrument, .freedom = GONIO_ALL_FREEDOM, .most = 1};
    int coarser = 0;
    while (coarser < COARSEST && takes_too_long(&s, coarser)) {
        coarser++;
    }
    run(&s, coarser);
    free(s.found);
    if (s.out_of_memory) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory for directions");
    }
    return s.count > 0 ? GONIO_OK : say_empty(&s);
}
