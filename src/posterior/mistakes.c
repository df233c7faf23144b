/* Usual mistakes in readings: see mistakes.h.
 *
 * Units are judged by the albedo, because materials differ by more than a factor of pi: a material
 * that reflects more than it receives is not one, and what makes it plausible is offered. Angles
 * and cosines are judged by how well readings predict each other (transform_trial.h). An unusual
 * material is explained better by many transforms, so a mistake has to explain it better than any
 * change of the unit does. */
#include "mistakes.h"

#include <math.h>
#include <stdlib.h>

#include "../measurement/readings.h"
#include "transform_trial.h"

/* What a mistake in angles has to explain, in ln of the density of a column, over the readings as
 * they are and in any unit (docs/experiments.md). */
static const double CONVINCING = 10.0;

/* The same of a cosine, which many right readings at grazing angles seem to include: over the
 * readings as they are, and in any unit. */
static const double OF_COSINE = 16.0;
static const double OF_COSINE_IN_UNITS = 6.0;

/* The same where velvet and cloth are easily mistaken: they too are bright towards the light. */
static const double OF_MIRROR = 20.0;

/* The same of angles that are all below pi/2 degrees, as nobody measures. */
static const double OF_RADIANS = 2.0;

/* Mistakes that explain less by this are not told. A unit of ln of the density; of MERL's numbers
 * less, because their factor is far from the others. */
static const double SIMILAR = 5.0;
static const double SIMILAR_UNITS = 30.0;
static const double SIMILAR_MERL = 4.0;

/* A mean albedo that is too large for a material even if the readings say little of it; and pi
 * times the median value from which that is not the doing of single readings. */
static const double TOO_MUCH = 1.5;
static const double BRIGHT = 0.6;

/* The albedos that another unit may give. */
static const double DARKEST = 0.004;
static const double BRIGHTEST = 1.05;

static const double USUAL_ALBEDO = 0.3;

/* Fewer readings do not tell of angles. */
enum { FEW = 5 };

static double to_radians(double degrees_taken_for_radians)
{
    return degrees_taken_for_radians * 180.0 / M_PI;
}

static gonio_pair from_radians(gonio_pair p)
{
    return (gonio_pair){{to_radians(p.incident.theta), to_radians(p.incident.phi)},
                        {to_radians(p.outgoing.theta), to_radians(p.outgoing.phi)}};
}

static gonio_pair from_elevation(gonio_pair p)
{
    return (gonio_pair){{M_PI / 2.0 - p.incident.theta, p.incident.phi},
                        {M_PI / 2.0 - p.outgoing.theta, p.outgoing.phi}};
}

static gonio_pair from_mirror(gonio_pair p)
{
    return (gonio_pair){p.incident, {p.outgoing.theta, p.outgoing.phi + M_PI}};
}

typedef struct hypothesis {
    gonio_i_transform transform;
    const char *name;
    double convincing; /* what it has to explain; 0 for a unit */
    double in_units;   /* and over the readings in any unit; */
    bool certain;      /* whatever the units and the albedo are */
    bool colours;      /* only of R, G, B */
    bool levels;       /* only of whole numbers up to 255; before all others then */
} hypothesis;

static const hypothesis UNITS[] = {
    {.transform = {.factor = 1.0 / M_PI},
     .name = "the values are reflectance factors; divide them by pi"},
    {.transform = {.factor = 0.01}, .name = "the values are in per cent; divide them by 100"},
    {.transform = {.factor = 0.01 / M_PI},
     .name = "the values are reflectance factors in per cent; divide them by 100 pi"},
    {.transform = {.factor = 1.0, .merl = true},
     .name = "the values are numbers of a MERL file; multiply them by (1, 1.15, 1.66)/1500",
     .colours = true},
    {.transform = {.factor = 1.0 / (255.0 * M_PI)},
     .name =
         "the values are levels of an image; if they are in proportion to light, divide them by "
         "255 pi",
     .levels = true},
};

static const hypothesis ANGLES[] = {
    {.transform = {.factor = 1.0, .by_cosine_i = true},
     .name = "the values include the cosine of theta_i; divide them by it",
     .convincing = OF_COSINE,
     .in_units = OF_COSINE_IN_UNITS},
    {.transform = {.factor = 1.0, .by_cosine = true},
     .name = "the values include the cosine of theta_o; divide them by it",
     .convincing = OF_COSINE,
     .in_units = OF_COSINE_IN_UNITS},
    {.transform = {.factor = 1.0, .change = from_radians},
     .name = "the angles are in radians; write them in degrees",
     .convincing = OF_RADIANS,
     .certain = true},
    {.transform = {.factor = 1.0, .change = from_elevation},
     .name = "theta is measured from the surface; give 90 degrees less theta",
     .convincing = CONVINCING,
     .in_units = CONVINCING},
    {.transform = {.factor = 1.0, .change = from_mirror},
     .name = "phi_o is measured from the mirror direction; add 180 degrees to it, unless the "
             "material is a retroreflector",
     .convincing = OF_MIRROR,
     .in_units = OF_MIRROR},
};

