/* The errors that the experiments report: which metrics, as cells of CSV files and as JSON. */
#ifndef GONIO_REPORTED_ERRORS_H
#define GONIO_REPORTED_ERRORS_H

#include <stdio.h>

#include <gonio/metric.h>
#include <jansson.h>

/* The metrics, in the order of the columns: those of the paper and of what it is compared with. */
enum { GONIO_I_REPORTED = 3 };
extern const gonio_metric gonio_i_reported[GONIO_I_REPORTED];

/* The last columns of a line of CSV: their names, or an error. */
void gonio_i_put_error_columns(FILE *f);
void gonio_i_put_error(FILE *f, gonio_error error);

/* {"e6_percent": ..., ...}; null for what is no number. */
json_t *gonio_i_reported_json(gonio_error error);

#endif
