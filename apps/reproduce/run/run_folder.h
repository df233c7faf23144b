/* The folder of a long run: whose it is (run.json), and that nobody else works in it. */
#ifndef GONIO_REPRODUCE_RUN_FOLDER_H
#define GONIO_REPRODUCE_RUN_FOLDER_H

#include <jansson.h>

#include "core/core.h"

/* Makes the folder or takes up the one that is there, and returns a descriptor that keeps others
 * out until it is closed. `run` is what run.json must hold. Errors: _IO; _MISMATCH for another
 * run's folder, naming what differs; _ARGUMENT for a folder with other things in it, or where a run
 * is going on; _FORMAT for a run.json that nobody can read. */
gonio_status gonio_i_run_folder_take(gonio_context *context, const char *folder, json_t *run,
                                     int *descriptor);

/* Checks that the folder is there and is this run's; for those who do not make it. */
gonio_status gonio_i_run_folder_check(gonio_context *context, const char *folder, json_t *run);

/* What differs between two JSON values, for people: "seed is 1 there and 2 here; ..."; an empty
 * text if nothing does, NULL when out of memory; released with free(). */
char *gonio_i_json_difference(const json_t *there, const json_t *here);

/* Writes text as a file that appears whole or not at all. */
gonio_status gonio_i_write_text(gonio_context *context, const char *path, const char *text);

/* Makes a folder; one that is there already is fine. */
gonio_status gonio_i_make_folder(gonio_context *context, const char *path);

#endif
