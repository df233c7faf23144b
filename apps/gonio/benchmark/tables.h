/* The numbers of a benchmark as files: CSV and JSON. */
#ifndef GONIO_BENCHMARK_TABLES_H
#define GONIO_BENCHMARK_TABLES_H

#include "summary.h"

/* In the folder: tables/trials.csv (every row), tables/means.csv, tables/times.csv (seconds, which
 * alone differ from run to run), results.json (the means). Errors: _IO, _MEMORY. */
gonio_status benchmark_write_tables(gonio_context *context, const benchmark_setting *setting,
                                    const benchmark_rows *rows, const benchmark_summary *summary,
                                    const char *folder);

#endif
