/* All raw numbers of the experiments as CSV files. */
#ifndef GONIO_REPRODUCE_CSV_TABLES_H
#define GONIO_REPRODUCE_CSV_TABLES_H

#include "summary.h"

/* Writes the tables to a folder, which is created. Errors: _IO, _MEMORY. */
gonio_status gonio_i_write_tables(gonio_context *context, const gonio_i_study *study,
                                  const gonio_i_results *results, const gonio_i_findings *findings,
                                  const char *folder);

/* The name of a series of errors: "80 samples", "all samples", "bivariate". */
const char *gonio_i_series_name(const gonio_i_study *study, size_t series, char text[32]);

#endif
