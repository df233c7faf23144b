/* Plans in files: names of channels, and the comments that describe the plan. */
#ifndef GONIO_PLAN_FILE_H
#define GONIO_PLAN_FILE_H

#include <gonio/plan.h>

#include "../core/comments.h"

/* The name of the channel that a plan reads, GONIO_ALL_CHANNELS .. 2: "all", "R", "G" or "B". */
const char *gonio_i_planned_channel_name(int channel);

/* Adds the title, the basis, K, the method and the frame; false when out of memory. */
bool gonio_i_plan_comments(const gonio_plan *plan, gonio_i_comments *comments);

#endif
