/* What an instrument reaches: positions of axes, limits, forbidden zones and the footprint. */
#include <math.h>
#include <string.h>

#include "instrument.h"

/* Limits are kept to within this, rad: steps of axes do not decide. */
static const double NEAR_LIMIT = 3.5e-4;

/* Positions of a list are found from angles this near, rad. */
static const double NEAR_POSITION = 1e-3;

/* ---- quantities ---- */

static double theta_i(const gonio_pair *p)
{
    return p->incident.theta;
}

static double theta_o(const gonio_pair *p)
{
    return p->outgoing.theta;
}

static double phi_i(const gonio_pair *p)
{
    return p->incident.phi;
}

static double phi_o(const gonio_pair *p)
{
    return p->outgoing.phi;
}

static double azimuth(const gonio_pair *p)
{
    const double difference = gonio_i_azimuth_difference(p);
    return fmin(difference, 2.0 * M_PI - difference);
}

/* The angle between two directions, the second turned about the normal by `turn`. */
static double angle_between(const gonio_pair *p, double turn)
{
    const double in = sin(p->incident.theta) * sin(p->outgoing.theta) *
                      cos(p->outgoing.phi - p->incident.phi + turn);
    return acos(fmin(fmax(cos(p->incident.theta) * cos(p->outgoing.theta) + in, -1.0), 1.0));
}

static double separation(const gonio_pair *p)
{
    return angle_between(p, 0.0);
}

static double from_specular(const gonio_pair *p)
{
    return angle_between(p, M_PI);
}

static const struct {
    const char *name;
    double (*value)(const gonio_pair *pair);
    bool turns;       /* an azimuth, to which whole turns may be added */
    bool axis_before; /* an axis of this name is another angle, and is meant where there is one */
} quantities[] = {{"theta_i", theta_i, false, false},
                  {"theta_o", theta_o, false, false},
                  {"phi_i", phi_i, true, false},
                  {"phi_o", phi_o, true, false},
                  {"azimuth", azimuth, false, true},
                  {"separation", separation, false, false},
                  {"from_specular", from_specular, false, false}};

enum { QUANTITIES = sizeof quantities / sizeof *quantities };

const char *gonio_i_quantity_at(int index)
{
    return index >= 0 && index < QUANTITIES ? quantities[index].name : NULL;
}

const char *gonio_i_quantity_named(const char *name)
{
    const char *found = NULL;
    for (int k = 0; k < QUANTITIES; k++) {
        found = strcmp(quantities[k].name, name) == 0 ? quantities[k].name : found;
    }
    return found;
}

bool gonio_i_quantity_gives_way(const char *name)
{
    bool found = false;
    for (int k = 0; k < QUANTITIES; k++) {
        found = found || (quantities[k].axis_before && strcmp(quantities[k].name, name) == 0);
    }
    return found;
}

/* The axis that a range names; the number of axes if it names none. */
static size_t axis_of(const gonio_instrument *instrument, const gonio_range *range)
{
    size_t k = 0;
    while (k < instrument->view.axes &&
           (instrument->axis[k].name != range->quantity || !instrument->axis[k].present)) {
        k++;
    }
    return k;
}

/* The value of a range's quantity, turned into the range if it is an azimuth. */
static double value_of(const gonio_instrument *instrument, const gonio_range *range,
                       const gonio_setting *setting)
{
    const size_t axis = axis_of(instrument, range);
    for (int k = 0; k < QUANTITIES; k++) {
        const bool is_axis = quantities[k].axis_before && axis < instrument->view.axes;
        if (quantities[k].name == range->quantity && !is_axis) {
            const double value = quantities[k].value(&setting->pair);
            return quantities[k].turns ? gonio_i_turn_into(value, range->low) : value;
        }
    }
    return axis < instrument->view.axes ? setting->axis[axis] : NAN;
}

/* ---- what keeps a setting out ---- */

static const char *outside_limits(const gonio_instrument *instrument, const gonio_setting *setting)
{
    for (size_t k = 0; k < instrument->view.limits; k++) {
        const gonio_range *limit = &instrument->view.limit[k];
        const double value = value_of(instrument, limit, setting);
        if (!(value >= limit->low - NEAR_LIMIT && value <= limit->high + NEAR_LIMIT)) {
            return limit->quantity;
        }
    }
    return NULL;
}

static const char *inside_zone(const gonio_instrument *instrument, const gonio_setting *setting)
{
    for (size_t k = 0; k < instrument->view.zones; k++) {
        const gonio_zone *zone = &instrument->view.zone[k];
        bool inside = true;
        for (size_t j = 0; j < zone->ranges; j++) {
            const double value = value_of(instrument, &zone->range[j], setting);
            inside = inside && value >= zone->range[j].low - GONIO_I_EDGE &&
                     value < zone->range[j].high - GONIO_I_EDGE;
        }
        if (inside) {
            return zone->name;
        }
    }
    return NULL;
}

