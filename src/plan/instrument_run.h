/* The run of a plan: which settings make its readings, in which order, and when; and what it leaves
 * unseen. */
#ifndef GONIO_INSTRUMENT_RUN_H
#define GONIO_INSTRUMENT_RUN_H

#include <gonio/plan.h>

#include "../instrument/order.h"
#include "../prior/prior.h"

typedef struct gonio_i_run {
    size_t count;
    size_t *order;          /* [count]: places in the order of choice */
    gonio_setting *setting; /* [count], in order */
    double *time;           /* [count], s: the end of each reading */
    double duration;        /* s */
    double unordered;       /* s: in the order of choice */
} gonio_i_run;

/* Orders the readings offered[chosen[count]]. nested: within blocks of 5, 5, 10, 20, 40 ... To be
 * freed in any case. Errors: _MEMORY, _CANCELLED. */
gonio_status gonio_i_run_create(gonio_context *context, const gonio_instrument *instrument,
                                const gonio_setting *offered, const size_t *chosen, size_t count,
                                bool nested, gonio_i_order_effort effort, gonio_i_run *run);
void gonio_i_run_free(gonio_i_run *run);

/* Moves a run into a plan. Errors: _MEMORY. */
gonio_status gonio_i_run_to_plan(gonio_context *context, const gonio_instrument *instrument,
                                 gonio_i_run *run, gonio_plan *plan);

/* The parts of all pairs that an instrument reaches and does not, and the deviation there that a
 * covariance [K][K] of z leaves. Errors: _MEMORY. */
gonio_status gonio_i_find_parts(gonio_context *context, const gonio_instrument *instrument,
                                const gonio_i_prior *prior, const double *covariance,
                                gonio_plan_run *run);

#endif
