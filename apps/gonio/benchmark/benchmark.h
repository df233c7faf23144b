/* `gonio benchmark`: how well BRDFs are completed from n readings, by many methods on many
 * materials.
 */
#ifndef GONIO_BENCHMARK_H
#define GONIO_BENCHMARK_H

#include "setting.h"
#include "subjects.h"

/* Runs the trials that the folder lacks and leaves in it
 *   report.md       a section for each set: errors, honesty, curves
 *   results.json    means for programs
 *   figures/        data, gnuplot script and pictures
 *   tables/         every trial, means and times as CSV
 *   run.json, pieces/  what is finished: a run that was stopped goes on there
 * All but times is the same for any number of threads or processes. Errors: _ARGUMENT for a folder
 * that is not empty; _MISMATCH for that of another run or build; those of lessons.h and run.h. */
gonio_status benchmark(gonio_context *context, const benchmark_setting *setting,
                       const benchmark_subjects *subjects, const char *folder);

#endif
