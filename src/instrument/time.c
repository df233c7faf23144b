/* How long readings take. */
#include <math.h>

#include "instrument.h"

/* A theta_i that differs by less is the same incidence, rad: steps of axes are no change. */
static const double SAME_INCIDENCE = 0.1 * M_PI / 180.0;

/* A smaller move is none, rad. */
static const double NO_MOVE = 1e-7;

double gonio_instrument_travel(const gonio_instrument *instrument, const gonio_setting *from,
                               const gonio_setting *to)
{
    const gonio_instrument_view *view = &instrument->view;
    double longest = 0.0;
    double sum = 0.0;
    for (size_t k = 0; k < view->axes; k++) {
        const gonio_axis *axis = &instrument->axis[k];
        const double way = fabs(to->axis[k] - from->axis[k]);
        if (way > NO_MOVE) {
            const double time = (axis->speed > 0.0 ? way / axis->speed : 0.0) + axis->settling;
            longest = fmax(longest, time);
            sum += time;
        }
    }
    const double turned = fabs(to->pair.incident.theta - from->pair.incident.theta);
    return (view->in_turn ? sum : longest) +
           (turned > SAME_INCIDENCE ? view->incidence_change : 0.0);
}

void gonio_instrument_home(const gonio_instrument *instrument, gonio_setting *home)
{
    for (size_t k = 0; k < GONIO_MOST_AXES; k++) {
        const gonio_axis *axis = &instrument->axis[k];
        double best = fmin(fmax(0.0, axis->low), axis->high);
        for (size_t j = 0; j < axis->positions; j++) {
            best = j == 0 || fabs(axis->position[j]) < fabs(best) ? axis->position[j] : best;
        }
        home->axis[k] = best;
    }
    home->pair = gonio_instrument_pair(instrument, home->axis);
}

double gonio_instrument_schedule(const gonio_instrument *instrument, const gonio_setting *setting,
                                 size_t count, double *time)
{
    const gonio_instrument_view *view = &instrument->view;
    const bool references = view->reference_every > 0.0;
    gonio_setting at;
    gonio_instrument_home(instrument, &at);
    double now = references && count > 0 ? view->reference_time : 0.0;
    double last = now;
    for (size_t k = 0; k < count; k++) {
        const double needed =
            gonio_instrument_travel(instrument, &at, &setting[k]) + view->exposure;
        if (references && now + needed - last > view->reference_every) {
            now += view->reference_time;
            last = now;
        }
        now += needed;
        at = setting[k];
        if (time != NULL) {
            time[k] = now;
        }
    }
    return now;
}
