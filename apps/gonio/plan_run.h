/* What a plan for an instrument costs, in words and as JSON. */
#ifndef GONIO_PLAN_RUN_H
#define GONIO_PLAN_RUN_H

#include <jansson.h>

#include "command_line.h"

/* Prints the time, the expected error and what stays unseen of a plan that has a run. */
void plan_run_print(const gonio_plan *plan, const char *output);

/* Adds the same to JSON; nothing if the plan has no run. */
void plan_run_add_json(const gonio_plan *plan, json_t *json);

#endif
