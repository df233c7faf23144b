/* The page of a benchmark: report.md, with its curves. */
#ifndef GONIO_BENCHMARK_PAGE_H
#define GONIO_BENCHMARK_PAGE_H

#include "summary.h"

/* Writes report.md and figures/ in the folder. Errors: _IO, _MEMORY, those of figure.h. */
gonio_status benchmark_write_page(gonio_context *context, const benchmark_setting *setting,
                                  const benchmark_rows *rows, const benchmark_summary *summary,
                                  const char *folder);

#endif
