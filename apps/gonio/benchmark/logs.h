/* Readings in log space, in which the simple methods work. */
#ifndef GONIO_BENCHMARK_LOGS_H
#define GONIO_BENCHMARK_LOGS_H

#include <gonio/measurement.h>

/* Values of readings in log space: logs[count][channels], NaN where nothing was read. Errors:
 * _MEMORY. */
gonio_status benchmark_logs(gonio_context *context, const gonio_readings *readings, double **logs);

#endif