/* x' A x = 1 of a round beam on the surface: (1 - sin^2 theta u u') / radius^2, u along phi. */
typedef struct ellipse {
    double xx, xy, yy;
} ellipse;

static ellipse footprint_of(gonio_angles beam, double radius)
{
    const double s = sin(beam.theta) * sin(beam.theta);
    const double scale = 1.0 / (radius * radius);
    return (ellipse){scale * (1.0 - s * cos(beam.phi) * cos(beam.phi)),
                     -scale * s * cos(beam.phi) * sin(beam.phi),
                     scale * (1.0 - s * sin(beam.phi) * sin(beam.phi))};
}

/* An ellipse is inside another about the same centre where the difference of their matrices has no
 * negative eigenvalue. */
static bool is_inside(const ellipse *inner, const ellipse *outer)
{
    const double xx = inner->xx - outer->xx;
    const double xy = inner->xy - outer->xy;
    const double yy = inner->yy - outer->yy;
    const double scale = inner->xx + inner->yy;
    return xx + yy >= -1e-9 * scale && xx * yy - xy * xy >= -1e-9 * scale * scale;
}

static bool fits_footprint(const gonio_instrument *instrument, const gonio_pair *pair)
{
    const gonio_instrument_view *view = &instrument->view;
    if (view->lit == 0.0) {
        return true;
    }
    const ellipse lit = footprint_of(pair->incident, 0.5 * view->lit);
    const ellipse seen = footprint_of(pair->outgoing, 0.5 * view->seen);
    return view->lit_inside ? is_inside(&lit, &seen) : is_inside(&seen, &lit);
}

/* Obstacles that follow from the directions and the positions of axes. */
static const char *obstacle_of(const gonio_instrument *instrument, const gonio_setting *setting)
{
    const gonio_pair *pair = &setting->pair;
    if (!(pair->incident.theta < 0.5 * M_PI - GONIO_I_EDGE) ||
        !(pair->outgoing.theta < 0.5 * M_PI - GONIO_I_EDGE)) {
        return "horizon";
    }
    const char *obstacle = outside_limits(instrument, setting);
    obstacle = obstacle != NULL ? obstacle : inside_zone(instrument, setting);
    return obstacle != NULL || fits_footprint(instrument, pair) ? obstacle : "footprint";
}

/* ---- positions ---- */

static double nearest_listed(const gonio_axis *axis, double angle)
{
    double best = axis->position[0];
    for (size_t k = 1; k < axis->positions; k++) {
        best = fabs(axis->position[k] - angle) < fabs(best - angle) ? axis->position[k] : best;
    }
    return best;
}

/* The position that an axis takes for an angle; NaN if it has none. */
static double position_for(const gonio_axis *axis, double angle)
{
    if (axis->positions > 0) {
        const double listed = nearest_listed(axis, angle);
        return fabs(listed - angle) < NEAR_POSITION ? listed : NAN;
    }
    if (!(angle >= axis->low - GONIO_I_EDGE && angle <= axis->high + GONIO_I_EDGE)) {
        return NAN;
    }
    const double inside = fmin(fmax(angle, axis->low), axis->high);
    if (axis->step == 0.0) {
        return inside;
    }
    const double steps = round((inside - axis->low) / axis->step);
    const double there = axis->low + steps * axis->step;
    return there <= axis->high + GONIO_I_EDGE ? there : there - axis->step;
}

const char *gonio_i_take_position(const gonio_instrument *instrument, gonio_setting *setting)
{
    for (size_t k = 0; k < instrument->view.axes; k++) {
        const double there = position_for(&instrument->axis[k], setting->axis[k]);
        if (isnan(there)) {
            return instrument->axis[k].name;
        }
        setting->axis[k] = there;
    }
    setting->pair = instrument->kinematics->pair(instrument, setting->axis);
    return obstacle_of(instrument, setting);
}

const char *gonio_instrument_obstacle(const gonio_instrument *instrument,
                                      const gonio_setting *setting)
{
    for (size_t k = 0; k < instrument->view.axes; k++) {
        const gonio_axis *axis = &instrument->axis[k];
        const double there = position_for(axis, setting->axis[k]);
        const double near = fmax(NEAR_POSITION, 0.5 * axis->step + GONIO_I_EDGE);
        if (!(fabs(there - setting->axis[k]) <= near)) {
            return axis->name;
        }
    }
    return obstacle_of(instrument, setting);
}

gonio_pair gonio_instrument_pair(const gonio_instrument *instrument, const double *axis)
{
    return instrument->kinematics->pair(instrument, axis);
}
