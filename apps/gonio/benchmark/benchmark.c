/* The benchmark as a whole: see benchmark.h. */
#include "benchmark.h"

#include "page.h"
#include "tables.h"

#include "core/core.h"

static gonio_status write_all(gonio_context *context, const benchmark_setting *setting,
                              const benchmark_rows *rows, const char *folder)
{
    benchmark_summary summary;
    gonio_status status = benchmark_summarise(context, rows, &summary);
    if (status == GONIO_OK) {
        status = benchmark_write_tables(context, setting, rows, &summary, folder);
    }
    if (status == GONIO_OK) {
        status = benchmark_write_page(context, setting, rows, &summary, folder);
    }
    benchmark_summary_free(&summary);
    return status;
}

gonio_status benchmark(gonio_context *context, const benchmark_setting *setting,
                       const benchmark_subjects *subjects, const char *folder)
{
    benchmark_lessons lessons;
    benchmark_rows rows = {0};
    gonio_status status = benchmark_lessons_make(context, setting, subjects, &lessons);
    if (status == GONIO_OK) {
        status = benchmark_run(context, setting, subjects, &lessons, folder, &rows);
    }
    if (status == GONIO_OK && rows.count == 0) {
        gonio_i_warn(context,
                     "%s: no trials: of scattered readings at most half are read, and "
                     "directions are drawn from candidates only",
                     folder);
    }
    if (status == GONIO_OK && (setting->group == NULL || setting->group->rank == 0)) {
        status = write_all(context, setting, &rows, folder);
    }
    benchmark_rows_free(&rows);
    benchmark_lessons_free(&lessons);
    return status;
}
