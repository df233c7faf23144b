/* What an instrument reaches of all pairs of directions, and what keeps the others out. */
#include <math.h>
#include <stdlib.h>

#include "settings.h"

enum { POLAR = 30, AZIMUTHS = 36, MOST_CANDIDATES = 8000 };

static void count_obstacle(gonio_reach *reach, const char *name, double share)
{
    for (size_t k = 0; k < reach->obstacles; k++) {
        if (reach->obstacle[k] == name) {
            reach->kept_out[k] += share;
            return;
        }
    }
    if (reach->obstacles < GONIO_MOST_OBSTACLES) {
        reach->obstacle[reach->obstacles] = name;
        reach->kept_out[reach->obstacles++] = share;
    }
}

static void sort_obstacles(gonio_reach *reach)
{
    for (size_t k = 1; k < reach->obstacles; k++) {
        for (size_t j = k; j > 0 && reach->kept_out[j] > reach->kept_out[j - 1]; j--) {
            const double share = reach->kept_out[j];
            const char *name = reach->obstacle[j];
            reach->kept_out[j] = reach->kept_out[j - 1];
            reach->obstacle[j] = reach->obstacle[j - 1];
            reach->kept_out[j - 1] = share;
            reach->obstacle[j - 1] = name;
        }
    }
}

/* Polar angles whose rings have the same projected solid angle. */
static double ring(int k)
{
    return asin(sqrt((k + 0.5) / POLAR));
}

/* Pairs at the centres of cells of equal share. */
static void survey_pairs(const gonio_instrument *instrument, gonio_freedom freedom,
                         gonio_reach *reach)
{
    const double share = 1.0 / ((double)POLAR * POLAR * AZIMUTHS);
    for (int i = 0; i < POLAR; i++) {
        for (int o = 0; o < POLAR; o++) {
            for (int k = 0; k < AZIMUTHS; k++) {
                const gonio_pair pair = {{ring(i), 0.0},
                                         {ring(o), 2.0 * M_PI * (k + 0.5) / AZIMUTHS}};
                const char *obstacle = gonio_instrument_region_obstacle(instrument, pair, freedom);
                if (obstacle == NULL) {
                    reach->share += share;
                } else {
                    count_obstacle(reach, obstacle, share);
                }
            }
        }
    }
}

static double angle_between(gonio_angles a, gonio_angles b, double turn)
{
    const double cosine =
        cos(a.theta) * cos(b.theta) + sin(a.theta) * sin(b.theta) * cos(b.phi - a.phi + turn);
    return acos(fmin(fmax(cosine, -1.0), 1.0));
}

static void widen(double range[2], double value)
{
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

static void survey_candidate(const gonio_pair *pair, gonio_reach *reach)
{
    widen(reach->theta_i, pair->incident.theta);
    widen(reach->theta_o, pair->outgoing.theta);
    reach->least_separation =
        fmin(reach->least_separation, angle_between(pair->incident, pair->outgoing, 0.0));
    reach->least_from_specular =
        fmin(reach->least_from_specular, angle_between(pair->incident, pair->outgoing, M_PI));
}

gonio_status gonio_instrument_survey(gonio_context *context, const gonio_instrument *instrument,
                                     gonio_freedom freedom, gonio_reach *reach)
{
    gonio_setting *setting = NULL;
    size_t count = 0;
    const gonio_status status = gonio_instrument_candidates(context, instrument, freedom,
                                                            MOST_CANDIDATES, &setting, &count);
    if (status != GONIO_OK) {
        return status;
    }
    *reach = (gonio_reach){.theta_i = {INFINITY, 0.0},
                           .theta_o = {INFINITY, 0.0},
                           .least_separation = INFINITY,
                           .least_from_specular = INFINITY};
    for (size_t k = 0; k < count; k++) {
        survey_candidate(&setting[k].pair, reach);
    }
    free(setting);
    survey_pairs(instrument, freedom, reach);
    sort_obstacles(reach);
    return GONIO_OK;
}
