/* Readings at other turns of the sample: what they say of its anisotropy. */
#include <math.h>
#include <stdlib.h>

#include "readings.h"

/* Directions that agree to this are the same, degrees; turns differ by more than 1 degree. */
static const double SAME = 0.01;
static const double TURN = 1.0;

enum { ANGLES = 3 };

/* theta_i, theta_o and phi_o - phi_i in units of SAME; the azimuth of the sample in degrees. */
typedef struct turned {
    long angle[ANGLES];
    double turn;
    size_t reading;
} turned;

static double degrees(double radians)
{
    return radians * 180.0 / M_PI;
}

/* Near the normal a direction has no azimuth; the turn is the other direction's. */
static turned of_reading(const gonio_readings *readings, size_t reading)
{
    const gonio_pair pair = readings->pair[reading];
    const long theta_i = lround(degrees(pair.incident.theta) / SAME);
    const long theta_o = lround(degrees(pair.outgoing.theta) / SAME);
    const long circle = lround(360.0 / SAME);
    const long across = lround(degrees(pair.outgoing.phi - pair.incident.phi) / SAME);
    const bool pole = theta_i == 0 || theta_o == 0;
    return (turned){{theta_i, theta_o, pole ? 0 : (across % circle + circle) % circle},
                    degrees(theta_i == 0 ? pair.outgoing.phi : pair.incident.phi),
                    reading};
}

static int compare_turned(const void *a, const void *b)
{
    const turned *x = a;
    const turned *y = b;
    for (int k = 0; k < ANGLES; k++) {
        if (x->angle[k] != y->angle[k]) {
            return x->angle[k] < y->angle[k] ? -1 : 1;
        }
    }
    if (x->turn != y->turn) {
        return x->turn < y->turn ? -1 : 1;
    }
    return (x->reading > y->reading) - (x->reading < y->reading);
}

/* Whether two readings are at the same angles and other turns. At the normal there is no turn. */
static bool is_pair(const turned *a, const turned *b)
{
    bool same = a->angle[0] > 0 || a->angle[1] > 0;
    for (int k = 0; k < ANGLES; k++) {
        same = same && a->angle[k] == b->angle[k];
    }
    return same && fabs(remainder(b->turn - a->turn, 360.0)) > TURN;
}

/* The mean over the channels of |ln| of the ratio of two readings; NaN without a common channel. */
static double differ(const gonio_readings *readings, size_t a, size_t b)
{
    double sum = 0.0;
    size_t channels = 0;
    for (size_t c = 0; c < readings->channels; c++) {
        const double s = gonio_readings_scale(readings, c);
        const double ratio =
            (gonio_readings_value(readings, a, c) + s) / (gonio_readings_value(readings, b, c) + s);
        if (!isnan(ratio)) {
            sum += fabs(log(ratio));
            channels++;
        }
    }
    return channels > 0 ? sum / (double)channels : NAN;
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* difference: of each pair of neighbours in `sorted`. Returns how many there are. */
static size_t find_differences(const gonio_readings *readings, const turned *sorted,
                               double *difference)
{
    size_t pairs = 0;
    for (size_t k = 1; k < readings->count; k++) {
        if (is_pair(&sorted[k - 1], &sorted[k])) {
            difference[pairs] = differ(readings, sorted[k - 1].reading, sorted[k].reading);
            pairs += !isnan(difference[pairs]);
        }
    }
    return pairs;
}

gonio_status gonio_i_readings_compare_turned(gonio_context *context, const gonio_readings *readings,
                                             size_t *pairs, double *median)
{
    turned *sorted = gonio_i_allocate(context, readings->count, sizeof *sorted);
    double *difference = gonio_i_allocate(context, readings->count, sizeof *difference);
    const bool done = sorted != NULL && difference != NULL;
    *pairs = 0;
    *median = 0.0;
    if (done) {
        for (size_t k = 0; k < readings->count; k++) {
            sorted[k] = of_reading(readings, k);
        }
        qsort(sorted, readings->count, sizeof *sorted, compare_turned);
        *pairs = find_differences(readings, sorted, difference);
        qsort(difference, *pairs, sizeof *difference, compare_numbers);
        *median = *pairs > 0 ? difference[*pairs / 2] : 0.0;
    }
    free(sorted);
    free(difference);
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}