enum {
    UNITS_COUNT = sizeof UNITS / sizeof *UNITS,
    ANGLES_COUNT = sizeof ANGLES / sizeof *ANGLES,
};

gonio_i_change gonio_i_mistake_change(const char *mistake)
{
    for (int k = 0; k < ANGLES_COUNT; k++) {
        if (ANGLES[k].name == mistake) {
            return ANGLES[k].transform.change;
        }
    }
    return NULL;
}

/* A hypothesis that has been tried. */
typedef struct tried {
    const hypothesis *hypothesis;
    bool possible;
    gonio_i_verdict verdict;
    double largest; /* albedo of the brightest channel */
    double mean;    /* and of all */
    double worth;   /* by which alternatives are sorted */
} tried;

typedef struct search {
    gonio_i_transform_trial trial;
    gonio_i_transform as_it_is;
    gonio_i_verdict given; /* of the readings as they are */
    double mean;           /* albedo of the same */
    bool units_tried;
    tried unit[UNITS_COUNT];
    tried angle[ANGLES_COUNT];
    gonio_interpretation *found;
} search;

static gonio_status try_one(search *s, const hypothesis *h, tried *t)
{
    const bool colours = gonio_readings_are_colours(s->trial.readings);
    t->hypothesis = h;
    t->possible = (colours || !h->colours) &&
                  (!h->levels || gonio_i_readings_are_levels(s->trial.readings)) &&
                  gonio_i_transform_trial_is_possible(&s->trial, &h->transform);
    gonio_status status = t->possible
                              ? gonio_i_transform_trial_judge(&s->trial, &h->transform, &t->verdict)
                              : GONIO_OK;
    return status;
}

static gonio_status try_units(search *s)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < UNITS_COUNT && !s->units_tried && status == GONIO_OK; k++) {
        status = try_one(s, &UNITS[k], &s->unit[k]);
    }
    s->units_tried = true;
    return status;
}

static gonio_status find_albedo(search *s, tried *t)
{
    return gonio_i_transform_trial_albedo(&s->trial, &t->hypothesis->transform, &t->verdict,
                                          &t->largest, &t->mean);
}

/* ---- what is offered ---- */

static int compare_worth(const void *a, const void *b)
{
    const tried *x = a;
    const tried *y = b;
    return (x->worth < y->worth) - (x->worth > y->worth);
}

/* Offers those that are worth something, of `similar` worth, best first. */
static void offer(search *s, tried *all, size_t count, double similar)
{
    gonio_interpretation *found = s->found;
    qsort(all, count, sizeof *all, compare_worth);
    for (size_t k = 0; k < count && found->alternatives < GONIO_MOST_ALTERNATIVES; k++) {
        if (all[k].worth > -INFINITY && all[k].worth >= all[0].worth - similar) {
            found->alternative[found->alternatives++] =
                (gonio_alternative){all[k].hypothesis->name, all[k].largest,
                                    all[k].hypothesis->convincing > 0.0 ? all[k].worth : 0.0};
        }
    }
}

/* ---- angles and cosines ---- */

/* The best explanation without a mistake in angles: the readings in any unit. */
static const gonio_i_verdict *best_unit(const search *s)
{
    const gonio_i_verdict *best = &s->given;
    for (int k = 0; k < UNITS_COUNT; k++) {
        if (s->unit[k].possible && s->unit[k].verdict.sum > best->sum) {
            best = &s->unit[k].verdict;
        }
    }
    return best;
}

/* Whether a mistake explains the readings better than any unit does, with a plausible albedo. */
static gonio_status check_units(search *s, tried *t, bool *convincing)
{
    gonio_status status = try_units(s);
    const double margin = gonio_i_transform_trial_margin(&s->trial, &t->verdict, best_unit(s));
    *convincing = margin > t->hypothesis->in_units;
    t->worth = fmin(t->worth, margin);
    if (*convincing && status == GONIO_OK) {
        status = find_albedo(s, t);
        *convincing = t->mean <= TOO_MUCH;
    }
    return status;
}

