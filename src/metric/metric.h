/* The interface of an error metric: a row of the table in metrics.c, which the metric's own file
 * defines.
 *
 * A metric compares values by the terms d = T(rho, c) - T(rho', c), c = c_i c_o. It is computed
 * from sums over these terms. */
#ifndef GONIO_I_METRIC_H
#define GONIO_I_METRIC_H

#include <stddef.h>

#include <gonio/metric.h>

/* The metrics, one a line, in the order of gonio_metric: gonio_i_metric_NAME is in NAME.c. */
#define GONIO_I_METRICS(METRIC)                                                                    \
    METRIC(e6)                                                                                     \
    METRIC(cube_root)                                                                              \
    METRIC(log_relative)                                                                           \
    METRIC(bias)

/* Values of one channel that are compared. */
typedef struct gonio_i_compared {
    size_t count;
    const double *reference; /* rho, 1/sr, finite and not negative; */
    const double *other;     /* rho' likewise */
    const double *cosines;   /* c_i c_o, not negative */
    double scale;            /* s of the channel, 1/sr */
} gonio_i_compared;

/* Sums over values, which can be added up. */
typedef struct gonio_i_metric_sums {
    double difference; /* of d */
    double square;     /* of d^2 */
    double reference;  /* of the squares that the error is relative to */
} gonio_i_metric_sums;

typedef struct gonio_i_metric {
    gonio_metric_view view;
    /* d of each value, [count]; and what the error is relative to, [count], 0 for an absolute one
     */
    void (*terms)(const gonio_i_compared *values, double *difference, double *reference);
    /* The error from the sums over so many values. */
    double (*finish)(const gonio_i_metric_sums *sums, double values);
    /* The factor a(c), if the terms are a(c) times the terms at c = 1. NULL otherwise; the terms
     * then are a smooth function of clip(c, 0.01, 1). */
    double (*proportion)(double cosines);
    /* (dT/dg)^2: how fast d^2 grows with the square of an error of g. NULL if no plan can be made
     * for the metric. */
    double (*loss)(double rho, double scale, double cosines);
} gonio_i_metric;

#define GONIO_I_DECLARE_METRIC(name) extern const gonio_i_metric gonio_i_metric_##name;
GONIO_I_METRICS(GONIO_I_DECLARE_METRIC)

/* The number of metrics, and the metric at an index. */
int gonio_i_metric_count(void);
const gonio_i_metric *gonio_i_metric_at(int metric);

/* The sums of all metrics. */
typedef struct gonio_i_error_sums {
    gonio_i_metric_sums metric[GONIO_MOST_METRICS];
} gonio_i_error_sums;

/* Adds n terms to the sums of a metric; the order of the sums depends on n only. */
void gonio_i_metric_add_terms(size_t n, const double *difference, const double *reference,
                              gonio_i_metric_sums *sums);

/* Adds values to the sums of all metrics. scratch: [2][count]. */
void gonio_i_error_add_values(const gonio_i_compared *values, double *scratch,
                              gonio_i_error_sums *sums);

void gonio_i_error_add(gonio_i_error_sums *total, const gonio_i_error_sums *part);

/* The errors over so many values (bins x channels). */
gonio_error gonio_i_error_of(const gonio_i_error_sums *sums, double values);

/* Ways to finish: root mean square in per cent of the reference's; root mean square. */
double gonio_i_relative_rms_percent(const gonio_i_metric_sums *sums, double values);
double gonio_i_rms(const gonio_i_metric_sums *sums, double values);

/* d = g - g' of each value, and g. */
void gonio_i_log_terms(const gonio_i_compared *values, double *difference, double *reference);

/* The proportion of terms that do not depend on the cosines: 1. */
double gonio_i_independent(double cosines);

/* w = clip(c, 0.01, 1). */
static inline double gonio_i_clip_cosines(double cosines)
{
    const double least = cosines > 0.01 ? cosines : 0.01;
    return least < 1.0 ? least : 1.0;
}

#endif
