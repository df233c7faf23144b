/* The paper's experiments on the user's database: see reproduce.h. */
#include "reproduce.h"

#include <stdlib.h>

#include "results/paper_figures.h"
#include "results/markdown.h"
#include "results/csv_tables.h"

/* A folder in the folder of the run; released with free(). */
static char *inside(gonio_context *context, const char *folder, const char *name)
{
    char *path = gonio_i_format("%s/%s", folder, name);
    if (path == NULL) {
        gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    return path;
}

static gonio_status write_texts(gonio_context *context, const gonio_i_study *study,
                                const gonio_i_findings *findings, const gonio_i_results *results,
                                const char *folder)
{
    gonio_i_claims claims;
    gonio_status status = gonio_i_make_claims(context, study, results, findings, &claims);
    if (status == GONIO_OK) {
        status = gonio_i_write_page(context, study, findings, &claims, folder);
    }
    if (status == GONIO_OK) {
        status = gonio_i_write_results(context, study, findings, &claims, folder);
    }
    gonio_i_claims_free(&claims);
    return status;
}

static gonio_status write_all(gonio_context *context, const gonio_i_study *study,
                              const gonio_i_results *results, const char *folder)
{
    gonio_i_findings findings;
    char *tables = inside(context, folder, "tables");
    char *figures = inside(context, folder, "figures");
    gonio_status status = tables != NULL && figures != NULL
                              ? gonio_i_find(context, study, results, &findings)
                              : GONIO_ERROR_MEMORY;
    if (tables != NULL && figures != NULL) {
        if (status == GONIO_OK) {
            status = gonio_i_write_tables(context, study, results, &findings, tables);
        }
        if (status == GONIO_OK) {
            status = gonio_i_draw(context, study, results, &findings, figures);
        }
        if (status == GONIO_OK) {
            status = write_texts(context, study, &findings, results, folder);
        }
        gonio_i_findings_free(&findings);
    }
    free(tables);
    free(figures);
    return status;
}

static gonio_status run(gonio_context *context, const gonio_i_study *study, const char *folder,
                        const process_group *group)
{
    gonio_i_checkpoint *checkpoint = NULL;
    gonio_i_results results = {0};
    json_t *identity = gonio_i_study_identity(study);
    gonio_status status =
        identity != NULL ? gonio_i_checkpoint_open(context, folder, identity, group, &checkpoint)
                         : gonio_i_fail(context, GONIO_ERROR_MEMORY,
                                        "a material's name is not UTF-8, or out of memory");
    if (status == GONIO_OK) {
        status = gonio_i_run_experiments(context, study, checkpoint, &results);
    }
    if (status == GONIO_OK && (group == NULL || group->rank == 0)) {
        status = write_all(context, study, &results, folder);
    }
    gonio_i_results_free(&results);
    gonio_i_checkpoint_free(&checkpoint);
    json_decref(identity);
    return status;
}

gonio_status gonio_reproduce(gonio_context *context, const char *const *paths, size_t count,
                             const char *folder, const gonio_reproduce_options *options)
{
    gonio_reproduce_options defaults;
    gonio_reproduce_options_default(&defaults);
    options = options != NULL ? options : &defaults;
    gonio_i_study study;
    gonio_status status = gonio_i_study_create(context, paths, count, options, &study);
    if (status == GONIO_OK) {
        status = run(context, &study, folder, options->group);
    }
    gonio_i_study_free(&study);
    return status;
}
