/* What a plan's file says of the plan in its comments. */
#ifndef GONIO_PLAN_FILE_H
#define GONIO_PLAN_FILE_H

#include <gonio/plan.h>

#include "../core/comments.h"

/* Adds the title, the basis, K, the method and the frame; false when out of memory. */
bool gonio_i_plan_comments(const gonio_plan *plan, gonio_i_comments *comments);

#endif