/* What a hypothesis is worth: the margin over no mistake; -INFINITY if that does not convince. */
static gonio_status value_angle(search *s, tried *t)
{
    t->worth =
        t->possible ? gonio_i_transform_trial_margin(&s->trial, &t->verdict, &s->given) : -INFINITY;
    bool convincing = t->worth > t->hypothesis->convincing;
    gonio_status status = GONIO_OK;
    if (convincing) {
        status = t->hypothesis->certain ? find_albedo(s, t) : check_units(s, t, &convincing);
    }
    t->worth = convincing ? t->worth : -INFINITY;
    return status;
}

static gonio_status find_angles(search *s)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < ANGLES_COUNT && status == GONIO_OK; k++) {
        status = try_one(s, &ANGLES[k], &s->angle[k]);
        if (status == GONIO_OK) {
            status = value_angle(s, &s->angle[k]);
        }
    }
    if (status == GONIO_OK) {
        offer(s, s->angle, ANGLES_COUNT, SIMILAR);
    }
    return status;
}

/* ---- units ---- */

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Whether most readings are bright, not only a few that an albedo is made of. */
static gonio_status find_bright(const search *s, bool *bright)
{
    const gonio_i_transform_trial *t = &s->trial;
    size_t count = 0;
    for (size_t c = 0; c < t->count; c++) {
        count += t->column[c].count;
    }
    double *value = gonio_i_allocate(t->context, count, sizeof *value);
    if (value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    count = 0;
    for (size_t c = 0; c < t->count; c++) {
        for (size_t i = 0; i < t->column[c].count; i++) {
            value[count++] = gonio_readings_value(t->readings, t->column[c].observation[i].reading,
                                                  t->channel[c]);
        }
    }
    qsort(value, count, sizeof *value, compare_numbers);
    *bright = count > 0 && M_PI * value[count / 2] > BRIGHT;
    free(value);
    return GONIO_OK;
}

/* The closer the albedo is to that of usual materials the better. The scores of units prefer dark
 * materials, which all look alike: they only exclude. */
static gonio_status value_unit(search *s, tried *t, double best)
{
    const double similar = t->hypothesis->transform.merl ? SIMILAR_MERL : SIMILAR_UNITS;
    const bool explains = t->possible && t->verdict.sum >= best - similar;
    const gonio_status status = explains ? find_albedo(s, t) : GONIO_OK;
    t->worth = explains && t->mean > DARKEST && t->mean < BRIGHTEST
                   ? (t->hypothesis->levels ? 1.0 : -fabs(log(t->mean / USUAL_ALBEDO)))
                   : -INFINITY;
    return status;
}

static gonio_status find_units(search *s)
{
    bool bright = false;
    gonio_status status = s->mean > TOO_MUCH ? find_bright(s, &bright) : GONIO_OK;
    if (!bright || status != GONIO_OK) {
        return status;
    }
    status = try_units(s);
    for (int k = 0; k < UNITS_COUNT && status == GONIO_OK; k++) {
        status = value_unit(s, &s->unit[k], best_unit(s)->sum);
    }
    if (status == GONIO_OK) {
        offer(s, s->unit, UNITS_COUNT, INFINITY);
    }
    return status;
}

static gonio_status find(search *s)
{
    gonio_status status = gonio_i_transform_trial_judge(&s->trial, &s->as_it_is, &s->given);
    if (status == GONIO_OK) {
        status = gonio_i_transform_trial_albedo(&s->trial, &s->as_it_is, &s->given,
                                                &s->found->albedo, &s->mean);
    }
    if (status == GONIO_OK && gonio_readings_describe(s->trial.readings)->count >= FEW) {
        status = find_angles(s);
    }
    return status == GONIO_OK && s->found->alternatives == 0 ? find_units(s) : status;
}

static void release(search *s)
{
    free(s->given.score);
    for (int k = 0; k < UNITS_COUNT; k++) {
        free(s->unit[k].verdict.score);
    }
    for (int k = 0; k < ANGLES_COUNT; k++) {
        free(s->angle[k].verdict.score);
    }
    gonio_i_transform_trial_end(&s->trial);
}

gonio_status gonio_i_mistakes_find(gonio_context *context, const gonio_i_prior *prior,
                                   const gonio_readings *readings, const gonio_i_noise *noise,
                                   const gonio_i_columns *columns, const double *dark,
                                   gonio_interpretation *interpretation)
{
    search s = {.as_it_is = {.factor = 1.0, .dark = dark}, .found = interpretation};
    if (prior->view->channels == GONIO_JOINT) {
        return GONIO_OK; /* the only column holds all channels */
    }
    gonio_status status =
        gonio_i_transform_trial_begin(context, prior, readings, noise, columns, &s.trial);
    if (status == GONIO_OK && s.trial.count > 0) {
        status = find(&s);
    }
    release(&s);
    return status;
}
