/* All raw numbers of the experiments as CSV files. */
#ifndef GONIO_REPRODUCE_CSV_TABLES_H
#define GONIO_REPRODUCE_CSV_TABLES_H

#include "summary.h"

/* Writes them to a folder, which is made. Errors: _IO, _MEMORY. */
gonio_status gonio_i_write_tables(gonio_context *context, const gonio_i_study *study,
                                  const gonio_i_results *results, const gonio_i_findings *findings,
                                  const char *folder);

/* What the errors of a left-out material are of: "80 samples", "all samples", "bivariate". */
const char *gonio_i_series_name(const gonio_i_study *study, size_t series, char text[32]);

#endif
