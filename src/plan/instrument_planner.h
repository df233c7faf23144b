/* What the parts of a plan for an instrument share: what is offered, and what is chosen of it. */
#ifndef GONIO_INSTRUMENT_PLANNER_H
#define GONIO_INSTRUMENT_PLANNER_H

#include <gonio/plan.h>

#include "expected_error_scale.h"
#include "expected_error_search.h"
#include "instrument_choices.h"
#include "instrument_run.h"

typedef struct gonio_i_planner {
    gonio_context *context;
    const gonio_plan_options *options;
    const gonio_i_known *known;
    gonio_i_prior *prior;
    gonio_i_choices grid; /* what the error is over */
    gonio_i_instrument_choices offered;
    double *weights; /* [K][K]: W of the grid's loss */
    gonio_i_error_of_loss error;
    size_t *chosen;    /* [room]: rows of what is offered, in the order of choice */
    double *remaining; /* [room + 1] */
    size_t room;
    size_t count;
} gonio_i_planner;

/* The choice of `count` readings among what is offered (expected_error_search.h). */
gonio_i_expected_error_problem gonio_i_planner_problem(const gonio_i_planner *p, size_t count,
                                                       double price, int sweeps);

/* Room for `count` chosen readings. Errors: _MEMORY. */
gonio_status gonio_i_planner_make_room(gonio_i_planner *p, size_t count);

/* Chooses them: p->chosen, p->remaining and p->count. Errors: _MEMORY, _CANCELLED. */
gonio_status gonio_i_planner_choose(gonio_i_planner *p, size_t count, double price, int sweeps);

/* The run of the first `count` chosen. Errors: _MEMORY, _CANCELLED. */
gonio_status gonio_i_planner_run(const gonio_i_planner *p, size_t count,
                                 gonio_i_order_effort effort, gonio_i_run *run);

#endif
