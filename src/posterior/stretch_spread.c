/* What readings leave open of a stretch: see stretch_spread.h. */
#include "stretch_spread.h"

#include <math.h>

enum { STEPS = 5 };

/* The steps that are tried: these, and twice, four times, .. as much. */
static const double LEAST_RATIO = 0.05;
static const double LEAST_ROTATION = M_PI / 128.0;

/* What the steps that are taken lose in log weight, on average of both sides: those of the three
 * nodes that integrate a Gaussian best. */
static const double LOSS = 1.5;

/* Of ln r: a stretch stays one. */
static const double LEAST = 0.01;

static double wrapped(double rotation)
{
    const double folded = fmod(rotation, M_PI);
    return folded < 0.0 ? folded + M_PI : folded;
}

gonio_i_stretch gonio_i_stretch_moved(gonio_i_stretch from, double ratio, double rotation)
{
    gonio_i_stretch to = from;
    const double turn = from.log_ratio + ratio < 0.0 ? 0.5 * M_PI : 0.0;
    to.log_ratio = fmax(fabs(from.log_ratio + ratio), LEAST);
    to.rotation = wrapped(from.rotation + rotation + turn);
    return to;
}

/* The step whose loss is LOSS, if the loss grows as its square. trials[2 STEPS]: to either side. */
static double step_of(const gonio_i_trial *trials, double weight, double least)
{
    double step = least;
    for (size_t k = 0; k < STEPS; k++) {
        const double loss = weight - 0.5 * (gonio_i_trial_weight(&trials[2 * k]) +
                                            gonio_i_trial_weight(&trials[2 * k + 1]));
        step = least * (double)(1 << k);
        if (loss > LOSS) {
            return step * sqrt(LOSS / loss);
        }
    }
    return step;
}

/* Steps of the ratio and of the azimuth. */
static gonio_status find_steps(gonio_i_search *s, const gonio_i_trial *centre, double *ratio,
                               double *rotation)
{
    gonio_i_trial trials[1 + 4 * STEPS];
    gonio_i_trial *ratios = trials + 1;
    gonio_i_trial *rotations = ratios + 2 * (size_t)STEPS;
    trials[0] = *centre;
    for (size_t k = 0; k < 2 * (size_t)STEPS; k++) {
        const double step = (double)(1 << k / 2) * (k % 2 == 0 ? 1.0 : -1.0);
        ratios[k] = rotations[k] = *centre;
        ratios[k].stretch = gonio_i_stretch_moved(centre->stretch, step * LEAST_RATIO, 0.0);
        rotations[k].stretch = gonio_i_stretch_moved(centre->stretch, 0.0, step * LEAST_ROTATION);
    }
    const gonio_status status = gonio_i_trials_score(s, trials, 1 + 4 * (size_t)STEPS);
    if (status == GONIO_OK) {
        const double weight = gonio_i_trial_weight(&trials[0]);
        *ratio = step_of(ratios, weight, LEAST_RATIO);
        *rotation = step_of(rotations, weight, LEAST_ROTATION);
    }
    return status;
}

static void share_out(const gonio_i_trial *trials, const gonio_i_hypothesis *h,
                      gonio_i_hypothesis *around)
{
    double most = -INFINITY;
    double sum = 0.0;
    for (size_t k = 0; k < GONIO_I_SPREAD; k++) {
        most = fmax(most, gonio_i_trial_weight(&trials[k]));
    }
    for (size_t k = 0; k < GONIO_I_SPREAD; k++) {
        sum += exp(gonio_i_trial_weight(&trials[k]) - most);
    }
    for (size_t k = 0; k < GONIO_I_SPREAD; k++) {
        around[k] = *h;
        around[k].stretch = trials[k].stretch;
        around[k].weight += gonio_i_trial_weight(&trials[k]) - most - log(sum);
    }
}

gonio_status gonio_i_stretch_spread(gonio_i_search *s, const gonio_i_hypothesis *h,
                                    gonio_i_hypothesis *around)
{
    gonio_i_model model = h->model;
    model.h = 1.0; /* mixtures take longer */
    const gonio_i_trial centre = gonio_i_trial_of(h->stretch, &model, 1);
    gonio_i_trial trials[GONIO_I_SPREAD];
    double ratio = 0.0;
    double rotation = 0.0;
    gonio_status status = find_steps(s, &centre, &ratio, &rotation);
    for (int k = 0; k < GONIO_I_SPREAD; k++) {
        const int across = k / 3 - 1;
        const int turns = k % 3 - 1;
        trials[k] = centre;
        trials[k].stretch = gonio_i_stretch_moved(h->stretch, across * ratio, turns * rotation);
    }
    if (status == GONIO_OK) {
        status = gonio_i_trials_score(s, trials, GONIO_I_SPREAD);
    }
    if (status == GONIO_OK) {
        share_out(trials, h, around);
    }
    return status;
}
