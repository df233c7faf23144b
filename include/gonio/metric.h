/* Error metrics: the error of a reflectance rho' relative to a reference rho.
 *
 * Over the values compared (bins or readings, times channels), with g = ln(1 + rho/s) the log space
 * of database.h and c_i, c_o the cosines of the incident and the outgoing direction:
 *   e6             100 sqrt(sum (g - g')^2 / sum g^2); Ali et al., eq. (6)
 *   cube-root      100 sqrt(sum (r - r')^2 / sum r^2), r = cbrt(rho c_i c_o); Fores et al. 2012
 *   log-relative   sqrt(mean ln^2((rho w + e)/(rho' w + e))), e = 0.001 1/sr,
 *                  w = clip(c_i c_o, 0.01, 1); Nielsen et al. 2015
 *   bias           100 mean(g' - g): above 0 if rho' is too bright. For reflectance far above s it
 *                  is the mean of ln(rho'/rho) in per cent: 9.5 if rho' is 1.1 rho
 *
 * All functions are pure; threads may share what they return, which is never released. */
#ifndef GONIO_METRIC_H
#define GONIO_METRIC_H

#include <stdbool.h>

#include <gonio/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The metrics whose place in the table callers may rely on. */
typedef enum gonio_metric {
    GONIO_E6 = 0,
    GONIO_CUBE_ROOT = 1,
    GONIO_LOG_RELATIVE_ERROR = 2,
    GONIO_BIAS = 3
} gonio_metric;

/* Room for metrics in a gonio_error. */
enum { GONIO_MOST_METRICS = 16 };

/* The errors by every metric, in the order of the table; 0 past its end. */
typedef struct gonio_error {
    double value[GONIO_MOST_METRICS];
} gonio_error;

/* The names of a metric. */
typedef struct gonio_metric_view {
    const char *name;    /* on command lines: "cube-root" */
    const char *key;     /* in JSON and CSV: "cube_root_percent" */
    const char *heading; /* of a column, at most 9 characters: "cbrt %" */
    const char *title;   /* in text: "cube root" */
    const char *unit;    /* "%", or "" for natural log units */
    const char *summary; /* one line: what it measures, and its source */
    int digits;          /* worth showing after the decimal point */
    bool plannable;      /* plans can be made for its expected value (gonio_plan_options.metric) */
} gonio_metric_view;

/* The metric at a place in the table; NULL past the last, and for negative numbers. */
GONIO_API const gonio_metric_view *gonio_metric_describe(int metric);

/* The place of a metric in the table by its name; -1 if there is none. */
GONIO_API int gonio_metric_find(const char *name);

#ifdef __cplusplus
}
#endif
#endif
